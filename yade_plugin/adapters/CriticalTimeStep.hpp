// The largest time step that is stable.
#pragma once
#include <string>

namespace masonry {

class SceneStore;

// The largest time step [s] that is safe under the damping of the engines, and the two bodies whose joint, or twice the
// unit, sets it; without any -1, -1 and an infinite step. It is 2/sqrt(w²) with w² the largest eigenvalue of stiffness
// over mass, damped masses over 1 + alpha, and at most 1.1 % below it (motion/LargestEigenvalue.hpp).
//
// Why it is safe, in degrees of freedom scaled by sqrt(mass), with a = -A x the acceleration without damping: a step of
// leapfrog is half a kick dt a/2, in whose middle the velocity is w, damping's impulse, the other half kick, and the
// motion. Without the impulse it keeps E = w·w/2 + x·(A - dt² A²/4) x/2, which is positive while dt² A < 4, so that the
// motion is bounded. Damping draws each w by dt alpha |a| towards zero, at most to zero (motion/Damping.hpp): E falls
// with every such impulse, whatever alpha, local or combined. So dt² A < 4 is enough for stability, and 1 + alpha a
// margin: close to that limit the highest motions go to and fro with w near zero, unseen by damping, and joints that
// yield let them drift.
// All this is for elastic joints and small turns; joints that yield, open or crush are softer. The host's damping may
// draw w past zero; that it is calm below the bound is measured (validation/stability).
struct TimeStepLimit {
    double dt = 0; // [s]
    int id1 = -1;
    int id2 = -1;
};

// The limit of a scene; `anew`: found again even where joints, units and damping are those of the last time.
TimeStepLimit timeStepLimit(SceneStore&, bool anew);

// The scene's time step, its limit, and what sets that, in words.
std::string described(const SceneStore&, const TimeStepLimit&);

} // namespace masonry
