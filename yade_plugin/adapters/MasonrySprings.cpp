// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonrySprings.hpp"
#include "engine/watch/EngineScope.hpp"

template class masonry::Adapter<masonry::MasonrySprings, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonrySprings)

namespace masonry {

void MasonrySprings::action() {
    const EngineScope scope(*scene, *this);
    act(scope.store());
    scope.end();
}

} // namespace masonry
