// SPDX-License-Identifier: GPL-2.0-or-later
#include "RigidMotion.hpp"
#include "Damping.hpp"
#include "common/PlainVector.hpp"
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace masonry {

void RigidColumns::resize(int count) {
    for (auto& column : position)
        column.resize(count, 0);
    for (auto& column : orientation)
        column.resize(count, 0);
    for (auto& column : velocity)
        column.resize(count, 0);
    for (auto& column : inertia)
        column.resize(count, 1);
    mass.resize(count, 1);
}

// Half of a step's work is done with the velocity before it and half with the one after.
MASONRY_VECTORISED
void RigidMotion::push(int n, const Axis& axis, const Around& around, double gravity) {
    const double *inert = axis.inert, *moves = axis.free, *pushed = axis.force;
    double *velocity = axis.velocity, *last = axis.last;
    const double* steady = steady_;
    const double dt = around.dt, half = 0.5 * dt, rate = 1 / dt;
    const double share = dampingShare(around.combined), calms = around.combined ? 1 : 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const double before = velocity[i], mass = inert[i], undamped = pushed[i] / mass + gravity, seen = last[i];
        const double middle = rate * before + 0.5 * undamped, change = undamped - seen;
        const double trend = calms * ((change > 0 ? 1.0 : 0.0) - (change < 0 ? 1.0 : 0.0));
        const double taken = dampingTaken(middle, share * alpha[i] * std::abs(undamped), trend);
        const bool isFree = moves[i] != 0;
        const double lost = taken + steady[i] * (before + half * (undamped - taken));
        const double end = before + dt * (undamped - lost), after = isFree ? end : before;
        const double drag = half * mass * lost, held = half * before * (pushed[i] + mass * gravity);
        const double energy = 0.5 * mass * before * after;
        kinetic[i] += isFree ? energy : 0;
        damped[0][i] += isFree ? drag * before : 0;
        damped[1][i] += isFree ? drag * after : 0;
        work[i] -= isFree ? 0 : held;
        last[i] = isFree ? undamped : seen;
        velocity[i] = after;
    }
}

MASONRY_VECTORISED
void RigidMotion::move(int n, double dt, const double* __restrict velocity, double* __restrict position) {
    for (int i = 0; i < n; ++i)
        position[i] += dt * velocity[i];
}

// Turns the orientations by the rotation vector dt times spin, but for bodies that turn in space. For half angles up to
// a thousandth the series are exact to the last digit. Faster bodies, which are rare, take the functions of the
// library.
MASONRY_VECTORISED
void RigidMotion::turn(int n, double dt, const double* const* spin, double* const* orientation) const {
    const double *wx = spin[0], *wy = spin[1], *wz = spin[2];
    double *q0 = orientation[0], *q1 = orientation[1], *q2 = orientation[2], *q3 = orientation[3];
    double cosine[most];    // cosine of half the angle
    double sinc[most];      // sine of half the angle over half the angle
    double angle2[most];    // square of half the angle
    std::int64_t quick = 0; // number of bodies that turn too fast for the series
    for (int i = 0; i < n; ++i) {
        const double h2 = (1 - inSpace[i]) * 0.25 * dt * dt * (wx[i] * wx[i] + wy[i] * wy[i] + wz[i] * wz[i]);
        cosine[i] = 1 - h2 * (0.5 - h2 / 24);
        sinc[i] = 1 - h2 * (1 / 6.0 - h2 / 120);
        angle2[i] = h2;
        quick += h2 > 1e-6 ? 1 : 0;
    }
    for (int i = 0; quick && i < n; ++i)
        if (angle2[i] > 1e-6) {
            const double h = std::sqrt(angle2[i]);
            cosine[i] = std::cos(h);
            sinc[i] = std::sin(h) / h;
        }
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const PlainQuaternion old{q0[i], {q1[i], q2[i], q3[i]}};
        const PlainQuaternion now =
            PlainQuaternion{cosine[i], 0.5 * dt * sinc[i] * PlainVector{wx[i], wy[i], wz[i]}} * old;
        const double size = 1 / std::sqrt(dot(now, now));
        const bool turns = angle2[i] > 0;
        q0[i] = turns ? now.w * size : old.w;
        q1[i] = turns ? now.v.x * size : old.v.x;
        q2[i] = turns ? now.v.y * size : old.v.y;
        q3[i] = turns ? now.v.z * size : old.v.z;
    }
}

// ---- bodies that turn in space ---------------------------------------------------------------------------------

namespace {

// An orientation after a time [s], if it changes as fast as the orientation `by` does with a spin [1/s] about its own
// axes.
MASONRY_INLINED PlainQuaternion after(const PlainQuaternion& old, double time, const PlainQuaternion& by,
                                      const PlainVector& spin) {
    const double half = 0.5 * time;
    return {old.w - half * dot(by.v, spin), old.v + half * (by.w * spin + cross(by.v, spin))};
}

} // namespace

