// SPDX-License-Identifier: GPL-2.0-or-later
#include "SceneCheck.hpp"
#include "Collapse.hpp"
#include "EngineOrder.hpp"
#include "common/Text.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/contacts/Contacts.hpp"
#include "engine/joints/JointFunctor.hpp"
#include "engine/store/SceneStore.hpp"
#include "engine/units/Zones.hpp"
#include <algorithm>

namespace masonry {

namespace {

struct LookForCollapse {
    long step = -1; // in which a collapse was last looked for in a scene that no engine watches over
};

void add(std::vector<std::string>& all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

} // namespace

void checkScene(const SceneStore& store) {
    const auto& scene = store.scene();
    std::vector<std::string> wrong;
    std::vector<const Zones*> owner(scene.bodies->body.size(), nullptr), zones;
    for (const auto& engine : scene.engines)
        if (const auto* one = dynamic_cast<const Zones*>(engine.get())) {
            if (!engine->dead) zones.push_back(one);
            for (int id : one->bodies)
                try {
                    bodyAt(scene, id, ": body", ClassRole::Units);
                    owner[id] = one;
                } catch (const std::invalid_argument& error) {
                    wrong.push_back(error.what());
                }
        }
    int blocks = 0;
    for (const auto& body : scene.bodies->body)
        if (body && isBlock(body->shape.get())) {
            add(wrong, problemsOf(*body));
            ++blocks;
        }
    bool jointed = false;
    for (std::size_t n = 0; n < scene.interactions->currSize; ++n) {
        const auto& interaction = *scene.interactions->linIntrs[n];
        const auto* geom = dynamic_cast<const JointGeometry*>(interaction.geom.get());
        const auto* phys = dynamic_cast<const JointPhysics*>(interaction.phys.get());
        if (!geom && !phys) continue;
        jointed = true;
        const auto fail = [&](const std::string& what) {
            wrong.push_back("the joint of bodies " + std::to_string(interaction.id1) + " and " +
                            std::to_string(interaction.id2) + " " + what);
        };
        if (!geom || !phys || !geom->made() || !phys->made() || geom->points() == 0 ||
            geom->points() != phys->points()) {
            fail("is not one that connect() made");
            continue;
        }
        bool lost = false;
        for (int id : {interaction.id1, interaction.id2})
            if (std::size_t(id) >= owner.size() || !scene.bodies->body[id] || !scene.bodies->body[id]->state) {
                fail("has lost body " + std::to_string(id) + ": erase its interaction, too, or call O.reset()");
                lost = true;
            }
        if (lost) continue;
        const auto& attached = geom->reference().attached;
        const Zones* own = attached ? attached->zones.get() : nullptr;
        if (own && std::find(zones.begin(), zones.end(), own) == zones.end())
            fail("needs its " + nameOf(ClassRole::Units) + " in O.engines, and not dead");
        for (int id : {interaction.id1, interaction.id2})
            if (owner[id] && own != owner[id])
                fail("was made before " + nameOf(ClassRole::Units) + " had body " + std::to_string(id) +
                     ": give the zones to masonry.engines(), then connect()");
    }
    for (const auto* connectors : store.connectors)
        try {
            connectors->checkBodies(store);
        } catch (const std::invalid_argument& error) {
            wrong.push_back(error.what());
        }
    for (const auto* contacts : store.contacts)
        try {
            contacts->checkBodies(store);
        } catch (const std::invalid_argument& error) {
            wrong.push_back(error.what());
        }
    const bool free = !store.contacts.empty(); // whether blocks may lie on others without a joint
    for (int id : free ? std::vector<int>() : store.unjoinedBlocks())
        wrong.push_back("body " + std::to_string(id) +
                        " was added after connect() and has no joint, so nothing would hold it: build all blocks "
                        "first, then call connect()");
    if (!jointed && blocks > 1 && !free) wrong.push_back("no joints: call masonry.connect() before the first step");
    if (const auto problem = problemOfEngines(scene, jointed); !problem.empty()) wrong.push_back(problem);
    if (!wrong.empty()) throw std::invalid_argument(firstOf(wrong));
}

void checkBeforeStep(SceneStore& store) {
    const auto& scene = store.scene();
    if (!(scene.dt > 0 && std::isfinite(scene.dt)))
        throw std::invalid_argument("O.dt " + text(scene.dt) + " s must be a finite number above 0");
    refuseParallelEngine();
    if (scene.isPeriodic)
        throw std::invalid_argument(
            "O.periodic: joints do not reach across a periodic cell, nor does a cell strain blocks; "
            "set it to False");
    if (mismatched.load().body1 >= 0) {
        const auto joint = mismatched.exchange({});
        std::vector<std::string> needs;
        for (const auto& [law, functor] : functorsOfLaws())
            needs.push_back("law \"" + law + "\" needs " + functor);
        throw std::invalid_argument(
            "the joint of bodies " + std::to_string(joint.body1) + " and " + std::to_string(joint.body2) +
            " follows another law than the Law2 functor of InteractionLoop: " + joined(needs, ", "));
    }
    if (!store.checked) {
        checkScene(store);
        if (store.zones) store.zones->units(); // divides the bodies into zones when nothing else is wrong
        if (!store.isConnected() && !store.joints.empty()) store.connected();
        store.checked = true;
    }
    auto& seen = store.kept<LookForCollapse>();
    if (!store.watched && scene.iter % collapseEvery == 0 && scene.iter != seen.step) {
        seen.step = scene.iter;
        if (const auto ended = findCollapse(store, {}).ended()) throw *ended;
    }
}

} // namespace masonry
