// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/bodies/BodyStep.hpp"
#include "engine/joints/Neighbours.hpp"
#include "engine/watch/EngineScope.hpp"

MASONRY_DEFINE(Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom)

namespace masonry {

using yade::State;

// The host calls this before the interaction loop of every step. It brings the store up to date, so that all joints are
// in their common groups and have the present properties.
void Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom::preStep() {
    if (scene) const EngineScope scope(*scene);
}

namespace {

// Whether a body can turn about no other of the global axes than this one. The nodes of a deformable unit are held in
// the direction of the axis instead.
bool turnsAboutOnly(int axis, int body, const State& state, MasonryZones* zones) {
    if (zones && zones->unitOf(body)) return zones->holds(axis);
    for (int other = 0; other < 3; ++other)
        if (other != axis && !isBlocked(state, 3 + other)) return false;
    return true;
}

} // namespace

// One row in the middle is exact where the jump is the same all across the joint. It is where no block turns about the
// normal or about the direction along the joint.
Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom::Grid
Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom::gridOf(const FaceContact& face, const yade::Interaction& interaction,
                                                       const State& state1, const State& state2) const {
    const auto inPlane = [&](const Vector3r& v) { return Vector3r(v - v.dot(face.normal) * face.normal); };
    const Vector3r wanted = inPlane(rowDirection);
    const bool chosen = wanted.norm() > 1e-6 * rowDirection.norm();
    const auto across = [&](const Vector3r& direction) { return Vector3r(direction.cross(face.normal).normalized()); };
    if (rows == 0)
        for (int axis : {1, 0, 2}) { // y first: walls stand in planes y = constant
            const Vector3r unit = Vector3r::Unit(axis);
            const bool inJoint = std::abs(unit.dot(face.normal)) < 1e-6;
            const bool asWanted = !chosen || wanted.cross(unit).norm() < 1e-6 * wanted.norm();
            if (inJoint && asWanted && turnsAboutOnly(axis, interaction.id1, state1, zones.get()) &&
                turnsAboutOnly(axis, interaction.id2, state2, zones.get()))
                return {across(unit), 1};
        }
    return {chosen ? across(wanted) : longestEdge(face.polygon), rows == 0 ? 3 : rows};
}

bool Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom::go(const shared_ptr<yade::Shape>& shape1,
                                                        const shared_ptr<yade::Shape>& shape2,
                                                        const yade::State& state1, const yade::State& state2,
                                                        const Vector3r&, const bool& force,
                                                        const shared_ptr<yade::Interaction>& interaction) {
    const bool fresh = !interaction->geom;
    if (fresh) {
        auto& faces = SceneStore::of(*scene).kept<SharedFaces>(); // that connect() has found
        auto face = faces.take(interaction->id1, interaction->id2, tolerance);
        if (!face)
            face = coincidentFaces(blockOf(*shape1, state1.pos, state1.ori), blockOf(*shape2, state2.pos, state2.ori),
                                   tolerance);
        if (!face) {
            if (!force) return false;
            throw std::invalid_argument(
                "bodies " + std::to_string(interaction->id1) + " and " + std::to_string(interaction->id2) +
                " share no face: no joint can be made (tolerance " + text(tolerance) + " of the smaller block's size)");
        }
        const auto grid = gridOf(*face, *interaction, state1, state2);
        const shared_ptr<MasonryJointGeom> geom(new MasonryJointGeom);
        geom->define(*face, grid.along, subcontacts, grid.rows, interaction->id1, interaction->id2, state1, state2);
        for (auto& side : geom->group->joints[0].sides)
            side.shearShare = faces.shearShareOf(side.body);
        if (zones) geom->attach(zones);
        interaction->geom = geom;
        fixed_.fix(*scene, {double(subcontacts), double(rows)});
    }
    auto& geom = static_cast<MasonryJointGeom&>(*interaction->geom);
    if (geom.made()) geom.follow(state1, state2);
    if (fresh && force) geom.step.reset(); // connect() makes joints outside a step, and this scratch takes memory
    return true;
}

} // namespace masonry
