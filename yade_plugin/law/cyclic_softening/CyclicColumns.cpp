#include "CyclicColumns.hpp"

namespace masonry {

namespace {

// The law where no strength is passed and no stiffness changes. Tells which subcontacts need more, which then are as
// before, and how many they are.
template <bool spatial, bool yielded, bool curved>
MASONRY_INLINED Mask stayElasticAs(const CyclicEquations& given, const CyclicConsequences& ofAll,
                                   const Columns& columns, std::size_t at, int count, const Jumps& jumps,
                                   double* normalStress, Mask* waits) {
    CyclicEquations e = given;
    e.curved = curved;
    const CyclicConsequences same = ofAll;
    double* opening = columns[Columns::Opening] + at;
    double* shearStressA = columns[Columns::ShearStressA] + at;
    double* shearStressB = columns[Columns::ShearStressB] + at;
    double* largestOpening = columns[Columns::LargestOpening] + at;
    const double* irreversible = columns[Columns::Irreversible] + at;
    const double* intact = columns[Columns::Intact] + at;
    const double* secant = columns[Columns::Secant] + at;
    const double* reach = columns[Columns::Reach] + at;
    const double* capSquared = columns[Columns::CapSquared] + at;
    const double* shearStiffness = columns[Columns::ShearStiffness] + at;
    const double* closingStiffness = columns[Columns::ClosingStiffness] + at;
    const double* squaredHardening = columns[Columns::SquaredHardening] + at;
    const double sameCap = same.strength * same.strength;
    const double onCap = 1 / (e.kn * e.kn);
    Mask waiting = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double bond = yielded ? intact[i] : same.intact;
        const double weak = yielded ? secant[i] : same.secant;
        const double within = yielded ? reach[i] : same.reach;
        const double capable = yielded ? capSquared[i] : sameCap;
        const double plastic = yielded ? irreversible[i] : same.irreversible;
        const double shearing = yielded ? shearStiffness[i] : same.shearing;
        const double closing = yielded ? closingStiffness[i] : same.closing;
        const double hardening = yielded ? squaredHardening[i] : same.squaredHardening;
        const double oldOpening = opening[i];
        const double oldA = shearStressA[i];
        const double oldB = spatial ? shearStressB[i] : 0;
        const double farthest = largestOpening[i];
        const auto moved = Equations::open(oldOpening, plastic, farthest, jumps.opening[i]);
        const double sigma = e.normal(moved.elastic, weak, closing);
        const double a = oldA + shearing * jumps.slideA[i];
        const double b = spatial ? oldB + shearing * jumps.slideB[i] : 0;
        const double tauSquared = a * a + b * b;
        const double strength = e.slipStrength(bond, sigma, moved.elastic);
        const double pressed = smaller(sigma, 0.0);
        const double crushing = e.capStress(pressed, tauSquared);
        const double closed = curved ? pressed / e.kn : smaller(moved.elastic, 0.0);
        const double displaced = sigma < 0 ? closed * closed + e.shearWeight * onCap * tauSquared : 0;
        // a subcontact that opens with one stiffness and closes with another loses energy
        const bool keeps = !yielded | ((closing - weak) * moved.before * moved.elastic >= 0);
        const bool elastic = (moved.elastic <= within) & (tauSquared <= strength * strength) & (crushing <= capable) &
                             (displaced <= hardening) & keeps;
        normalStress[i] = sigma;
        opening[i] = elastic ? moved.total : oldOpening;
        shearStressA[i] = elastic ? a : oldA;
        if (spatial) shearStressB[i] = elastic ? b : oldB;
        largestOpening[i] = elastic ? moved.farthest : farthest;
        waits[i] = elastic ? 0 : 1;
        waiting += elastic ? 0 : 1;
    }
    return waiting;
}

template <bool spatial, bool yielded>
MASONRY_INLINED Mask stayElasticOn(const CyclicEquations& e, const CyclicConsequences& ofAll, const Columns& columns,
                                   std::size_t at, int count, const Jumps& jumps, double* normalStress, Mask* waits) {
    return e.curved ? stayElasticAs<spatial, yielded, true>(e, ofAll, columns, at, count, jumps, normalStress, waits)
                    : stayElasticAs<spatial, yielded, false>(e, ofAll, columns, at, count, jumps, normalStress, waits);
}

// What is looked up one by one. These functions are not compiled into their callers, which would become too large for
// the processor's cache of instructions. The numbers stand in memory, where each can be reached.
struct Asked {
    alignas(64) double at[lanes], shift[lanes], found[lanes];
    alignas(64) Mask asks[lanes];
};

[[gnu::noinline]] void readTable(const SofteningTable& table, std::int32_t TableRows::*row, TableRows* rows,
                                 const int* places, Asked& a) {
    for (int i = 0; i < lanes; ++i)
        if (a.asks[i]) a.found[i] = larger<double>(a.found[i], table.damage(a.at[i], a.shift[i], rows[places[i]].*row));
}
[[gnu::noinline]] void readCurve(const CyclicEquations& e, Asked& a) {
    for (int i = 0; i < lanes; ++i)
        if (a.asks[i]) a.found[i] = e.curve.strength(a.at[i], e.stretch);
}
[[gnu::noinline]] void readDecay(const CyclicEquations& e, Asked& a) {
    for (int i = 0; i < lanes; ++i)
        if (a.asks[i]) a.found[i] = e.dilatancy(a.at[i]);
}
[[gnu::noinline]] void readEnergy(const CyclicEquations& e, Asked& a) {
    for (int i = 0; i < lanes; ++i)
        if (a.asks[i]) a.found[i] = e.storedNormal(a.at[i], a.shift[i]);
}

struct LookAtEight {
    const CyclicEquations& e;
    const SofteningTable &tensionTable, &shearTable;
    TableRows* rows;
    const int* places; // of the eight, in `rows`
    PackMask waits;    // the others are not looked up

