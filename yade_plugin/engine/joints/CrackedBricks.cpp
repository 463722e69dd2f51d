// SPDX-License-Identifier: GPL-2.0-or-later
#include "CrackedBricks.hpp"
#include <algorithm>

namespace masonry {

std::vector<int> newlyCracked(const Zones& zones, const std::vector<JointKind>& kinds) {
    std::vector<int> found;
    if (zones.massScaling == 0 && zones.scaledBy == 0) return found;
    for (const auto& kind : kinds) {
        const auto& states = *kind.states->columns;
        if (!kind.attached || !states.law().properties().monolithic) continue;
        const int count = int(kind.shapes->joints.size());
        for (int p = 0; p < kind.shapes->points; ++p) {
            const Regime* regime = states.regime(p, 0);
            for (int j = 0; j < count; ++j) {
                bool yields = regime[j] != Regime::Elastic;
                if (zones.massScaling != zones.scaledBy) {
                    const auto lost = states.dissipated(p, j);
                    yields = yields || lost.tension != 0 || lost.shear != 0 || lost.compression != 0;
                }
                if (!yields) continue;
                const int body = kind.shapes->joints[j].sides[0].body;
                if (zones.isWholeBrick(body) && std::find(found.begin(), found.end(), body) == found.end())
                    found.push_back(body);
            }
        }
    }
    return found;
}

} // namespace masonry
