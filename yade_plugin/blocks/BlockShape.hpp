// SPDX-License-Identifier: GPL-2.0-or-later
// The shape and the mass properties of a convex block.
#pragma once
#include "FaceContact.hpp"
#include <Eigen/Geometry>

namespace masonry {

// A convex block about its centroid, in its principal axes.
struct BlockShape {
    std::vector<Point> vertices;               // [m]
    std::vector<std::array<int, 3>> triangles; // of the surface, counter-clockwise seen from outside
    double volume;                             // [m³]
    Point inertia;                             // principal moments for a density of 1 [m⁵]
    Point centroid;                            // in the axes of the given points [m]
    Eigen::Quaterniond orientation;            // turns the principal axes into those of the given points
};

// The convex block around points. Throws std::invalid_argument if they have no volume around them.
//
// Order of corners, faces and sums is that of YADE's Polyhedra, so that both kinds of block give the same bits, up to
// 14 points: a Polyhedra of more is not equal to the bit to another one of the same points.
BlockShape blockAround(const std::vector<Point>& points);

} // namespace masonry
