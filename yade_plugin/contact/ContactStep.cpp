// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactStep.hpp"
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace masonry {

double mobilityOf(const ContactBlock& block, double mass, const Eigen::Vector3d& inertia) {
    double most = 0;
    for (int i = 0; i < block.cornerCount(); ++i) {
        const double x = block.corners[0][i], y = block.corners[1][i], z = block.corners[2][i];
        Eigen::Matrix3d arm; // turns a rotation into a velocity
        arm << 0, z, -y, -z, 0, x, y, -x, 0;
        const Eigen::Matrix3d turning = arm * inertia.cwiseInverse().asDiagonal() * arm.transpose();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(turning, Eigen::EigenvaluesOnly);
        most = std::max(most, 1 / mass + solver.eigenvalues()[2]);
    }
    return most;
}

} // namespace masonry
