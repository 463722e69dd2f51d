// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryLoad.hpp"
#include "engine/bodies/Integrator.hpp"
#include "engine/units/Zones.hpp"
#include "engine/watch/EngineScope.hpp"

template class masonry::Adapter<masonry::MasonryLoad, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryLoad)

namespace masonry {

void MasonryLoad::action() {
    const EngineScope scope(*scene, *this);
    eachBody([&](int id) {
        if (scope->zones && scope->zones->unitOf(id))
            throw std::invalid_argument("MasonryLoad.body " + std::to_string(id) +
                                        " is a deformable unit; load a rigid block joined to it");
    });
    act(*scene, scope->gravity(), [&](int id) { return scope->inertiaFactor(id); });
    scope.end();
}

Vector3r MasonryLoad::displacement() const {
    const BetweenSteps still;
    return displacementIn(*Singleton<yade::Omega>::instance().getScene());
}

} // namespace masonry
