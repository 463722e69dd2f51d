// SPDX-License-Identifier: GPL-2.0-or-later
#include "PiecewiseSideBySide.hpp"
#include <cmath>

namespace masonry {

namespace {

using Column = PiecewiseColumn;
constexpr int most = Columns::most;

} // namespace

// ---- subcontacts that stay elastic ---------------------------------------------------------------------------------

namespace {

// Advances the subcontacts at which no strength is exceeded, by eqs. (6) and (7), the secant of eq. (11), and the three
// conditions of eq. (8). A subcontact that needs the whole law keeps its old state, and its entry of `pending` becomes
// 1.
template <bool spatial, bool yielded, bool residual>
MASONRY_INLINED Waiting stayElasticAs(const PiecewiseEquations& given, const PiecewiseDerived& ofAll,
                                      const Columns& columns, std::size_t at, int count, const Jumps& jumps,
                                      double* normalStress, Mask* pending) {
    const PiecewiseEquations e = given;
    const PiecewiseDerived same = ofAll;
    const double limit = e.curve.limit(e.stretch);
    double* opening = columns[Column::Opening] + at;
    double* shearStressA = columns[Column::ShearStressA] + at;
    double* shearStressB = columns[Column::ShearStressB] + at;
    double* largestOpening = columns[Column::LargestOpening] + at;
    double* largestClosure = columns[Column::LargestClosure] + at;
    const double* irreversible = columns[Column::Irreversible] + at;
    const double* intact = columns[Column::Intact] + at;
    const double* secant = columns[Column::Secant] + at;
    const double* reach = columns[Column::Reach] + at;
    const double* capSquared = columns[Column::CapSquared] + at;
    Mask waiting = 0, open = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double bond = yielded ? intact[i] : same.intact;
        const double tensileSecant = yielded ? secant[i] : same.secant;
        const double within = yielded ? reach[i] : same.reach;
        const double squaredCap = yielded ? capSquared[i] : same.capSquared;
        const double plastic = yielded ? irreversible[i] : same.irreversible;
        const double oldOpening = opening[i];
        const double oldA = shearStressA[i];
        const double oldB = spatial ? shearStressB[i] : 0;
        const double farthest = largestOpening[i];
        const double closest = largestClosure[i];
        const auto moved = e.open(oldOpening, plastic, farthest, jumps.opening[i]);
        const double sigma = e.stiffness(moved.elastic, tensileSecant) * moved.elastic;
        const double a = oldA + e.ks * jumps.slideA[i];
        const double b = spatial ? oldB + e.ks * jumps.slideB[i] : 0;
        const double tauSquared = a * a + b * b;
        const double rest = residual ? e.residualCohesion(moved.elastic) : 0; // most joints have none
        const double closure = e.closure(moved.total, sigma);
        const double hardens = closest > limit ? closest : limit;
        // a subcontact that opens with one stiffness and closes with another loses energy
        const bool keeps = !yielded | ((e.kn - tensileSecant) * moved.before * moved.elastic >= 0);
        const bool elastic =
            e.isElastic({within, bond, squaredCap, hardens}, moved.elastic, sigma, tauSquared, closure, rest) & keeps;
        const Mask stays = elastic ? 1 : 0;
        normalStress[i] = sigma;
        opening[i] = pick(stays, moved.total, oldOpening);
        shearStressA[i] = pick(stays, a, oldA);
        if (spatial) shearStressB[i] = pick(stays, b, oldB);
        largestOpening[i] = pick(stays, moved.farthest, farthest);
        largestClosure[i] = pick(stays, closure > closest ? closure : closest, closest);
        pending[i] = 1 - stays;
        waiting += 1 - stays;
        if (yielded) open += (moved.before > 0) & (tensileSecant == 0) ? 1 : 0;
    }
    return {waiting, open};
}

template <bool spatial, bool yielded>
MASONRY_INLINED Waiting stayElasticAs(const PiecewiseEquations& e, const PiecewiseDerived& ofAll,
                                      const Columns& columns, std::size_t at, int count, const Jumps& jumps,
                                      double* normalStress, Mask* pending) {
    return e.cr > 0
               ? stayElasticAs<spatial, yielded, true>(e, ofAll, columns, at, count, jumps, normalStress, pending)
               : stayElasticAs<spatial, yielded, false>(e, ofAll, columns, at, count, jumps, normalStress, pending);
}

} // namespace

