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
// conditions of eq. (8). One that needs the whole law keeps its old state and becomes pending.
template <bool spatial, bool yielded, bool residual>
MASONRY_INLINED Waiting stayElasticAs(const PiecewiseEquations& given, const PiecewiseDerived& ofAll,
                                      const SideBySide& subcontacts) {
    const PiecewiseEquations e = given;
    const SideBySide all = subcontacts;
    const PiecewiseDerived same = ofAll;
    const double limit = e.curve.limit(e.stretch);
    double* opening = all.columns[Column::Opening];
    double* shearStressA = all.columns[Column::ShearStressA];
    double* shearStressB = all.columns[Column::ShearStressB];
    double* largestOpening = all.columns[Column::LargestOpening];
    double* largestClosure = all.columns[Column::LargestClosure];
    const double* irreversible = all.columns[Column::Irreversible];
    const double* intact = all.columns[Column::Intact];
    const double* secant = all.columns[Column::Secant];
    const double* reach = all.columns[Column::Reach];
    const double* capSquared = all.columns[Column::CapSquared];
    Mask waiting = 0, open = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
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
        const auto moved = e.open(oldOpening, plastic, farthest, all.jumps.opening[i]);
        const double sigma = e.stiffness(moved.elastic, tensileSecant) * moved.elastic;
        const double a = oldA + e.ks * all.jumps.slideA[i];
        const double b = spatial ? oldB + e.ks * all.jumps.slideB[i] : 0;
        const double tauSquared = a * a + b * b;
        const double rest = residual ? e.residualCohesion(moved.elastic) : 0; // most joints have none
        const double closure = e.closure(moved.total, sigma);
        const double hardens = closest > limit ? closest : limit;
        // a subcontact that opens with one stiffness and closes with another loses energy
        const bool keeps = !yielded | ((e.kn - tensileSecant) * moved.before * moved.elastic >= 0);
        const bool elastic =
            e.isElastic({within, bond, squaredCap, hardens}, moved.elastic, sigma, tauSquared, closure, rest) & keeps;
        const Mask stays = elastic ? 1 : 0;
        all.normalStress[i] = sigma;
        opening[i] = pick(stays, moved.total, oldOpening);
        shearStressA[i] = pick(stays, a, oldA);
        if (spatial) shearStressB[i] = pick(stays, b, oldB);
        largestOpening[i] = pick(stays, moved.farthest, farthest);
        largestClosure[i] = pick(stays, closure > closest ? closure : closest, closest);
        all.pending[i] = 1 - stays;
        waiting += 1 - stays;
        if (yielded) open += (moved.before > 0) & (tensileSecant == 0) ? 1 : 0;
    }
    return {waiting, open};
}

template <bool spatial, bool yielded>
MASONRY_INLINED Waiting stayElasticAs(const PiecewiseEquations& e, const PiecewiseDerived& ofAll,
                                      const SideBySide& all) {
    return e.cr > 0 ? stayElasticAs<spatial, yielded, true>(e, ofAll, all)
                    : stayElasticAs<spatial, yielded, false>(e, ofAll, all);
}

} // namespace

MASONRY_VECTORISED
Waiting stayElastic(const PiecewiseEquations& e, const PiecewiseDerived* neverYielded, const SideBySide& all) {
    const bool yielded = neverYielded == nullptr;
    const PiecewiseDerived ofAll = yielded ? PiecewiseDerived{} : *neverYielded;
    if (all.jumps.plane)
        return yielded ? stayElasticAs<false, true>(e, ofAll, all) : stayElasticAs<false, false>(e, ofAll, all);
    return yielded ? stayElasticAs<true, true>(e, ofAll, all) : stayElasticAs<true, false>(e, ofAll, all);
}

// ---- open subcontacts that carry nothing ----------------------------------------------------------------------------

