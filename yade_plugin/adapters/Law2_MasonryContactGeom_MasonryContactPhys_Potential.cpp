// SPDX-License-Identifier: GPL-2.0-or-later
#include "Law2_MasonryContactGeom_MasonryContactPhys_Potential.hpp"

template class masonry::Adapter<masonry::Law2_MasonryContactGeom_MasonryContactPhys_Potential, yade::LawFunctor>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Law2_MasonryContactGeom_MasonryContactPhys_Potential)

namespace masonry {

bool Law2_MasonryContactGeom_MasonryContactPhys_Potential::go(shared_ptr<yade::IGeom>& geom,
                                                              shared_ptr<yade::IPhys>& phys,
                                                              yade::Interaction* interaction) {
    return act(*scene, *interaction, static_cast<MasonryContactGeom&>(*geom), static_cast<MasonryContactPhys&>(*phys));
}

double Law2_MasonryContactGeom_MasonryContactPhys_Potential::storedInScene() {
    const BetweenSteps still;
    return stored(*Singleton<yade::Omega>::instance().getScene());
}

} // namespace masonry
