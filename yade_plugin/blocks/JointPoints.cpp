// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointPoints.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace masonry {

namespace {

constexpr double roundOff = 1e-9; // relative to the size of a polygon

// Length of the cut through a convex polygon at x·along = at, and its middle. The cut lies between the lowest and the
// highest corner.
struct Width {
    double length; // [m]
    Point middle;
};
Width widthAt(const Polygon& polygon, const Point& along, const Point& across, double at) {
    const Point *lowest = nullptr, *highest = nullptr;
    std::vector<Point> ends;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = a.dot(along) - at, db = b.dot(along) - at;
        if (da == 0) ends.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) ends.push_back(a + (b - a) * (da / (da - db)));
    }
    for (const auto& p : ends) {
        if (!lowest || p.dot(across) < lowest->dot(across)) lowest = &p;
        if (!highest || p.dot(across) > highest->dot(across)) highest = &p;
    }
    return {(*highest - *lowest).dot(across), 0.5 * (*lowest + *highest)};
}

// One row of points in the direction `along`, in the middle of the polygon's width.
std::vector<Subcontact> row(const Polygon& polygon, const Point& normal, const Point& along, int count) {
    const Point across = normal.cross(along);
    std::vector<double> corners;
    for (const auto& p : polygon)
        corners.push_back(p.dot(along));
    std::sort(corners.begin(), corners.end());
    const double length = corners.back() - corners.front();
    const auto close = [&](double a, double b) { return b - a <= roundOff * length; };
    corners.erase(std::unique(corners.begin(), corners.end(), close), corners.end());
    std::vector<Subcontact> points;
    for (std::size_t stretch = 0; stretch + 1 < corners.size(); ++stretch) {
        const double from = corners[stretch], size = corners[stretch + 1] - from;
        // Width and middle are linear in a stretch, so two cuts within it give both. Cuts through corners do not:
        // round-off decides whether they meet the edge there.
        const Width one = widthAt(polygon, along, across, from + 0.25 * size);
        const Width two = widthAt(polygon, along, across, from + 0.75 * size);
        const double steady = std::max(one.length, two.length);
        const bool even = std::abs(two.length - one.length) <= roundOff * steady;
        const auto rule = gaussLobatto(even ? count : std::max(count, 3));
        for (std::size_t i = 0; i < rule.places.size(); ++i) {
            const double t = 2 * rule.places[i] - 0.5; // from 0 at the first cut to 1 at the second
            const double width = std::max(0.0, one.length + t * (two.length - one.length));
            const Point place = one.middle + t * (two.middle - one.middle);
            const double part = rule.weights[i] * size * width;
            const bool shared = i == 0 && stretch > 0 && rule.places[i] == 0;
            if (shared && !points.empty() && (points.back().centre - place).norm() <= roundOff * length)
                points.back().area += part;
            else if (part > roundOff * size * steady) // none at an end that is a corner
                points.push_back({place, part});
        }
    }
    return points;
}

std::vector<Subcontact> quadrilateral(const Polygon& corners, const Point& normal, const Point& along, int columns,
                                      int rows) {
    // The first edge is the one of which the direction, with that of its opposite, is nearest to `along`.
    std::size_t first = 0;
    double best = -HUGE_VAL;
    for (std::size_t i = 0; i < 4; ++i) {
        const Point edge = corners[(i + 1) % 4] - corners[i] + corners[(i + 2) % 4] - corners[(i + 3) % 4];
        const double nearness = edge.normalized().dot(along);
        if (nearness > best + roundOff) {
            best = nearness;
            first = i;
        }
    }
    const Point &a = corners[first], &b = corners[(first + 1) % 4], &c = corners[(first + 2) % 4],
                &d = corners[(first + 3) % 4];
    const Point warp = a - b + c - d; // zero in a parallelogram
    if (warp.norm() > 1e-6 * (c - a).norm()) {
        columns = std::max(columns, 3);
        rows = std::max(rows, 3);
    }
    const auto one = gaussLobatto(columns), two = gaussLobatto(rows);
    std::vector<Subcontact> points;
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j) {
            const double x = one.places[i], y = two.places[j];
            const double stretch =
                (b - a + y * warp).cross(d - a + x * warp).dot(normal); // area over that of a unit square
            const double part = one.weights[i] * two.weights[j] * stretch;
            if (part > 0) points.push_back({a + x * (b - a) + y * (d - a) + x * y * warp, part});
        }
    return points;
}

