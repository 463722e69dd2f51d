// SPDX-License-Identifier: GPL-2.0-or-later
#include "BodyStep.hpp"
#include <cmath>

namespace masonry {

using yade::Matrix3r;
using yade::State;
using yade::Vector3r;

namespace {

int sign(double x) { return (x > 0) - (x < 0); }

} // namespace

Matrix3r inverseInertia(const State& s) {
    Vector3r inverse = s.inertia.cwiseInverse();
    if (!rotationRestrained(s)) {
        const Matrix3r axes = s.ori.toRotationMatrix();
        return axes * inverse.asDiagonal() * axes.transpose();
    }
    for (int i = 0; i < 3; ++i)
        if (isBlocked(s, 3 + i)) inverse[i] = 0;
    return inverse.asDiagonal();
}

Vector3r inverseMass(const State& s) {
    Vector3r inverse;
    for (int i = 0; i < 3; ++i)
        inverse[i] = isBlocked(s, i) ? 0 : 1 / s.mass;
    return inverse;
}

BodyStep stepOf(const State& s, const BodyForces& on, const Vector3r& gravity, double dt, double damping) {
    BodyStep step{s.vel, s.angVel, {}};
    auto& e = step.energies;
    const double alpha = s.isDamped ? damping : 0, rate = 1 / dt;
    const auto drag = [&](double free, double middle) { return alpha * std::abs(free) * sign(middle); };
    for (int i = 0; i < 3; ++i) {
        const double all = on.force[i] + s.mass * gravity[i];
        if (isBlocked(s, i)) {
            e.external -= 0.5 * dt * s.vel[i] * all;
            continue;
        }
        const double free = on.force[i] / s.mass + gravity[i];
        const double taken = drag(free, rate * s.vel[i] + 0.5 * free);
        step.vel[i] += dt * (free - taken);
        e.damped += 0.5 * dt * s.mass * taken * s.vel[i];
        e.pendingDamped += 0.5 * dt * s.mass * taken * step.vel[i];
        e.kinetic += 0.5 * s.mass * s.vel[i] * step.vel[i];
    }
    // If a rotation is blocked, the host damps the accelerations about the global axes. If none is, it damps the
    // components of the torque about them.
    const bool restrained = rotationRestrained(s);
    Vector3r taken = Vector3r::Zero();
    for (int i = 0; i < 3; ++i) {
        if (isBlocked(s, 3 + i)) {
            e.external -= 0.5 * dt * s.angVel[i] * on.torque[i];
            continue;
        }
        const double free = on.torque[i] / s.inertia[i];
        taken[i] = s.inertia[i] * drag(free, restrained ? rate * s.angVel[i] + 0.5 * free : s.angVel[i]);
    }
    e.pendingExternal = e.external;
    const Vector3r torque = on.torque - taken;
    if (restrained) {
        for (int i = 0; i < 3; ++i)
            if (!isBlocked(s, 3 + i)) {
                step.angVel[i] += dt * torque[i] / s.inertia[i];
                e.kinetic += 0.5 * s.inertia[i] * s.angVel[i] * step.angVel[i];
            }
    } else {
        const Matrix3r axes = s.ori.toRotationMatrix();
        step.angVel += dt * (inverseInertia(s) * torque);
        e.kinetic += 0.5 * (axes.transpose() * s.angVel).dot(s.inertia.cwiseProduct(axes.transpose() * step.angVel));
    }
    e.damped += 0.5 * dt * taken.dot(s.angVel);
    e.pendingDamped += 0.5 * dt * taken.dot(step.angVel);
    return step;
}

} // namespace masonry
