// SPDX-License-Identifier: GPL-2.0-or-later
// Joints between convex blocks: where two faces coincide, in a polygon. All points are in one common coordinate system
// [m].
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace masonry {

using Point = Eigen::Vector3d;
using Polygon = std::vector<Point>; // corners of a convex polygon, counter-clockwise about its normal

// A convex polyhedron, given by its vertices and the triangles of its surface. Seen from outside, the corners of a
// triangle run counter-clockwise.
struct ConvexBlock {
    std::vector<Point> vertices;
    std::vector<std::array<int, 3>> triangles;

    double size() const;                // diagonal of the bounding box [m]
    std::vector<Polygon> faces() const; // one polygon for all triangles that lie in one plane
};

// A convex block with its faces, normals and sizes, computed once: it is compared with each of its neighbours.
struct KnownBlock : ConvexBlock {
    // Throws std::invalid_argument if the block is not convex, or if its triangles run the wrong way round.
    KnownBlock(ConvexBlock block);
    struct Face {
        Polygon corners;
        Point normal; // outward
    };
    std::vector<Face> known; // all faces of the block
    double diagonal;         // of the bounding box [m]
    double thickness;        // smallest extent of the block along the normal of one of its faces [m]

    // Whether a point lies inside the block, or outside by at most `margin` [m].
    bool holds(const Point&, double margin) const;
};

// A joint between two blocks.
struct FaceContact {
    Point normal;    // from block 1 to block 2
    Polygon polygon; // counter-clockwise about the normal, midway between the two faces
};

// The joint of two blocks that share a face, or nothing. Two faces coincide if their normals are opposite and if the
// gap or overlap between them is at most a width: `tolerance` times the diagonal of the smaller block. Faces that touch
// along a strip narrower than this width share nothing.
std::optional<FaceContact> coincidentFaces(const KnownBlock& one, const KnownBlock& two, double tolerance = 1e-4);

// Describes two blocks that share no face but probably should: they overlap, or two of their faces nearly coincide.
struct Misfit {
    double gap;   // largest gap between the two faces [m] if above 0; depth of the overlap [m], negative, if below 0
    Point middle; // the middle of the gap; (0, 0, 0) for an overlap
};

// The misfit of two blocks, or nothing. Blocks overlap if their overlap is deeper than the width of `coincidentFaces`.
// Faces nearly coincide if three things hold: their normals are opposite within 6°, they face each other over at least
// a hundredth of the smaller face, and they are no further apart than a quarter of the thinner block.
std::optional<Misfit> misfit(const KnownBlock& one, const KnownBlock& two, double tolerance = 1e-4);

double area(const Polygon&, const Point& normal); // [m²]
Point centroid(const Polygon&, const Point& normal);

// Divides a polygon, for pictures: for each given point, the part of the polygon that is nearer to it than to all other
// points.
std::vector<Polygon> nearestCells(const Polygon&, const std::vector<Point>& points);

// Unit vector along the longest edge of a polygon.
Point longestEdge(const Polygon&);

} // namespace masonry
