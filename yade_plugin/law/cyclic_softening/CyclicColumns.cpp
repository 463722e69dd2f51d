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

[[gnu::noinline]] void readTable(const SofteningTable& table, std::int32_t TableRows::*row, TableRows* rows, Asked& a) {
    for (int i = 0; i < lanes; ++i)
        if (a.asks[i]) a.found[i] = larger<double>(a.found[i], table.damage(a.at[i], a.shift[i], rows[i].*row));
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
    PackMask waits; // the others are not looked up

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
        readTable(tensionTable, &TableRows::tension, rows, a);
        return load(a.found);
    }
    MASONRY_INLINED Pack shear(const Pack& damage, const Pack& ratio, const Pack& shift, const PackMask& asks) const {
        Asked a = asked(damage, ratio, shift, asks);
        readTable(shearTable, &TableRows::shear, rows, a);
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

// Writes a column where `waits` says so.
MASONRY_INLINED void put(double* to, const Pack& x, const PackMask& waits) { store(to, choose(waits, x, load(to))); }

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
    for (int from = 0; from < count; from += lanes) {
        // jumps, marks and normal stresses may end before the eighth joint
        Pack opening{}, slideA{}, slideB{};
        PackMask mask{};
        const int many = count - from < lanes ? count - from : lanes;
        for (int i = 0; i < many; ++i) {
            mask[i] = waits[from + i] ? -1 : 0;
            opening[i] = jumps.opening[from + i];
            slideA[i] = jumps.slideA[from + i];
            slideB[i] = jumps.slideB[from + i];
        }
        if (!any(mask)) continue;
        const Columns c = columns.from(std::size_t(from));
        CyclicPoint<Pack> p;
        p.opening = load(c[Columns::Opening]);
        p.crushing = load(c[Columns::Crushing]);
        p.dilation = load(c[Columns::Dilation]);
        p.slip = load(c[Columns::Slip]);
        p.largestOpening = load(c[Columns::LargestOpening]);
        p.largestClosure = load(c[Columns::LargestClosure]);
        p.tensionDamage = load(c[Columns::TensionDamage]);
        p.shearDamage = load(c[Columns::ShearDamage]);
        p.shearA = load(c[Columns::ShearStressA]);
        p.shearB = load(c[Columns::ShearStressB]);
        p.plasticA = load(c[Columns::PlasticSlipA]);
        p.plasticB = load(c[Columns::PlasticSlipB]);
        p.shearSoftening = load(c[Columns::ShearSoftening]);
        p.shearStiffnessLoss = load(c[Columns::ShearStiffnessLoss]);
        p.capDisplacement = load(c[Columns::CapDisplacement]);
        p.strength = root(load(c[Columns::CapSquared]));
        p.closing = load(c[Columns::ClosingStiffness]);
        p.shearing = load(c[Columns::ShearStiffness]);
        p.left = load(c[Columns::Intact]);
        p.secant = load(c[Columns::Secant]);
        p.hardening = load(c[Columns::SquaredHardening]);
        p.normalStress = e.normal<Pack>(p.opening + load(c[Columns::Irreversible]), p.secant, p.closing);
        const auto out =
            advance<Pack>(e, LookAtEight{e, tension, shear, rows + from, mask}, p, opening, slideA, slideB);
        // what did not happen to one of them changes no column
        put(c[Columns::Opening], p.opening, mask);
        put(c[Columns::ShearStressA], p.shearA, mask);
        put(c[Columns::ShearStressB], p.shearB, mask);
        if (out.tore | out.dilated) {
            put(c[Columns::LargestOpening], p.largestOpening, mask);
            put(c[Columns::TensionDamage], p.tensionDamage, mask);
            put(c[Columns::ShearDamage], p.shearDamage, mask);
            put(c[Columns::Intact], p.left, mask);
            put(c[Columns::Secant], p.secant, mask);
            put(c[Columns::Reach], e.reach<Pack>(p.left, p.largestOpening), mask);
        }
        if (out.slid) {
            put(c[Columns::Slip], p.slip, mask);
            put(c[Columns::PlasticSlipA], p.plasticA, mask);
            put(c[Columns::PlasticSlipB], p.plasticB, mask);
            put(c[Columns::ShearSoftening], p.shearSoftening, mask);
            put(c[Columns::LostShear], load(c[Columns::LostShear]) + out.lostShear, mask);
            if (e.omegaM > 0) {
                put(c[Columns::ShearStiffnessLoss], p.shearStiffnessLoss, mask);
                put(c[Columns::ShearStiffness], p.shearing, mask);
            }
        }
        if (out.crushed) {
            put(c[Columns::LargestClosure], p.largestClosure, mask);
            put(c[Columns::CapDisplacement], p.capDisplacement, mask);
            put(c[Columns::CapSquared], p.strength * p.strength, mask);
            put(c[Columns::ClosingStiffness], p.closing, mask);
            put(c[Columns::SquaredHardening], p.hardening, mask);
        }
        if (out.crushed | out.dilated) {
            put(c[Columns::Crushing], p.crushing, mask);
            put(c[Columns::Dilation], p.dilation, mask);
            put(c[Columns::Irreversible], p.crushing - p.dilation, mask);
        }
        put(c[Columns::LostTension], load(c[Columns::LostTension]) + out.lostTension, mask);
        put(c[Columns::LostCompression], load(c[Columns::LostCompression]) + out.lostCompression, mask);
        for (int i = 0; i < many; ++i) {
            if (!mask[i]) continue;
            normalStress[from + i] = p.normalStress[i];
            regime[from + i] = Regime(int(out.regime[i]));
        }
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
