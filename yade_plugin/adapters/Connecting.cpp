// SPDX-License-Identifier: GPL-2.0-or-later
#include "Connecting.hpp"
#include "MasonryBlock.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/store/SceneStore.hpp"
#include <set>

namespace masonry {

namespace {

// The joints that connect() has made so far.
struct Made {
    yade::Scene& scene;
    const shared_ptr<Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom> geometry;
    const shared_ptr<Ip2_MasonryMat_MasonryMat_MasonryJointPhys> physics;
    const py::object rule;
    std::vector<shared_ptr<yade::Interaction>> interactions{};
    std::vector<shared_ptr<MasonryJoint>> used{};
    std::set<const PropertySet*> known{}; // those in `used`
    std::size_t due =
        256; // number of joints at which they move into columns: what they leave is free for the next ones

    shared_ptr<yade::Interaction> makeGeometry(int id1, int id2);
    void makePhysics(const shared_ptr<yade::Interaction>&);
    shared_ptr<MasonryJoint> askRule(const yade::Interaction&) const;
    void gatherIfDue();
    void erase();
};

// As YADE's dispatcher does, the shape that stands first in the name of the functor comes first.
shared_ptr<yade::Interaction> Made::makeGeometry(int id1, int id2) {
    const auto isMasonryBlock = [&](int id) {
        return dynamic_cast<const MasonryBlock*>(bodyAt(scene, id, "body").shape.get()) != nullptr;
    };
    if (isMasonryBlock(id2) && !isMasonryBlock(id1)) std::swap(id1, id2);
    auto& all = *scene.interactions;
    if (!all.insert(id1, id2))
        throw std::invalid_argument("bodies " + std::to_string(id1) + " and " + std::to_string(id2) +
                                    " have an interaction already");
    const auto interaction = all.linIntrs[all.currSize - 1];
    interactions.push_back(interaction);
    const auto &one = *scene.bodies->body[id1], &two = *scene.bodies->body[id2];
    geometry->go(one.shape, two.shape, *one.state, *two.state, Vector3r::Zero(), true, interaction);
    interaction->iterMadeReal = scene.iter;
    return interaction;
}

shared_ptr<MasonryJoint> Made::askRule(const yade::Interaction& interaction) const {
    if (rule.is_none()) return nullptr;
    const auto& bodies = scene.bodies->body;
    const py::object given = rule(bodies[interaction.id1], bodies[interaction.id2], interaction.geom);
    const py::extract<shared_ptr<MasonryJoint>> joint(given);
    if (given.is_none()) return nullptr;
    if (!joint.check())
        throw std::invalid_argument("rule must return a MasonryJoint or None, got " + shown(given.attr("__repr__")()) +
                                    " for bodies " + std::to_string(interaction.id1) + " and " +
                                    std::to_string(interaction.id2));
    return joint();
}

void Made::gatherIfDue() {
    if (interactions.size() < due) return;
    const BetweenSteps still;
    SceneStore::of(scene).gather();
    due += 256 + due / 12;
}

void Made::makePhysics(const shared_ptr<yade::Interaction>& interaction) {
    if (const auto joint = askRule(*interaction)) {
        gatherIfDue();
        physics->assignTo(interaction, joint);
    } else {
        const auto& bodies = scene.bodies->body;
        physics->go(bodies[interaction->id1]->material, bodies[interaction->id2]->material, interaction);
        gatherIfDue();
    }
    const auto& joint = static_cast<const MasonryJointPhys&>(*interaction->phys).propertySet();
    if (known.insert(joint.get()).second) used.push_back(boost::static_pointer_cast<MasonryJoint>(joint));
}

void Made::erase() {
    auto& all = *scene.interactions;
    for (; !interactions.empty(); interactions.pop_back()) // the last one of the scene is the last one here
        all.erase(interactions.back()->id1, interactions.back()->id2, int(all.currSize) - 1);
}

} // namespace

py::tuple connect(const py::list& pairs, const shared_ptr<Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom>& geometry,
                  const shared_ptr<Ip2_MasonryMat_MasonryMat_MasonryJointPhys>& physics, const py::object& rule) {
    auto& scene = *Singleton<yade::Omega>::instance().getScene();
    geometry->scene = physics->scene = &scene;
    Made made{scene, geometry, physics, rule};
    py::list interactions, joints, problems;
    try {
        for (py::ssize_t n = 0; n < py::len(pairs); ++n)
            try {
                made.makePhysics(made.makeGeometry(py::extract<int>(pairs[n][0]), py::extract<int>(pairs[n][1])));
            } catch (const std::invalid_argument& error) {
                problems.append(error.what());
            }
        if (py::len(problems) > 0) made.erase();
    } catch (...) {
        made.erase();
        throw;
    }
    for (const auto& interaction : made.interactions)
        interactions.append(interaction);
    for (const auto& joint : made.used)
        joints.append(joint);
    return py::make_tuple(interactions, joints, problems);
}

} // namespace masonry