MASONRY_VECTORISED
Waiting stayElastic(const PiecewiseEquations& e, const PiecewiseDerived* neverYielded, const Columns& columns,
                    std::size_t at, int count, const Jumps& jumps, double* normalStress, Mask* pending) {
    const bool yielded = neverYielded == nullptr;
    const PiecewiseDerived ofAll = yielded ? PiecewiseDerived{} : *neverYielded;
    if (jumps.plane)
        return yielded ? stayElasticAs<false, true>(e, ofAll, columns, at, count, jumps, normalStress, pending)
                       : stayElasticAs<false, false>(e, ofAll, columns, at, count, jumps, normalStress, pending);
    return yielded ? stayElasticAs<true, true>(e, ofAll, columns, at, count, jumps, normalStress, pending)
                   : stayElasticAs<true, false>(e, ofAll, columns, at, count, jumps, normalStress, pending);
}

// ---- open subcontacts that carry nothing ----------------------------------------------------------------------------

namespace {

struct Open {                                          // scratch of a step
    double total[most], elastic[most], farthest[most]; // [m] see PiecewiseEquations::Opened
    double trialA[most], trialB[most];                 // [Pa]
    Mask here[most];
};

// Marks those in `s.here`. Returns how many there are.
MASONRY_INLINED Mask findOpen(const PiecewiseEquations& given, const Columns& columns, const Jumps& jumps, int count,
                              double mostTension, double mostShear, const Mask* pending, Open& s) {
    const PiecewiseEquations e = given;
    const double* opening = columns[Column::Opening];
    const double* shearStressA = columns[Column::ShearStressA];
    const double* shearStressB = columns[Column::ShearStressB];
    const double* largestOpening = columns[Column::LargestOpening];
    const double* irreversible = columns[Column::Irreversible];
    const double* tensionDamage = columns[Column::TensionDamage];
    const double* shearDamage = columns[Column::ShearDamage];
    const double* intact = columns[Column::Intact];
    const double* secant = columns[Column::Secant];
    Mask many = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const auto moved = e.open(opening[i], irreversible[i], largestOpening[i], jumps.opening[i]);
        const double inTension = tensionDamage[i], inShear = shearDamage[i], holds = secant[i];
        const double bond = intact[i], strength = e.residualCohesion(moved.elastic) + e.cp * bond;
        const Mask isPending = pending[i];
        const bool carriesNothing = (moved.before > 0) & (moved.elastic > 0) & (holds == 0) & (strength == 0) &
                                    (inTension >= mostTension) & (inShear >= mostShear);
        s.total[i] = moved.total;
        s.elastic[i] = moved.elastic;
        s.farthest[i] = moved.farthest;
        s.trialA[i] = shearStressA[i] + e.ks * jumps.slideA[i]; // eq. (7)
        s.trialB[i] = shearStressB[i] + e.ks * jumps.slideB[i];
        s.here[i] = carriesNothing ? isPending : 0;
        many += carriesNothing ? isPending : 0;
    }
    return many;
}

} // namespace

