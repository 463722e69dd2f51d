// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactPair.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace masonry {

using Vector = Eigen::Vector3d;

namespace {

// How the other block moves where it counts as standing, at the centre of the one, in the axes of the one.
RelativeMotion motionOf(const NearBlocks& blocks) {
    const auto &one = blocks.one, &other = blocks.other;
    const Eigen::Matrix3d back = one.turn.transpose();
    const Vector arm = other.position - one.position, spin = back * (other.spin - one.spin);
    return {back * (other.velocity - other.spin.cross(arm) - one.velocity) - spin.cross(blocks.gap), spin};
}

// Whether the blocks have come from their last pose with the velocities that they have. Where a script has put a block
// elsewhere, nothing has given that change of elastic energy.
bool cameByThemselves(const NearBlocks& blocks, double dt, const FrictionState& last) {
    const auto &one = blocks.one, &other = blocks.other;
    const Eigen::Matrix3d back = one.turn.transpose();
    const Vector arm = other.position - one.position, velocity = other.velocity - one.velocity,
                 spin = other.spin - one.spin, turning = one.spin.cross(arm);
    const double reach = blocks.otherBlock.radius;
    const double allowed = 0.1 * dt * (velocity.norm() + turning.norm() + reach * spin.norm()) +
                           1e-12 * (one.position.norm() + arm.norm() + reach);
    const Vector shift = blocks.pose.place - last.place - dt * (back * (velocity - turning));
    const Eigen::Matrix3d turned = blocks.pose.turn * last.turn.transpose();
    const Vector turn(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0), turned(1, 0) - turned(0, 1));
    return shift.norm() + reach * (0.5 * turn - dt * (back * spin)).norm() <= allowed;
}

// The wrench of damping [N, N m] and the power that it takes [W].
Wrench damp(const ContactProperties& law, const NearBlocks& blocks, const Overlap& overlap, double& power) {
    power = 0;
    if (!(law.dampingRatio > 0)) return Wrench();
    const auto& one = blocks.one;
    const double mass = massAlong(blocks, one.position + one.turn * overlap.centre, one.turn * overlap.normal);
    const double coefficient = 2 * law.dampingRatio * std::sqrt(law.normalStiffness * mass / overlap.area);
    const auto step = dampContact(overlap, motionOf(blocks), coefficient, law.normalStiffness * overlap.force.norm());
    power = step.power;
    return wrenchOf(blocks, step.force * overlap.normal, step.moment);
}

} // namespace

RelativePose relativePose(const Eigen::Matrix3d& turn, const Vector& position, const Eigen::Matrix3d& otherTurn,
                          const Vector& otherPosition) {
    const Eigen::Matrix3d back = turn.transpose();
    return {back * otherTurn, back * (otherPosition - position)};
}

double energyBesidePotential(const PairMemory& memory) {
    return elasticEnergyOf(memory.friction) + memory.elastic.excess;
}

// A force works over a step with its mean over both ends, as all forces of a scene do (engine/bodies/BodyStep): what
// the forces of the last step did in the half step since then is counted first.
void actOnPair(const ContactProperties& law, const NearBlocks& blocks, double dt, const Overlap& overlap,
               OverlapFinder& finder, PairMemory& memory, ContactEffect& effect) {
    effect.acts = effect.touches;
    effect.damped = effect.lost = 0;
    auto& account = memory.elastic;
    account.excess = 0;
    if (memory.touched()) {
        effect.damped -= 0.5 * dt * powerOf(blocks, memory.dashpot);
        countLastPush(blocks, dt, account);
        if (!cameByThemselves(blocks, dt, memory.friction)) account.push = Wrench();
    }
    const auto potential =
        effect.touches ? wrenchOf(blocks, law.normalStiffness * overlap.force, law.normalStiffness * overlap.moment)
                       : Wrench();
    if (!(effect.touches && overlap.area > 0)) {
        effect.wrench = potential;
        if (!effect.touches && memory.touched())
            effect.acts = endOn(blocks, memory.friction.normal, dt, account, effect.wrench);
        effect.lost += endFriction(memory.friction);
        const double excess = account.excess;
        memory = PairMemory{};
        account.excess = excess;
        return;
    }
    double power;
    const auto dashpot = damp(law, blocks, overlap, power);
    memory.dashpot = dashpot;
    effect.damped += 0.5 * dt * power;
    const double tangential = law.tangentialRatio * law.normalStiffness * overlap.area;
    const ContactChange change{!memory.touched(), 1 - memory.friction.stiffness / tangential};
    effect.wrench =
        keepEnergy(blocks, law.normalStiffness, dt, change, potential, dashpot, finder, account).add(1, dashpot);
    const double normalForce = std::max(0.0, effect.wrench.force.dot(blocks.one.turn * overlap.normal));
    const auto step = advanceFriction(memory.friction, overlap, blocks.pose, normalForce, tangential, law.friction);
    effect.lost += step.lost;
    effect.wrench.add(1, wrenchOf(blocks, step.force, overlap.centre.cross(step.force) + step.moment * overlap.normal));
}

} // namespace masonry
