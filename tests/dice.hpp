// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors and rotations that a test draws.
#pragma once
#include "chance.hpp"
#include <Eigen/Geometry>

namespace masonry {

struct Dice : Chance {
    using Chance::Chance;
    Eigen::Vector3d vector(double size = 1) { // in a cube
        const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
        return {x, y, z};
    }
    Eigen::Vector3d direction() { return vector().normalized(); }
    Eigen::Quaterniond rotation() {
        const Eigen::Vector3d v = vector();
        return Eigen::Quaterniond(between(-1, 1), v[0], v[1], v[2]).normalized();
    }
};

} // namespace masonry
