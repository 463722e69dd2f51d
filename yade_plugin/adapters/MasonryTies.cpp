// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryTies.hpp"
#include "engine/watch/EngineScope.hpp"

template class masonry::Adapter<masonry::MasonryTies, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryTies)

namespace masonry {

void MasonryTies::action() {
    const EngineScope scope(*scene, *this);
    act(scope.store());
    scope.end();
}

double MasonryTies::forceOf(int tie) {
    const BetweenSteps still;
    if (tie < 0 || tie >= count())
        throw std::invalid_argument("MasonryTies.forceOf: tie " + std::to_string(tie) + " must be from 0 to " +
                                    std::to_string(count() - 1));
    return std::size_t(tie) < forces.size() ? forces[std::size_t(tie)] : 0;
}

} // namespace masonry
