// SPDX-License-Identifier: GPL-2.0-or-later
#include "FaceContact.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace masonry {

namespace {

constexpr double parallel = 1 - 1e-6;     // least cosine between the normals of parallel faces: an angle of 1.4 mrad
constexpr double nearlyParallel = 0.9945; // least cosine between the normals of nearly parallel faces: an angle of 6°

// The normal of a polygon by Newell's method: the sum is twice the area vector.
Point unitNormal(const Polygon& p) {
    Point sum = Point::Zero();
    for (std::size_t i = 0; i < p.size(); ++i)
        sum += (p[i] - p[0]).cross(p[(i + 1) % p.size()] - p[0]);
    return sum.normalized();
}

// The part of a convex polygon on one side of a plane: its points x satisfy (x - origin)·inward >= 0.
Polygon cut(const Polygon& polygon, const Point& origin, const Point& inward) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = (a - origin).dot(inward);
        const double db = (b - origin).dot(inward);
        if (da >= 0) kept.push_back(a);
        const bool crossesPlane = (da > 0 && db < 0) || (da < 0 && db > 0);
        if (crossesPlane) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    return kept;
}

// The polygon without corners that lie on the line between their neighbours. Round-off in `cut` leaves such corners.
Polygon withoutFlatCorners(Polygon p, double width) {
    for (std::size_t i = 0; i < p.size() && p.size() > 2;) {
        const Point& before = p[(i + p.size() - 1) % p.size()];
        const Point chord = p[(i + 1) % p.size()] - before;
        if ((p[i] - before).cross(chord).norm() <= width * chord.norm())
            p.erase(p.begin() + std::ptrdiff_t(i));
        else
            ++i;
    }
    return p;
}

} // namespace

