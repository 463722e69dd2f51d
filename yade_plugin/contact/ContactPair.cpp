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

// The coefficient of the dashpot of a contact per area [Pa s/m].
double dampingCoefficient(const ContactProperties& law, const NearBlocks& blocks, const Overlap& overlap) {
    if (!(law.dampingRatio > 0)) return 0;
    const auto& one = blocks.one;
    const double mass = massAlong(blocks, one.position + one.turn * overlap.centre, one.turn * overlap.normal);
    return 2 * law.dampingRatio * std::sqrt(law.normalStiffness * mass / overlap.area);
}

// The wrench of a dashpot [N, N m] at the mean of the velocities before its impulse of a step, which are given, and
// after it. With its power p at those before, and x = dt response / (2 p), the kinetic energy falls by dt p / (1 + x)²
// (contact/README.md).
Wrench damp(const ContactProperties& law, const NearBlocks& blocks, const Overlap& overlap, double coefficient,
            double dt) {
    Wrench dashpot;
    if (!(coefficient > 0)) return dashpot;
    const auto step = dampContact(overlap, motionOf(blocks), coefficient, law.normalStiffness * overlap.force.norm());
    if (!(step.power > 0)) return dashpot;
    const auto full = wrenchOf(blocks, step.force * overlap.normal, step.moment);
    return dashpot.add(1 / (1 + 0.5 * dt * responseOf(blocks, full, full) / step.power), full);
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
void actOnPair(const ContactProperties& law, const NearBlocks& blocks, double dt, OverlapFinder& finder,
               PairMemory& memory, ContactEffect& effect) {
    const auto& overlap = effect.overlap;
    effect.acts = effect.touches;
    effect.damped = effect.lost = effect.dampingCoefficient = 0;
    auto& account = memory.elastic;
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
        account.excess = 0;
        if (!effect.touches && memory.touched())
            effect.acts = endOn(blocks, memory.friction.normal, dt, account, effect.wrench);
        if (memory.touched()) effect.lost -= 0.5 * dt * powerOf(blocks, memory.rubbing);
        effect.lost += endFriction(memory.friction);
        const double excess = account.excess;
        memory = PairMemory{};
        account.excess = excess;
        return;
    }
    // The dashpot is known only when all other forces are (dampPair). Friction takes it at the present velocities, and
    // keepEnergy at those that the elastic force gives, too, as in an impact.
    effect.dampingCoefficient = dampingCoefficient(law, blocks, overlap);
    memory.dashpot = Wrench();
    const auto dashpot = damp(law, blocks, overlap, effect.dampingCoefficient, dt);
    auto one = blocks.one, other = blocks.other;
    push(one, -potential.force, potential.torques[0], 0.5 * dt);
    push(other, potential.force, potential.torques[1], 0.5 * dt);
    const auto struck = damp(law, {blocks.oneBlock, blocks.otherBlock, one, other, blocks.pose, blocks.gap}, overlap,
                             effect.dampingCoefficient, dt);
    const double tangential = law.tangentialRatio * law.normalStiffness * overlap.area;
    const ContactChange change{!memory.touched(), 1 - memory.friction.stiffness / tangential};
    effect.wrench = keepEnergy(blocks, law.normalStiffness, dt, change, potential, struck, finder, account);
    const double normalForce =
        std::max(0.0, (effect.wrench.force + dashpot.force).dot(blocks.one.turn * overlap.normal));
    const auto step = advanceFriction(memory.friction, overlap, blocks.pose, normalForce, tangential, law.friction);
    effect.lost += step.lost;
    memory.rubbing = wrenchOf(blocks, step.force, overlap.centre.cross(step.force) + step.moment * overlap.normal);
    effect.wrench.add(1, memory.rubbing);
}

Wrench dampPair(const ContactProperties& law, const NearBlocks& blocks, const NearBlocks& middle, double dt,
                PairMemory& memory, ContactEffect& effect) {
    const auto dashpot = damp(law, middle, effect.overlap, effect.dampingCoefficient, dt);
    memory.dashpot = dashpot;
    effect.damped -= 0.5 * dt * powerOf(blocks, dashpot);
    effect.wrench.add(1, dashpot);
    return dashpot;
}

} // namespace masonry