    MASONRY_INLINED Asked asked(const Pack& found, const Pack& at, const Pack& shift, const PackMask& asks) const {
        Asked a;
        store(a.at, at);
        store(a.shift, shift);
        store(a.found, found);
        const PackMask both = asks & waits;
        std::memcpy(a.asks, &both, sizeof both);
        return a;
    }
    MASONRY_INLINED Pack tension(const Pack& damage, const Pack& ratio, const Pack& shift, const PackMask& asks) const {
        Asked a = asked(damage, ratio, shift, asks);
        readTable(tensionTable, &TableRows::tension, rows, places, a);
        return load(a.found);
    }
    MASONRY_INLINED Pack shear(const Pack& damage, const Pack& ratio, const Pack& shift, const PackMask& asks) const {
        Asked a = asked(damage, ratio, shift, asks);
        readTable(shearTable, &TableRows::shear, rows, places, a);
        return load(a.found);
    }
    double lastRatio() const { return shearTable.lastRatio() - 1; }
    MASONRY_INLINED Pack strength(const Pack& fc, const Pack& kappa, const PackMask& asks) const {
        Asked a = asked(fc, kappa, kappa, asks);
        readCurve(e, a);
        return load(a.found);
    }
    MASONRY_INLINED Pack decay(const Pack& slip, const PackMask& asks) const {
        Asked a = asked(Pack{}, slip, slip, asks);
        readDecay(e, a);
        return load(a.found);
    }
    MASONRY_INLINED Pack normalEnergy(const Pack& sigma, const Pack& w) const {
        Asked a = asked(Pack{}, sigma, w, waits);
        readEnergy(e, a);
        return load(a.found);
    }
};

// Eight subcontacts of a column, wherever they stand in it.
struct Places {
    int at[lanes]; // the last one stands for those that are missing
    int many;

    MASONRY_INLINED Pack get(const double* column) const {
        alignas(64) double x[lanes];
        for (int i = 0; i < lanes; ++i)
            x[i] = column[at[i]];
        return load(x);
    }
    MASONRY_INLINED void put(double* column, const Pack& x) const {
        for (int i = 0; i < many; ++i)
            column[at[i]] = x[i];
    }
    MASONRY_INLINED void add(double* column, const Pack& x) const {
        for (int i = 0; i < many; ++i)
            column[at[i]] += x[i];
    }
};

} // namespace