MASONRY_VECTORISED
Mask slideOpen(const PiecewiseEquations& given, const SofteningTable& tension, const SofteningTable& shear,
               const Columns& columns, Regime* regime, const Jumps& jumps, Mask* pending, int count,
               double* normalStress) {
    const PiecewiseEquations e = given;
    Open s;
    if (!findOpen(e, columns, jumps, count, tension.mostDamage(), shear.mostDamage(), pending, s)) return 0;
    Mask many = 0;
    double* opening = columns[Column::Opening];
    double* shearStressA = columns[Column::ShearStressA];
    double* shearStressB = columns[Column::ShearStressB];
    double* largestOpening = columns[Column::LargestOpening];
    double* slip = columns[Column::Slip];
    double* lostShear = columns[Column::LostShear];
    double* reach = columns[Column::Reach];
    const double* intact = columns[Column::Intact];
    Mask slides[most];
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double oldA = shearStressA[i], oldB = shearStressB[i];
        const double oldOpening = opening[i], oldFarthest = largestOpening[i];
        const double oldSlip = slip[i], oldLost = lostShear[i], oldReach = reach[i], oldStress = normalStress[i];
        const double size = std::sqrt(s.trialA[i] * s.trialA[i] + s.trialB[i] * s.trialB[i]);
        const auto slid = e.slide(size, 0, s.elastic[i], intact[i], 0);
        const double a = slid.share * s.trialA[i], b = slid.share * s.trialB[i];
        const double mean = PiecewiseEquations::meanShear(oldA, oldB, a, b, s.trialA[i], s.trialB[i], size);
        const double newReach = e.reach(intact[i], s.farthest[i]);
        const double sigma = 0, crushing = e.capStress(sigma, a * a + b * b);
        const bool here = (s.here[i] != 0) & (crushing <= e.smallestFcSquared);
        opening[i] = here ? s.total[i] : oldOpening;
        shearStressA[i] = here ? a : oldA;
        shearStressB[i] = here ? b : oldB;
        largestOpening[i] = here ? s.farthest[i] : oldFarthest;
        slip[i] = here ? oldSlip + slid.slip : oldSlip;
        lostShear[i] = here & (slid.slip > 0) ? oldLost + mean * slid.slip : oldLost;
        reach[i] = here ? newReach : oldReach;
        normalStress[i] = here ? 0 : oldStress;
        slides[i] = here & slid.slides ? 1 : 0;
        pending[i] -= here ? 1 : 0;
        many += here ? 1 : 0;
    }
    for (int i = 0; i < count; ++i)
        if (slides[i]) regime[i] = Regime::Slipping;
    return many;
}

// ---- intact joints --------------------------------------------------------------------------------------------------

namespace {

template <bool spatial>
MASONRY_INLINED void markYieldingAs(const PiecewiseEquations& given, const PiecewiseDerived& ofAll, int count,
                                    const double* opening, const double* slideA, const double* slideB, Mask* yielding) {
    const PiecewiseEquations e = given;
    const double less = 1 - marginOfIntact, more = 1 + marginOfIntact;
    const PiecewiseEquations::Domain domain{less * ofAll.reach, ofAll.intact, less * ofAll.capSquared,
                                            less * e.curve.limit(e.stretch)};
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double sigma = e.kn * opening[i];
        const double a = e.ks * slideA[i];
        const double b = spatial ? e.ks * slideB[i] : 0;
        const bool elastic = e.isElastic(domain, opening[i], sigma, more * (a * a + b * b),
                                         e.closure(opening[i], sigma), e.residualCohesion(opening[i]));
        yielding[i] += elastic ? 0 : 1;
    }
}

} // namespace

MASONRY_VECTORISED
void markYielding(const PiecewiseEquations& e, const PiecewiseDerived& neverYielded, int count, const double* opening,
                  const double* slideA, const double* slideB, Mask* yielding) {
    slideB ? markYieldingAs<true>(e, neverYielded, count, opening, slideA, slideB, yielding)
           : markYieldingAs<false>(e, neverYielded, count, opening, slideA, slideB, yielding);
}

MASONRY_VECTORISED
void rememberElastic(const PiecewiseEquations& given, const Columns& columns, std::size_t at, int count,
                     const double* opening) {
    const PiecewiseEquations e = given;
    double* largestOpening = columns[Column::LargestOpening] + at;
    double* largestClosure = columns[Column::LargestClosure] + at;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double farthest = largestOpening[i], closest = largestClosure[i];
        const double closure = e.closure(opening[i], opening[i]); // the stress has the sign of the opening
        largestOpening[i] = opening[i] > farthest ? opening[i] : farthest;
        largestClosure[i] = closure > closest ? closure : closest;
    }
}

// ---- subcontacts that may yield ------------------------------------------------------------------------------------

