#include "FaceContact.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace masonry {

namespace {

constexpr double parallel = 1 - 1e-6; // cosine between normals of faces that count as parallel (1.4 mrad)

Point unitNormal(const Polygon& p) { // Newell's sum: twice the vector area
    Point sum = Point::Zero();
    for (std::size_t i = 0; i < p.size(); ++i)
        sum += (p[i] - p[0]).cross(p[(i + 1) % p.size()] - p[0]);
    return sum.normalized();
}

// The part of a convex polygon on the side (x - origin)·inward >= 0.
Polygon cut(const Polygon& polygon, const Point& origin, const Point& inward) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = (a - origin).dot(inward), db = (b - origin).dot(inward);
        if (da >= 0) kept.push_back(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    return kept;
}

} // namespace

double ConvexBlock::size() const {
    Point low = vertices.front(), high = low;
    for (const auto& v : vertices)
        low = low.cwiseMin(v), high = high.cwiseMax(v);
    return (high - low).norm();
}

std::vector<Polygon> ConvexBlock::faces() const {
    std::vector<Polygon> faces;
    std::vector<Point> normals;
    std::vector<std::vector<int>> corners;
    for (const auto& t : triangles) {
        const Point n = unitNormal({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
        std::size_t f = 0;
        while (f < normals.size() && normals[f].dot(n) < parallel)
            ++f; // a convex body has one face to a direction
        if (f == normals.size()) normals.push_back(n), corners.emplace_back();
        for (int corner : t)
            if (std::find(corners[f].begin(), corners[f].end(), corner) == corners[f].end())
                corners[f].push_back(corner);
    }
    for (std::size_t f = 0; f < normals.size(); ++f) {
        Point middle = Point::Zero();
        for (int c : corners[f])
            middle += vertices[c] / corners[f].size();
        const Point e1 = (vertices[corners[f][0]] - middle).normalized(), e2 = normals[f].cross(e1);
        const auto angle = [&](int c) {
            return std::atan2((vertices[c] - middle).dot(e2), (vertices[c] - middle).dot(e1));
        };
        std::sort(corners[f].begin(), corners[f].end(), [&](int a, int b) { return angle(a) < angle(b); });
        faces.emplace_back();
        for (int c : corners[f])
            faces.back().push_back(vertices[c]);
    }
    return faces;
}

std::optional<FaceContact> coincidentFaces(const ConvexBlock& one, const ConvexBlock& two, double tolerance) {
    const double width = tolerance * std::min(one.size(), two.size());
    const auto facesOfTwo = two.faces();
    for (const auto& mine : one.faces()) {
        const Point normal = unitNormal(mine);
        for (const auto& theirs : facesOfTwo) {
            if (normal.dot(unitNormal(theirs)) > -parallel) continue;
            if (std::abs((theirs[0] - mine[0]).dot(normal)) > 100 * width) continue; // far; the exact test comes below
            Polygon overlap = mine;
            for (std::size_t i = 0; i < theirs.size() && overlap.size() > 2; ++i) {
                const Point edge = theirs[(i + 1) % theirs.size()] - theirs[i];
                overlap = cut(overlap, theirs[i], edge.cross(normal)); // their edges run clockwise about our normal
            }
            if (overlap.size() < 3) continue;
            double perimeter = 0, gap = 0;
            const Point theirNormal = unitNormal(theirs);
            for (std::size_t i = 0; i < overlap.size(); ++i) {
                perimeter += (overlap[(i + 1) % overlap.size()] - overlap[i]).norm();
                gap = std::max(gap, std::abs((overlap[i] - theirs[0]).dot(theirNormal)));
            }
            if (gap > width || area(overlap, normal) < 0.5 * perimeter * width) continue;
            for (auto& corner : overlap)
                corner += 0.5 * (theirs[0] - corner).dot(theirNormal) * theirNormal;
            return FaceContact{normal, overlap};
        }
    }
    return std::nullopt;
}

double area(const Polygon& p, const Point& normal) {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i)
        twice += (p[i] - p[0]).cross(p[i + 1] - p[0]).dot(normal);
    return 0.5 * twice;
}

Point centroid(const Polygon& p, const Point& normal) {
    Point moment = Point::Zero();
    double twice = 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        const double part = (p[i] - p[0]).cross(p[i + 1] - p[0]).dot(normal);
        moment += part * (p[i] + p[i + 1] - 2 * p[0]) / 3; // from p[0], to keep digits far from the origin
        twice += part;
    }
    return p[0] + moment / twice;
}

std::vector<Subcontact> subdivide(const Polygon& polygon, const Point& normal, const Point& direction, int along,
                                  int across) {
    const Point axes[2] = {direction, normal.cross(direction)};
    const int counts[2] = {along, across};
    double low[2], step[2];
    for (int d = 0; d < 2; ++d) {
        double high = low[d] = polygon[0].dot(axes[d]);
        for (const auto& p : polygon)
            low[d] = std::min(low[d], p.dot(axes[d])), high = std::max(high, p.dot(axes[d]));
        step[d] = (high - low[d]) / counts[d];
    }
    const double smallest = 1e-9 * area(polygon, normal);
    std::vector<Subcontact> cells;
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < across; ++j) {
            const int at[2] = {i, j};
            Polygon cell = polygon;
            for (int d = 0; d < 2 && cell.size() > 2; ++d) { // the outermost sides are the polygon's own
                if (at[d] > 0) cell = cut(cell, (low[d] + at[d] * step[d]) * axes[d], axes[d]);
                if (at[d] + 1 < counts[d] && cell.size() > 2)
                    cell = cut(cell, (low[d] + (at[d] + 1) * step[d]) * axes[d], -axes[d]);
            }
            if (cell.size() < 3) continue;
            const double size = area(cell, normal);
            if (size > smallest) cells.push_back({centroid(cell, normal), size});
        }
    return cells;
}

std::vector<Polygon> nearestCells(const Polygon& polygon, const std::vector<Point>& points) {
    std::vector<Polygon> cells;
    for (const auto& mine : points) {
        Polygon cell = polygon;
        for (const auto& other : points)
            if (&other != &mine && cell.size() > 2) cell = cut(cell, 0.5 * (mine + other), mine - other);
        cells.push_back(cell);
    }
    return cells;
}

Point longestEdge(const Polygon& p) {
    Point longest = Point::Zero();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Point edge = p[(i + 1) % p.size()] - p[i];
        if (edge.squaredNorm() > longest.squaredNorm() * (1 + 1e-9)) longest = edge;
    }
    return longest.normalized();
}

} // namespace masonry
