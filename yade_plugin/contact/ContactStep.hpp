// SPDX-License-Identifier: GPL-2.0-or-later
// The largest eigenvalue of stiffness over mass that contacts can bring, for the time step. The bound is derived in
// contact/README.md.
#pragma once
#include "ContactBlock.hpp"

namespace masonry {

// The largest velocity squared that a corner of a block can have for twice its kinetic energy [1/kg]. `inertia` holds
// the principal moments [kg m²], about the block's own axes.
double mobilityOf(const ContactBlock&, double mass, const Eigen::Vector3d& inertia);

// What a contact adds to the sum of each of its two blocks [1/s²]. The largest sum of a block bounds the largest
// eigenvalue. `touched` [m²] is that of the overlap, `stiffness` the larger one of normal and tangential stiffness
// [Pa/m].
inline double eigenvalueOfContact(double touched, double stiffness, double mobilityOfOne, double mobilityOfOther) {
    return stiffness * touched * (mobilityOfOne + mobilityOfOther);
}

} // namespace masonry
