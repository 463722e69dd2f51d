// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointFunctor.hpp"
#include "engine/units/Zones.hpp"

namespace masonry {

std::atomic<MismatchedJoint> mismatched;

std::map<std::string, std::string>& functorsOfLaws() {
    static std::map<std::string, std::string> all;
    return all;
}

void advanceJoint(yade::Scene& scene, JointGeometry& geom, JointPhysics& phys, const yade::Interaction& interaction,
                  const char* law) {
    // A joint that connect() did not make is left out here: the loop is parallel, where an exception would end the
    // program. The next engine of this plugin reports it (SceneCheck).
    if (!geom.made() || !geom.step || geom.points() != phys.points()) return;
    const auto& properties = phys.law().properties();
    if (!properties.elastic && properties.law != law) {
        mismatched.store({interaction.id1, interaction.id2});
        return;
    }
    auto& step = *geom.step;
    const auto& r = geom.reference();
    const bool attached = r.attached != nullptr;
    Vector3r force = Vector3r::Zero(), torque = Vector3r::Zero(), moment = Vector3r::Zero();
    for (int p = 0; p < phys.points(); ++p) {
        const auto& by = step.increments[p];
        phys.group->columns->advanceOne(p, phys.index, {by[0], {by[1], by[2]}});
        const auto s = phys.state(p);
        // Tension is positive, so a joint in tension pulls body 1 along the normal.
        const Vector3r pull = Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b) * geom.area(p);
        force += pull;
        torque += step.arms[p].cross(pull);
        if (attached) { // gatherFromFunctors() brings these forces to the nodes
            step.forces[p] = step.axes * pull;
            moment += geom.jump(p).cross(pull);
        }
    }
    force = step.axes * force;
    torque = step.axes * torque;
    // The jump between nodes is measured in axes that turn with the mean rotation of the two blocks. So the joint does
    // work on that rotation, too, and each block takes half of the moment. With it the two forces, which act apart by
    // the jump, have no resulting moment.
    step.moment = 0.5 * (step.axes * moment);
    auto& forces = scene.forces();
    if (r.rigid(0)) {
        forces.addForce(interaction.id1, force);
        forces.addTorque(interaction.id1, torque + step.moment);
    }
    if (r.rigid(1)) {
        forces.addForce(interaction.id2, -force);
        // The arms lead from body 1, so those of body 2 are shorter by `between`. If body 1 is deformable, the arms
        // lead from body 2 already.
        const Vector3r onBody2 =
            attached ? Vector3r(step.moment - torque) : Vector3r(step.between.cross(force) - torque);
        forces.addTorque(interaction.id2, onBody2);
    }
}

void gatherFromFunctors(const std::vector<JointView>& joints, Zones& zones) {
    zones.clearForces();
    const auto hang = [&](const Attachment& a, const Vector3r& force) {
        for (int i = 0; i < 3; ++i)
            for (int d = 0; a.weights[i] != 0 && d < 3; ++d)
                (zones.forceRows() + zones.placeOf(a.nodes[i]))[d * lanes] += a.weights[i] * force[d];
    };
    for (const auto& joint : joints) {
        const auto& geom = *joint.geom;
        const auto& r = geom.reference();
        if (!r.attached || r.attached->zones.get() != &zones || !geom.step) continue;
        for (int p = 0; p < geom.points(); ++p) {
            const Vector3r force = geom.step->forces[p];
            if (!r.rigid(0)) hang(r.attached->sides[0][p], force);
            if (!r.rigid(1)) hang(r.attached->sides[1][p], -force);
        }
        for (const auto& side : r.sides)
            if (const auto* unit = zones.unitOf(side.body))
                for (int d = 0; d < 3; ++d)
                    (zones.momentRows() + unit->momentPlace)[d * lanes] += geom.step->moment[d];
    }
}

} // namespace masonry
