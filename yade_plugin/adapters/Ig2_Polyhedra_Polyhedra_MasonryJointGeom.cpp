#include "Ig2_Polyhedra_Polyhedra_MasonryJointGeom.hpp"
#include "Neighbours.hpp"
#include "SceneStore.hpp"

template class masonry::Adapter<masonry::Ig2_Polyhedra_Polyhedra_MasonryJointGeom, yade::IGeomFunctor>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Ig2_Polyhedra_Polyhedra_MasonryJointGeom)

namespace masonry {

// The host calls this before the interaction loop of every step. It brings the store up to date, so that all joints are
// in their common homes and have the present properties.
void Ig2_Polyhedra_Polyhedra_MasonryJointGeom::preStep() {
    if (scene) const EngineTurn turn(*scene);
}

bool Ig2_Polyhedra_Polyhedra_MasonryJointGeom::go(const shared_ptr<yade::Shape>& shape1,
                                                  const shared_ptr<yade::Shape>& shape2, const yade::State& state1,
                                                  const yade::State& state2, const Vector3r&, const bool& force,
                                                  const shared_ptr<yade::Interaction>& interaction) {
    if (!interaction->geom) {
        const auto face =
            coincidentFaces(blockOf(static_cast<yade::Polyhedra&>(*shape1), state1.pos, state1.ori),
                            blockOf(static_cast<yade::Polyhedra&>(*shape2), state2.pos, state2.ori), tolerance);
        if (!face) {
            if (!force) return false;
            throw std::invalid_argument(
                "bodies " + std::to_string(interaction->id1) + " and " + std::to_string(interaction->id2) +
                " share no face: no joint can be made (tolerance " + text(tolerance) + " of the smaller block's size)");
        }
        const Vector3r across = rowDirection - rowDirection.dot(face->normal) * face->normal;
        const bool chosen = across.norm() > 1e-6 * rowDirection.norm();
        const Vector3r along = chosen ? Vector3r(across.cross(face->normal).normalized()) : longestEdge(face->polygon);
        const shared_ptr<MasonryJointGeom> geom(new MasonryJointGeom);
        geom->define(*face, along, subcontacts, rows, interaction->id1, interaction->id2, state1, state2);
        if (zones) geom->attach(zones);
        interaction->geom = geom;
    }
    auto& geom = static_cast<MasonryJointGeom&>(*interaction->geom);
    if (geom.made()) geom.follow(state1, state2);
    return true;
}

} // namespace masonry
