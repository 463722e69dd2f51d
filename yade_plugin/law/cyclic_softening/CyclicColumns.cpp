// SPDX-License-Identifier: GPL-2.0-or-later
#include "CyclicColumns.hpp"
#include "CyclicSideBySide.hpp"

namespace masonry {

namespace {

using Column = CyclicColumn;

// Advances the subcontacts at which no strength is exceeded and no stiffness changes. One that needs the whole law
// keeps its old state and becomes pending. Returns how many these are.
template <bool spatial, bool yielded, bool curved>
MASONRY_INLINED Mask stayElasticAs(const CyclicEquations& given, const CyclicDerived& ofAll,
                                   const SideBySide& subcontacts) {
    CyclicEquations e = given;
    const SideBySide all = subcontacts;
    e.curved = curved;
    const CyclicDerived same = ofAll;
    double* opening = all.columns[Column::Opening];
    double* shearStressA = all.columns[Column::ShearStressA];
    double* shearStressB = all.columns[Column::ShearStressB];
    double* largestOpening = all.columns[Column::LargestOpening];
    const double* irreversible = all.columns[Column::Irreversible];
    const double* intact = all.columns[Column::Intact];
    const double* secant = all.columns[Column::Secant];
    const double* reach = all.columns[Column::Reach];
    const double* capSquared = all.columns[Column::CapSquared];
    const double* shearStiffness = all.columns[Column::ShearStiffness];
    const double* closingStiffness = all.columns[Column::ClosingStiffness];
    const double* squaredHardening = all.columns[Column::SquaredHardening];
    const double sameCap = same.strength * same.strength;
    Mask waiting = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        const double bond = yielded ? intact[i] : same.intact;
        const double tensileSecant = yielded ? secant[i] : same.secant;
        const double within = yielded ? reach[i] : same.reach;
        const double squaredCap = yielded ? capSquared[i] : sameCap;
        const double plastic = yielded ? irreversible[i] : same.irreversible;
        const double shearing = yielded ? shearStiffness[i] : same.shearing;
        const double closing = yielded ? closingStiffness[i] : same.closing;
        const double hardening = yielded ? squaredHardening[i] : same.squaredHardening;
        const double oldOpening = opening[i];
        const double oldA = shearStressA[i];
        const double oldB = spatial ? shearStressB[i] : 0;
        const double farthest = largestOpening[i];
        const auto moved = PiecewiseEquations::open(oldOpening, plastic, farthest, all.jumps.opening[i]);
        const double sigma = e.normal(moved.elastic, tensileSecant, closing);
        const double a = oldA + shearing * all.jumps.slideA[i];
        const double b = spatial ? oldB + shearing * all.jumps.slideB[i] : 0;
        const double tauSquared = a * a + b * b;
        // a subcontact that opens with one stiffness and closes with another loses energy
        const bool keeps = !yielded | ((closing - tensileSecant) * moved.before * moved.elastic >= 0);
        const bool elastic =
            e.isElastic<curved>({within, bond, squaredCap, hardening}, moved.elastic, sigma, tauSquared) & keeps;
        all.normalStress[i] = sigma;
        opening[i] = elastic ? moved.total : oldOpening;
        shearStressA[i] = elastic ? a : oldA;
        if (spatial) shearStressB[i] = elastic ? b : oldB;
        largestOpening[i] = elastic ? moved.farthest : farthest;
        all.pending[i] = elastic ? 0 : 1;
        waiting += elastic ? 0 : 1;
    }
    return waiting;
}

template <bool spatial, bool yielded>
MASONRY_INLINED Mask stayElasticOn(const CyclicEquations& e, const CyclicDerived& ofAll, const SideBySide& all) {
    return e.curved ? stayElasticAs<spatial, yielded, true>(e, ofAll, all)
                    : stayElasticAs<spatial, yielded, false>(e, ofAll, all);
}

} // namespace

MASONRY_VECTORISED
Waiting stayElastic(const CyclicEquations& e, const CyclicDerived* neverYielded, const SideBySide& all) {
    const bool yielded = neverYielded == nullptr;
    const CyclicDerived ofAll = yielded ? CyclicDerived{} : *neverYielded;
    if (all.jumps.plane)
        return {yielded ? stayElasticOn<false, true>(e, ofAll, all) : stayElasticOn<false, false>(e, ofAll, all), 0};
    return {yielded ? stayElasticOn<true, true>(e, ofAll, all) : stayElasticOn<true, false>(e, ofAll, all), 0};
}

// ---- intact joints --------------------------------------------------------------------------------------------------

