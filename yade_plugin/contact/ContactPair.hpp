// SPDX-License-Identifier: GPL-2.0-or-later
// What two blocks that touch do to each other in a step: the force of the potential, which keeps the energy, damping,
// and friction, with their memory.
#pragma once
#include "ContactDamping.hpp"
#include "ContactEnds.hpp"
#include "ContactFriction.hpp"

namespace masonry {

struct ContactProperties {
    double normalStiffness; // per area [Pa/m]
    double tangentialRatio; // stiffness along the face over that along the normal [-]
    double friction;        // coefficient [-]
    double dampingRatio;    // of ContactDamping [-]
};

// What a pair remembers from the last step. All numbers are 0 for a pair that did not touch.
struct PairMemory {
    FrictionState friction;
    Wrench rubbing, dashpot; // of friction and of damping
    ElasticAccount elastic;

    bool touched() const { return friction.stiffness > 0; }
    template <class Visit> void visitState(Visit&& visit) { visit(friction, rubbing, dashpot, elastic); }
};

// The elastic energy that a pair has beside the potential of its overlap [J].
double energyBesidePotential(const PairMemory&);

struct ContactEffect { // of a pair in the present step
    bool touches = false;
    bool acts = false;             // whether there is a wrench, which the first step after a contact has, too
    Wrench wrench;                 // without the dashpot until `dampPair`
    double lost = 0, damped = 0;   // energy that friction and damping took in this step [J]
    Overlap overlap;               // of a pair that touches
    double dampingCoefficient = 0; // of the dashpot per area [Pa s/m]; 0: there is none in this step

    template <class Visit> void visitState(Visit&& visit) { visit(touches, acts, wrench); }
};

// Place and orientation of the other block in the axes of the one, from those of both in global axes.
RelativePose relativePose(const Eigen::Matrix3d& turn, const Eigen::Vector3d& position,
                          const Eigen::Matrix3d& otherTurn, const Eigen::Vector3d& otherPosition);

// The step of a pair without its dashpot. `touches` of the effect is what OverlapFinder answers for its pose, and
// `overlap`, which counts only then, what it found. A pair that does not touch and did not do so in the last step needs
// no call.
void actOnPair(const ContactProperties&, const NearBlocks&, double dt, OverlapFinder&, PairMemory&, ContactEffect&);

// Adds the dashpot of a pair, when all other forces of the step are known. `middle` has the velocities in the middle of
// the step: those before it, with half of what these forces give in the step, and all that dashpots of other pairs have
// given. Returns the wrench of the dashpot.
Wrench dampPair(const ContactProperties&, const NearBlocks& blocks, const NearBlocks& middle, double dt, PairMemory&,
                ContactEffect&);

} // namespace masonry
