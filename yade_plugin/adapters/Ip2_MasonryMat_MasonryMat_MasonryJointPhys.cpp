// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ip2_MasonryMat_MasonryMat_MasonryJointPhys.hpp"
#include "MasonryJointGeom.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/joints/Lumping.hpp"

MASONRY_DEFINE(Ip2_MasonryMat_MasonryMat_MasonryJointPhys)

namespace masonry {

namespace {

const MasonryJointGeom& geometryOf(const yade::Interaction& interaction) {
    const auto* geom = dynamic_cast<const MasonryJointGeom*>(interaction.geom.get());
    if (!geom || !geom->made())
        throw std::invalid_argument(
            "interaction " + std::to_string(interaction.id1) + "+" + std::to_string(interaction.id2) +
            " has no MasonryJointGeom: Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom must make it");
    return *geom;
}

} // namespace

void Ip2_MasonryMat_MasonryMat_MasonryJointPhys::assign(const MasonryMat& mat1, const MasonryMat& mat2,
                                                        yade::Interaction& interaction,
                                                        const shared_ptr<MasonryJoint>& joint) const {
    const auto& geom = geometryOf(interaction);
    const auto k = lumpedStiffness(*joint, mat1, mat2, geom.reference());
    const shared_ptr<MasonryJointPhys> phys(new MasonryJointPhys);
    phys->define(joint, k, geom.points());
    interaction.phys = phys;
    const auto& present = *Singleton<yade::Omega>::instance().getScene();
    joint->madeIn(present);
    mat1.usedIn(present);
    mat2.usedIn(present);
}

void Ip2_MasonryMat_MasonryMat_MasonryJointPhys::assignTo(const shared_ptr<yade::Interaction>& interaction,
                                                          const shared_ptr<MasonryJoint>& joint) const {
    const BetweenSteps still;
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
    if (interaction->phys) return; // the joint has been made already
    const auto& mat1 = static_cast<MasonryMat&>(*material1);
    const auto& mat2 = static_cast<MasonryMat&>(*material2);
    const Vector3r normal = geometryOf(*interaction).reference().normal;
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

} // namespace masonry
