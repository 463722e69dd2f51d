#include "RigidMotion.hpp"
#include "common/Vectorised.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

// One degree of freedom. Half of a step's work is done with the velocity before it and half with the one after.
MASONRY_VECTORISED
void RigidMotion::push(int n, const Around& around, double gravity, const double* __restrict inert,
                       const double* __restrict alpha, const double* __restrict free, const double* __restrict force,
                       double* __restrict velocity, double* __restrict last, double* __restrict kinetic,
                       double* __restrict work, double* __restrict damped0, double* __restrict damped1) {
    const double half = 0.5 * around.dt, dt = around.dt;
    const double rate = 1 / dt, share = around.combined ? 0.5 : 1, calms = around.combined ? 1 : 0;
    for (int i = 0; i < n; ++i) {
        const double before = velocity[i], mass = inert[i], undamped = force[i] / mass + gravity, seen = last[i];
        // paper eq. (3), or combined; at most what stops the motion in the middle of the step
        const double stop = rate * before + 0.5 * undamped, change = undamped - seen;
        const double along = calms * ((change > 0 ? 1.0 : 0.0) - (change < 0 ? 1.0 : 0.0));
        const double reach = share * alpha[i] * std::abs(undamped);
        const double least = -reach * (1 + along), most = reach * (1 - along);
        const double below = stop < most ? stop : most, taken = below > least ? below : least;
        const bool moves = free[i] != 0;
        const double end = before + dt * (undamped - taken), after = moves ? end : before;
        const double drag = half * mass * taken, held = half * before * (force[i] + mass * gravity);
        const double energy = 0.5 * mass * before * after;
        kinetic[i] += moves ? energy : 0;
        damped0[i] += moves ? drag * before : 0;
        damped1[i] += moves ? drag * after : 0;
        work[i] -= moves ? 0 : held;
        last[i] = moves ? undamped : seen;
        velocity[i] = after;
    }
}

// By the rotation vector. The series are exact to the last digit up to a thousandth; hardly anything turns faster.
MASONRY_VECTORISED
void RigidMotion::turn(int n, double dt, const double* __restrict wx, const double* __restrict wy,
                       const double* __restrict wz, double* __restrict q0, double* __restrict q1, double* __restrict q2,
                       double* __restrict q3) {
    double cosine[most], sinc[most], angle2[most];
    for (int i = 0; i < n; ++i) {
        const double h2 = 0.25 * dt * dt * (wx[i] * wx[i] + wy[i] * wy[i] + wz[i] * wz[i]);
        cosine[i] = 1 - h2 * (0.5 - h2 / 24), sinc[i] = 1 - h2 * (1 / 6.0 - h2 / 120), angle2[i] = h2;
    }
    for (int i = 0; i < n; ++i)
        if (angle2[i] > 1e-6) {
            const double h = std::sqrt(angle2[i]);
            cosine[i] = std::cos(h), sinc[i] = std::sin(h) / h;
        }
    for (int i = 0; i < n; ++i) {
        const double by = 0.5 * dt * sinc[i], w = cosine[i], x = by * wx[i], y = by * wy[i], z = by * wz[i];
        const double a = q0[i], b = q1[i], c = q2[i], d = q3[i];
        const double w1 = w * a - x * b - y * c - z * d, x1 = w * b + x * a + y * d - z * c;
        const double y1 = w * c + y * a + z * b - x * d, z1 = w * d + z * a + x * c - y * b;
        const double size = 1 / std::sqrt(w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1);
        const bool turns = angle2[i] > 0;
        q0[i] = turns ? w1 * size : a, q1[i] = turns ? x1 * size : b;
        q2[i] = turns ? y1 * size : c, q3[i] = turns ? z1 * size : d;
    }
}

void RigidMotion::advance(int n, const Around& around, unsigned axes) {
    for (auto* sum : {kinetic, work, damped[0], damped[1]})
        std::fill(sum, sum + n, 0.0);
    for (int d = 0; d < 6; ++d)
        if (axes >> d & 1)
            push(n, around, d < 3 ? around.gravity[d] : 0, d < 3 ? mass : inertia[d - 3], alpha, free[d], force[d],
                 velocity[d], last[d], kinetic, work, damped[0], damped[1]);
    if (axes >> 3)
        turn(n, around.dt, velocity[3], velocity[4], velocity[5], orientation[0], orientation[1], orientation[2],
             orientation[3]);
}

} // namespace masonry
