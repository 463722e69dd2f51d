// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockMesh.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

namespace masonry {

namespace {

// The eight corners of a hexahedron in the order of those of a unit cube, x changing fastest; the three edges at the
// first corner are taken in the order that lies nearest to x, y and z. Empty if the block is not a hexahedron.
std::vector<Point> hexahedron(const ConvexBlock& block) {
    if (block.vertices.size() != 8) return {};
    const auto faces = block.faces();
    if (faces.size() != 6) return {};
    for (const auto& face : faces)
        if (face.size() != 4) return {};
    const auto index = [&](const Point& p) {
        return int(std::find(block.vertices.begin(), block.vertices.end(), p) - block.vertices.begin());
    };
    std::map<int, std::vector<int>> next; // vertices at the other ends of the edges of each vertex
    for (const auto& face : faces)
        for (int i = 0; i < 4; ++i)
            next[index(face[i])].push_back(index(face[(i + 1) % 4]));
    // The first corner is the one with the smallest sum of coordinates.
    int start = 0;
    for (int i = 1; i < 8; ++i)
        if (block.vertices[i].sum() < block.vertices[start].sum() - 1e-12 * block.size()) start = i;
    if (next[start].size() != 3) return {};
    // Of the six orders of its edges, the best has the largest sum of cosines between edges and axes.
    std::array<int, 3> edge{next[start][0], next[start][1], next[start][2]};
    std::array<int, 3> best = edge;
    std::sort(edge.begin(), edge.end());
    double most = -HUGE_VAL;
    do {
        double along = 0;
        for (int d = 0; d < 3; ++d)
            along += (block.vertices[edge[d]] - block.vertices[start]).normalized()[d];
        if (along > most) {
            most = along;
            best = edge;
        }
    } while (std::next_permutation(edge.begin(), edge.end()));
    // The vertex, other than `except`, that has edges to both a and b; -1 if there is none.
    const auto common = [&](int a, int b, int except) {
        for (int v : next[a])
            if (v != except && std::count(next[b].begin(), next[b].end(), v)) return v;
        return -1;
    };
    const int xy = common(best[0], best[1], start);
    const int xz = common(best[0], best[2], start);
    const int yz = common(best[1], best[2], start);
    if (xy < 0 || xz < 0 || yz < 0) return {};
    const int xyz = common(xy, xz, best[0]);
    if (xyz < 0) return {};
    std::vector<Point> cube;
    for (int v : {start, best[0], best[1], xy, best[2], xz, yz, xyz})
        cube.push_back(block.vertices[v]);
    return cube;
}

} // namespace

double volume(const std::array<Point, 4>& c) { return (c[1] - c[0]).cross(c[2] - c[0]).dot(c[3] - c[0]) / 6; }

namespace {

void checkDivisions(const std::array<int, 3>& divisions) {
    for (int n : divisions)
        if (n < 1 || n > 100) throw std::invalid_argument("divisions " + std::to_string(n) + " must be 1 to 100");
}

// Throws if a zone with this volume or area is inverted, or a sliver.
void checkZone(double content, double height, double longestEdge, double sliver) {
    if (!(content > 0)) throw std::invalid_argument("block has an inverted zone: not convex, or without volume");
    if (height < sliver * longestEdge)
        throw std::invalid_argument("block has a sliver zone, height " + std::to_string(height) +
                                    " m beside an edge of " + std::to_string(longestEdge) +
                                    " m: choose other divisions");
}

// The corners of the middle plane of a right prism along the direction `across`, in the order of its base, counter-
// clockwise about this direction. Empty if the block is no such prism.
std::vector<Point> middleOfPrism(const ConvexBlock& block, int across, double& thickness) {
    const double close = 1e-6 * block.size();
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const auto& v : block.vertices) {
        low = std::min(low, v[across]);
        high = std::max(high, v[across]);
    }
    thickness = high - low;
    if (!(thickness > 1e-3 * block.size())) return {};
    for (const auto& v : block.vertices) { // every corner has a partner at the other end
        const double other = std::abs(v[across] - low) < close ? high : low;
        if (std::min(std::abs(v[across] - low), std::abs(v[across] - high)) > close) return {};
        const bool found = std::any_of(block.vertices.begin(), block.vertices.end(), [&](Point w) {
            if (std::abs(w[across] - other) > close) return false;
            w[across] = v[across];
            return (w - v).norm() < close;
        });
        if (!found) return {};
    }
    std::vector<Point> base; // the face at the upper end, whose outward normal is the direction
    for (const auto& face : block.faces())
        if (std::all_of(face.begin(), face.end(), [&](const Point& v) { return high - v[across] < close; }))
            base = face;
    for (auto& v : base)
        v[across] = 0.5 * (low + high);
    return base;
}

} // namespace

