// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactEnds.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

double shareThatTakes(const AddedForce& force, double energy) {
    if (energy == 0 || !(force.response > 0)) return 0;
    // With the share x the force gives x slope + x² response / 2.
    const double slope = force.work + 0.5 * force.others;
    const double under = slope * slope - 2 * force.response * energy;
    const double share =
        under > 0 ? -2 * energy / (slope + std::copysign(std::sqrt(under), slope)) : -slope / force.response;
    return std::clamp(share, -1.0, 1.0);
}

} // namespace masonry
