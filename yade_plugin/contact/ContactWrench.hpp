// SPDX-License-Identifier: GPL-2.0-or-later
// What two blocks do to each other, as a force and two torques, and what that gives to both.
#pragma once
#include "Overlap.hpp"

namespace masonry {

// A block in the present step, global axes.
struct ContactBody {
    Eigen::Matrix3d turn; // from the axes of the block to the global ones
    Eigen::Vector3d position, velocity, spin;
    double mass;
    Eigen::Vector3d inertia; // about its own axes if it turns freely, else about the global ones [kg m²]
    unsigned blocked;        // one bit for each blocked axis: translations along x, y and z, rotations about them
};

// Two blocks that are near each other, in the present step.
struct NearBlocks {
    const ContactBlock &oneBlock, &otherBlock;
    const ContactBody &one, &other;
    RelativePose pose;   // for which the overlap was found
    Eigen::Vector3d gap; // by how much the pose has the other block farther away than it stands, in the axes of the one
                         // [m]
};

struct Wrench {                                      // of a pair, global axes
    Eigen::Vector3d force = Eigen::Vector3d::Zero(); // on the other block [N]; the one has the opposite
    // On the one and on the other block, about their centres [N m].
    Eigen::Vector3d torques[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};

    Wrench& add(double share, const Wrench&);
    template <class Visit> void visitState(Visit&& visit) { visit(force, torques[0], torques[1]); }
};

// Of a force on the other block [N] and a moment about the centre of the one [N m], both in the axes of the one.
Wrench wrenchOf(const NearBlocks&, const Eigen::Vector3d& force, const Eigen::Vector3d& moment);

// What a wrench gives to both blocks, with their present velocities [W].
double powerOf(const NearBlocks&, const Wrench&);

// What a wrench gives with the velocities that an impulse of another one causes [N²/kg].
double responseOf(const NearBlocks&, const Wrench&, const Wrench& to);

// Changes the velocities of a body as a force [N] and a torque about its centre [N m] do in a time [s].
void push(ContactBody&, const Eigen::Vector3d& force, const Eigen::Vector3d& torque, double time);

// The mass with which two blocks meet at a point along a normal, both in global axes [kg]; 0 if both are held.
double massAlong(const NearBlocks&, const Eigen::Vector3d& point, const Eigen::Vector3d& normal);

// The wrench with the same force along the same line at the one block, which gives no angular momentum where both
// blocks stand now.
Wrench standing(const NearBlocks&, const Wrench&);

} // namespace masonry
