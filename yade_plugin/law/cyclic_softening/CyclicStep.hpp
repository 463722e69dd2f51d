// One step of the cyclic law, for one subcontact (T is double) or for eight (T is Pack).
#pragma once
#include "CyclicEquations.hpp"

namespace masonry {

template <class T> struct CyclicPoint { // JointState, and what follows from it
    T opening, crushing, dilation, slip, largestOpening, largestClosure, tensionDamage, shearDamage;
    T shearA, shearB, plasticA, plasticB, shearSoftening, shearStiffnessLoss, capDisplacement;
    T normalStress;
    T strength, closing, shearing; // fc [Pa], normal stiffness of the closed subcontact, shear stiffness [Pa/m]
    T left;                        // [-] of the bond, by tension, shear and crushing
};

template <class T> struct CyclicOutcome {
    T lostTension, lostShear, lostCompression; // [J/m²] of the step
    T regime;                                  // a number of Regime
};

// Tension damage when the bond was lost otherwise: with lumped units the rows of the table move by what the bond holds.
template <class T, class Look, class M>
MASONRY_INLINED T tornAgain(const CyclicEquations& e, const Look& look, const CyclicPoint<T>& s, const T& crushLeft,
                            const M& weaker) {
    if (!(e.normalShift > 0)) return s.tensionDamage;
    const auto asks = weaker & (s.largestOpening > 0) & (s.tensionDamage < 1);
    if (!any(asks)) return s.tensionDamage;
    const T shift = (1 - s.shearDamage) * crushLeft * e.normalShift;
    return look.tension(s.tensionDamage, s.largestOpening * (e.ownKn / e.ft), shift, asks);
}

// `look` reads tables and curve where a mask says so:
//   tension, shear(damage, ratio, shift, asks)  the larger of `damage` and that of the table
//   strength(fc, kappa, asks)                   fc at kappa, where asked
//   decay(slip, asks)                           dilatancy at a slip
//   normalEnergy(sigma, w)                      [J/m²] stored
template <class T, class Look>
MASONRY_INLINED CyclicOutcome<T> advance(const CyclicEquations& e, Look&& look, CyclicPoint<T>& s, const T& opening,
                                         const T& slideA, const T& slideB) {
    CyclicOutcome<T> out{T{}, T{}, T{}, T{} + double(Regime::Elastic)};
    const T zero{};

    // 1, opening
    const T oldW = s.opening + (s.crushing - s.dilation);
    const T oldNormal = s.normalStress;
    const T oldStiffness = choose(oldW > 0, e.opened<T>(s.left, s.largestOpening, s.closing), s.closing);
    s.opening = s.opening + opening;
    T w = s.opening + (s.crushing - s.dilation);
    const auto open = w > 0;
    const auto tears = w > s.largestOpening;
    const T crushLeft = e.leftByCrushing(s.largestClosure, s.strength);
    if (any(tears)) {
        s.largestOpening = choose(tears, w, s.largestOpening);
        const T shift = (1 - s.shearDamage) * crushLeft * e.normalShift;
        const T damage = look.tension(s.tensionDamage, w * (e.ownKn / e.ft), shift, tears);
        out.regime = choose(damage > s.tensionDamage, all<T>(double(Regime::Opening)), out.regime);
        s.tensionDamage = damage;
    }
    T intact = Equations::intact(s.tensionDamage, s.shearDamage) * crushLeft;
    T sigma = e.normal<T>(w, e.opened<T>(intact, s.largestOpening, s.closing), s.closing);

    // 2, Coulomb slip
    const T oldA = s.shearA, oldB = s.shearB;
    const T trialA = oldA + s.shearing * slideA; // eq. (7)
    const T trialB = oldB + s.shearing * slideB;
    const T trialSquared = trialA * trialA + trialB * trialB;
    const T size = root(trialSquared);
    const T oldShearing = s.shearing;
    T now = size;         // [Pa] shear stress, along the trial stress
    T slip{}, dilation{}; // [m] of the step
    T tauStrength = e.slipStrength<T>(intact, sigma, w);
    const auto slides = size > tauStrength;
    if (any(slides)) {
        // softening by rate: the ratio grows with what the trial stress is beyond the strength
        const T peak = e.peakStrength(sigma);
        const T bond = (1 - s.tensionDamage) * crushLeft;
        const T shift = bond * (1 - e.restOfPeak(peak, sigma, w)) * e.shearShift;
        const T advance = (size - tauStrength) / s.shearing * (e.ownKs / peak);
        const T reading = 1 + s.shearSoftening + advance + shift * (1 - s.shearDamage); // with rows that are moved
        const T damage = look.shear(s.shearDamage, reading, shift, slides);
        const T ratio = s.shearSoftening + advance + shift * (damage - s.shearDamage);
        s.shearSoftening =
            choose(slides, larger(s.shearSoftening, smaller(ratio, all<T>(look.lastRatio()))), s.shearSoftening);
        const auto weaker = damage > s.shearDamage;
        s.shearDamage = damage;
        s.tensionDamage = tornAgain(e, look, s, crushLeft, weaker);
        intact = Equations::intact(s.tensionDamage, s.shearDamage) * crushLeft;
        sigma =
            choose(open & weaker, e.normal<T>(w, e.opened<T>(intact, s.largestOpening, s.closing), s.closing), sigma);
        tauStrength = e.slipStrength<T>(intact, sigma, w);

        // loss of stiffness, before the rest becomes slip
        if (e.omegaM > 0) {
            const T gamma = size / s.shearing;
            const T loss = smaller<T>(e.omegaM * (1 - intact), e.lossThatReaches(tauStrength, gamma));
            const auto loses = slides & (size > tauStrength) & (loss > s.shearStiffnessLoss);
            s.shearStiffnessLoss = choose(loses, loss, s.shearStiffnessLoss);
            s.shearing = choose(loses, e.shearStiffness(loss), s.shearing);
            now = choose(loses, s.shearing * gamma, now);
        }

        // return to the strength; sliding lifts a closed joint and lowers it on the way back
        const auto slips = slides & (now > tauStrength);
        const T excess = now - tauStrength;
        T plain = excess / s.shearing;
        const auto dilates = slips & (w < 0);
        if (e.tanPsi > 0 && any(dilates)) {
            const T lift = look.decay(s.slip, dilates);
            const T stiffness = e.curved ? e.tangentOnCurve<T>(-sigma) : s.closing;
            const T along = (s.plasticA * trialA + s.plasticB * trialB) / size;
            const T away = root(s.plasticA * s.plasticA + s.plasticB * s.plasticB);
            const T m = stiffness * e.friction(intact) * lift;
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
            const T rest = larger<T>((now - e.slipStrength<T>(intact, seated, w - rise)) / s.shearing, zero);
            plain = choose(dilates, choose(sits, rest, found), plain);
            dilation = choose(dilates, rise, zero);
        }
        // without bond, an open joint comes down while it slides back
        const auto sinks = slips & open & (s.dilation > 0) & !(intact > 0);
        if (any(sinks)) {
            const T a = s.plasticA + plain * trialA / size, b = s.plasticB + plain * trialB / size;
            const T away = root(T(s.plasticA * s.plasticA + s.plasticB * s.plasticB));
            const T rise = look.decay(s.slip, sinks) * smaller<T>(root(T(a * a + b * b)) - away, zero);
            dilation = choose(sinks, larger<T>(rise, -s.dilation), dilation);
        }
        slip = choose(slips, plain, zero);
        now = choose(slips, larger<T>(now - s.shearing * slip, zero), now);
        const T before = s.dilation;
        s.dilation = s.dilation + dilation;
        dilation = s.dilation - before;
        w = s.opening + (s.crushing - s.dilation);
        s.largestOpening = choose(dilation < 0, larger(s.largestOpening, w), s.largestOpening);
        sigma =
            choose(dilation != 0, e.normal<T>(w, e.opened<T>(intact, s.largestOpening, s.closing), s.closing), sigma);
        out.regime = choose(slips, all<T>(double(Regime::Slipping)), out.regime);
    }

    // 3, cap
    T closure{}, crushingSlip{};
    if (e.cap) {
        const T tauSquared = choose(now < size, now * now, trialSquared);
        const T displaced = e.onCap(w, sigma, tauSquared);
        const T kappa = s.capDisplacement + displaced;
        const auto hardens = (sigma < 0) & (kappa > larger(s.largestClosure, all<T>(e.limitClosure())));
        if (any(hardens)) {
            s.largestClosure = choose(hardens, kappa, s.largestClosure);
            s.strength = look.strength(s.strength, s.largestClosure, hardens);
            s.closing = choose(hardens, e.closingStiffness(s.largestClosure, s.strength), s.closing);
            sigma = choose(hardens, e.normal<T>(w, zero, s.closing), sigma);
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
                choose(crushes & (sigma < 0), s.capDisplacement + (1 - share) * displaced, s.capDisplacement);
            const T before = s.crushing;
            s.crushing = s.crushing + closure;
            closure = s.crushing - before;
            w = s.opening + (s.crushing - s.dilation);
            sigma = choose(closure > 0, e.normal<T>(w, zero, s.closing), sigma);
            now = share * now;
            out.regime = choose(crushes, all<T>(double(Regime::Crushing)), out.regime);
        }
        // crushing takes bond and pressure, and with them strength of slip
        const T leftNow = e.leftByCrushing(s.largestClosure, s.strength);
        s.tensionDamage = tornAgain(e, look, s, leftNow, leftNow < crushLeft);
        intact = Equations::intact(s.tensionDamage, s.shearDamage) * leftNow;
    }
    tauStrength = e.slipStrength<T>(intact, sigma, w);
    const auto again = now > tauStrength;
    if (any(again)) {
        slip = choose(again, slip + (now - tauStrength) / s.shearing, slip);
        now = choose(again, tauStrength, now);
    }

    // what is new
    s.normalStress = sigma;
    s.left = intact;
    const auto slipped = slip + crushingSlip > 0;
    const auto changed = slipped | (s.shearing < oldShearing);
    s.shearA = trialA;
    s.shearB = trialB;
    if (any(changed)) {
        const T share = now / size;
        const T unitA = trialA / size, unitB = trialB / size;
        s.shearA = choose(changed, share * trialA, trialA);
        s.shearB = choose(changed, share * trialB, trialB);
        s.slip = choose(slipped, s.slip + slip + crushingSlip, s.slip);
        s.plasticA = choose(slipped, s.plasticA + (slip + crushingSlip) * unitA, s.plasticA);
        s.plasticB = choose(slipped, s.plasticB + (slip + crushingSlip) * unitB, s.plasticB);
    }

    // The trapezoidal work of a step is mean stress times jump; what of it is not stored is lost.
    const T meanNormal = 0.5 * (oldNormal + sigma);
    if (any(changed)) {
        const T meanShear = Equations::meanShear<T>(oldA, oldB, s.shearA, s.shearB, trialA, trialB, size);
        const T weakened = 0.5 * (oldA * s.shearA + oldB * s.shearB) * (1 / s.shearing - 1 / oldShearing);
        out.lostShear = choose(changed, meanShear * slip + meanNormal * dilation + weakened, zero);
        out.lostCompression = choose(slipped, meanShear * crushingSlip, zero);
    }
    out.lostCompression = out.lostCompression - meanNormal * closure;
    const T newStiffness = choose(w > 0, e.opened<T>(s.left, s.largestOpening, s.closing), s.closing);
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
