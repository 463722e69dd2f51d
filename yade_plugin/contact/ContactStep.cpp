// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactStep.hpp"
#include <Eigen/Eigenvalues>

namespace masonry {

double embeddedEigenvalue(const ContactBlock& block, double mass, const Eigen::Vector3d& inertia,
                          double normalStiffness, double tangentialStiffness) {
    using Vector = Eigen::Vector3d;
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    Matrix6 stiffness = Matrix6::Zero();
    const auto at = [&](int corner) {
        return Vector(block.corners[0][corner], block.corners[1][corner], block.corners[2][corner]);
    };
    for (const auto& face : block.faces) {
        const Eigen::Matrix3d law = tangentialStiffness * Eigen::Matrix3d::Identity() +
                                    (normalStiffness - tangentialStiffness) * face.normal * face.normal.transpose();
        const auto outline = [&](int k) { return at(block.outlines[k]); };
        for (int k = face.first + 2; k < face.beyond; ++k) {
            const Vector p[3] = {outline(face.first), outline(k - 1), outline(k)};
            const double area = 0.5 * face.normal.dot((p[1] - p[0]).cross(p[2] - p[0]));
            for (int edge = 0; edge < 3; ++edge) { // the middles of the edges are exact for the second power
                const Vector x = 0.5 * (p[edge] + p[(edge + 1) % 3]);
                Eigen::Matrix<double, 3, 6> motion; // of this point, for each of the six motions of the block
                motion << 1, 0, 0, 0, x[2], -x[1], 0, 1, 0, -x[2], 0, x[0], 0, 0, 1, x[1], -x[0], 0;
                stiffness += area / 3 * motion.transpose() * law * motion;
            }
        }
    }
    Eigen::Matrix<double, 6, 1> scale;
    scale << Vector::Constant(1 / std::sqrt(mass)), inertia.cwiseInverse().cwiseSqrt();
    const Matrix6 scaled = scale.asDiagonal() * stiffness * scale.asDiagonal();
    return Eigen::SelfAdjointEigenSolver<Matrix6>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[5];
}

} // namespace masonry
