// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactBlock.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace masonry {

using Vector = Eigen::Vector3d;

namespace {

constexpr double flat = 1e-10;   // how far corners of one face may lie from its plane, over the radius of the block
constexpr double convex = 0.002; // how far corners may lie above a face, likewise: blocks of files are rounded

} // namespace

ContactBlock contactBlock(const std::vector<Vector>& corners, const std::vector<std::array<int, 3>>& triangles) {
    ContactBlock block;
    for (const auto& corner : corners) {
        for (int d = 0; d < 3; ++d)
            block.corners[d].push_back(corner[d]);
        block.radius = std::max(block.radius, corner.norm());
    }
    const auto across = [&](const std::array<int, 3>& t) -> Vector {
        return (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]);
    };
    // The largest triangle of a face gives its normal most exactly.
    std::vector<std::array<int, 3>> sorted = triangles;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const auto& a, const auto& b) { return across(a).squaredNorm() > across(b).squaredNorm(); });
    block.thickness = HUGE_VAL;
    for (const auto& triangle : sorted) {
        const auto lies = [&](const ContactBlock::Face& face, int corner) {
            return std::abs(face.offset - face.normal.dot(corners[corner])) <= flat * block.radius;
        };
        const bool known = std::any_of(block.faces.begin(), block.faces.end(), [&](const auto& face) {
            return std::all_of(triangle.begin(), triangle.end(), [&](int corner) { return lies(face, corner); });
        });
        const Vector normal = across(triangle);
        if (known || !(normal.norm() > 1e-14 * block.radius * block.radius)) continue;
        ContactBlock::Face face{normal.normalized(), 0, int(block.outlines.size()), 0};
        face.offset = face.normal.dot(corners[triangle[0]]);
        std::vector<int> outline;
        Vector middle = Vector::Zero();
        double deep = 0;
        for (int corner = 0; corner < int(corners.size()); ++corner) {
            const double depth = face.offset - face.normal.dot(corners[corner]);
            if (depth < -convex * block.radius)
                throw std::invalid_argument("block is not convex, or the corners of its faces wind the wrong way");
            deep = std::max(deep, depth);
            if (!lies(face, corner)) continue;
            outline.push_back(corner);
            middle += corners[corner];
        }
        middle /= double(outline.size());
        block.thickness = std::min(block.thickness, deep);
        const Vector e1 = (corners[outline[0]] - middle).normalized(), e2 = face.normal.cross(e1);
        const auto angle = [&](int corner) {
            const Vector arm = corners[corner] - middle;
            return std::atan2(arm.dot(e2), arm.dot(e1));
        };
        std::sort(outline.begin(), outline.end(), [&](int a, int b) { return angle(a) < angle(b); });
        double area = 0;
        for (std::size_t i = 2; i < outline.size(); ++i)
            area += 0.5 * across({outline[0], outline[i - 1], outline[i]}).dot(face.normal);
        block.surface += area;
        block.largestFace = std::max(block.largestFace, area);
        block.outlines.insert(block.outlines.end(), outline.begin(), outline.end());
        face.beyond = int(block.outlines.size());
        block.faces.push_back(face);
    }
    for (const auto& face : block.faces)
        for (int k = face.first; k < face.beyond; ++k) {
            const int next = k + 1 < face.beyond ? k + 1 : face.first;
            const Vector edge = (corners[block.outlines[next]] - corners[block.outlines[k]]).normalized();
            const auto parallel = [&](const Vector& known) { return known.cross(edge).norm() < 1e-9; };
            if (std::none_of(block.edges.begin(), block.edges.end(), parallel)) block.edges.push_back(edge);
        }
    if (block.faces.size() < 4 || !(block.thickness > 1e-9 * block.radius))
        throw std::invalid_argument("block has no volume");
    return block;
}

} // namespace masonry