namespace {

struct Scratch { // of subcontacts side by side, for one step
    alignas(64) double total[most];
    double before[most], elastic[most], farthest[most]; // [m] see PiecewiseEquations::Opened
    double oldStiffness[most], newStiffness[most];      // [Pa/m] of the elastic opening
    double trialA[most], trialB[most], size[most];      // [Pa] trial shear stress
    double ratio[most], shift[most];                    // see PiecewiseEquations::Reading
    double tensionDamage[most], shearDamage[most], intact[most], secant[most], dilatancy[most];
    double sigma[most];                                   // [Pa]
    double share[most], slip[most], dilation[most];       // see PiecewiseEquations::Slid
    double closest[most], fc[most];                       // [m], [Pa]
    double left[most], closure[most], crushingSlip[most]; // see PiecewiseEquations::Crushed
    double torn[most];                                    // [J/m²] lost in tension
    Mask open[most], wanted[most], regime[most];
};

// The step of the pending subcontacts, in the parts of PiecewiseLaw::advance. Each part is a pass over the columns that
// begin at the first subcontact of the batch. A part that no subcontact needs is left out. Tables and exponentials are
// evaluated one by one, only for the subcontacts that need them.
struct SideBySide {
    const PiecewiseEquations& e;
    const Columns& columns;
    TableRows* rows;
    const Jumps& jumps;
    const Mask* pending;
    int count;
};

// 1, opening. Tells whether a crack of one tears further.
MASONRY_INLINED Mask openAll(const SideBySide& all, const SofteningTable& tension, Scratch& s) {
    const PiecewiseEquations e = all.e;
    const Columns& columns = all.columns;
    const Jumps& jumps = all.jumps;
    const Mask* pending = all.pending;
    const int count = all.count;
    double* opening = columns[Column::Opening];
    double* shearStressA = columns[Column::ShearStressA];
    double* shearStressB = columns[Column::ShearStressB];
    double* largestOpening = columns[Column::LargestOpening];
    double* irreversible = columns[Column::Irreversible];
    double* tensionDamage = columns[Column::TensionDamage];
    double* shearDamage = columns[Column::ShearDamage];
    double* intact = columns[Column::Intact];
    double* secant = columns[Column::Secant];
    Mask tears = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const auto moved = e.open(opening[i], irreversible[i], largestOpening[i], jumps.opening[i]);
        const double a = shearStressA[i] + e.ks * jumps.slideA[i]; // eq. (7)
        const double b = shearStressB[i] + e.ks * jumps.slideB[i];
        s.total[i] = moved.total;
        s.before[i] = moved.before;
        s.elastic[i] = moved.elastic;
        s.farthest[i] = moved.farthest;
        s.open[i] = moved.open;
        s.wanted[i] = moved.tears ? pending[i] : 0;
        s.regime[i] = Mask(Regime::Elastic);
        s.oldStiffness[i] = e.stiffness(moved.before, secant[i]);
        s.trialA[i] = a;
        s.trialB[i] = b;
        s.size[i] = std::sqrt(a * a + b * b);
        s.intact[i] = intact[i];
        s.secant[i] = secant[i];
        s.tensionDamage[i] = tensionDamage[i];
        s.shearDamage[i] = shearDamage[i];
        tears |= s.wanted[i];
    }
    if (tears) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const auto at = e.tensionReading(s.elastic[i], s.shearDamage[i]);
            s.ratio[i] = at.ratio;
            s.shift[i] = at.shift;
        }
        for (int i = 0; i < count; ++i) {
            if (!s.wanted[i]) continue;
            const double damage = tension.damage(s.ratio[i], s.shift[i], all.rows[i].tension);
            if (!(damage > s.tensionDamage[i])) continue;
            s.tensionDamage[i] = damage;
            s.regime[i] = Mask(Regime::Opening);
        }
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            s.intact[i] = PiecewiseEquations::intact(s.tensionDamage[i], s.shearDamage[i]);
            s.secant[i] = e.secant(s.intact[i], s.farthest[i]);
        }
    }
    return tears;
}

