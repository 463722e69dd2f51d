// SPDX-License-Identifier: GPL-2.0-or-later
// The largest eigenvalue of stiffness over mass that contacts can bring, for the time step. The bound is derived in
// contact/README.md.
#pragma once
#include "ContactBlock.hpp"

namespace masonry {

// The largest eigenvalue [1/s²] of a block all of whose faces rest on rigid bodies. Stiffnesses are those along the
// normal and along the face [Pa/m]. `inertia` holds the principal moments [kg m²], about the block's own axes. Twice
// the largest of these numbers in a scene bounds its largest eigenvalue, as long as depths are small beside the blocks.
double embeddedEigenvalue(const ContactBlock&, double mass, const Eigen::Vector3d& inertia, double normalStiffness,
                          double tangentialStiffness);

} // namespace masonry