double ConvexBlock::size() const {
    Point low = vertices.front(), high = low;
    for (const auto& v : vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    return (high - low).norm();
}

std::vector<Polygon> ConvexBlock::faces() const {
    std::vector<Polygon> faces;
    std::vector<Point> normals;
    std::vector<std::vector<int>> corners;
    for (const auto& t : triangles) {
        const Point n = unitNormal({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
        // A convex block has at most one face with a given normal, so triangles with one normal belong to one face.
        std::size_t f = 0;
        while (f < normals.size() && normals[f].dot(n) < parallel)
            ++f;
        if (f == normals.size()) {
            normals.push_back(n);
            corners.emplace_back();
        }
        for (int corner : t)
            if (std::find(corners[f].begin(), corners[f].end(), corner) == corners[f].end())
                corners[f].push_back(corner);
    }
    for (std::size_t f = 0; f < normals.size(); ++f) {
        Point middle = Point::Zero();
        for (int c : corners[f])
            middle += vertices[c] / corners[f].size();
        const Point e1 = (vertices[corners[f][0]] - middle).normalized();
        const Point e2 = normals[f].cross(e1);
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

KnownBlock::KnownBlock(ConvexBlock block) : ConvexBlock(std::move(block)), diagonal(size()), thickness(HUGE_VAL) {
    for (auto& face : faces()) {
        const Point normal = unitNormal(face);
        double deep = 0;
        for (const auto& v : vertices) {
            const double below = (face[0] - v).dot(normal);
            // Merged triangles may deviate from one plane by a little, so a vertex may lie a little above a face.
            if (below < -0.002 * diagonal)
                throw std::invalid_argument("block is not convex, or the corners of its faces wind the wrong way");
            deep = std::max(deep, below);
        }
        thickness = std::min(thickness, deep);
        known.push_back({std::move(face), normal});
    }
}

bool KnownBlock::holds(const Point& p, double margin) const {
    return std::all_of(known.begin(), known.end(),
                       [&](const Face& face) { return (p - face.corners[0]).dot(face.normal) <= margin; });
}

namespace {

// Two faces that look at each other, projected onto one of them along its normal.
struct Meeting {
    Polygon shared;       // what the two faces have in common
    double gap = 0;       // largest distance between the two faces over the shared polygon [m]
    double area = 0;      // of the shared polygon [m²]
    double perimeter = 0; // of the shared polygon [m]
};

Meeting meet(const KnownBlock::Face& mine, const KnownBlock::Face& theirs) {
    Meeting m{mine.corners};
    const auto& corners = theirs.corners;
    for (std::size_t i = 0; i < corners.size() && m.shared.size() > 2; ++i) {
        const Point edge = corners[(i + 1) % corners.size()] - corners[i];
        // The corners of the opposite face run clockwise about our normal, so this vector points into that face.
        const Point inward = edge.cross(mine.normal);
        m.shared = cut(m.shared, corners[i], inward);
    }
    if (m.shared.size() < 3) return m;
    m.area = area(m.shared, mine.normal);
    for (std::size_t i = 0; i < m.shared.size(); ++i) {
        m.perimeter += (m.shared[(i + 1) % m.shared.size()] - m.shared[i]).norm();
        m.gap = std::max(m.gap, std::abs((m.shared[i] - corners[0]).dot(theirs.normal)));
    }
    return m;
}

// How far apart two convex blocks are [m], by the separating axis theorem: along each axis both blocks are projected,
// and the largest gap between the projections counts. If no axis separates the blocks, the result is negative, and its
// magnitude is the smallest overlap. The axes are the normals of all faces; if these give less than `enough`, also the
// directions at right angles to an edge of each block.
double separation(const KnownBlock& one, const KnownBlock& two, double enough) {
    double most = -HUGE_VAL;
    const auto across = [&](const Point& axis) {
        double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
        for (int side = 0; side < 2; ++side)
            for (const auto& v : (side ? two : one).vertices) {
                low[side] = std::min(low[side], v.dot(axis));
                high[side] = std::max(high[side], v.dot(axis));
            }
        most = std::max({most, low[1] - high[0], low[0] - high[1]});
    };
    for (const auto* block : {&one, &two})
        for (const auto& face : block->known)
            across(face.normal);
    if (most >= enough) return most;
    for (const auto& t : one.triangles)
        for (const auto& s : two.triangles)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const Point e = (one.vertices[t[(i + 1) % 3]] - one.vertices[t[i]]).normalized();
                    const Point f = (two.vertices[s[(j + 1) % 3]] - two.vertices[s[j]]).normalized();
                    const bool areParallel = !(e.cross(f).norm() > 1e-6);
                    if (!areParallel) across(e.cross(f).normalized());
                }
    return most;
}

} // namespace

std::optional<FaceContact> coincidentFaces(const KnownBlock& one, const KnownBlock& two, double tolerance) {
    const double width = tolerance * std::min(one.diagonal, two.diagonal);
    for (const auto& mine : one.known)
        for (const auto& theirs : two.known) {
            if (mine.normal.dot(theirs.normal) > -parallel) continue;
            const Point& origin = theirs.corners[0];
            // A cheap test leaves out faces that are far apart; the gap is measured below.
            if (std::abs((origin - mine.corners[0]).dot(mine.normal)) > 100 * width) continue;
            auto m = meet(mine, theirs);
            if (m.shared.size() < 3 || m.gap > width || !(m.area > 0.5 * m.perimeter * width)) continue;
            m.shared = withoutFlatCorners(std::move(m.shared), 0.01 * width);
            for (auto& corner : m.shared)
                corner += 0.5 * (origin - corner).dot(theirs.normal) * theirs.normal;
            return FaceContact{mine.normal, m.shared};
        }
    return std::nullopt;
}

std::optional<Misfit> misfit(const KnownBlock& one, const KnownBlock& two, double tolerance) {
    const double width = tolerance * std::min(one.diagonal, two.diagonal);
    const double reach = 0.25 * std::min(one.thickness, two.thickness);
    const double apart = separation(one, two, -width);
    if (apart < -width) return Misfit{apart, Point::Zero()};
    if (apart > reach) return std::nullopt;
    for (const auto& mine : one.known)
        for (const auto& theirs : two.known) {
            if (mine.normal.dot(theirs.normal) > -nearlyParallel) continue;
            const auto m = meet(mine, theirs);
            const double smaller = std::min(area(mine.corners, mine.normal), area(theirs.corners, theirs.normal));
            if (m.shared.size() < 3 || m.gap > reach || m.area < std::max(0.5 * m.perimeter * width, 0.01 * smaller))
                continue;
            const Point centre = centroid(m.shared, mine.normal);
            return Misfit{m.gap, centre + 0.5 * (theirs.corners[0] - centre).dot(theirs.normal) * theirs.normal};
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
        moment += part * (p[i] + p[i + 1] - 2 * p[0]) / 3; // about p[0]: less round-off far from the origin
        twice += part;
    }
    return p[0] + moment / twice;
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
    // Round-off decides at which corner a polygon begins. So of edges of one length not the first is taken, but the one
    // that points most in this direction. No edge of a usual block is at a right angle to it.
    const Point preferred(1, 0.618, 0.272);
    Point longest = Point::Zero();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Point edge = p[(i + 1) % p.size()] - p[i];
        const double excess = edge.squaredNorm() - longest.squaredNorm(), roundOff = 1e-9 * longest.squaredNorm();
        if (excess > roundOff || (excess > -roundOff && edge.dot(preferred) > longest.dot(preferred))) longest = edge;
    }
    return longest.normalized();
}

} // namespace masonry
