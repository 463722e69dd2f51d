// SPDX-License-Identifier: GPL-2.0-or-later
// Local damping, paper eq. (3), and combined damping. Rigid blocks and the nodes of deformable ones use the same
// function, with one number or with several side by side.
#pragma once

namespace masonry {

// What damping takes away from a force, or from an acceleration. Local damping takes alpha |F| sgn(v), combined damping
// alpha |F| (sgn(v) - sgn(dF/dt)) / 2, whose second part has a mean of zero in a vibration about a steady motion that
// keeps the sign of the velocity. Neither takes more than what stops the motion in the middle of the step. So damping
// never reverses a motion and never adds energy.
//
// `middle` is the velocity in the middle of the step, and `reach` is alpha |F|, or half of it for combined damping.
// Both must be in the unit of the answer. `trend` is the sign of the force's change, and zero for local damping.
template <class Number> [[gnu::always_inline]] inline Number dampingTaken(Number middle, Number reach, Number trend) {
    const Number least = -reach * (1.0 + trend), most = reach * (1.0 - trend);
    const Number below = middle < most ? middle : most;
    return below > least ? below : least;
}

// Mass-proportional viscous damping takes `massDamping` times the mean velocity of a step from an acceleration. This
// mean is v + dt (a - taken) / 2 divided by 1 + massDamping dt / 2, with the velocity v before the step and what other
// damping takes from the acceleration a. Returns the factor on v + dt (a - taken) / 2. The limit of the time step stays
// that of the undamped motion.
inline double meanOverStep(double massDamping, double dt) { return massDamping / (1 + 0.5 * massDamping * dt); }

// The share of alpha |F| in `reach`.
inline double dampingShare(bool combined) { return combined ? 0.5 : 1; }

} // namespace masonry
