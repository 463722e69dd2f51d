// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactFriction.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace masonry {

using Vector = Eigen::Vector3d;

namespace {

// A vector turned as the normal of the contact has turned.
Vector follow(const Vector& v, const Vector& from, const Vector& to) {
    const Vector axis = from.cross(to), first = axis.cross(v);
    return v + first + axis.cross(first) / (1 + from.dot(to));
}

} // namespace

double leverOfFriction(const Overlap& overlap) { return 0.94 * std::sqrt(overlap.meanSquare); }

double elasticEnergyOf(const FrictionState& s) {
    const double square = s.shear.squaredNorm() + s.twist * s.twist;
    return s.stiffness > 0 ? 0.5 * square / s.stiffness : 0;
}

double endFriction(FrictionState& state) {
    const double lost = elasticEnergyOf(state);
    state = FrictionState{};
    return lost;
}

FrictionStep advanceFriction(FrictionState& state, const Overlap& overlap, const RelativePose& pose, double normalForce,
                             double stiffness, double friction) {
    const double lever = leverOfFriction(overlap), limit = friction * normalForce;
    const Vector& normal = overlap.normal;
    FrictionStep step{Vector::Zero(), 0, 0, 0};
    Vector shear = state.shear, slip = Vector::Zero();
    Vector acted = Vector::Zero(); // force of the last step, in the present direction
    double twist = state.twist, spin = 0;
    const double soft = 0.5 / stiffness; // [m/N] energy over the square of a force
    if (state.stiffness > 0) {
        const Vector& last = state.normal;
        if (last.dot(normal) < -0.5) { // the contact is another one
            step.lost += endFriction(state);
            shear.setZero();
            twist = 0;
        } else {
            // The point of the other block at the centre of pressure was here, in the axes of the one.
            const Eigen::Matrix3d turned = pose.turn * state.turn.transpose();
            const Vector before = state.place + turned.transpose() * (overlap.centre - pose.place);
            slip = overlap.centre - before;
            slip -= slip.dot(normal) * normal;
            const Vector turn(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0), turned(1, 0) - turned(0, 1));
            spin = 0.5 * turn.dot(normal);
            // The frame turns with the normal, and about it as both blocks do on average.
            shear = follow(shear, last, normal);
            const double half = 0.5 * spin;
            shear = (shear + std::tan(half) * normal.cross(shear)).eval();
            shear -= shear.dot(normal) * normal;
            if (const double length = shear.norm(); length > 0) shear *= state.shear.norm() / length;
            acted = shear;
            // Where the area grows, what comes in is without stress, and the force stays. Where it shrinks, what goes
            // takes its force along.
            const double energy = elasticEnergyOf(state), share = std::min(1.0, stiffness / state.stiffness);
            shear *= share;
            twist *= share;
            step.lost += std::max(0.0, energy - soft * (shear.squaredNorm() + twist * twist));
        }
    }
    if (const double size = std::sqrt(shear.squaredNorm() + twist * twist); size > limit) {
        // The normal force has fallen: the elastic slip is cut to the limit.
        step.lost += soft * (size - limit) * (size + limit);
        shear *= limit / size;
        twist *= limit / size;
    }
    // The part that was cut off has still acted in the first half of the step.
    if (state.stiffness > 0) step.lost -= 0.5 * ((acted - shear).dot(slip) + (state.twist - twist) * lever * spin);
    const Vector trial = shear - stiffness * slip;
    const double trialTwist = twist - stiffness * lever * spin;
    const double size = std::sqrt(trial.squaredNorm() + trialTwist * trialTwist);
    if (size > limit) {
        const Vector after = limit / size * trial;
        const double afterTwist = limit / size * trialTwist;
        const Vector plastic = (after - trial) / -stiffness;
        const double plasticTwist = (afterTwist - trialTwist) / -stiffness;
        step.lost += std::max(0.0, 0.5 * ((shear + after).dot(plastic) + (twist + afterTwist) * plasticTwist));
        shear = after;
        twist = afterTwist;
    } else {
        shear = trial;
        twist = trialTwist;
    }
    state = {shear, twist, stiffness, normal, pose.turn, pose.place};
    step.force = shear;
    step.moment = twist * lever;
    step.stored = elasticEnergyOf(state);
    return step;
}

} // namespace masonry
