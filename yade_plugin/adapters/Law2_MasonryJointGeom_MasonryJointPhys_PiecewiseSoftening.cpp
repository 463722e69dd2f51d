#include "Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening.hpp"

template class masonry::Adapter<masonry::Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening, yade::LawFunctor>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening)

namespace masonry {

bool Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening::go(shared_ptr<yade::IGeom>& ig,
                                                                   shared_ptr<yade::IPhys>& ip,
                                                                   yade::Interaction* interaction) {
    auto& geom = static_cast<MasonryJointGeom&>(*ig);
    auto& phys = static_cast<MasonryJointPhys&>(*ip);
    // Not connect()'s. The loop is parallel, where an exception would end the program: MasonryEnergy tells of it.
    if (!geom.made() || !geom.step || geom.points() != phys.points()) return true;
    auto& step = *geom.step;
    const auto& r = geom.reference();
    const bool hung = r.hung != nullptr;
    Vector3r force = Vector3r::Zero(), torque = Vector3r::Zero(), moment = Vector3r::Zero();
    for (int p = 0; p < phys.points(); ++p) {
        const auto& by = step.increments[p];
        phys.home->columns.advanceOne(p, phys.index, {by[0], {by[1], by[2]}});
        const auto s = phys.state(p);
        // Stress meets area, and an open joint pulls body 1 on.
        const Vector3r pull = Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b) * geom.area(p);
        force += pull;
        torque += step.arms[p].cross(pull);
        if (hung) { // MasonryZones takes it to the nodes
            step.forces[p] = step.axes * pull;
            moment += geom.jump(p).cross(pull);
        }
    }
    force = step.axes * force;
    torque = step.axes * torque;
    // The jump between nodes is seen in axes that turn with the mean rotation of the two blocks: so the joint works on
    // that rotation too, half on each block's. It makes the joint's forces a couple without moment, however far it
    // slid.
    step.moment = 0.5 * (step.axes * moment);
    auto& forces = scene->forces();
    if (r.rigid(0)) {
        forces.addForce(interaction->id1, force);
        forces.addTorque(interaction->id1, torque + step.moment);
    }
    if (r.rigid(1)) {
        forces.addForce(interaction->id2, -force);
        // the arms of body 2 are shorter by `between`; those of a deformable joint are the rigid side's own
        const Vector3r onBody2 = hung ? Vector3r(step.moment - torque) : Vector3r(step.between.cross(force) - torque);
        forces.addTorque(interaction->id2, onBody2);
    }
    return true;
}

} // namespace masonry
