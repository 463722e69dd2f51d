// SPDX-License-Identifier: GPL-2.0-or-later
#include "RigidMotion.hpp"
#include "Damping.hpp"
#include "common/Vectorised.hpp"
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

// Turns the orientations by the rotation vector dt times spin. For half angles up to a thousandth the series are exact
// to the last digit. Faster bodies, which are rare, take the functions of the library.
MASONRY_VECTORISED
void RigidMotion::turn(int n, double dt, const double* const* spin, double* const* orientation) {
    const double *wx = spin[0], *wy = spin[1], *wz = spin[2];
    double *q0 = orientation[0], *q1 = orientation[1], *q2 = orientation[2], *q3 = orientation[3];
    double cosine[most];    // cosine of half the angle
    double sinc[most];      // sine of half the angle over half the angle
    double angle2[most];    // square of half the angle
    std::int64_t quick = 0; // number of bodies that turn too fast for the series
    for (int i = 0; i < n; ++i) {
        const double h2 = 0.25 * dt * dt * (wx[i] * wx[i] + wy[i] * wy[i] + wz[i] * wz[i]);
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
        const double by = 0.5 * dt * sinc[i], w = cosine[i], x = by * wx[i], y = by * wy[i], z = by * wz[i];
        const double a = q0[i], b = q1[i], c = q2[i], d = q3[i];
        const double w1 = w * a - x * b - y * c - z * d, x1 = w * b + x * a + y * d - z * c;
        const double y1 = w * c + y * a + z * b - x * d, z1 = w * d + z * a + x * c - y * b;
        const double size = 1 / std::sqrt(w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1);
        const bool turns = angle2[i] > 0;
        q0[i] = turns ? w1 * size : a;
        q1[i] = turns ? x1 * size : b;
        q2[i] = turns ? y1 * size : c;
        q3[i] = turns ? z1 * size : d;
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
    if (!(axes >> 3)) return;
    const double* const spin[3] = {&bodies.velocity[3][first], &bodies.velocity[4][first], &bodies.velocity[5][first]};
    double* const orientation[4] = {&bodies.orientation[0][first], &bodies.orientation[1][first],
                                    &bodies.orientation[2][first], &bodies.orientation[3][first]};
    turn(n, around.dt, spin, orientation);
}

} // namespace masonry