std::vector<Subcontact> fan(const Polygon& polygon, const Point& normal, int fineness) {
    const Point centre = centroid(polygon, normal);
    const int corners = int(polygon.size());
    std::map<std::array<int, 3>, Subcontact> lattice; // corners of the small triangles, each once
    std::vector<Subcontact> inner;
    for (int i = 0; i < corners; ++i) {
        const int next = (i + 1) % corners;
        const Point one = (polygon[i] - centre) / fineness, two = (polygon[next] - centre) / fineness;
        const double size = 0.5 * one.cross(two).dot(normal); // of a small triangle [m²]
        const auto add = [&](int u, int v) {
            // Points on the line from the centre to a corner belong to two triangles of the fan.
            const std::array<int, 3> key = u + v == 0 ? std::array<int, 3>{0, 0, 0}
                                           : v == 0   ? std::array<int, 3>{i, u, 0}
                                           : u == 0   ? std::array<int, 3>{next, v, 0}
                                                      : std::array<int, 3>{i, u, v};
            lattice.emplace(key, Subcontact{centre + u * one + v * two, 0}).first->second.area += size / 12;
        };
        const auto triangle = [&](int u, int v,
                                  int direction) { // with its right angle at (u, v) in the lattice's coordinates
            add(u, v);
            add(u + direction, v);
            add(u, v + direction);
            inner.push_back({centre + (u + direction / 3.0) * one + (v + direction / 3.0) * two, 0.75 * size});
        };
        for (int u = 0; u < fineness; ++u)
            for (int v = 0; u + v < fineness; ++v) {
                triangle(u, v, 1);
                if (u + v + 1 < fineness) triangle(u + 1, v + 1, -1);
            }
    }
    for (const auto& [key, point] : lattice)
        inner.push_back(point);
    return inner;
}

} // namespace

LineRule gaussLobatto(int n) {
    if (n == 1) return {{0.5}, {1.0}};
    LineRule rule{std::vector<double>(n), std::vector<double>(n)};
    const int degree = n - 1;
    for (int i = 0; 2 * i < n; ++i) {
        // The points are the roots of (1 - x²) P'(x), P the Legendre polynomial of this degree; Newton's method finds
        // them from those of Chebyshev.
        double x = -std::cos(M_PI * i / degree), value = 1;
        if (2 * i == degree) x = 0;
        for (int iteration = 0; iteration < 100; ++iteration) {
            double before = 1; // Legendre polynomials of two successive degrees
            value = x;
            for (int k = 2; k <= degree; ++k) {
                const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
                before = value;
                value = next;
            }
            if (i == 0 || 2 * i == degree) break; // the end and the middle are known
            const double change = (x * value - before) / (n * value);
            x -= change;
            if (std::abs(change) < 1e-15) break;
        }
        rule.places[i] = 0.5 * (1 + x);
        rule.places[n - 1 - i] = 0.5 * (1 - x);
        rule.weights[i] = rule.weights[n - 1 - i] = 1 / (degree * n * value * value);
    }
    return rule;
}

std::vector<Subcontact> subdivide(const Polygon& polygon, const Point& normal, const Point& direction, int along,
                                  int across) {
    if (along == 1 && across == 1) return {{centroid(polygon, normal), area(polygon, normal)}};
    if (across == 1) return row(polygon, normal, direction, along);
    if (along == 1) return row(polygon, normal, normal.cross(direction), across);
    if (polygon.size() == 4) return quadrilateral(polygon, normal, direction, along, across);
    return fan(polygon, normal, std::max(1, std::max(along, across) / 2));
}

} // namespace masonry
