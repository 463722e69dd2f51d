// A convex block divided into tetrahedral zones, paper §2. Pure geometry.
#pragma once
#include "FaceContact.hpp"

namespace masonry {

struct BlockMesh {
    std::vector<Point> nodes;
    std::vector<std::array<int, 4>> zones;     // positive volume
    std::vector<std::array<int, 3>> triangles; // of the surface, outward
};

// Zones of a block. A hexahedron is divided along its own edges into the given numbers of cells in the directions that
// lie nearest to x, y and z, each cell a star of twelve zones about its centre; the diagonals of neighbouring faces
// alternate, and opposite faces across x and z have the same, so that blocks laid in courses meet node to node with
// equal triangles. Any other convex block is one star about its
// centroid, and divisions do not apply. Throws std::invalid_argument for a block without volume, one that is not
// convex, and slivers: zones whose height is less than `sliver` times their longest edge.
BlockMesh divide(const ConvexBlock&, const std::array<int, 3>& divisions, double sliver = 0.01);

double volume(const std::array<Point, 4>& corners);

// Weights of the surface point nearest to p: the nodes of its triangle and their shares, which add up to one.
struct SurfacePoint {
    std::array<int, 3> nodes;
    std::array<double, 3> weights;
};
SurfacePoint nearestOnSurface(const BlockMesh&, const Point& p);

} // namespace masonry
