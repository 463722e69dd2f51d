// SPDX-License-Identifier: GPL-2.0-or-later
// One step of the cyclic law, for one subcontact (T is double) or for several (T is Pack).
#pragma once
#include "CyclicEquations.hpp"
#include "law/common/JointState.hpp"

namespace masonry {

template <class T> struct CyclicPoint { // CyclicState, and what follows from it
    T opening, crushing, dilation, slip, largestOpening, largestClosure, tensionDamage, shearDamage;
    T shearA, shearB, plasticA, plasticB, shearSoftening, shearStiffnessLoss, capDisplacement;
    T normalStress;
    T strength, closing, shearing; // fc [Pa], normal stiffness of the closed subcontact, shear stiffness [Pa/m]
    T left;                        // [-] of the bond, by tension, shear and crushing
    T secant;                      // [Pa/m] stiffness of the open subcontact
    T hardening;                   // [m²] see CyclicEquations::squaredHardening
};

template <class T> struct CyclicOutcome {
    T lostTension, lostShear, lostCompression; // [J/m²] of the step
    T regime;                                  // a number of Regime
    bool tore, slid, dilated, crushed; // whether bond, slip, dilation, crushing of one at least may have changed
};

// Tension damage after shear or crushing has weakened the bond. With lumped units the softening table is stretched by
// the force that the bond can carry, so the damage at the largest opening must be read again.
template <class T, class Look, class M>
MASONRY_INLINED T tornAgain(const CyclicEquations& e, const Look& look, const CyclicPoint<T>& s,
                            const T& crushRemaining, const M& weaker) {
    if (!(e.normalShift > 0)) return s.tensionDamage;
    const auto wanted = weaker & (s.largestOpening > 0) & (s.tensionDamage < 1);
    if (!any(wanted)) return s.tensionDamage;
    const T shift = (1 - s.shearDamage) * crushRemaining * e.normalShift;
    return look.tension(s.tensionDamage, s.largestOpening * (e.ownKn / e.ft), shift, wanted);
}

// Dilatancy of the subcontacts that slip, from the shear stress `stress` along the trial stress to their strength.
// Sliding lifts a closed joint and lowers it on the way back. Changes slip, shear stress `now`, w and sigma.
template <class T, class Look, class M>
MASONRY_INLINED void dilate(const CyclicEquations& e, const Look& look, CyclicPoint<T>& s, const M& slips,
                            const T& stress, const T& trialA, const T& trialB, const T& size, T& w, T& sigma, T& now,
                            T& slip, T& dilation) {
    const T zero{};
    const T excess = stress - now;
    const T lift = look.decay(s.slip, slips);
    const T along = (s.plasticA * trialA + s.plasticB * trialB) / size;
    const T away = root(T(s.plasticA * s.plasticA + s.plasticB * s.plasticB));
    const auto closed = slips & (w < 0);
    if (any(closed)) {
        const T stiffness = e.curved ? e.tangentOnCurve<T>(-sigma) : s.closing;
        const T m = stiffness * e.friction(s.left) * lift;
        const T c = excess * (excess + 2 * m * away);
        const T h = s.shearing * (excess + m * away) + m * m * along;
        const T inner = h * h - (s.shearing * s.shearing - m * m) * c;
        const T found = c / (h + root(larger(inner, zero)));
        const T moved = root(larger<T>(away * away + 2 * along * found + found * found, zero));
        T rise = lift * (moved - away);
        // a joint goes no further down than where it was before it was lifted, and never opens by that
        const T lowest = larger<T>(-s.dilation, w);
        const auto sits = rise < lowest;
        rise = larger(rise, lowest);
        const T seated = e.normal<T>(w - rise, zero, s.closing);
        const T rest = larger<T>((stress - e.slipStrength<T>(s.left, seated, w - rise)) / s.shearing, zero);
        slip = choose(closed, choose(sits, rest, found), slip);
        now = choose(closed, larger<T>(stress - s.shearing * slip, zero), now);
        dilation = choose(closed, rise, zero);
    }
    // without bond, an open joint comes down while it slides back
    const auto sinks = slips & (w > 0) & (s.dilation > 0) & !(s.left > 0);
    if (any(sinks)) {
        const T moved = root(larger<T>(away * away + 2 * along * slip + slip * slip, zero));
        const T rise = lift * smaller<T>(moved - away, zero);
        dilation = choose(sinks, larger<T>(rise, -s.dilation), dilation);
    }
    const T before = s.dilation;
    s.dilation = s.dilation + dilation;
    dilation = s.dilation - before;
    w = s.opening + (s.crushing - s.dilation);
    s.largestOpening = choose(dilation < 0, larger(s.largestOpening, w), s.largestOpening);
    s.secant = choose(dilation < 0, e.opened<T>(s.left, s.largestOpening, s.closing), s.secant);
    sigma = choose(dilation != 0, e.normal<T>(w, s.secant, s.closing), sigma);
}

// One step, in the order of README.md. `look` has these functions, which read tables and curves for those subcontacts
// that the mask `wanted` marks:
//   tension, shear(damage, ratio, shift, asks)  the damage of the table, or `damage` if that is larger or not asked
//   strength(fc, kappa, asks)                   the cap's strength at kappa, or `fc` if not asked
//   decay(slip, asks)                           the dilatancy that is left at a slip
//   normalEnergy(sigma, w)                      the energy that normal stress stores [J/m²]
template <class T, class Look>
MASONRY_INLINED CyclicOutcome<T> advance(const CyclicEquations& e, Look&& look, CyclicPoint<T>& s, const T& opening,
                                         const T& slideA, const T& slideB) {
    CyclicOutcome<T> out{T{}, T{}, T{}, T{} + double(Regime::Elastic), false, false, false, false};
    const T zero{};

    // 1, opening
    const T oldW = s.opening + (s.crushing - s.dilation);
    const T oldNormal = s.normalStress;
    const T oldStiffness = choose(oldW > 0, s.secant, s.closing);
    s.opening = s.opening + opening;
    T w = s.opening + (s.crushing - s.dilation);
    const auto open = w > 0;
    const auto tears = w > s.largestOpening;
    const T crushRemaining = e.remainingByCrushing(s.largestClosure, s.strength);
    const auto weakens = [&](const T& byCrushing) { // what follows from damage of the bond
        s.left = PiecewiseEquations::intact(s.tensionDamage, s.shearDamage) * byCrushing;
        s.secant = e.opened<T>(s.left, s.largestOpening, s.closing);
        out.tore = true;
    };
    if (any(tears)) {
        s.largestOpening = choose(tears, w, s.largestOpening);
        const T shift = (1 - s.shearDamage) * crushRemaining * e.normalShift;
        const T damage = look.tension(s.tensionDamage, w * (e.ownKn / e.ft), shift, tears & (s.tensionDamage < 1));
        out.regime = choose(damage > s.tensionDamage, all<T>(double(Regime::Opening)), out.regime);
        s.tensionDamage = damage;
        weakens(crushRemaining);
    }
    T sigma = e.normal<T>(w, s.secant, s.closing);

    // 2, Coulomb slip
    const T oldA = s.shearA, oldB = s.shearB;
    const T trialA = oldA + s.shearing * slideA; // eq. (7)
    const T trialB = oldB + s.shearing * slideB;
    const T trialSquared = trialA * trialA + trialB * trialB;
    const T size = root(trialSquared);
    const T oldShearing = s.shearing;
    T now = size;         // [Pa] shear stress, along the trial stress
    T slip{}, dilation{}; // [m] of the step
    T tauStrength = e.slipStrength<T>(s.left, sigma, w);
    const auto slides = size > tauStrength;
    if (any(slides)) {
        // softening by rate: the ratio grows with what the trial stress is beyond the strength
        const T peak = e.peakStrength(sigma);
        T shift{};
        if (e.shearShift > 0)
            shift = (1 - s.tensionDamage) * crushRemaining * (1 - e.restOfPeak(peak, sigma, w)) * e.shearShift;
        const T advance = (size - tauStrength) * e.ownKs / (s.shearing * peak);
        const T reading = 1 + s.shearSoftening + advance + shift * (1 - s.shearDamage); // with rows that are moved
        const T damage = look.shear(s.shearDamage, reading, shift, slides & (s.shearDamage < 1));
        const T ratio = s.shearSoftening + advance + shift * (damage - s.shearDamage);
        s.shearSoftening =
            choose(slides, larger(s.shearSoftening, smaller(ratio, all<T>(look.lastRatio()))), s.shearSoftening);
        const auto weaker = damage > s.shearDamage;
        if (any(weaker)) {
            s.shearDamage = damage;
            s.tensionDamage = tornAgain(e, look, s, crushRemaining, weaker);
            weakens(crushRemaining);
            sigma = choose(open & weaker, e.normal<T>(w, s.secant, s.closing), sigma);
            tauStrength = e.slipStrength<T>(s.left, sigma, w);
        }

        // loss of stiffness, before the rest becomes slip
        if (e.omegaM > 0) {
            const T gamma = size / s.shearing;
            const T loss = smaller<T>(e.omegaM * (1 - s.left), e.lossThatReaches(tauStrength, gamma));
            const auto loses = slides & (size > tauStrength) & (loss > s.shearStiffnessLoss);
            s.shearStiffnessLoss = choose(loses, loss, s.shearStiffnessLoss);
            s.shearing = choose(loses, e.shearStiffness(loss), s.shearing);
            now = choose(loses, s.shearing * gamma, now);
        }

        // return to the strength; sliding lifts a closed joint and lowers it on the way back
        const auto slips = slides & (now > tauStrength);
        const T stress = now;
        slip = choose(slips, (stress - tauStrength) / s.shearing, zero);
        now = choose(slips, tauStrength, stress);
        if (e.tanPsi > 0 && any(slips))
            dilate(e, look, s, slips, stress, trialA, trialB, size, w, sigma, now, slip, dilation);
        out.dilated = e.tanPsi > 0;
        out.regime = choose(slips, all<T>(double(Regime::Slipping)), out.regime);
    }

    // 3, cap
    T closure{}, crushingSlip{};
    if (e.cap) {
        const T tauSquared = choose(now < size, now * now, trialSquared);
        const T squared = e.onCap(w, sigma, tauSquared);
        const auto mayHarden = (sigma < 0) & (squared > s.hardening);
        if (any(mayHarden)) {
            const T kappa = s.capDisplacement + root(squared);
            const auto hardens = mayHarden & (kappa > larger(s.largestClosure, all<T>(e.limitClosure())));
            s.largestClosure = choose(hardens, kappa, s.largestClosure);
            s.strength = look.strength(s.strength, s.largestClosure, hardens);
            s.closing = choose(hardens, e.closingStiffness(s.largestClosure, s.strength), s.closing);
            sigma = choose(hardens, e.normal<T>(w, zero, s.closing), sigma);
            out.crushed = true;
        }
        const T pressed = smaller(sigma, zero);
        const T capStress = e.capStress<T>(pressed, tauSquared);
        const auto crushes = capStress > s.strength * s.strength;
        if (any(crushes)) {
            const T share = choose(crushes, e.capShare<T>(pressed, tauSquared, s.strength), all<T>(1));
            const T lostClosure = e.curved ? -w - e.closureOnCurve<T>(-pressed * share) : (share - 1) * w;
            closure = choose(crushes & (sigma < 0), larger(lostClosure, zero), zero);
            crushingSlip = choose(crushes, (1 - share) * now / s.shearing, zero);
            s.capDisplacement =
                choose(crushes & (sigma < 0), s.capDisplacement + (1 - share) * root(squared), s.capDisplacement);
            const T before = s.crushing;
            s.crushing = s.crushing + closure;
            closure = s.crushing - before;
            w = s.opening + (s.crushing - s.dilation);
            sigma = choose(closure > 0, e.normal<T>(w, zero, s.closing), sigma);
            now = share * now;
            out.regime = choose(crushes, all<T>(double(Regime::Crushing)), out.regime);
            out.crushed = true;
        }
        if (out.crushed) { // crushing takes bond and pressure, and with them strength of slip
            const T crushRemainingNow = e.remainingByCrushing(s.largestClosure, s.strength);
            s.tensionDamage = tornAgain(e, look, s, crushRemainingNow, crushRemainingNow < crushRemaining);
            weakens(crushRemainingNow);
            s.hardening = e.squaredHardening(s.largestClosure, s.capDisplacement);
        }
    }
    if (out.crushed | out.dilated) {
        tauStrength = e.slipStrength<T>(s.left, sigma, w);
        const auto again = now > tauStrength;
        slip = choose(again, slip + (now - tauStrength) / s.shearing, slip);
        now = choose(again, tauStrength, now);
    }

    // what is new
    s.normalStress = sigma;
    const auto slipped = slip + crushingSlip > 0;
    const auto changed = slipped | (s.shearing < oldShearing);
    s.shearA = trialA;
    s.shearB = trialB;
    // The trapezoidal work of a step is mean stress times jump; what of it is not stored is lost.
    const T meanNormal = 0.5 * (oldNormal + sigma);
    if (any(changed)) {
        out.slid = true;
        const T share = now / size;
        const T grown = slip + crushingSlip;
        const T perStress = grown / size;
        s.shearA = choose(changed, share * trialA, trialA);
        s.shearB = choose(changed, share * trialB, trialB);
        s.slip = choose(slipped, s.slip + grown, s.slip);
        s.plasticA = choose(slipped, s.plasticA + perStress * trialA, s.plasticA);
        s.plasticB = choose(slipped, s.plasticB + perStress * trialB, s.plasticB);
        const T meanShear = PiecewiseEquations::meanShear<T>(oldA, oldB, s.shearA, s.shearB, trialA, trialB, size);
        T inShear = meanShear * slip + meanNormal * dilation;
        if (e.omegaM > 0)
            inShear = inShear + 0.5 * (oldA * s.shearA + oldB * s.shearB) * (1 / s.shearing - 1 / oldShearing);
        out.lostShear = choose(changed, inShear, zero);
        out.lostCompression = choose(slipped, meanShear * crushingSlip, zero);
    }
    out.lostCompression = out.lostCompression - meanNormal * closure;
    const T newStiffness = choose(w > 0, s.secant, s.closing);
    const auto softer = newStiffness != oldStiffness;
    if (any(softer)) {
        T lost = 0.5 * (oldNormal * w - sigma * oldW);
        if (e.curved)
            lost = meanNormal * (w - oldW) - (look.normalEnergy(sigma, w) - look.normalEnergy(oldNormal, oldW));
        const auto closed = (w < 0) & (oldW < 0);
        out.lostTension = choose(softer & !closed, lost, zero);
        out.lostCompression = choose(softer & closed, out.lostCompression + lost, out.lostCompression);
    }
    return out;
}

} // namespace masonry