std::optional<BlockMesh> divideInPlane(const ConvexBlock& block, const std::array<int, 3>& divisions, int across,
                                       double sliver) {
    checkDivisions(divisions);
    BlockMesh mesh;
    mesh.across = across;
    const auto base = middleOfPrism(block, across, mesh.thickness);
    if (base.size() < 3) return std::nullopt;
    const int a = (across + 1) % 3, b = (across + 2) % 3; // the two directions of the plane
    const auto cube = hexahedron(block);
    if (cube.empty()) {
        mesh.nodes = base;
        Point centre = Point::Zero();
        for (const auto& v : base)
            centre += v / base.size();
        mesh.nodes.push_back(centre);
        const int corners = int(base.size());
        for (int i = 0; i < corners; ++i) {
            mesh.triangles.push_back({i, (i + 1) % corners, corners});
            mesh.rim.push_back({i, (i + 1) % corners});
        }
    } else {
        const int na = divisions[a], nb = divisions[b];
        // The point of the middle plane with these coordinates, each from 0 to 1 along the edges.
        const auto at = [&](double x, double y) {
            Point p = Point::Zero();
            for (int c = 0; c < 8; ++c)
                p += 0.5 * (c >> a & 1 ? x : 1 - x) * (c >> b & 1 ? y : 1 - y) * cube[c];
            return p;
        };
        const auto node = [&](int i, int j) { return j * (na + 1) + i; };
        for (int j = 0; j <= nb; ++j)
            for (int i = 0; i <= na; ++i)
                mesh.nodes.push_back(at(double(i) / na, double(j) / nb));
        for (int j = 0; j < nb; ++j)
            for (int i = 0; i < na; ++i) {
                const int centre = int(mesh.nodes.size());
                mesh.nodes.push_back(at((i + 0.5) / na, (j + 0.5) / nb));
                const int around[4] = {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
                const bool onRim[4] = {j == 0, i == na - 1, j == nb - 1, i == 0};
                for (int side = 0; side < 4; ++side) {
                    mesh.triangles.push_back({around[side], around[(side + 1) % 4], centre});
                    if (onRim[side]) mesh.rim.push_back({around[side], around[(side + 1) % 4]});
                }
            }
    }
    for (const auto& t : mesh.triangles) {
        double longest = 0; // edge [m]
        for (int i = 0; i < 3; ++i)
            longest = std::max(longest, (mesh.nodes[t[(i + 1) % 3]] - mesh.nodes[t[i]]).norm());
        const double twice =
            (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]])[across]; // area [m²]
        checkZone(twice, twice / longest, longest, sliver);
    }
    return mesh;
}

