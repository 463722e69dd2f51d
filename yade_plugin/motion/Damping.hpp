// The damping of the paper, eq. (3), and its combined kind: one rule for rigid blocks and for the nodes of deformable
// ones, one number or several side by side at a time.
#pragma once

namespace masonry {

// What damping takes of a change of motion, local: alpha |F| against the velocity; combined: alpha |F| (sgn(dF/dt) -
// sgn(v)) / 2, which is blind to a steady motion. At most what stops the motion in the middle of the step, so that it
// never turns a motion round and never adds energy.
//
// `middle` is the velocity in the middle of the step; `reach` is alpha |F|, half of it for combined damping; both in
// one unit, that of the answer. `trend` is the sign of the force's change, and zero for local damping.
template <class Number> [[gnu::always_inline]] inline Number dampingTaken(Number middle, Number reach, Number trend) {
    const Number least = -reach * (1.0 + trend), most = reach * (1.0 - trend);
    const Number below = middle < most ? middle : most;
    return below > least ? below : least;
}

// What alpha stands for in `reach`.
inline double dampingShare(bool combined) { return combined ? 0.5 : 1; }

} // namespace masonry
