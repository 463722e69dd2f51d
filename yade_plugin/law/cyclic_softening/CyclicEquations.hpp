// SPDX-License-Identifier: GPL-2.0-or-later
// The equations of the cyclic law at one subcontact, beside those of the paper's law, for a number type T: one
// subcontact (double) or several (Pack). README.md says them in words.
#pragma once
#include "common/Pack.hpp"
#include "law/piecewise_softening/PiecewiseEquations.hpp"

namespace masonry {

struct CyclicEquations : PiecewiseEquations {
    double omegaM = 0, rho = 0, chi = 0; // [-]
    double shearStretch = 0;             // [m/Pa] 1/ks - 1/ownKs
    double shearWeight = 0;              // [-] Css/Cnn, how shear stress counts beside normal stress on the cap
    double peakClosure = HUGE_VAL;       // [m] ucp, beyond which crushing is damage

    bool curved = false;               // whether the joint closes on a curve
    double kn0 = 0;                    // [Pa/m]
    double cm = 0;                     // [m]
    double bend = 0, bendPressure = 0; // [m], [Pa] where the curve has reached kn and goes on as a straight line

    // ---- stiffnesses ------------------------------------------------------------------------------------------------

    // Shear stiffness with the loss omega: the joint's own part loses it, the lumped units do not.
    template <class T> MASONRY_INLINED T shearStiffness(const T& omega) const {
        const T weakened = 1 / (1 / ((1 - omega) * ownKs) + shearStretch);
        return choose(omega > 0, weakened, all<T>(ks));
    }

    // The loss with which the shear strength is just reached at the elastic slide gamma.
    template <class T> MASONRY_INLINED T lossThatReaches(const T& strength, const T& gamma) const {
        return 1 - 1 / (ownKs * (gamma / strength - shearStretch));
    }

    // Stiffness of an open subcontact: the paper's secant, and never more than what crushing has left.
    template <class T> MASONRY_INLINED T opened(const T& left, const T& largestOpening, const T& closing) const {
        return smaller<T>(secant<T>(left, largestOpening), closing);
    }

    // Normal stiffness of a closed subcontact that has crushed up to kappa, where the cap's strength is fc. Where rho
    // is not zero, fc is the pressure at which pure closure is on the cap.
    template <class T> MASONRY_INLINED T closingStiffness(const T& kappa, const T& fc) const {
        const T share = 1 - fc / (ownKn * (kappa - fc * stretch)); // of the joint's own closure that is irreversible
        const T weakened = 1 / (1 / ((1 - rho * share) * ownKn) + stretch);
        return choose((share > 0) & (kappa > limitClosure()), weakened, all<T>(kn));
    }
    MASONRY_INLINED double limitClosure() const { return curve.limit(stretch); }

    // ---- closing on a curve -----------------------------------------------------------------------------------------

    // Pressure sigma = kn0·c/(1 - c/cm) of a joint in series with units, at a closure of both.
    template <class T> MASONRY_INLINED T pressureOnCurve(const T& closure) const {
        const T b = 1 + stretch * kn0 - closure / cm;
        const T onCurve = 2 * kn0 * closure / (b + root(b * b + (4 * stretch * kn0 / cm) * closure));
        return choose(closure < bend, onCurve, bendPressure + (closure - bend) * kn);
    }
    // The closure at a pressure.
    template <class T> MASONRY_INLINED T closureOnCurve(const T& pressure) const {
        const T onCurve = pressure / (kn0 + pressure / cm) + pressure * stretch;
        return choose(pressure < bendPressure, onCurve, bend + (pressure - bendPressure) / kn);
    }
    template <class T> MASONRY_INLINED T tangentOnCurve(const T& pressure) const {
        const T rise = 1 + pressure / (kn0 * cm);
        const T onCurve = 1 / (1 / (kn0 * rise * rise) + stretch);
        return choose(pressure < bendPressure, onCurve, all<T>(kn));
    }
    // Energy [J/m²] that is stored up to a closure.
    double energyOnCurve(double closure) const {
        const double pressure = pressureOnCurve(closure);
        const double curved = pressure < bendPressure ? pressure : bendPressure;
        const double own = curved / (kn0 + curved / cm);
        const double below = -kn0 * cm * (own + cm * std::log1p(-own / cm)) + 0.5 * stretch * curved * curved;
        return closure > bend ? below + 0.5 * (bendPressure + pressure) * (closure - bend) : below;
    }

    // ---- stresses ---------------------------------------------------------------------------------------------------

    // Normal stress at the elastic opening w.
    template <class T> MASONRY_INLINED T normal(const T& w, const T& secant, const T& closing) const {
        const T straight = choose(w > 0, secant, closing) * w;
        if (!curved) return straight;
        return choose(w > 0, straight, -pressureOnCurve<T>(choose(w > 0, T{}, -w)));
    }

    // Share of the bond that crushing has left, with the compression damage of eq. (21).
    template <class T> MASONRY_INLINED T remainingByCrushing(const T& kappa, const T& fc) const {
        return choose(kappa > peakClosure, 1 - chi * (1 - fc / curve.peak), all<T>(1));
    }

    // Square of the elastic displacement Q [m], which measures closure and shear stress together on the cap. Crushing
    // goes by Q plus the plastic displacement (capDisplacement).
    template <class T> MASONRY_INLINED T onCap(const T& w, const T& sigma, const T& tauSquared) const {
        const T closed = smaller(curved ? sigma / kn : w, T{});
        return closed * closed + (shearWeight / (kn * kn)) * tauSquared;
    }
    // The square of Q that there may be before the cap hardens or softens further; a little less, so that rounding
    // cannot tell.
    template <class T> MASONRY_INLINED T squaredHardening(const T& kappa, const T& capDisplacement) const {
        const T most = larger(kappa, all<T>(limitClosure())) - capDisplacement;
        return most * most * (1 - 1e-14);
    }

    struct Domain {       // of a subcontact
        double reach;     // [m] see reach()
        double intact;    // [-] what the bond has left
        double cap;       // [Pa²] square of the cap's strength
        double hardening; // [m²] see squaredHardening()
    };
    // Whether no strength is passed and the cap does not harden. `curve` is `curved`, known to the compiler.
    template <bool curve>
    MASONRY_INLINED bool isElastic(const Domain& d, double w, double sigma, double tauSquared) const {
        const double strength = slipStrength(d.intact, sigma, w);
        const double pressed = smaller(sigma, 0.0);
        const double crushing = capStress(pressed, tauSquared);
        const double closed = curve ? pressed / kn : smaller(w, 0.0);
        const double displaced = sigma < 0 ? closed * closed + shearWeight * (1 / (kn * kn)) * tauSquared : 0;
        return (w <= d.reach) & (tauSquared <= strength * strength) & (crushing <= d.cap) & (displaced <= d.hardening);
    }

    // Peak strength of slip that the shear table is read with; never so small that every slip would soften at once.
    template <class T> MASONRY_INLINED T peakStrength(const T& sigma) const {
        return larger<T>(cp - sigma * tanPhiP, all<T>(cp > 0 ? 1e-3 * cp : 1e-300));
    }

    // Energy [J/m²] that normal stress stores.
    MASONRY_INLINED double storedNormal(double sigma, double w) const {
        return curved && !(w > 0) ? energyOnCurve(-w) : PiecewiseEquations::storedNormal(sigma, w);
    }
};

} // namespace masonry