namespace {

struct Open {                                          // scratch of a step
    double total[most], elastic[most], farthest[most]; // [m] see PiecewiseEquations::Opened
    double trialA[most], trialB[most];                 // [Pa]
    Mask here[most];
};

// Marks those in `s.here`. Returns how many there are.
MASONRY_INLINED Mask findOpen(const PiecewiseEquations& e, const SideBySide& all, double mostTension, double mostShear,
                              Open& s) {
    const double* opening = all.columns[Column::Opening];
    const double* shearStressA = all.columns[Column::ShearStressA];
    const double* shearStressB = all.columns[Column::ShearStressB];
    const double* largestOpening = all.columns[Column::LargestOpening];
    const double* irreversible = all.columns[Column::Irreversible];
    const double* tensionDamage = all.columns[Column::TensionDamage];
    const double* shearDamage = all.columns[Column::ShearDamage];
    const double* intact = all.columns[Column::Intact];
    const double* secant = all.columns[Column::Secant];
    Mask many = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        const auto moved = e.open(opening[i], irreversible[i], largestOpening[i], all.jumps.opening[i]);
        const double inTension = tensionDamage[i], inShear = shearDamage[i], holds = secant[i];
        const double bond = intact[i], strength = e.residualCohesion(moved.elastic) + e.cp * bond;
        const Mask isPending = all.pending[i];
        const bool carriesNothing = (moved.before > 0) & (moved.elastic > 0) & (holds == 0) & (strength == 0) &
                                    (inTension >= mostTension) & (inShear >= mostShear);
        s.total[i] = moved.total;
        s.elastic[i] = moved.elastic;
        s.farthest[i] = moved.farthest;
        s.trialA[i] = shearStressA[i] + e.ks * all.jumps.slideA[i]; // eq. (7)
        s.trialB[i] = shearStressB[i] + e.ks * all.jumps.slideB[i];
        s.here[i] = carriesNothing ? isPending : 0;
        many += carriesNothing ? isPending : 0;
    }
    return many;
}

} // namespace

MASONRY_VECTORISED
Mask slideOpen(const PiecewiseEquations& given, const SofteningTable& tension, const SofteningTable& shear,
               const SideBySide& subcontacts) {
    const PiecewiseEquations e = given;
    const SideBySide all = subcontacts;
    Open s;
    if (!findOpen(e, all, tension.mostDamage(), shear.mostDamage(), s)) return 0;
    Mask many = 0;
    double* opening = all.columns[Column::Opening];
    double* shearStressA = all.columns[Column::ShearStressA];
    double* shearStressB = all.columns[Column::ShearStressB];
    double* largestOpening = all.columns[Column::LargestOpening];
    double* slip = all.columns[Column::Slip];
    double* lostShear = all.columns[Column::LostShear];
    double* reach = all.columns[Column::Reach];
    const double* intact = all.columns[Column::Intact];
    Mask slides[most];
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        const double oldA = shearStressA[i], oldB = shearStressB[i];
        const double oldOpening = opening[i], oldFarthest = largestOpening[i];
        const double oldSlip = slip[i], oldLost = lostShear[i], oldReach = reach[i], oldStress = all.normalStress[i];
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
        all.normalStress[i] = here ? 0 : oldStress;
        slides[i] = here & slid.slides ? 1 : 0;
        all.pending[i] -= here ? 1 : 0;
        many += here ? 1 : 0;
    }
    for (int i = 0; i < all.count; ++i)
        if (slides[i]) all.regime[i] = Regime::Slipping;
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
void rememberElastic(const PiecewiseEquations& given, const Columns& columns, int count, const double* opening) {
    const PiecewiseEquations e = given;
    double* largestOpening = columns[Column::LargestOpening];
    double* largestClosure = columns[Column::LargestClosure];
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

// The step of the pending subcontacts, in the parts of PiecewiseLaw::advance. Each part is a pass over the columns. A
// part that no subcontact needs is left out. Tables and exponentials are evaluated one by one, only for the subcontacts
// that need them.

// 1, opening. Tells whether a crack of one tears further.
MASONRY_INLINED Mask openAll(const PiecewiseEquations& given, const SideBySide& all, const SofteningTable& tension,
                             TableRows* rows, Scratch& s) {
    const PiecewiseEquations e = given;
    double* opening = all.columns[Column::Opening];
    double* shearStressA = all.columns[Column::ShearStressA];
    double* shearStressB = all.columns[Column::ShearStressB];
    double* largestOpening = all.columns[Column::LargestOpening];
    double* irreversible = all.columns[Column::Irreversible];
    double* tensionDamage = all.columns[Column::TensionDamage];
    double* shearDamage = all.columns[Column::ShearDamage];
    double* intact = all.columns[Column::Intact];
    double* secant = all.columns[Column::Secant];
    Mask tears = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        const auto moved = e.open(opening[i], irreversible[i], largestOpening[i], all.jumps.opening[i]);
        const double a = shearStressA[i] + e.ks * all.jumps.slideA[i]; // eq. (7)
        const double b = shearStressB[i] + e.ks * all.jumps.slideB[i];
        s.total[i] = moved.total;
        s.before[i] = moved.before;
        s.elastic[i] = moved.elastic;
        s.farthest[i] = moved.farthest;
        s.open[i] = moved.open;
        s.wanted[i] = moved.tears ? all.pending[i] : 0;
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
        for (int i = 0; i < all.count; ++i) {
            const auto at = e.tensionReading(s.elastic[i], s.shearDamage[i]);
            s.ratio[i] = at.ratio;
            s.shift[i] = at.shift;
        }
        for (int i = 0; i < all.count; ++i) {
            if (!s.wanted[i]) continue;
            const double damage = tension.damage(s.ratio[i], s.shift[i], rows[i].tension);
            if (!(damage > s.tensionDamage[i])) continue;
            s.tensionDamage[i] = damage;
            s.regime[i] = Mask(Regime::Opening);
        }
        MASONRY_INDEPENDENT
        for (int i = 0; i < all.count; ++i) {
            s.intact[i] = PiecewiseEquations::intact(s.tensionDamage[i], s.shearDamage[i]);
            s.secant[i] = e.secant(s.intact[i], s.farthest[i]);
        }
    }
    return tears;
}

