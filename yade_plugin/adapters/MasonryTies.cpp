// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryTies.hpp"
#include "scene/EngineTurn.hpp"

template class masonry::Adapter<masonry::MasonryTies, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryTies)

namespace masonry {

void MasonryTies::action() {
    const EngineTurn turn(*scene, *this);
    act(turn.store());
    turn.end();
}

} // namespace masonry