MASONRY_VECTORISED
Mask stayElastic(const CyclicEquations& e, const CyclicConsequences* neverYielded, const Columns& columns,
                 std::size_t at, int count, const Jumps& jumps, double* normalStress, Mask* waits) {
    const bool yielded = neverYielded == nullptr;
    const CyclicConsequences ofAll = yielded ? CyclicConsequences{} : *neverYielded;
    if (jumps.plane)
        return yielded ? stayElasticOn<false, true>(e, ofAll, columns, at, count, jumps, normalStress, waits)
                       : stayElasticOn<false, false>(e, ofAll, columns, at, count, jumps, normalStress, waits);
    return yielded ? stayElasticOn<true, true>(e, ofAll, columns, at, count, jumps, normalStress, waits)
                   : stayElasticOn<true, false>(e, ofAll, columns, at, count, jumps, normalStress, waits);
}

MASONRY_VECTORISED
void advanceSideBySide(const CyclicEquations& given, const SofteningTable& tension, const SofteningTable& shear,
                       const Columns& columns, TableRows* rows, Regime* regime, const Jumps& jumps, const Mask* waits,
                       int count, double* normalStress) {
    const CyclicEquations e = given;
    Places eight;
    for (int from = 0; from < count;) {
        // those that wait stand scattered among others, and few of them fill eight places
        int last = 0;
        for (eight.many = 0; from < count && eight.many < lanes; ++from)
            if (waits[from]) eight.at[eight.many++] = last = from;
        if (eight.many == 0) return;
        PackMask mask{};
        for (int i = 0; i < lanes; ++i) {
            mask[i] = i < eight.many ? -1 : 0;
            if (i >= eight.many) eight.at[i] = last;
        }
        const Pack opening = eight.get(jumps.opening), slideA = eight.get(jumps.slideA),
                   slideB = eight.get(jumps.slideB);
        const Columns& c = columns;
        CyclicPoint<Pack> p;
        p.opening = eight.get(c[Columns::Opening]);
        p.crushing = eight.get(c[Columns::Crushing]);
        p.dilation = eight.get(c[Columns::Dilation]);
        p.slip = eight.get(c[Columns::Slip]);
        p.largestOpening = eight.get(c[Columns::LargestOpening]);
        p.largestClosure = eight.get(c[Columns::LargestClosure]);
        p.tensionDamage = eight.get(c[Columns::TensionDamage]);
        p.shearDamage = eight.get(c[Columns::ShearDamage]);
        p.shearA = eight.get(c[Columns::ShearStressA]);
        p.shearB = eight.get(c[Columns::ShearStressB]);
        p.plasticA = eight.get(c[Columns::PlasticSlipA]);
        p.plasticB = eight.get(c[Columns::PlasticSlipB]);
        p.shearSoftening = eight.get(c[Columns::ShearSoftening]);
        p.shearStiffnessLoss = eight.get(c[Columns::ShearStiffnessLoss]);
        p.capDisplacement = eight.get(c[Columns::CapDisplacement]);
        p.strength = root(eight.get(c[Columns::CapSquared]));
        p.closing = eight.get(c[Columns::ClosingStiffness]);
        p.shearing = eight.get(c[Columns::ShearStiffness]);
        p.left = eight.get(c[Columns::Intact]);
        p.secant = eight.get(c[Columns::Secant]);
        p.hardening = eight.get(c[Columns::SquaredHardening]);
        p.normalStress = e.normal<Pack>(p.opening + eight.get(c[Columns::Irreversible]), p.secant, p.closing);
        const auto out =
            advance<Pack>(e, LookAtEight{e, tension, shear, rows, eight.at, mask}, p, opening, slideA, slideB);
        // what did not happen to one of them changes no column
        eight.put(c[Columns::Opening], p.opening);
        eight.put(c[Columns::ShearStressA], p.shearA);
        eight.put(c[Columns::ShearStressB], p.shearB);
        if (out.tore | out.dilated) {
            eight.put(c[Columns::LargestOpening], p.largestOpening);
            eight.put(c[Columns::TensionDamage], p.tensionDamage);
            eight.put(c[Columns::ShearDamage], p.shearDamage);
            eight.put(c[Columns::Intact], p.left);
            eight.put(c[Columns::Secant], p.secant);
            eight.put(c[Columns::Reach], e.reach<Pack>(p.left, p.largestOpening));
        }
        if (out.slid) {
            eight.put(c[Columns::Slip], p.slip);
            eight.put(c[Columns::PlasticSlipA], p.plasticA);
            eight.put(c[Columns::PlasticSlipB], p.plasticB);
            eight.put(c[Columns::ShearSoftening], p.shearSoftening);
            eight.add(c[Columns::LostShear], out.lostShear);
            if (e.omegaM > 0) {
                eight.put(c[Columns::ShearStiffnessLoss], p.shearStiffnessLoss);
                eight.put(c[Columns::ShearStiffness], p.shearing);
            }
        }
        if (out.crushed) {
            eight.put(c[Columns::LargestClosure], p.largestClosure);
            eight.put(c[Columns::CapDisplacement], p.capDisplacement);
            eight.put(c[Columns::CapSquared], p.strength * p.strength);
            eight.put(c[Columns::ClosingStiffness], p.closing);
            eight.put(c[Columns::SquaredHardening], p.hardening);
        }
        if (out.crushed | out.dilated) {
            eight.put(c[Columns::Crushing], p.crushing);
            eight.put(c[Columns::Dilation], p.dilation);
            eight.put(c[Columns::Irreversible], p.crushing - p.dilation);
        }
        eight.add(c[Columns::LostTension], out.lostTension);
        eight.add(c[Columns::LostCompression], out.lostCompression);
        eight.put(normalStress, p.normalStress);
        for (int i = 0; i < eight.many; ++i)
            regime[eight.at[i]] = Regime(int(out.regime[i]));
    }
}

