// SPDX-License-Identifier: GPL-2.0-or-later
// The equations of the paper's law at one subcontact, each written once for PiecewiseLaw and for PiecewiseSideBySide,
// which takes several: therefore they choose between values and have no branches. They are numbered as in the paper;
// law/README.md says them in words.
#pragma once
#include "common/Pack.hpp"
#include "law/common/CompressionCurve.hpp"
#include <cmath>

namespace masonry {

struct PiecewiseEquations {                      // with the numbers of a kind of joint, in the paper's symbols
    double kn = 0, ks = 0;                       // [Pa/m] stiffnesses that the joint shows
    double ownKn = 0, ownKs = 0;                 // [Pa/m] stiffnesses of the joint without lumped units
    double ft = 0;                               // [Pa] tensile strength
    double onset = 0;                            // [m] elastic opening at the tensile strength, ft/kn
    double cp = 0, cr = 0;                       // [Pa] peak and residual cohesion
    double tanPhiP = 0, tanPhiR = 0, tanPsi = 0; // [-]
    double delta = 0;                            // [1/m] decay of the dilatancy with slip
    double Cnn = 0, Css = 0;                     // [-]
    double Cn = 0;                               // [Pa]
    CompressionCurve curve;
    double stretch = 0;           // [m/Pa] 1/kn - 1/ownKn
    double normalShift = 0;       // [-] the same over 1/ownKn, and the same of ks: what lumped units add to the ratio
    double shearShift = 0;        //     at the peak
    double smallestFcSquared = 0; // [Pa²] below this the cap cannot act
    bool cap = false;             // whether the joint can crush

    // ---- softening -----------------------------------------------------------------------------------------------

    // Damage of the bond d_ts, eq. (10), and what the bond has left.
    template <class T> MASONRY_INLINED static T coupled(const T& tensionDamage, const T& shearDamage) {
        return tensionDamage + shearDamage - tensionDamage * shearDamage;
    }
    template <class T> MASONRY_INLINED static T intact(const T& tensionDamage, const T& shearDamage) {
        return 1 - coupled(tensionDamage, shearDamage);
    }

    // Where a table is read: at the displacement ratio, and how far its rows move for lumped units (SofteningTable).
    struct Reading {
        double ratio, shift; // [-]
    };

    // In tension, eq. (12), at an elastic opening that was never as large. Only ft (1 - d_t)(1 - d_s) stretches units.
    MASONRY_INLINED Reading tensionReading(double elasticOpening, double shearDamage) const {
        return {elasticOpening * ownKn / ft, (1 - shearDamage) * normalShift};
    }

    // Whether shear damage makes lumped units give opening back to the joint, which was open before: at the largest
    // opening so far the table of tension is then read anew. Otherwise the stress would jump when it is passed
    // [decided].
    MASONRY_INLINED bool relaxes(double largestOpening) const { return (normalShift > 0) & (largestOpening > 0); }

    // Share of the peak strength of slip that is left when the bond is lost: residual cohesion and friction.
    template <class T> MASONRY_INLINED T restOfPeak(const T& peak, const T& sigma, const T& elasticOpening) const {
        const T rest = residualCohesion(elasticOpening) - smaller(sigma, T{}) * tanPhiR;
        return smaller(rest, peak) / peak;
    }

    // In shear, eqs. (13)-(15), with u = s + |tau|/ks [decided], under the trial stress `size`. What is left without
    // bond moves all rows alike.
    MASONRY_INLINED Reading shearReading(double size, double sigma, double elasticOpening, double slip,
                                         double tensionDamage) const {
        const double peak = cp - sigma * tanPhiP;
        const double share = restOfPeak(peak, sigma, elasticOpening);
        const double ratio = (slip + size / ks) * ownKs / peak - share * shearShift;
        const double shift = (1 - tensionDamage) * (1 - share) * shearShift;
        return {peak > 0 ? ratio : HUGE_VAL, peak > 0 ? shift : 0};
    }

    // ---- 1, opening ----------------------------------------------------------------------------------------------