// 2, Coulomb slip. Tells whether one slides.
MASONRY_INLINED Mask slideAll(const SideBySide& all, const SofteningTable& tension, const SofteningTable& shear,
                              Scratch& s) {
    const PiecewiseEquations e = all.e;
    const Mask* pending = all.pending;
    const int count = all.count;
    const double* slip = all.columns[Column::Slip];
    Mask slides = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        s.newStiffness[i] = e.stiffness(s.elastic[i], s.secant[i]);
        s.sigma[i] = s.newStiffness[i] * s.elastic[i];
        s.wanted[i] = s.size[i] > e.slipStrength(s.intact[i], s.sigma[i], s.elastic[i]) ? pending[i] : 0;
        s.share[i] = 1;
        s.slip[i] = 0;
        s.dilation[i] = 0;
        slides |= s.wanted[i];
    }
    if (slides) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const auto at = e.shearReading(s.size[i], s.sigma[i], s.elastic[i], slip[i], s.tensionDamage[i]);
            s.ratio[i] = at.ratio;
            s.shift[i] = at.shift;
            s.dilatancy[i] = s.open[i] ? 0 : e.tanPsi;
        }
        for (int i = 0; i < count; ++i) {
            if (!s.wanted[i] || !(s.shearDamage[i] < 1)) continue;
            const double damage = shear.damage(s.ratio[i], s.shift[i], all.rows[i].shear);
            if (!(damage > s.shearDamage[i])) continue;
            s.shearDamage[i] = damage;
            if (!e.relaxes(s.farthest[i])) continue;
            const auto reopened = e.tensionReading(s.farthest[i], damage);
            const double torn = tension.damage(reopened.ratio, reopened.shift, all.rows[i].tension);
            s.tensionDamage[i] = std::max(s.tensionDamage[i], torn);
        }
        for (int i = 0; e.tanPsi > 0 && e.delta > 0 && i < count; ++i)
            if (s.wanted[i] && !s.open[i]) s.dilatancy[i] = e.dilatancy(slip[i]);
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            s.intact[i] = PiecewiseEquations::intact(s.tensionDamage[i], s.shearDamage[i]);
            s.secant[i] = e.secant(s.intact[i], s.farthest[i]);
            s.newStiffness[i] = e.stiffness(s.elastic[i], s.secant[i]);
            const auto slid = e.slide(s.size[i], s.sigma[i], s.elastic[i], s.intact[i], s.dilatancy[i]);
            s.sigma[i] = s.open[i] ? s.newStiffness[i] * s.elastic[i] : slid.sigma;
            s.share[i] = slid.share;
            s.slip[i] = slid.slip;
            s.dilation[i] = slid.dilation;
            s.regime[i] = slid.slides ? Mask(Regime::Slipping) : s.regime[i];
        }
    }
    return slides;
}

// 3, cap. Tells whether one crushes or hardens.
MASONRY_INLINED Mask crushAll(const SideBySide& all, Scratch& s) {
    const PiecewiseEquations e = all.e;
    const Columns& columns = all.columns;
    const Mask* pending = all.pending;
    const int count = all.count;
    const double* largestClosure = columns[Column::LargestClosure];
    Mask crushes = 0;
    const double limit = e.curve.limit(e.stretch);
    const double closing = e.cap ? -1 : 0; // sign of a closure; 0: without a cap none counts
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double a = s.share[i] * s.trialA[i];
        const double b = s.share[i] * s.trialB[i];
        const double closest = largestClosure[i];
        const double closure = s.sigma[i] < 0 ? closing * s.total[i] : 0;
        const bool passes = e.capStress(s.sigma[i], a * a + b * b) > e.smallestFcSquared;
        s.closest[i] = closure > closest ? closure : closest;
        s.left[i] = 1;
        s.closure[i] = 0;
        s.crushingSlip[i] = 0;
        crushes |= (passes | ((closure > closest) & (closure > limit))) ? pending[i] : 0;
    }
    if (crushes && e.cap) {
        double* capSquared = columns[Column::CapSquared];
        Mask beyond = 0;
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            s.fc[i] = e.curve.upToMiddle(s.closest[i], e.stretch);
            s.wanted[i] = e.curve.isBeyondMiddle(s.closest[i], e.stretch) ? pending[i] : 0;
            beyond |= s.wanted[i];
        }
        for (int i = 0; beyond && i < count; ++i)
            if (s.wanted[i]) s.fc[i] = e.curve.beyondMiddle(s.closest[i], e.stretch);
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i) {
            const double a = s.share[i] * s.trialA[i];
            const double b = s.share[i] * s.trialB[i];
            const double old = capSquared[i];
            const auto crushed = e.crush(s.sigma[i], a * a + b * b, s.fc[i]);
            s.sigma[i] = crushed.sigma;
            s.left[i] = crushed.share;
            s.closure[i] = crushed.closure;
            s.crushingSlip[i] = crushed.slip;
            s.regime[i] = crushed.crushes ? Mask(Regime::Crushing) : s.regime[i];
            capSquared[i] = pending[i] ? s.fc[i] * s.fc[i] : old;
        }
    } else
        crushes = 0;
    return crushes;
}