// 2, Coulomb slip. Tells whether one slides.
MASONRY_INLINED Mask slideAll(const PiecewiseEquations& given, const SideBySide& all, const SofteningTable& tension,
                              const SofteningTable& shear, TableRows* rows, Scratch& s) {
    const PiecewiseEquations e = given;
    const double* slip = all.columns[Column::Slip];
    Mask slides = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        s.newStiffness[i] = e.stiffness(s.elastic[i], s.secant[i]);
        s.sigma[i] = s.newStiffness[i] * s.elastic[i];
        s.wanted[i] = s.size[i] > e.slipStrength(s.intact[i], s.sigma[i], s.elastic[i]) ? all.pending[i] : 0;
        s.share[i] = 1;
        s.slip[i] = 0;
        s.dilation[i] = 0;
        slides |= s.wanted[i];
    }
    if (slides) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < all.count; ++i) {
            const auto at = e.shearReading(s.size[i], s.sigma[i], s.elastic[i], slip[i], s.tensionDamage[i]);
            s.ratio[i] = at.ratio;
            s.shift[i] = at.shift;
            s.dilatancy[i] = s.open[i] ? 0 : e.tanPsi;
        }
        for (int i = 0; i < all.count; ++i) {
            if (!s.wanted[i] || !(s.shearDamage[i] < 1)) continue;
            const double damage = shear.damage(s.ratio[i], s.shift[i], rows[i].shear);
            if (!(damage > s.shearDamage[i])) continue;
            s.shearDamage[i] = damage;
            if (!e.relaxes(s.farthest[i])) continue;
            const auto reopened = e.tensionReading(s.farthest[i], damage);
            const double torn = tension.damage(reopened.ratio, reopened.shift, rows[i].tension);
            s.tensionDamage[i] = std::max(s.tensionDamage[i], torn);
        }
        for (int i = 0; e.tanPsi > 0 && e.delta > 0 && i < all.count; ++i)
            if (s.wanted[i] && !s.open[i]) s.dilatancy[i] = e.dilatancy(slip[i]);
        MASONRY_INDEPENDENT
        for (int i = 0; i < all.count; ++i) {
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
MASONRY_INLINED Mask crushAll(const PiecewiseEquations& given, const SideBySide& all, Scratch& s) {
    const PiecewiseEquations e = given;
    const double* largestClosure = all.columns[Column::LargestClosure];
    Mask crushes = 0;
    const double limit = e.curve.limit(e.stretch);
    const double closing = e.cap ? -1 : 0; // sign of a closure; 0: without a cap none counts
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        const double a = s.share[i] * s.trialA[i];
        const double b = s.share[i] * s.trialB[i];
        const double closest = largestClosure[i];
        const double closure = s.sigma[i] < 0 ? closing * s.total[i] : 0;
        const bool passes = e.capStress(s.sigma[i], a * a + b * b) > e.smallestFcSquared;
        s.closest[i] = closure > closest ? closure : closest;
        s.left[i] = 1;
        s.closure[i] = 0;
        s.crushingSlip[i] = 0;
        crushes |= (passes | ((closure > closest) & (closure > limit))) ? all.pending[i] : 0;
    }
    if (crushes && e.cap) {
        double* capSquared = all.columns[Column::CapSquared];
        Mask beyond = 0;
        MASONRY_INDEPENDENT
        for (int i = 0; i < all.count; ++i) {
            s.fc[i] = e.curve.upToMiddle(s.closest[i], e.stretch);
            s.wanted[i] = e.curve.isBeyondMiddle(s.closest[i], e.stretch) ? all.pending[i] : 0;
            beyond |= s.wanted[i];
        }
        for (int i = 0; beyond && i < all.count; ++i)
            if (s.wanted[i]) s.fc[i] = e.curve.beyondMiddle(s.closest[i], e.stretch);
        MASONRY_INDEPENDENT
        for (int i = 0; i < all.count; ++i) {
            const double a = s.share[i] * s.trialA[i];
            const double b = s.share[i] * s.trialB[i];
            const double old = capSquared[i];
            const auto crushed = e.crush(s.sigma[i], a * a + b * b, s.fc[i]);
            s.sigma[i] = crushed.sigma;
            s.left[i] = crushed.share;
            s.closure[i] = crushed.closure;
            s.crushingSlip[i] = crushed.slip;
            s.regime[i] = crushed.crushes ? Mask(Regime::Crushing) : s.regime[i];
            capSquared[i] = all.pending[i] ? s.fc[i] * s.fc[i] : old;
        }
    } else
        crushes = 0;
    return crushes;
}