namespace {

template <bool yielded>
MASONRY_INLINED void addEnergiesAs(const CyclicEquations& e, const Columns& columns, std::size_t at, int count,
                                   const double* area, LaneSums& sums) {
    const double* opening = columns[Columns::Opening] + at;
    const double* shearStressA = columns[Columns::ShearStressA] + at;
    const double* shearStressB = columns[Columns::ShearStressB] + at;
    for (int i = 0; i < count; ++i) {
        const double w = yielded ? opening[i] + columns[Columns::Irreversible][at + i] : opening[i];
        const double secant = yielded ? columns[Columns::Secant][at + i] : e.kn;
        const double closing = yielded ? columns[Columns::ClosingStiffness][at + i] : e.kn;
        const double shearing = yielded ? columns[Columns::ShearStiffness][at + i] : e.ks;
        const double tauSquared = shearStressA[i] * shearStressA[i] + shearStressB[i] * shearStressB[i];
        const double normal = area[i] * e.storedNormal(e.normal(w, secant, closing), w);
        sums.storedTension[i] += w > 0 ? normal : 0;
        sums.storedCompression[i] += w > 0 ? 0 : normal;
        sums.storedShear[i] += area[i] * Equations::storedShear(tauSquared, shearing);
        if (!yielded) continue;
        sums.lostTension[i] += area[i] * columns[Columns::LostTension][at + i];
        sums.lostShear[i] += area[i] * columns[Columns::LostShear][at + i];
        sums.lostCompression[i] += area[i] * columns[Columns::LostCompression][at + i];
    }
}

} // namespace

void addEnergies(const CyclicEquations& e, const Columns& columns, std::size_t at, int count, bool yielded,
                 const double* area, LaneSums& sums) {
    yielded ? addEnergiesAs<true>(e, columns, at, count, area, sums)
            : addEnergiesAs<false>(e, columns, at, count, area, sums);
}

} // namespace masonry