    struct Opened {
        double total;    // [m] opening
        double before;   // [m] elastic opening before the step
        double elastic;  // [m] elastic opening
        double farthest; // [m] largest elastic opening
        bool open;       // whether the subcontact is open
        bool tears;      // whether it has never been open as far
    };
    // `irreversible` is the plastic closure less the dilatant opening.
    MASONRY_INLINED static Opened open(double opening, double irreversible, double largestOpening, double jump) {
        const double total = opening + jump;
        const double before = opening + irreversible;
        const double elastic = total + irreversible;
        const bool tears = elastic > largestOpening;
        return {total, before, elastic, tears ? elastic : largestOpening, elastic > 0, tears};
    }

    // Stiffness of an open subcontact, eq. (11): the secant to the softened strength at the largest opening, which
    // closes at the origin and never pushes [decided].
    template <class T> MASONRY_INLINED T secant(const T& intact, const T& largestOpening) const {
        return smaller<T>(ft * intact / largestOpening, all<T>(kn));
    }
    MASONRY_INLINED double stiffness(double elasticOpening, double secant) const {
        return elasticOpening > 0 ? secant : kn;
    }

    // Elastic opening up to which no damage grows and the secant stays what it is; a little below the softened
    // strength, so that rounding cannot tell.
    template <class T> MASONRY_INLINED T reach(const T& intact, const T& largestOpening) const {
        return larger<T>(onset * intact * (1 - 1e-15), largestOpening);
    }

    // ---- 2, Coulomb slip -----------------------------------------------------------------------------------------

    template <class T> MASONRY_INLINED T friction(const T& intact) const { // eq. (17b)
        return tanPhiR + (tanPhiP - tanPhiR) * intact;
    }

    // Residual cohesion at an elastic opening: faces that do not touch have none. It fades while the joint opens by
    // cr/kn, because a loss at once would be a jump of the stress [decided].
    template <class T> MASONRY_INLINED T residualCohesion(const T& elasticOpening) const {
        return smaller<T>(larger<T>(cr - kn * elasticOpening, T{}), all<T>(cr));
    }

    // Strength of slip, eqs. (16), (17a), never below zero.
    template <class T> MASONRY_INLINED T slipStrength(const T& intact, const T& sigma, const T& elasticOpening) const {
        return slipStrengthWith<T>(residualCohesion(elasticOpening), intact, sigma);
    }
    template <class T> MASONRY_INLINED T slipStrengthWith(const T& rest, const T& intact, const T& sigma) const {
        const T cohesion = rest + (cp - rest) * intact;
        return larger<T>(cohesion - sigma * friction(intact), T{});
    }

    MASONRY_INLINED double dilatancy(double slip) const { return tanPsi * std::exp(-delta * slip); }

    struct Slid {
        bool slides;
        double slip;     // [m] plastic slip of the step
        double dilation; // [m] dilatant opening of the step
        double sigma;    // [Pa] normal stress after it
        double share;    // [-] of the trial shear stress that is left
    };
    // Return from the trial shear stress `size` to the strength, eqs. (8b), (9).
    MASONRY_INLINED Slid slide(double size, double sigma, double elasticOpening, double intact,
                               double dilatancy) const {
        const double strength = slipStrength(intact, sigma, elasticOpening);
        const bool slides = size > strength;
        const double excess = (size - strength) / (ks + kn * friction(intact) * dilatancy);
        const double slip = slides ? excess : 0;
        const double left = 1 - ks * slip / size;
        const double share = left > 0 ? left : 0;
        return {slides, slip, dilatancy * slip, sigma - kn * dilatancy * slip, slides ? share : 1};
    }

    // ---- 3, cap --------------------------------------------------------------------------------------------------

    // The side of eq. (8c) that stresses make. A tensile stress counts as none: what the cap leaves of the shear stress
    // at sigma = 0, fc/sqrt(Css), is the most that an open joint carries, too. So it does not jump when a joint closes
    // [decided].
    template <class T> MASONRY_INLINED T capStress(const T& sigma, const T& tauSquared) const {
        const T pressed = smaller(sigma, T{});
        return Cnn * pressed * pressed + Css * tauSquared + Cn * pressed;
    }

