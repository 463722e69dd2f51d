// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryIntegrator.hpp"
#include "engine/watch/EngineScope.hpp"

template class masonry::Adapter<masonry::MasonryIntegrator, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryIntegrator)

namespace masonry {

void MasonryIntegrator::action() {
    const EngineScope scope(*scene, *this);
    advance(*scene, scope->bodies, scope->loads, scope->foreignForces);
    scope.end();
}

} // namespace masonry