// The irreversible parts of the opening; s.closure and s.dilation become what they have grown by.
MASONRY_INLINED void keepIrreversible(const SideBySide& all, Scratch& s) {
    const Columns& columns = all.columns;
    const Mask* pending = all.pending;
    const int count = all.count;
    double* irreversible = columns[Column::Irreversible];
    double* crushing = columns[Column::Crushing];
    double* dilation = columns[Column::Dilation];
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double oldCrushing = crushing[i];
        const double oldDilation = dilation[i];
        const double old = irreversible[i];
        const double newCrushing = oldCrushing + s.closure[i];
        const double newDilation = oldDilation + s.dilation[i];
        const double now = newCrushing - newDilation;
        s.closure[i] = newCrushing - oldCrushing;
        s.dilation[i] = newDilation - oldDilation;
        s.elastic[i] = s.total[i] + now;
        crushing[i] = pending[i] ? newCrushing : oldCrushing;
        dilation[i] = pending[i] ? newDilation : oldDilation;
        irreversible[i] = pending[i] ? now : old;
    }
}

// Slip, and what was lost in shear and compression.
MASONRY_INLINED void keepSlip(const SideBySide& all, Scratch& s) {
    const Columns& columns = all.columns;
    const Mask* pending = all.pending;
    const int count = all.count;
    double* slip = columns[Column::Slip];
    const double* shearStressA = columns[Column::ShearStressA];
    const double* shearStressB = columns[Column::ShearStressB];
    double* lostShear = columns[Column::LostShear];
    double* lostCompression = columns[Column::LostCompression];
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double a = s.left[i] * (s.share[i] * s.trialA[i]);
        const double b = s.left[i] * (s.share[i] * s.trialB[i]);
        const double meanNormal = 0.5 * (s.oldStiffness[i] * s.before[i] + s.sigma[i]);
        const double meanShear =
            PiecewiseEquations::meanShear(shearStressA[i], shearStressB[i], a, b, s.trialA[i], s.trialB[i], s.size[i]);
        const bool slips = s.slip[i] + s.crushingSlip[i] > 0;
        const double inShear = meanShear * s.slip[i] + meanNormal * s.dilation[i];
        const double inCrushing = meanShear * s.crushingSlip[i];
        const double oldSlip = slip[i];
        const double oldShear = lostShear[i];
        const double oldCompression = lostCompression[i];
        const double newSlip = oldSlip + s.slip[i] + s.crushingSlip[i];
        const double newShear = oldShear + (slips ? inShear : 0);
        const double newCompression = oldCompression + ((slips ? inCrushing : 0) - meanNormal * s.closure[i]);
        slip[i] = pending[i] ? newSlip : oldSlip;
        lostShear[i] = pending[i] ? newShear : oldShear;
        lostCompression[i] = pending[i] ? newCompression : oldCompression;
    }
}

// Openings and stresses, and what was lost in tension.
MASONRY_INLINED void keepStresses(const SideBySide& all, Scratch& s, double* normalStress) {
    const Columns& columns = all.columns;
    const Mask* pending = all.pending;
    const int count = all.count;
    double* opening = columns[Column::Opening];
    double* shearStressA = columns[Column::ShearStressA];
    double* shearStressB = columns[Column::ShearStressB];
    double* largestOpening = columns[Column::LargestOpening];
    double* largestClosure = columns[Column::LargestClosure];
    Mask tore = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double oldOpening = opening[i];
        const double oldA = shearStressA[i];
        const double oldB = shearStressB[i];
        const double oldFarthest = largestOpening[i];
        const double oldClosest = largestClosure[i];
        const double oldStress = normalStress[i];
        const double a = s.left[i] * (s.share[i] * s.trialA[i]);
        const double b = s.left[i] * (s.share[i] * s.trialB[i]);
        s.torn[i] =
            PiecewiseEquations::lostInTension(s.oldStiffness[i], s.newStiffness[i], s.oldStiffness[i] * s.before[i],
                                              s.sigma[i], s.before[i], s.elastic[i]);
        tore |= s.oldStiffness[i] != s.newStiffness[i] ? pending[i] : 0;
        opening[i] = pending[i] ? s.total[i] : oldOpening;
        shearStressA[i] = pending[i] ? a : oldA;
        shearStressB[i] = pending[i] ? b : oldB;
        largestOpening[i] = pending[i] ? s.farthest[i] : oldFarthest;
        largestClosure[i] = pending[i] ? s.closest[i] : oldClosest;
        normalStress[i] = pending[i] ? s.sigma[i] : oldStress;
    }
    if (tore) {
        double* lostTension = columns[Column::LostTension];
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i)
            lostTension[i] += pending[i] ? s.torn[i] : 0;
    }
}

