#include "Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening.hpp"
#include "MasonryJointGeom.hpp"
#include "MasonryJointPhys.hpp"
#include "scene/JointFunctor.hpp"

template class masonry::Adapter<masonry::Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening, yade::LawFunctor>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening)

namespace masonry {

bool Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening::go(shared_ptr<yade::IGeom>& geom,
                                                                   shared_ptr<yade::IPhys>& phys,
                                                                   yade::Interaction* interaction) {
    advanceJoint(*scene, static_cast<MasonryJointGeom&>(*geom), static_cast<MasonryJointPhys&>(*phys), *interaction,
                 false);
    return true;
}

} // namespace masonry