// The irreversible parts of the opening; s.closure and s.dilation become what they have grown by.
MASONRY_INLINED void keepIrreversible(const SideBySide& all, Scratch& s) {
    double* irreversible = all.columns[Column::Irreversible];
    double* crushing = all.columns[Column::Crushing];
    double* dilation = all.columns[Column::Dilation];
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        const double oldCrushing = crushing[i];
        const double oldDilation = dilation[i];
        const double old = irreversible[i];
        const double newCrushing = oldCrushing + s.closure[i];
        const double newDilation = oldDilation + s.dilation[i];
        const double now = newCrushing - newDilation;
        s.closure[i] = newCrushing - oldCrushing;
        s.dilation[i] = newDilation - oldDilation;
        s.elastic[i] = s.total[i] + now;
        crushing[i] = all.pending[i] ? newCrushing : oldCrushing;
        dilation[i] = all.pending[i] ? newDilation : oldDilation;
        irreversible[i] = all.pending[i] ? now : old;
    }
}

// Slip, and what was lost in shear and compression.
MASONRY_INLINED void keepSlip(const SideBySide& all, Scratch& s) {
    double* slip = all.columns[Column::Slip];
    const double* shearStressA = all.columns[Column::ShearStressA];
    const double* shearStressB = all.columns[Column::ShearStressB];
    double* lostShear = all.columns[Column::LostShear];
    double* lostCompression = all.columns[Column::LostCompression];
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
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
        slip[i] = all.pending[i] ? newSlip : oldSlip;
        lostShear[i] = all.pending[i] ? newShear : oldShear;
        lostCompression[i] = all.pending[i] ? newCompression : oldCompression;
    }
}

// Openings and stresses, and what was lost in tension.
MASONRY_INLINED void keepStresses(const SideBySide& all, Scratch& s) {
    double* opening = all.columns[Column::Opening];
    double* shearStressA = all.columns[Column::ShearStressA];
    double* shearStressB = all.columns[Column::ShearStressB];
    double* largestOpening = all.columns[Column::LargestOpening];
    double* largestClosure = all.columns[Column::LargestClosure];
    Mask tore = 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        const double oldOpening = opening[i];
        const double oldA = shearStressA[i];
        const double oldB = shearStressB[i];
        const double oldFarthest = largestOpening[i];
        const double oldClosest = largestClosure[i];
        const double oldStress = all.normalStress[i];
        const double a = s.left[i] * (s.share[i] * s.trialA[i]);
        const double b = s.left[i] * (s.share[i] * s.trialB[i]);
        s.torn[i] =
            PiecewiseEquations::lostInTension(s.oldStiffness[i], s.newStiffness[i], s.oldStiffness[i] * s.before[i],
                                              s.sigma[i], s.before[i], s.elastic[i]);
        tore |= s.oldStiffness[i] != s.newStiffness[i] ? all.pending[i] : 0;
        opening[i] = all.pending[i] ? s.total[i] : oldOpening;
        shearStressA[i] = all.pending[i] ? a : oldA;
        shearStressB[i] = all.pending[i] ? b : oldB;
        largestOpening[i] = all.pending[i] ? s.farthest[i] : oldFarthest;
        largestClosure[i] = all.pending[i] ? s.closest[i] : oldClosest;
        all.normalStress[i] = all.pending[i] ? s.sigma[i] : oldStress;
    }
    if (tore) {
        double* lostTension = all.columns[Column::LostTension];
        MASONRY_INDEPENDENT
        for (int i = 0; i < all.count; ++i)
            lostTension[i] += all.pending[i] ? s.torn[i] : 0;
    }
}

