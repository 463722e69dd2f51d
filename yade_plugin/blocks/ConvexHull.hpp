// SPDX-License-Identifier: GPL-2.0-or-later
// The convex hull of points, by CGAL.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace masonry {

// Corners and faces of a convex hull. Seen from outside, the corners of a face run counter-clockwise. Triangles in one
// plane are one face, and every corner belongs to three faces or more.
struct ConvexHull {
    std::vector<Eigen::Vector3d> corners;
    std::vector<std::vector<int>> faces; // numbers of corners
};

// Throws std::invalid_argument if the points have no volume around them.
ConvexHull convexHull(const std::vector<Eigen::Vector3d>& points);

} // namespace masonry
