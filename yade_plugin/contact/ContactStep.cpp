// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactStep.hpp"
#include <Eigen/Eigenvalues>

namespace masonry {

namespace {

using Vector = Eigen::Vector3d;
using Polygon = std::vector<Vector>;

Polygon outlineOf(const ContactBlock& block, const ContactBlock::Face& face) {
    Polygon found;
    for (int k = face.first; k < face.beyond; ++k) {
        const int corner = block.outlines[k];
        found.emplace_back(block.corners[0][corner], block.corners[1][corner], block.corners[2][corner]);
    }
    return found;
}

// The part of a polygon below a plane.
Polygon cut(const Polygon& polygon, const Vector& normal, double offset) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vector &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
        const double s = offset - normal.dot(here), t = offset - normal.dot(next);
        if (s >= 0) kept.push_back(here);
        if ((s > 0 && t < 0) || (s < 0 && t > 0)) kept.push_back(here + s / (s - t) * (next - here));
    }
    return kept;
}

void addPolygon(const Polygon& p, const Vector& normal, double normalStiffness, double tangentialStiffness,
                BlockStiffness& stiffness) {
    const Eigen::Matrix3d law = tangentialStiffness * Eigen::Matrix3d::Identity() +
                                (normalStiffness - tangentialStiffness) * normal * normal.transpose();
    for (std::size_t k = 2; k < p.size(); ++k) {
        const double area = 0.5 * normal.dot((p[k - 1] - p[0]).cross(p[k] - p[0]));
        // The middles of the edges of a triangle are exact for the second power.
        for (const Vector& x : {Vector(p[0] + p[k - 1]), Vector(p[k - 1] + p[k]), Vector(p[k] + p[0])})
            addSpring(0.5 * x, area / 3 * law, stiffness);
    }
}

} // namespace

void addSpring(const Vector& x, const Eigen::Matrix3d& spring, BlockStiffness& stiffness) {
    Eigen::Matrix<double, 3, 6> motion; // of the point, for each of the six motions of the block
    motion << 1, 0, 0, 0, x[2], -x[1], 0, 1, 0, -x[2], 0, x[0], 0, 0, 1, x[1], -x[0], 0;
    stiffness += motion.transpose() * spring * motion;
}

void addSurface(const ContactBlock& block, double normalStiffness, double tangentialStiffness,
                BlockStiffness& stiffness) {
    for (const auto& face : block.faces)
        addPolygon(outlineOf(block, face), face.normal, normalStiffness, tangentialStiffness, stiffness);
}

void addNearSurface(const ContactBlock& block, const ContactBlock& other, const RelativePose& pose, double distance,
                    double normalStiffness, double tangentialStiffness, BlockStiffness& stiffness) {
    for (const auto& face : block.faces) {
        auto polygon = outlineOf(block, face);
        for (const auto& plane : other.faces) {
            const Vector normal = pose.turn * plane.normal;
            polygon = cut(polygon, normal, plane.offset + normal.dot(pose.place) + distance);
            if (polygon.size() < 3) break;
        }
        addPolygon(polygon, face.normal, normalStiffness, tangentialStiffness, stiffness);
    }
}

double largestEigenvalueOf(const BlockStiffness& stiffness, const ContactBody& body) {
    const bool spins = body.blocked >> 3 == 0;
    BlockStiffness turned = stiffness;
    if (body.blocked != 0) { // blocked axes are global ones
        BlockStiffness turn = BlockStiffness::Zero();
        turn.block<3, 3>(0, 0) = body.turn;
        turn.block<3, 3>(3, 3) = spins ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : body.turn;
        turned = turn * stiffness * turn.transpose();
    }
    Eigen::Matrix<double, 6, 1> scale;
    for (int d = 0; d < 6; ++d)
        scale[d] = body.blocked >> d & 1 ? 0 : 1 / std::sqrt(d < 3 ? body.mass : body.inertia[d - 3]);
    const BlockStiffness scaled = scale.asDiagonal() * turned * scale.asDiagonal();
    return Eigen::SelfAdjointEigenSolver<BlockStiffness>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[5];
}

double embeddedEigenvalue(const ContactBlock& block, double mass, const Vector& inertia, double normalStiffness,
                          double tangentialStiffness) {
    BlockStiffness stiffness = BlockStiffness::Zero();
    addSurface(block, normalStiffness, tangentialStiffness, stiffness);
    const Vector none = Vector::Zero();
    return largestEigenvalueOf(stiffness, {Eigen::Matrix3d::Identity(), none, none, none, mass, inertia, 0});
}

} // namespace masonry
