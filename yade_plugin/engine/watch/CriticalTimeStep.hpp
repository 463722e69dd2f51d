// SPDX-License-Identifier: GPL-2.0-or-later
// The largest time step for which a scene is stable.
#pragma once
#include <map>
#include <string>
#include <utility>

namespace masonry {

class SceneStore;

// The largest time step that is safe under the damping of the engines. It is 2/sqrt(L), where L is the largest
// eigenvalue of stiffness over mass and every damped mass is divided by 1 + alpha. The value given is at most 1.1 %
// below that, because L is found with an error on the safe side (motion/LargestEigenvalue.hpp).
//
// Why it is safe: let x be the displacements, each scaled by the square root of its mass, and a = -A x the
// accelerations without damping. A step of the leapfrog scheme consists of half of the velocity change, dt a/2; of the
// impulse of damping; of the other half of the velocity change; and of the motion. Let w be the velocity between the
// two halves. Without damping such steps keep E = w·w/2 + x·(A - dt² A²/4) x/2. This is positive while all eigenvalues
// of dt² A are below 4, so the motion is bounded. Damping brings each component of w by up to dt alpha |a| towards
// zero, and never beyond zero (motion/Damping.hpp). So E falls with every such impulse, for any alpha and for both
// kinds of damping. Therefore dt² A < 4 is enough for stability, and the factor 1 + alpha is a margin. It is needed
// because close to the limit the highest modes swing with w near zero, where damping has no effect, and joints that
// yield let them drift.
//
// Mass-proportional damping, which acts on the mean velocity of a step, changes nothing of this. Stiffness-proportional
// damping of the joints takes the velocity of half a step before. A mode of angular frequency w and damping ratio
// d = stiffnessDamping w/2 is then stable up to (sqrt(1 + d²) - d) 2/w: the quadratic equation of its step has a root
// of size 1 where (w dt/2)² + 2 d (w dt/2) = 1. The highest mode gives the least of these limits. It is taken as if all
// of its stiffness were that of joints, which is on the safe side for deformable units.
//
// Where masses of deformable units are scaled (Zones::massScaling), M stands for the scaled masses. Damping takes
// no more from a component of w than with the true masses, which are at most the scaled ones, so E falls there, too.
// All bricks that can crack count as cracked, because they do so during a run whose time step stays.
//
// All this holds for elastic joints and small rotations; joints that yield, open or crush are softer. The host's own
// damping may bring w beyond zero. That such runs are calm below the limit is measured, not proved
// (validation/stability).
//
// The dashpots of contacts act as impulses on w, one after the other, and each takes energy from it (Contacts::damp).
// Contacts come and go, so what they may bring is counted from the beginning, or, if the time step follows the state,
// from when two blocks are near each other (contact/README.md).
//
// The limit of a scene [s]; infinite where nothing can vibrate. It is kept while joints, units and damping are the
// same; with `anew` it is found again in any case, because changes of masses or blocked axes are not noticed.
// Without it the value may be lower than the limit, but it is below the scene's time step only if the limit is, too.
double timeStepLimit(SceneStore&, bool anew);

// Chooses the first time step that follows the state (Contacts::stepShare).
void beginFollowing(SceneStore&);
// Chooses the time step anew at the beginning of a step, if it follows the state.
void followTimeStep(SceneStore&);

// The two bodies whose joint sets the limit; twice the same body where a deformable unit does; -1 where nothing does.
std::pair<int, int> limitingBodies(SceneStore&);

// The largest eigenvalue of every rigid body with a joint while all others are held, by its id [1/s²]. That of the
// scene is at most twice the largest of these, because every joint acts on two bodies.
std::map<int, double> eigenvaluesOfBodies(SceneStore&);

// A text for messages: the scene's time step, its limit, and what sets the limit.
std::string describedLimit(SceneStore&);

} // namespace masonry