namespace {

template <bool spatial>
MASONRY_INLINED void markYieldingAs(const CyclicEquations& given, const CyclicDerived& ofAll, int count,
                                    const double* opening, const double* slideA, const double* slideB, Mask* yielding) {
    const CyclicEquations e = given;
    const double less = 1 - marginOfIntact, more = 1 + marginOfIntact;
    const CyclicEquations::Domain domain{less * ofAll.reach, ofAll.intact, less * ofAll.strength * ofAll.strength,
                                         less * ofAll.squaredHardening};
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double a = e.ks * slideA[i];
        const double b = spatial ? e.ks * slideB[i] : 0;
        const bool elastic = e.isElastic<false>(domain, opening[i], e.kn * opening[i], more * (a * a + b * b));
        yielding[i] += elastic ? 0 : 1;
    }
}

} // namespace

MASONRY_VECTORISED
void markYielding(const CyclicEquations& e, const CyclicDerived& neverYielded, int count, const double* opening,
                  const double* slideA, const double* slideB, Mask* yielding) {
    slideB ? markYieldingAs<true>(e, neverYielded, count, opening, slideA, slideB, yielding)
           : markYieldingAs<false>(e, neverYielded, count, opening, slideA, slideB, yielding);
}

MASONRY_VECTORISED
void rememberElastic(const CyclicEquations&, const Columns& columns, int count, const double* opening) {
    double* largestOpening = columns[Column::LargestOpening];
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double farthest = largestOpening[i];
        largestOpening[i] = opening[i] > farthest ? opening[i] : farthest;
    }
}

// ---- subcontacts that need the whole law ----------------------------------------------------------------------------

namespace cyclic {

void readTable(const SofteningTable& table, std::int32_t TableRows::*row, TableRows* rows, const int* places,
               Asked& a) {
    for (int i = 0; i < a.many; ++i)
        if (a.wanted[i])
            a.found[i] = larger<double>(a.found[i], table.damage(a.at[i], a.shift[i], rows[places[i]].*row));
}
void readCurve(const CyclicEquations& e, Asked& a) {
    for (int i = 0; i < a.many; ++i)
        if (a.wanted[i]) a.found[i] = e.curve.beyondMiddle(a.at[i], e.stretch);
}
void readDecay(const CyclicEquations& e, Asked& a) {
    for (int i = 0; i < a.many; ++i)
        if (a.wanted[i]) a.found[i] = e.dilatancy(a.at[i]);
}
void readEnergy(const CyclicEquations& e, Asked& a) {
    for (int i = 0; i < a.many; ++i)
        if (a.wanted[i]) a.found[i] = e.storedNormal(a.at[i], a.shift[i]);
}

std::vector<Processor> processors() {
    std::vector<Processor> found{{"any processor", advanceOnAny}};
#if MASONRY_VECTOR_UNITS
    if (__builtin_cpu_supports("avx2")) found.push_back({"AVX2", advanceOnAvx2});
    if (__builtin_cpu_supports("x86-64-v4")) found.push_back({"AVX-512", advanceOnAvx512});
#endif
    return found;
}

} // namespace cyclic

void advanceSideBySide(const CyclicEquations& e, const SofteningTable& tension, const SofteningTable& shear,
                       TableRows* rows, const SideBySide& all) {
    static const auto fastest = cyclic::processors().back().advance;
    fastest({e, tension, shear, shear.lastRatio() - 1}, rows, all);
}

namespace {

template <bool yielded>
MASONRY_INLINED void addEnergiesAs(const CyclicEquations& e, const Columns& columns, int count, const double* area,
                                   LaneSums& sums) {
    const double* opening = columns[Column::Opening];
    const double* shearStressA = columns[Column::ShearStressA];
    const double* shearStressB = columns[Column::ShearStressB];
    for (int i = 0; i < count; ++i) {
        const double w = yielded ? opening[i] + columns[Column::Irreversible][i] : opening[i];
        const double secant = yielded ? columns[Column::Secant][i] : e.kn;
        const double closing = yielded ? columns[Column::ClosingStiffness][i] : e.kn;
        const double shearing = yielded ? columns[Column::ShearStiffness][i] : e.ks;
        const double tauSquared = shearStressA[i] * shearStressA[i] + shearStressB[i] * shearStressB[i];
        const double normal = area[i] * e.storedNormal(e.normal(w, secant, closing), w);
        sums.storedTension[i] += w > 0 ? normal : 0;
        sums.storedCompression[i] += w > 0 ? 0 : normal;
        sums.storedShear[i] += area[i] * PiecewiseEquations::storedShear(tauSquared, shearing);
        if (!yielded) continue;
        sums.lostTension[i] += area[i] * columns[Column::LostTension][i];
        sums.lostShear[i] += area[i] * columns[Column::LostShear][i];
        sums.lostCompression[i] += area[i] * columns[Column::LostCompression][i];
    }
}

} // namespace

void addEnergies(const CyclicEquations& e, const Columns& columns, int count, bool yielded, const double* area,
                 LaneSums& sums) {
    yielded ? addEnergiesAs<true>(e, columns, count, area, sums) : addEnergiesAs<false>(e, columns, count, area, sums);
}

} // namespace masonry