// Damage, and what follows from it.
MASONRY_INLINED void keepDamage(const SideBySide& all, Scratch& s) {
    const PiecewiseEquations e = all.e;
    const Columns& columns = all.columns;
    const Mask* pending = all.pending;
    const int count = all.count;
    double* tensionDamage = columns[Column::TensionDamage];
    double* shearDamage = columns[Column::ShearDamage];
    double* intact = columns[Column::Intact];
    double* secant = columns[Column::Secant];
    double* reach = columns[Column::Reach];
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double oldTension = tensionDamage[i];
        const double oldShear = shearDamage[i];
        const double oldIntact = intact[i];
        const double oldSecant = secant[i];
        const double oldReach = reach[i];
        tensionDamage[i] = pending[i] ? s.tensionDamage[i] : oldTension;
        shearDamage[i] = pending[i] ? s.shearDamage[i] : oldShear;
        intact[i] = pending[i] ? s.intact[i] : oldIntact;
        secant[i] = pending[i] ? s.secant[i] : oldSecant;
        reach[i] = pending[i] ? e.reach(s.intact[i], s.farthest[i]) : oldReach;
    }
}

} // namespace

MASONRY_VECTORISED
void advanceSideBySide(const PiecewiseEquations& given, const SofteningTable& tension, const SofteningTable& shear,
                       const Columns& columns, TableRows* rows, Regime* regime, const Jumps& jumps, const Mask* pending,
                       int count, double* normalStress) {
    const PiecewiseEquations e = given;
    const SideBySide all{e, columns, rows, jumps, pending, count};
    Scratch s;
    const Mask tears = openAll(all, tension, s);
    const Mask slides = slideAll(all, tension, shear, s);
    const Mask crushes = crushAll(all, s);
    if (crushes || (slides && e.tanPsi > 0)) keepIrreversible(all, s);
    if (crushes || slides) keepSlip(all, s);
    keepStresses(all, s, normalStress);
    if (tears || slides) keepDamage(all, s);
    for (int i = 0; i < count; ++i) {
        const Regime old = regime[i];
        regime[i] = pending[i] ? Regime(s.regime[i]) : old;
    }
}

// ---- energies ------------------------------------------------------------------------------------------------------

namespace {

template <bool yielded>
MASONRY_INLINED void addEnergiesAs(double kn, double ks, const Columns& columns, std::size_t at, int count,
                                   const double* area, LaneSums& sums) {
    const double* opening = columns[Column::Opening] + at;
    const double* shearStressA = columns[Column::ShearStressA] + at;
    const double* shearStressB = columns[Column::ShearStressB] + at;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double elastic = yielded ? opening[i] + columns[Column::Irreversible][at + i] : opening[i];
        const double stiffness = yielded && elastic > 0 ? columns[Column::Secant][at + i] : kn;
        const double tauSquared = shearStressA[i] * shearStressA[i] + shearStressB[i] * shearStressB[i];
        const double normal = area[i] * PiecewiseEquations::storedNormal(stiffness * elastic, elastic);
        sums.storedTension[i] += elastic > 0 ? normal : 0;
        sums.storedCompression[i] += elastic > 0 ? 0 : normal;
        sums.storedShear[i] += area[i] * PiecewiseEquations::storedShear(tauSquared, ks);
        if (!yielded) continue;
        sums.lostTension[i] += area[i] * columns[Column::LostTension][at + i];
        sums.lostShear[i] += area[i] * columns[Column::LostShear][at + i];
        sums.lostCompression[i] += area[i] * columns[Column::LostCompression][at + i];
    }
}

} // namespace

MASONRY_VECTORISED
void addEnergies(const PiecewiseEquations& e, const Columns& columns, std::size_t at, int count, bool yielded,
                 const double* area, LaneSums& sums) {
    if (yielded)
        count == lanes ? addEnergiesAs<true>(e.kn, e.ks, columns, at, lanes, area, sums)
                       : addEnergiesAs<true>(e.kn, e.ks, columns, at, count, area, sums);
    else
        count == lanes ? addEnergiesAs<false>(e.kn, e.ks, columns, at, lanes, area, sums)
                       : addEnergiesAs<false>(e.kn, e.ks, columns, at, count, area, sums);
}

} // namespace masonry
