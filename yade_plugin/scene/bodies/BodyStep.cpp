// SPDX-License-Identifier: GPL-2.0-or-later
#include "BodyStep.hpp"
#include "motion/Damping.hpp"
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

BodyStep stepOf(const State& s, const BodyForces& on, const Vector3r& gravity, double dt, const BodyDamping& damping) {
    BodyStep step{s.vel, s.angVel, on.torque, {}};
    auto& e = step.energies;
    const double alpha = s.isDamped ? damping.alpha : 0, rate = 1 / dt;
    const double steady = meanOverStep(s.isDamped ? damping.viscous : 0, dt);
    const bool combined = damping.last != nullptr;
    const double share = dampingShare(combined);
    // What damping takes of an acceleration whose undamped value is `free`. `middle` is the velocity in the middle of
    // the step divided by the time step; `before` is the undamped value of the step before, which is replaced, or null.
    const auto drag = [&](double free, double middle, double* before) {
        const double reach = alpha * std::abs(free);
        if (damping.host) return reach * sign(middle);
        const int trend = before ? sign(free - *before) : 0;
        if (before) *before = free;
        return dampingTaken(middle, share * reach, double(trend));
    };
    for (int i = 0; i < 3; ++i) {
        const double all = on.force[i] + s.mass * gravity[i];
        if (isBlocked(s, i)) {
            e.external -= 0.5 * dt * s.vel[i] * all;
            continue;
        }
        const double free = on.force[i] / s.mass + gravity[i];
        double taken = drag(free, rate * s.vel[i] + 0.5 * free, combined ? &damping.last->force[i] : nullptr);
        taken += steady * (s.vel[i] + 0.5 * dt * (free - taken));
        step.vel[i] += dt * (free - taken);
        e.damped += 0.5 * dt * s.mass * taken * s.vel[i];
        e.pendingDamped += 0.5 * dt * s.mass * taken * step.vel[i];
        e.kinetic += 0.5 * s.mass * s.vel[i] * step.vel[i];
    }
    // If a rotation is blocked, the integrator damps the accelerations about the global axes. If none is, it damps the
    // components of the torque about the global axes. The torque that stops a rotation depends on the body's own axes;
    // the smallest inertia gives a torque that never reverses it.
    const bool restrained = rotationRestrained(s);
    const Matrix3r inverse = restrained ? Matrix3r::Zero() : inverseInertia(s);
    const bool damped = !restrained && !damping.host && alpha > 0;
    const Vector3r gained = damped ? Vector3r(inverse * on.torque) : Vector3r::Zero();
    const double least = s.inertia.minCoeff();
    Vector3r taken = Vector3r::Zero();
    for (int i = 0; i < 3; ++i) {
        if (isBlocked(s, 3 + i)) {
            e.external -= 0.5 * dt * s.angVel[i] * on.torque[i];
            continue;
        }
        const double free = on.torque[i] / s.inertia[i];
        const double middle = restrained ? rate * s.angVel[i] + 0.5 * free
                                         : least / s.inertia[i] * (rate * s.angVel[i] + 0.5 * gained[i]);
        taken[i] = s.inertia[i] * drag(free, middle, combined ? &damping.last->torque[i] : nullptr);
        const double momentum = restrained ? s.inertia[i] * s.angVel[i] : s.angMom[i];
        taken[i] += steady * (momentum + 0.5 * dt * (on.torque[i] - taken[i]));
    }
    step.torque -= taken;
    e.pendingExternal = e.external;
    if (restrained) {
        for (int i = 0; i < 3; ++i)
            if (!isBlocked(s, 3 + i)) {
                step.angVel[i] += dt * step.torque[i] / s.inertia[i];
                e.kinetic += 0.5 * s.inertia[i] * s.angVel[i] * step.angVel[i];
            }
    } else {
        const Matrix3r axes = s.ori.toRotationMatrix();
        step.angVel += dt * (inverse * step.torque);
        e.kinetic += 0.5 * (axes.transpose() * s.angVel).dot(s.inertia.cwiseProduct(axes.transpose() * step.angVel));
    }
    e.damped += 0.5 * dt * taken.dot(s.angVel);
    e.pendingDamped += 0.5 * dt * taken.dot(step.angVel);
    return step;
}

} // namespace masonry
