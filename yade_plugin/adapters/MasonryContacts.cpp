// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryContacts.hpp"
#include "scene/EngineTurn.hpp"

template class masonry::Adapter<masonry::MasonryContacts, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryContacts)

namespace masonry {

void MasonryContacts::action() {
    const EngineTurn turn(*scene, *this);
    act(turn.store());
    handOver_.act(turn.store(), *this);
    turn.end();
}

int MasonryContacts::countTouching() {
    const BetweenSteps still;
    return touching();
}

Vector3r MasonryContacts::forceBetween(int id1, int id2) {
    const BetweenSteps still;
    return forceOf(id1, id2);
}

} // namespace masonry
