// SPDX-License-Identifier: GPL-2.0-or-later
// A convex block as the contact of blocks needs it: corners, and the planes and outlines of its faces.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace masonry {

// All is in the block's own axes, about its own origin, which lies inside the block or near it.
struct ContactBlock {
    struct Face {
        Eigen::Vector3d normal; // outward, of length 1
        double offset;          // normal · x of all points x of the face [m]
        int first, beyond;      // places in `outlines` of its corners, counter-clockwise seen from outside
    };
    std::vector<double> corners[3]; // coordinates of all corners [m]
    std::vector<Face> faces;
    std::vector<int> outlines;          // numbers of corners
    std::vector<Eigen::Vector3d> edges; // directions of all edges, parallel ones once
    double radius = 0;                  // largest distance of a corner from the origin [m]
    double surface = 0;                 // area of all faces [m²]
    double largestFace = 0;             // area of the largest face [m²]
    double thickness = 0;               // smallest extent along the normal of a face [m]

    int cornerCount() const { return int(corners[0].size()); }
    int faceCount() const { return int(faces.size()); }
};

// The block with these corners and triangles, which run counter-clockwise seen from outside. Triangles whose corners
// lie in one plane, within 1e-10 of the largest distance of a corner from the origin, become one face. Throws
// std::invalid_argument if the block is not convex or has no volume.
ContactBlock contactBlock(const std::vector<Eigen::Vector3d>& corners,
                          const std::vector<std::array<int, 3>>& triangles);

} // namespace masonry
