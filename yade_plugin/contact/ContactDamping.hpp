// SPDX-License-Identifier: GPL-2.0-or-later
// Viscous damping of a contact, in compression only, so that a central impact of two faces has a given restitution.
#pragma once
#include "Overlap.hpp"

namespace masonry {

// The damping ratio with which a mass on a spring and a dashpot, which leaves an obstacle when their force is zero, has
// this restitution of an impact, above 0 and at most 1; to 1e-12.
double dampingRatio(double restitution);

// The restitution with this damping ratio.
double restitutionOf(double dampingRatio);

// How the other block moves in the axes of the one block, relative to it.
struct RelativeMotion {
    Eigen::Vector3d velocity; // of the point of the other block at the origin of the one [m/s]
    Eigen::Vector3d spin;     // [rad/s]
};

struct DampingStep {
    double force;           // on the other block along the normal [N]
    Eigen::Vector3d moment; // on the other block about the origin of the one [N m]
    double power;           // that it takes [W], never below 0
};

// The force of a dashpot of so much per area [Pa s/m], spread over the contact area. It is no larger than the elastic
// `normalForce` [N] where it pulls, so that the blocks never hold each other.
DampingStep dampContact(const Overlap&, const RelativeMotion&, double coefficient, double normalForce);

} // namespace masonry
