// SPDX-License-Identifier: GPL-2.0-or-later
// Stiffness-proportional viscous damping of subcontacts, which acts beside the law and leaves its state alone.
#pragma once
#include "Columns.hpp"
#include "JointState.hpp"

namespace masonry {

// What the damping of some subcontacts depends on in a step.
struct JointDamping {
    double normal, shear; // damping time times stiffness over the time step [Pa/m]
    bool elastic;         // whether the joint has no strength, so that it is never open
    bool bonded;          // whether it has tensile strength before it is damaged
    double friction;      // coefficient [-]
};

// Adds the viscous stress, which is `normal` and `shear` times the change of the jump, to the stresses of `n`
// subcontacts [Pa]: in the elastic regime alone, and only at subcontacts that are intact or pressed. Where the bond is
// damaged or missing it is cut, along its own direction, so that the sum of both stresses does not pull, and does not
// exceed friction where the stress of the law does not. So the damping takes energy in every step.
//
// `change` are the changes of the jumps in this step [m], `viscous` the viscous stresses of the step before, which are
// replaced. Returns the energy taken in the step by the trapezoidal rule [J], the mean of both viscous stresses times
// the change, as the law counts its work.
double addJointDamping(int n, const JointDamping&, const Regime* regime, const double* tensionDamage,
                       const double* area, const double* const* change, double* normal, double* shearA, double* shearB,
                       double* const* viscous);

} // namespace masonry
