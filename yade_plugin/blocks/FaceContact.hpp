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

struct FaceContact {
    Point normal;    // from block 1 to block 2
    Polygon polygon; // counter-clockwise about the normal, midway between the two faces
};

// The face that two blocks share: opposite normals and a gap or overlap within `tolerance` times the size of the
// smaller block. Faces that touch along less than that width share nothing.
std::optional<FaceContact> coincidentFaces(const ConvexBlock& one, const ConvexBlock& two, double tolerance = 1e-4);

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
