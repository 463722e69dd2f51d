// Joints between convex blocks: coincident faces -> joint polygon -> subcontacts. Pure geometry, in one common frame.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace masonry {

using Point = Eigen::Vector3d;
using Polygon = std::vector<Point>; // convex, counter-clockwise about its normal

// A convex polyhedron: vertices and outward triangles of its surface.
struct ConvexBlock {
    std::vector<Point> vertices;
    std::vector<std::array<int, 3>> triangles;

    double size() const;                // [m] diagonal of the bounding box
    std::vector<Polygon> faces() const; // coplanar triangles merged
};

// A block with what its neighbours ask of it again and again.
struct KnownBlock : ConvexBlock {
    KnownBlock(ConvexBlock block); // std::invalid_argument if it is not convex, or its triangles wind inward
    struct Face {
        Polygon corners;
        Point normal;
    };
    std::vector<Face> known;
    double diagonal, thickness; // [m] of the bounding box; smallest extent along the normal of a face
    bool holds(const Point&, double margin) const; // whether a point lies inside, or outside by no more than that
};

struct FaceContact {
    Point normal;    // from block 1 to block 2
    Polygon polygon; // counter-clockwise about the normal, midway between the two faces
};

// The face that two blocks share: opposite normals and a gap or overlap within `tolerance` times the size of the
// smaller block. Faces that touch along less than that width share nothing.
std::optional<FaceContact> coincidentFaces(const KnownBlock& one, const KnownBlock& two, double tolerance = 1e-4);

// How two blocks without a coincident face miss each other by little.
struct Misfit {
    double gap;   // [m] above 0: largest gap between two faces that nearly coincide; below 0: depth of the overlap
    Point middle; // of the gap
};

// The misfit of two blocks that overlap by more than the width of `coincidentFaces`, or have faces opposite each other
// (within 6° and over a hundredth of the smaller face) that are no further apart than a quarter of the thinner block.
std::optional<Misfit> misfit(const KnownBlock& one, const KnownBlock& two, double tolerance = 1e-4);

struct Subcontact {
    Point centre;
    double area; // [m²]
};

double area(const Polygon&, const Point& normal);
Point centroid(const Polygon&, const Point& normal);

// A grid over the polygon's extent, `along` cells in the direction of that unit vector and `across` cells beside it,
// cut by the polygon: the areas add up to the polygon's.
std::vector<Subcontact> subdivide(const Polygon&, const Point& normal, const Point& direction, int along, int across);

// The part of a polygon nearest to each of the given points, for pictures.
std::vector<Polygon> nearestCells(const Polygon&, const std::vector<Point>& points);

// Direction of the longest edge of a polygon, the default for `subdivide`.
Point longestEdge(const Polygon&);

} // namespace masonry
