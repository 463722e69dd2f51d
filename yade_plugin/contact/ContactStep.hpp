// SPDX-License-Identifier: GPL-2.0-or-later
// The largest eigenvalue of stiffness over mass that contacts can bring, for the time step. The bounds are derived in
// contact/README.md.
#pragma once
#include "ContactWrench.hpp"

namespace masonry {

// Stiffness of a block against motions along its own axes and rotations about them: [N/m], [N], [N m].
using BlockStiffness = Eigen::Matrix<double, 6, 6>;

// Adds a spring [N/m] at a point of the block, both in its own axes.
void addSpring(const Eigen::Vector3d& point, const Eigen::Matrix3d& spring, BlockStiffness&);

// Adds the whole surface of a block, with stiffnesses along the normal and along the face [Pa/m], or the part of it
// within a distance [m] of another block in this pose.
void addSurface(const ContactBlock&, double normalStiffness, double tangentialStiffness, BlockStiffness&);
void addNearSurface(const ContactBlock&, const ContactBlock& other, const RelativePose&, double distance,
                    double normalStiffness, double tangentialStiffness, BlockStiffness&);

// The largest eigenvalue [1/s²] of this stiffness over mass and inertia along and about the axes that are not blocked.
double largestEigenvalueOf(const BlockStiffness&, const ContactBody&);

// The largest eigenvalue [1/s²] of a block all of whose faces rest on rigid bodies. `inertia` holds the principal
// moments [kg m²], about the block's own axes. Twice the largest of these numbers in a scene bounds its largest
// eigenvalue, as long as depths are small beside the blocks.
double embeddedEigenvalue(const ContactBlock&, double mass, const Eigen::Vector3d& inertia, double normalStiffness,
                          double tangentialStiffness);

} // namespace masonry