    struct Crushed {
        bool crushes;
        double share;   // [-] of the shear stress and of a compressive stress that is left
        double sigma;   // [Pa] normal stress after it
        double closure; // [m] plastic closure of the step
        double slip;    // [m] plastic slip of the step
    };
    // Share of stresses outside eq. (8c) with the strength fc that a radial return leaves.
    template <class T> MASONRY_INLINED T capShare(const T& pressed, const T& tauSquared, const T& fc) const {
        const T quadratic = Cnn * pressed * pressed + Css * tauSquared;
        const T linear = Cn * pressed;
        const T inner = masonry::root(T(linear * linear + 4.0 * quadratic * fc * fc));
        const T positive = 2.0 * fc * fc / (linear + inner);     // the same root of quadratic x² + linear x = fc²,
        const T negative = (inner - linear) / (2.0 * quadratic); // each where it does not cancel
        return choose(linear > 0, positive, negative);
    }
    // Radial return to eq. (8c) with the strength fc.
    MASONRY_INLINED Crushed crush(double sigma, double tauSquared, double fc) const {
        const double pressed = sigma < 0 ? sigma : 0;
        const bool crushes = capStress(sigma, tauSquared) > fc * fc;
        const double scale = capShare(pressed, tauSquared, fc);
        const double closure = (pressed * scale - pressed) / kn;
        const double slip = (1 - scale) * std::sqrt(tauSquared) / ks;
        const double left = sigma < 0 ? sigma * scale : sigma;
        return {crushes, crushes ? scale : 1, crushes ? left : sigma, crushes ? closure : 0, crushes ? slip : 0};
    }

    // ---- elastic domain ------------------------------------------------------------------------------------------

    struct Domain {        // of a subcontact
        double reach;      // [m] see reach()
        double intact;     // [-] what the bond has left
        double capSquared; // [Pa²] square of the cap's strength
        double hardening;  // [m] closure from which the cap hardens
    };
    // Whether no strength is passed: the three conditions of eq. (8), and no hardening. `rest` is the residual
    // cohesion.
    MASONRY_INLINED bool isElastic(const Domain& d, double elasticOpening, double sigma, double tauSquared,
                                   double closure, double rest) const {
        const double strength = slipStrengthWith(rest, d.intact, sigma);
        const double crushing = capStress(sigma, tauSquared);
        return (elasticOpening <= d.reach) & (tauSquared <= strength * strength) & (crushing <= d.capSquared) &
               (closure <= d.hardening);
    }
    // Closure that counts for the cap, at an opening.
    MASONRY_INLINED double closure(double opening, double sigma) const { return cap & (sigma < 0) ? -opening : 0; }

    // ---- energy --------------------------------------------------------------------------------------------------

    // Elastic energy [J/m²] of a normal stress at an elastic opening, and of a shear stress.
    MASONRY_INLINED static double storedNormal(double sigma, double elasticOpening) {
        return 0.5 * sigma * elasticOpening;
    }
    MASONRY_INLINED static double storedShear(double tauSquared, double ks) { return 0.5 * tauSquared / ks; }

    // The trapezoidal work of a step is mean stress times jump, and the jump is the change of the elastic displacements
    // plus the plastic ones. The mean stress on the plastic ones is dissipated, in shear along the trial stress; the
    // elastic parts of shear and of closed joints are stored exactly; what remains of the elastic opening is the damage
    // in tension, and that is nothing where the stiffness stays.
    template <class T>
    MASONRY_INLINED static T meanShear(const T& oldA, const T& oldB, const T& newA, const T& newB, const T& trialA,
                                       const T& trialB, const T& trialSize) {
        return 0.5 * ((oldA + newA) * trialA + (oldB + newB) * trialB) / trialSize;
    }
    MASONRY_INLINED static double lostInTension(double oldStiffness, double newStiffness, double oldSigma,
                                                double newSigma, double oldElasticOpening, double newElasticOpening) {
        const double lost = 0.5 * (oldSigma * newElasticOpening - newSigma * oldElasticOpening);
        return newStiffness != oldStiffness ? lost : 0;
    }
};

} // namespace masonry
