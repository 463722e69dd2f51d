// SPDX-License-Identifier: GPL-2.0-or-later
// Coulomb friction of two blocks, with the memory of an elastic slip and an elastic twist; derived in
// contact/README.md.
#pragma once
#include "Overlap.hpp"

namespace masonry {

// What the friction of a pair remembers from the last step. All is in the axes of the one block.
struct FrictionState {
    Eigen::Vector3d shear = Eigen::Vector3d::Zero(); // force on the other block [N]
    double twist = 0;     // moment about the normal on the other block over the lever of friction [N]
    double stiffness = 0; // of the elastic slip [N/m]; 0: the pair did not touch
    Eigen::Vector3d normal = Eigen::Vector3d::Zero(); // of the contact
    Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();   // of the relative pose
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  // of the relative pose [m]

    template <class Visit> void visitState(Visit&& visit) { visit(shear, twist, stiffness, normal, turn, place); }
};

struct FrictionStep {
    Eigen::Vector3d force; // on the other block, at the centre of pressure [N]
    double moment;         // on the other block about the normal [N m]
    // Energy that friction took in this step [J]; below 0 where the force has fallen and the blocks move along it.
    double lost;
    double stored; // elastic energy of slip and twist [J]
};

// The lever of friction [m]: the largest moment of friction about the normal, without shear force, over friction times
// normal force. It is the mean distance of the pressure from its centre; 0.94 of the root of the mean square is that to
// 1 % for a disc and a square under even pressure, and 9 % above it for a thin strip.
double leverOfFriction(const Overlap&);

// Friction after the blocks have moved from the pose that the state remembers to this one. `normalForce` [N] is at
// least 0, `stiffness` [N/m] is that of the elastic slip, above 0.
FrictionStep advanceFriction(FrictionState&, const Overlap&, const RelativePose&, double normalForce, double stiffness,
                             double friction);

double elasticEnergyOf(const FrictionState&); // [J]

// The elastic energy that is lost when the pair parts [J]; the state is then that of a pair that does not touch.
double endFriction(FrictionState&);

} // namespace masonry