BlockMesh divide(const ConvexBlock& block, const std::array<int, 3>& divisions, double sliver) {
    checkDivisions(divisions);
    BlockMesh mesh;
    const auto addZone = [&](int apex, const std::array<int, 3>& base) {
        mesh.zones.push_back({base[0], base[1], base[2], apex});
    };
    const auto cube = hexahedron(block);
    if (cube.empty()) {
        mesh.nodes = block.vertices;
        mesh.triangles = block.triangles;
        Point centre = Point::Zero();
        for (const auto& v : block.vertices)
            centre += v / block.vertices.size();
        mesh.nodes.push_back(centre);
        for (const auto& t : block.triangles)
            addZone(int(mesh.nodes.size()) - 1, {t[0], t[2], t[1]});
    } else {
        const auto [nx, ny, nz] = divisions;
        // The point of the block with these coordinates, each from 0 to 1 along the edges.
        const auto at = [&](double x, double y, double z) {
            Point p = Point::Zero();
            for (int c = 0; c < 8; ++c)
                p += (c & 1 ? x : 1 - x) * (c & 2 ? y : 1 - y) * (c & 4 ? z : 1 - z) * cube[c];
            return p;
        };
        // The number of a node at the corner of cells, from its indices along the edges.
        const auto node = [&, ax = nx + 1, ay = ny + 1](int i, int j, int k) { return (k * ay + j) * ax + i; };
        for (int k = 0; k <= nz; ++k)
            for (int j = 0; j <= ny; ++j)
                for (int i = 0; i <= nx; ++i)
                    mesh.nodes.push_back(at(double(i) / nx, double(j) / ny, double(k) / nz));
        for (int k = 0; k < nz; ++k)
            for (int j = 0; j < ny; ++j)
                for (int i = 0; i < nx; ++i) {
                    const int centre = int(mesh.nodes.size());
                    mesh.nodes.push_back(at((i + 0.5) / nx, (j + 0.5) / ny, (k + 0.5) / nz));
                    const int cell[3] = {i, j, k};
                    const int last[3] = {nx - 1, ny - 1, nz - 1};
                    for (int axis = 0; axis < 3; ++axis)
                        for (int side = 0; side < 2; ++side) {
                            const int u = (axis + 1) % 3;
                            const int v = (axis + 2) % 3;
                            int q[4]; // nodes around the face, counter-clockwise about the positive axis
                            int odd = 0;
                            for (int c = 0; c < 4; ++c) {
                                int index[3] = {cell[0], cell[1], cell[2]};
                                index[axis] += side;
                                index[u] += c == 1 || c == 2;
                                index[v] += c >= 2;
                                q[c] = node(index[0], index[1], index[2]);
                                if (c == 0) odd = (index[0] + index[1] + index[2] - (axis == 1 ? 0 : index[axis])) % 2;
                            }
                            if (!side) std::swap(q[1], q[3]);
                            // The diagonal joins the corners whose indices have an even sum. On faces across x and z
                            // the index along the axis does not count, so that all of them have the same diagonals
                            // and blocks laid in courses meet with equal triangles.
                            const std::array<int, 3> halves[2][2] = {{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}},
                                                                     {{q[1], q[2], q[3]}, {q[1], q[3], q[0]}}};
                            const bool atSurface = cell[axis] == (side ? last[axis] : 0);
                            for (const auto& t : halves[odd]) {
                                addZone(centre, {t[0], t[2], t[1]});
                                if (atSurface) mesh.triangles.push_back(t);
                            }
                            if (atSurface) mesh.cellFaces.push_back({q[0], q[1], q[2], q[3]});
                        }
                }
    }
    for (const auto& zone : mesh.zones) {
        std::array<Point, 4> c;
        double longest = 0; // edge [m]
        double largest = 0; // area of a side [m²]
        for (int i = 0; i < 4; ++i)
            c[i] = mesh.nodes[zone[i]];
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j)
                longest = std::max(longest, (c[i] - c[j]).norm());
        for (int i = 0; i < 4; ++i)
            largest = std::max(largest,
                               0.5 * (c[(i + 1) % 4] - c[(i + 2) % 4]).cross(c[(i + 3) % 4] - c[(i + 2) % 4]).norm());
        const double inside = volume(c);
        checkZone(inside, 3 * inside / largest, longest, sliver);
    }
    return mesh;
}

SurfacePoint nearestOnSurface(const BlockMesh& mesh, const Point& p) {
    SurfacePoint best{};
    double nearest = HUGE_VAL;
    for (const auto& t : mesh.triangles) {
        const Point &a = mesh.nodes[t[0]], &b = mesh.nodes[t[1]], &c = mesh.nodes[t[2]];
        const Point n = (b - a).cross(c - a);
        Eigen::Vector3d w(n.dot((b - p).cross(c - p)), n.dot((c - p).cross(a - p)), n.dot((a - p).cross(b - p)));
        w = (w / w.sum()).cwiseMax(0); // weights below zero belong to a point outside the triangle: move it to the rim
        w /= w.sum();
        const double distance = (w[0] * a + w[1] * b + w[2] * c - p).squaredNorm();
        if (distance < nearest) {
            nearest = distance;
            best = {t, {w[0], w[1], w[2]}};
        }
    }
    return best;
}

} // namespace masonry
