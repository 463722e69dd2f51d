// SPDX-License-Identifier: GPL-2.0-or-later
// A convex block divided into tetrahedral zones (paper §2: deformable blocks), or, as a plane unit, into triangles of
// its middle plane.
#pragma once
#include "FaceContact.hpp"
#include <optional>

namespace masonry {

struct BlockMesh {
    std::vector<Point> nodes;                  // places of the nodes [m]
    std::vector<std::array<int, 4>> zones;     // nodes of each zone, in an order that makes its volume positive
    std::vector<std::array<int, 3>> triangles; // nodes of each triangle of the surface, counter-clockwise from outside
    // Nodes around each face of a cell on the surface, counter-clockwise from outside. Triangles 2 i and 2 i + 1
    // are the halves of face i. Empty if the block is no hexahedron.
    std::vector<std::array<int, 4>> cellFaces;
    // Of a plane unit alone: the direction (0, 1 or 2) across its plane, else -1; its thickness in this direction [m];
    // and the edges of its cells on its rim. It has no zones: `triangles` divide its middle plane, counter-clockwise
    // about the direction across.
    int across = -1;
    double thickness = 0;
    std::vector<std::array<int, 2>> rim;
};

// Divides a block into zones.
//
// A hexahedron is first divided into cells: `divisions` along those of its edges that lie nearest to x, y and z. Twelve
// zones make up a cell, each with its apex at the centre of the cell and its base on one half of a face. The diagonals
// that halve neighbouring faces alternate; faces across x and z that lie behind one another have the same diagonals, so
// that blocks laid in courses meet node to node, with equal triangles.
//
// Any other convex block has one zone for each triangle of its surface, about the mean of its vertices, whatever
// `divisions`.
//
// Throws std::invalid_argument if the block has no volume, is not convex, or gets a sliver: a zone whose smallest
// height is less than `sliver` times its longest edge.
BlockMesh divide(const ConvexBlock&, const std::array<int, 3>& divisions, double sliver = 0.01);

// Divides the middle plane of a block into triangles, if the block is a right prism along the direction `across`
// (0, 1 or 2); empty if it is none, or if it is thinner than a thousandth of its size.
//
// A prism over a quadrilateral is divided into cells, as above, each into four triangles about its centre. Any other
// prism has one triangle for every side of its base, about the mean of the base's corners.
//
// Throws std::invalid_argument as divide() does.
std::optional<BlockMesh> divideInPlane(const ConvexBlock&, const std::array<int, 3>& divisions, int across,
                                       double sliver = 0.01);

// Volume of a tetrahedron [m³]; negative if its corners stand in the other order.
double volume(const std::array<Point, 4>& corners);

// A point on the surface of a mesh: the nodes of the triangle that it lies on, and the weight of each. The weights add
// up to one.
struct SurfacePoint {
    std::array<int, 3> nodes;
    std::array<double, 3> weights;
};

// The point on the surface that is nearest to p; in a plane unit the point of the middle plane.
SurfacePoint nearestOnSurface(const BlockMesh&, const Point& p);

} // namespace masonry