// Damping acts on the components of the torque about the global axes. The torque that stops a rotation depends on the
// body's own axes; the smallest inertia gives a torque that never reverses it.
MASONRY_VECTORISED
void RigidMotion::pushInSpace(int n, const InSpace& given, const Around& around) {
    const InSpace c = given;
    const double dt = around.dt, half = 0.5 * dt, rate = 1 / dt;
    const double share = dampingShare(around.combined), calms = around.combined ? 1 : 0;
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const bool mine = inSpace[i] != 0;
        const PlainQuaternion own = quaternionAt(c.orientation, i);
        const double reach = share * alpha[i], steady = steady_[i];
        const PlainVector inertia = vectorAt(c.inertia, i);
        const PlainVector on = vectorAt(torque, i);
        const PlainVector before = vectorAt(c.spin, i);
        const double smaller = inertia.y < inertia.x ? inertia.y : inertia.x;
        const double least = inertia.z < smaller ? inertia.z : smaller;
        const PlainVector undamped = own.turn(own.turnBack(on) / inertia); // angular acceleration
        const auto take = [&](double inert, double on, double before, double gained, double momentum, double& last)
            __attribute__((always_inline)) {
            const double free = on / inert, change = free - last;
            const double middle = least / inert * (rate * before + 0.5 * gained);
            const double trend = calms * ((change > 0 ? 1.0 : 0.0) - (change < 0 ? 1.0 : 0.0));
            const double local = inert * dampingTaken(middle, reach * std::abs(free), trend);
            last = mine ? free : last;
            return local + steady * (momentum + half * (on - local));
        };
        const PlainVector taken{take(inertia.x, on.x, before.x, undamped.x, momentum[0][i], c.last[0][i]),
                                take(inertia.y, on.y, before.y, undamped.y, momentum[1][i], c.last[1][i]),
                                take(inertia.z, on.z, before.z, undamped.z, momentum[2][i], c.last[2][i])};
        const PlainVector left = on - taken;
        const PlainVector after = before + dt * own.turn(own.turnBack(left) / inertia);
        put(torque, i, left);
        kinetic[i] += mine ? 0.5 * dot(own.turnBack(before), inertia * own.turnBack(after)) : 0;
        damped[0][i] += mine ? half * dot(taken, before) : 0;
        damped[1][i] += mine ? half * dot(taken, after) : 0;
    }
}

// The leapfrog scheme of the host for aspherical bodies. The angular momentum at the middle of the step before is
// advanced to the present step; the angular velocity that belongs to it, in the body's axes, gives the orientation at
// the middle of the step. With that orientation the momentum at the middle of the step turns the body by a whole step.
MASONRY_VECTORISED
void RigidMotion::turnInSpace(int n, const InSpace& given, double dt) {
    const InSpace c = given;
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i) {
        const bool mine = inSpace[i] != 0;
        const PlainQuaternion old = quaternionAt(c.orientation, i);
        const PlainVector inertia = vectorAt(c.inertia, i);
        const PlainVector on = vectorAt(torque, i);
        const PlainVector before = vectorAt(momentum, i), grown = before + dt * on;
        const PlainQuaternion middle = after(old, 0.5 * dt, old, old.turnBack(before + 0.5 * dt * on) / inertia);
        const PlainVector spin = old.turnBack(grown) / inertia;
        const PlainQuaternion now = after(old, dt, middle, spin);
        const PlainVector turning = now.turn(spin);
        const double size = std::sqrt(now.w * now.w + dot(now.v, now.v));
        put(momentum, i, grown);
        c.orientation[0][i] = mine ? now.w / size : old.w;
        c.orientation[1][i] = mine ? now.v.x / size : old.v.x;
        c.orientation[2][i] = mine ? now.v.y / size : old.v.y;
        c.orientation[3][i] = mine ? now.v.z / size : old.v.z;
        c.spin[0][i] = mine ? turning.x : c.spin[0][i];
        c.spin[1][i] = mine ? turning.y : c.spin[1][i];
        c.spin[2][i] = mine ? turning.z : c.spin[2][i];
    }
}

void RigidMotion::advance(RigidColumns& bodies, double* const* last, int first, int n, const Around& around,
                          unsigned axes) {
    for (auto* sum : {kinetic, work, damped[0], damped[1]})
        std::fill(sum, sum + n, 0.0);
    for (int i = 0; i < n; ++i)
        steady_[i] = meanOverStep(viscous[i], around.dt);
    for (int d = 0; d < 6; ++d) {
        if (!(axes >> d & 1)) continue;
        const auto& inert = d < 3 ? bodies.mass : bodies.inertia[d - 3];
        push(n, {&inert[first], free[d], force[d], &bodies.velocity[d][first], last[d]}, around,
             d < 3 ? around.gravity[d] : 0);
        if (d < 3) move(n, around.dt, &bodies.velocity[d][first], &bodies.position[d][first]);
    }
    InSpace rotation;
    for (int d = 0; d < 3; ++d) {
        rotation.inertia[d] = &bodies.inertia[d][first];
        rotation.spin[d] = &bodies.velocity[3 + d][first];
        rotation.last[d] = last[3 + d];
    }
    for (int d = 0; d < 4; ++d)
        rotation.orientation[d] = &bodies.orientation[d][first];
    if (axes >> 3) turn(n, around.dt, rotation.spin, rotation.orientation);
    if (std::all_of(inSpace, inSpace + n, [](double turns) { return turns == 0; })) return;
    pushInSpace(n, rotation, around);
    turnInSpace(n, rotation, around.dt);
}

} // namespace masonry
