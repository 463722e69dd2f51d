// SPDX-License-Identifier: GPL-2.0-or-later
// What two blocks that touch do to each other in a step: the force of the potential, damping, and friction with its
// memory. The engine of contacts and the functors of contacts both take it from here.
#pragma once
#include "ContactDamping.hpp"
#include "ContactFriction.hpp"

namespace masonry {

struct ContactProperties {
    double normalStiffness = 0;   // per area [Pa/m]
    double tangentialRatio = 0.4; // stiffness along the face over that along the normal [-]
    double friction = 0;          // coefficient [-]
    double dampingRatio = 0;      // of ContactDamping [-]
};

// A block in the present step, global axes.
struct ContactBody {
    Eigen::Matrix3d turn; // from the axes of the block to the global ones
    Eigen::Vector3d position, velocity, spin;
    double mass;
    Eigen::Vector3d inertia; // about its own axes if it turns freely, else about the global ones [kg m²]
    unsigned blocked;        // one bit for each blocked axis: translations along x, y and z, rotations about them
};

struct ContactEffect { // of a pair in the present step, global axes
    bool touches;
    Eigen::Vector3d force;      // on the other block [N]
    Eigen::Vector3d torques[2]; // on the one and on the other block, about their centres [N m]
    double lost, damped;        // energy that friction and damping took in this step [J]
};

// Place and orientation of the other block in the axes of the one, from those of both in global axes.
RelativePose relativePose(const Eigen::Matrix3d& turn, const Eigen::Vector3d& position,
                          const Eigen::Matrix3d& otherTurn, const Eigen::Vector3d& otherPosition);

// The step of a pair. The pose and the overlap are those that OverlapFinder was asked for and found; `touches` of the
// effect is its answer, and the overlap counts only then. `gap` is by how much the pose has the other block farther
// away than it stands, in the axes of the one [m]. `dashpot` is what damping did in the last step, in the axes of the
// one: force on the other block [N] and moment about the centre of the one [N m]; zero for a pair that did not touch.
void actOnPair(const ContactProperties&, const ContactBody& one, const ContactBody& other, const RelativePose&,
               const Eigen::Vector3d& gap, double dt, Overlap&, FrictionState&, double (&dashpot)[6], ContactEffect&);

} // namespace masonry
