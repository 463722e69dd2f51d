// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom.hpp"

template class masonry::Adapter<masonry::Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom, yade::IGeomFunctor>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom)

namespace masonry {

// A pair that does not touch yet keeps its geometry, in which stands the plane that separated it last.
bool Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom::go(const shared_ptr<yade::Shape>& shape1,
                                                          const shared_ptr<yade::Shape>& shape2,
                                                          const yade::State& state1, const yade::State& state2,
                                                          const Vector3r&, const bool& force,
                                                          const shared_ptr<yade::Interaction>& interaction) {
    if (!interaction->geom) interaction->geom = shared_ptr<MasonryContactGeom>(new MasonryContactGeom);
    auto* geom = dynamic_cast<MasonryContactGeom*>(interaction->geom.get());
    if (!geom) {
        refuseScene(*scene, "bodies " + std::to_string(interaction->id1) + " and " + std::to_string(interaction->id2) +
                                " have a " + interaction->geom->getClassName() +
                                ", which functors of contacts do not know: take MasonryContacts in their place");
        return false;
    }
    if (!find(*scene, *interaction, shape1, shape2, state1, state2, *geom)) return false;
    return geom->touches || force || interaction->phys;
}

} // namespace masonry
