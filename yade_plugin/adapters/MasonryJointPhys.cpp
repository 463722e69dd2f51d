#include "MasonryJointPhys.hpp"
#include "MasonryJointGeom.hpp"
#include "SceneCheck.hpp"

BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryMat)
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJoint)
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointPhys)
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Ip2_MasonryMat_MasonryMat_MasonryJointPhys)
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening)

namespace masonry {

namespace {

const MasonryJointGeom& geometryOf(const yade::Interaction& interaction) {
    const auto* geom = dynamic_cast<const MasonryJointGeom*>(interaction.geom.get());
    if (!geom)
        throw std::invalid_argument("interaction " + std::to_string(interaction.id1) + "+" +
                                    std::to_string(interaction.id2) +
                                    " has no MasonryJointGeom: Ig2_Polyhedra_Polyhedra_MasonryJointGeom must make it");
    return *geom;
}

} // namespace

void Ip2_MasonryMat_MasonryMat_MasonryJointPhys::assign(const MasonryMat& mat1, const MasonryMat& mat2,
                                                        yade::Interaction& interaction,
                                                        const shared_ptr<MasonryJoint>& joint) const {
    const auto& geom = geometryOf(interaction);
    // a deformable side shows its elasticity itself
    const double d1 = geom.attachments1.empty() ? geom.distance1 : 0,
                 d2 = geom.attachments2.empty() ? geom.distance2 : 0;
    const auto k = inSeriesWithUnits(*joint, d1 / mat1.young + d2 / mat2.young,
                                     d1 / mat1.shearModulus() + d2 / mat2.shearModulus());
    const shared_ptr<MasonryJointPhys> phys(new MasonryJointPhys);
    phys->joint = joint;
    phys->normalStiffness = k.normal, phys->shearStiffness = k.shear;
    phys->states.resize(geom.points.size());
    phys->losses.assign(geom.points.size(), Vector3r::Zero());
    interaction.phys = phys;
}

void Ip2_MasonryMat_MasonryMat_MasonryJointPhys::assignTo(const shared_ptr<yade::Interaction>& interaction,
                                                          const shared_ptr<MasonryJoint>& joint) const {
    if (!interaction || !joint) throw std::invalid_argument("assign needs an interaction and a MasonryJoint, got None");
    const auto& scene = *Singleton<yade::Omega>::instance().getScene();
    const auto unit = [&](int id) -> const MasonryMat& {
        const auto* mat = dynamic_cast<const MasonryMat*>(bodyAt(scene, id, "body").material.get());
        if (!mat) throw std::invalid_argument("body " + std::to_string(id) + " has no MasonryMat");
        return *mat;
    };
    assign(unit(interaction->id1), unit(interaction->id2), *interaction, joint);
}

void Ip2_MasonryMat_MasonryMat_MasonryJointPhys::go(const shared_ptr<yade::Material>& material1,
                                                    const shared_ptr<yade::Material>& material2,
                                                    const shared_ptr<yade::Interaction>& interaction) {
    if (interaction->phys) return; // joints are made once
    const auto &mat1 = static_cast<MasonryMat&>(*material1), &mat2 = static_cast<MasonryMat&>(*material2);
    const Vector3r normal = geometryOf(*interaction).normal;
    std::string names;
    for (const auto& joint : joints) {
        if (joint && joint->appliesTo(mat1.jointSet, mat2.jointSet, normal))
            return assign(mat1, mat2, *interaction, joint);
        if (joint) names += (names.empty() ? "" : ", ") + joint->name;
    }
    throw std::invalid_argument("no joint fits bodies " + std::to_string(interaction->id1) + " and " +
                                std::to_string(interaction->id2) + ": joint sets \"" + mat1.jointSet + "\" and \"" +
                                mat2.jointSet + "\", normal (" + text(normal[0]) + ", " + text(normal[1]) + ", " +
                                text(normal[2]) + "); offered: " + (names.empty() ? "none" : names));
}

bool Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening::go(shared_ptr<yade::IGeom>& ig,
                                                                   shared_ptr<yade::IPhys>& ip,
                                                                   yade::Interaction* interaction) {
    auto& geom = static_cast<MasonryJointGeom&>(*ig);
    auto& phys = static_cast<MasonryJointPhys&>(*ip);
    // Not connect()'s. The loop is parallel, where an exception would end the program: MasonryEnergy tells of it.
    if (!phys.joint || phys.states.size() != geom.points.size()) return true;
    const JointLaw& law = phys.law();
    const auto k = phys.stiffness();
    Vector3r force = Vector3r::Zero(), torque = Vector3r::Zero(), lost = Vector3r::Zero(), moment = Vector3r::Zero();
    for (std::size_t i = 0; i < phys.states.size(); ++i) {
        auto& s = phys.states[i];
        auto& point = geom.points[i];
        const auto spent = law.advance(k, s, point.increment);
        // The one place where stress meets area, and tension meets the host's forces: an open joint pulls body 1 on.
        const Vector3r pull = Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b) * point.area;
        force += pull;
        if (geom.zones) { // MasonryZones takes it to the nodes
            point.force = geom.axes * pull;
            moment += point.jump.cross(pull);
        }
        torque += point.arm.cross(pull);
        phys.losses[i] += Vector3r(spent.tension, spent.shear, spent.compression);
        lost += point.area * phys.losses[i];
    }
    phys.dissipated = lost;
    force = geom.axes * force, torque = geom.axes * torque;
    // The jump between nodes is seen in axes that turn with the mean rotation of the two blocks: so the joint works on
    // that rotation too, half on each block's. It makes the joint's forces a couple without moment, however far it
    // slid.
    geom.moment = 0.5 * (geom.axes * moment);
    auto& forces = scene->forces();
    if (geom.attachments1.empty()) {
        forces.addForce(interaction->id1, force);
        forces.addTorque(interaction->id1, torque + geom.moment);
    }
    if (geom.attachments2.empty()) {
        forces.addForce(interaction->id2, -force);
        // the arms of body 2 are shorter by `between`; those of a deformable joint are the rigid side's own
        forces.addTorque(interaction->id2,
                         geom.zones ? Vector3r(geom.moment - torque) : geom.between.cross(force) - torque);
    }
    return true;
}

} // namespace masonry
