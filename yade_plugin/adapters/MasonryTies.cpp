// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryTies.hpp"

MASONRY_DEFINE(MasonryTies)

namespace masonry {

void MasonryTies::step(SceneStore& store) { act(store); }

double MasonryTies::forceOf(int tie) {
    const BetweenSteps still;
    if (tie < 0 || tie >= count())
        throw std::invalid_argument("MasonryTies.forceOf: tie " + std::to_string(tie) + " must be from 0 to " +
                                    std::to_string(count() - 1));
    return std::size_t(tie) < forces.size() ? forces[tie] : 0;
}

} // namespace masonry
