// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactWrench.hpp"
#include <Eigen/Geometry>

namespace masonry {

using Vector = Eigen::Vector3d;

Wrench& Wrench::add(double share, const Wrench& wrench) {
    force += share * wrench.force;
    torques[0] += share * wrench.torques[0];
    torques[1] += share * wrench.torques[1];
    return *this;
}

Wrench wrenchOf(const NearBlocks& blocks, const Vector& force, const Vector& moment) {
    const auto& turn = blocks.one.turn;
    return {turn * force,
            {turn * (blocks.gap.cross(force) - moment), turn * (moment - blocks.pose.place.cross(force))}};
}

double powerOf(const NearBlocks& blocks, const Wrench& wrench) {
    return wrench.force.dot(blocks.other.velocity - blocks.one.velocity) + wrench.torques[0].dot(blocks.one.spin) +
           wrench.torques[1].dot(blocks.other.spin);
}

double responseOf(const NearBlocks& blocks, const Wrench& wrench, const Wrench& to) {
    double sum = 0;
    for (int side = 0; side < 2; ++side) {
        const auto& body = side ? blocks.other : blocks.one;
        const bool spins = body.blocked >> 3 == 0;
        Vector turning = wrench.torques[side], by = to.torques[side];
        if (spins) { // moments of inertia are those of its own axes
            turning = (body.turn.transpose() * turning).eval();
            by = (body.turn.transpose() * by).eval();
        }
        for (int d = 0; d < 3; ++d) {
            if (!(body.blocked >> d & 1)) sum += wrench.force[d] * to.force[d] / body.mass;
            if (spins || !(body.blocked >> (3 + d) & 1)) sum += turning[d] * by[d] / body.inertia[d];
        }
    }
    return sum;
}

void push(ContactBody& body, const Vector& force, const Vector& torque, double time) {
    const bool spins = body.blocked >> 3 == 0;
    Vector turning = spins ? Vector(body.turn.transpose() * torque) : torque;
    for (int d = 0; d < 3; ++d) {
        if (!(body.blocked >> d & 1)) body.velocity[d] += time * force[d] / body.mass;
        turning[d] = spins || !(body.blocked >> (3 + d) & 1) ? time * turning[d] / body.inertia[d] : 0;
    }
    body.spin += spins ? Vector(body.turn * turning) : turning;
}

double massAlong(const NearBlocks& blocks, const Vector& point, const Vector& normal) {
    const Wrench unit{normal,
                      {(blocks.one.position - point).cross(normal), (point - blocks.other.position).cross(normal)}};
    const double inverse = responseOf(blocks, unit, unit);
    return inverse > 0 ? 1 / inverse : 0;
}

Wrench standing(const NearBlocks& blocks, const Wrench& wrench) {
    const Vector arm = blocks.other.position - blocks.one.position;
    return {wrench.force, {wrench.torques[0], -wrench.torques[0] - arm.cross(wrench.force)}};
}

} // namespace masonry
