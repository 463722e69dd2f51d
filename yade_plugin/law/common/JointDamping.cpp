// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointDamping.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

namespace {

// The largest share, at most 1, of (va, vb) that can be added to (a, b) without exceeding `bound`, which (a, b) does
// not exceed.
double shareWithin(double bound, double a, double b, double va, double vb) {
    const double square = va * va + vb * vb, mixed = a * va + b * vb, available = bound * bound - (a * a + b * b);
    if (!(square + 2 * mixed > available)) return 1;
    return std::max(0.0, (std::sqrt(mixed * mixed + square * std::max(available, 0.0)) - mixed) / square);
}

} // namespace

double addJointDamping(int n, const JointDamping& by, const Regime* regime, const double* tensionDamage,
                       const double* area, const double* const* change, double* normal, double* shearA, double* shearB,
                       double* const* viscous) {
    double taken = 0;
    for (int i = 0; i < n; ++i) {
        double now[3] = {by.normal * change[0][i], by.shear * change[1][i], by.shear * change[2][i]};
        const bool intact = by.elastic || (by.bonded && tensionDamage[i] == 0);
        if (regime[i] != Regime::Elastic || !(intact || normal[i] < 0))
            now[0] = now[1] = now[2] = 0;
        else if (!intact) {
            now[0] = std::min(now[0], -normal[i]);
            const double law = std::hypot(shearA[i], shearB[i]);
            const double bound = std::max(law, -by.friction * (normal[i] + now[0]));
            const double share = shareWithin(bound, shearA[i], shearB[i], now[1], now[2]);
            now[1] *= share;
            now[2] *= share;
        }
        normal[i] += now[0];
        shearA[i] += now[1];
        shearB[i] += now[2];
        double work = 0;
        for (int d = 0; d < 3; ++d) {
            work += 0.5 * (now[d] + viscous[d][i]) * change[d][i];
            viscous[d][i] = now[d];
        }
        taken += area[i] * work;
    }
    return taken;
}

} // namespace masonry
