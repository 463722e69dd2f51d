// SPDX-License-Identifier: GPL-2.0-or-later
// What the functors of the joint laws share: a step of one joint in the host's InteractionLoop, and the way of its
// forces to the nodes of deformable units.
#pragma once
#include "JointView.hpp"
#include <atomic>
#include <map>
#include <string>

namespace masonry {

// Bodies of a joint that a functor of another law was called for. The loop is parallel, where an exception would end
// the program: SceneStore::check() reports it.
struct MismatchedJoint {
    int body1 = -1, body2 = -1;
};
extern std::atomic<MismatchedJoint> mismatched;

// Advances a joint by its jumps and brings its forces to both blocks. A joint that has strength and whose law is not
// `law`, that of the functor, is left out and noted in `mismatched`.
void advanceJoint(yade::Scene&, JointGeometry&, JointPhysics&, const yade::Interaction&, const char* law);

// The name of the functor class of every law, by the name of the law. The functors enter themselves when the module is
// loaded (adapters/FunctorOfLaw.hpp).
std::map<std::string, std::string>& functorsOfLaws();

// Brings the forces that the functors have calculated to the nodes of deformable units. JointPlan, the fast way through
// the same step, does that itself.
void gatherFromFunctors(const std::vector<JointView>&, Zones&);

} // namespace masonry
