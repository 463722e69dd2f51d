// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactPair.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace masonry {

using Vector = Eigen::Vector3d;

namespace {

// The mass with which two blocks meet at a point along a normal [kg]: the inverse of how fast the point of each would
// be after an impulse of 1.
double massAlong(const ContactBody& one, const ContactBody& other, const Vector& point, const Vector& normal) {
    double inverse = 0;
    for (const auto* body : {&one, &other}) {
        const bool spins = body->blocked >> 3 == 0;
        Vector turning = (point - body->position).cross(normal);
        if (spins) turning = (body->turn.transpose() * turning).eval(); // moments of inertia are those of its own axes
        for (int d = 0; d < 3; ++d) {
            if (!(body->blocked >> d & 1)) inverse += normal[d] * normal[d] / body->mass;
            if (spins || !(body->blocked >> (3 + d) & 1)) inverse += turning[d] * turning[d] / body->inertia[d];
        }
    }
    return inverse > 0 ? 1 / inverse : 0;
}

} // namespace

RelativePose relativePose(const Eigen::Matrix3d& turn, const Vector& position, const Eigen::Matrix3d& otherTurn,
                          const Vector& otherPosition) {
    const Eigen::Matrix3d back = turn.transpose();
    return {back * otherTurn, back * (otherPosition - position)};
}

void actOnPair(const ContactProperties& law, const ContactBody& one, const ContactBody& other, const RelativePose& pose,
               const Vector& gap, double dt, Overlap& overlap, FrictionState& state, double (&dashpot)[6],
               ContactEffect& effect) {
    if (!effect.touches) {
        overlap.force.setZero();
        overlap.moment.setZero();
        overlap.area = 0;
    }
    effect.damped = 0;
    if (!(overlap.area > 0)) effect.lost = endFriction(state);
    Vector force = law.normalStiffness * overlap.force, moment = law.normalStiffness * overlap.moment;
    Eigen::Map<Vector> lastForce(dashpot), lastMoment(dashpot + 3);
    RelativeMotion motion{Vector::Zero(), Vector::Zero()};
    if (law.dampingRatio > 0) {
        const Vector arm = other.position - one.position;
        motion.velocity = one.turn.transpose() * (other.velocity - other.spin.cross(arm) - one.velocity);
        motion.spin = one.turn.transpose() * (other.spin - one.spin);
        // A force works over a step with its mean over both ends, as all forces of a scene do (scene/BodyStep).
        effect.damped = -0.5 * dt * (lastForce.dot(motion.velocity) + lastMoment.dot(motion.spin));
    }
    lastForce.setZero();
    lastMoment.setZero();
    if (overlap.area > 0) {
        double normalForce = force.norm();
        if (law.dampingRatio > 0) {
            const double mass =
                massAlong(one, other, one.position + one.turn * overlap.centre, one.turn * overlap.normal);
            const double coefficient = 2 * law.dampingRatio * std::sqrt(law.normalStiffness * mass / overlap.area);
            const auto damped = dampContact(overlap, motion, coefficient, normalForce);
            lastForce = damped.force * overlap.normal;
            lastMoment = damped.moment;
            force += lastForce;
            moment += lastMoment;
            normalForce = std::max(0.0, normalForce + damped.force);
            effect.damped += 0.5 * damped.power * dt;
        }
        const auto step = advanceFriction(state, overlap, pose, normalForce,
                                          law.tangentialRatio * law.normalStiffness * overlap.area, law.friction);
        effect.lost = step.lost;
        force += step.force;
        moment += overlap.centre.cross(step.force) + step.moment * overlap.normal;
    }
    effect.force = one.turn * force;
    effect.torques[0] = one.turn * (gap.cross(force) - moment);
    effect.torques[1] = one.turn * (moment - pose.place.cross(force));
}

} // namespace masonry