// Damage, and what follows from it.
MASONRY_INLINED void keepDamage(const PiecewiseEquations& given, const SideBySide& all, Scratch& s) {
    const PiecewiseEquations e = given;
    double* tensionDamage = all.columns[Column::TensionDamage];
    double* shearDamage = all.columns[Column::ShearDamage];
    double* intact = all.columns[Column::Intact];
    double* secant = all.columns[Column::Secant];
    double* reach = all.columns[Column::Reach];
    MASONRY_INDEPENDENT
    for (int i = 0; i < all.count; ++i) {
        const double oldTension = tensionDamage[i];
        const double oldShear = shearDamage[i];
        const double oldIntact = intact[i];
        const double oldSecant = secant[i];
        const double oldReach = reach[i];
        tensionDamage[i] = all.pending[i] ? s.tensionDamage[i] : oldTension;
        shearDamage[i] = all.pending[i] ? s.shearDamage[i] : oldShear;
        intact[i] = all.pending[i] ? s.intact[i] : oldIntact;
        secant[i] = all.pending[i] ? s.secant[i] : oldSecant;
        reach[i] = all.pending[i] ? e.reach(s.intact[i], s.farthest[i]) : oldReach;
    }
}

} // namespace

MASONRY_VECTORISED
void advanceSideBySide(const PiecewiseEquations& given, const SofteningTable& tension, const SofteningTable& shear,
                       TableRows* rows, const SideBySide& subcontacts) {
    const PiecewiseEquations e = given;
    const SideBySide all = subcontacts;
    Scratch s;
    const Mask tears = openAll(e, all, tension, rows, s);
    const Mask slides = slideAll(e, all, tension, shear, rows, s);
    const Mask crushes = crushAll(e, all, s);
    if (crushes || (slides && e.tanPsi > 0)) keepIrreversible(all, s);
    if (crushes || slides) keepSlip(all, s);
    keepStresses(all, s);
    if (tears || slides) keepDamage(e, all, s);
    for (int i = 0; i < all.count; ++i) {
        const Regime old = all.regime[i];
        all.regime[i] = all.pending[i] ? Regime(s.regime[i]) : old;
    }
}

// ---- energies ------------------------------------------------------------------------------------------------------

namespace {

template <bool yielded>
MASONRY_INLINED void addEnergiesAs(double kn, double ks, const Columns& columns, int count, const double* area,
                                   LaneSums& sums) {
    const double* opening = columns[Column::Opening];
    const double* shearStressA = columns[Column::ShearStressA];
    const double* shearStressB = columns[Column::ShearStressB];
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const double elastic = yielded ? opening[i] + columns[Column::Irreversible][i] : opening[i];
        const double stiffness = yielded && elastic > 0 ? columns[Column::Secant][i] : kn;
        const double tauSquared = shearStressA[i] * shearStressA[i] + shearStressB[i] * shearStressB[i];
        const double normal = area[i] * PiecewiseEquations::storedNormal(stiffness * elastic, elastic);
        sums.storedTension[i] += elastic > 0 ? normal : 0;
        sums.storedCompression[i] += elastic > 0 ? 0 : normal;
        sums.storedShear[i] += area[i] * PiecewiseEquations::storedShear(tauSquared, ks);
        if (!yielded) continue;
        sums.lostTension[i] += area[i] * columns[Column::LostTension][i];
        sums.lostShear[i] += area[i] * columns[Column::LostShear][i];
        sums.lostCompression[i] += area[i] * columns[Column::LostCompression][i];
    }
}

} // namespace

MASONRY_VECTORISED
void addEnergies(const PiecewiseEquations& e, const Columns& columns, int count, bool yielded, const double* area,
                 LaneSums& sums) {
    if (yielded)
        count == lanes ? addEnergiesAs<true>(e.kn, e.ks, columns, lanes, area, sums)
                       : addEnergiesAs<true>(e.kn, e.ks, columns, count, area, sums);
    else
        count == lanes ? addEnergiesAs<false>(e.kn, e.ks, columns, lanes, area, sums)
                       : addEnergiesAs<false>(e.kn, e.ks, columns, count, area, sums);
}

} // namespace masonry
