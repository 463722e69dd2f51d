// SPDX-License-Identifier: GPL-2.0-or-later
#include "SceneCheck.hpp"
#include "Collapse.hpp"
#include "common/Text.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/contacts/Contacts.hpp"
#include "engine/joints/JointFunctor.hpp"
#include "engine/store/SceneStore.hpp"
#include "engine/units/Zones.hpp"
#include <algorithm>
#include <atomic>
#include <iostream>
#include <mutex>
#include <omp.h>
#include <utility>

namespace masonry {

namespace {

std::atomic<bool> parallelMet{false}; // whether there is a sentence in `parallelEngine`
std::mutex parallel;                  // guards what follows
std::string parallelEngine;           // the sentence about an engine in a ParallelEngine, until it is thrown
long parallelStep = -1;               // the step in which that engine should have acted

long presentStep() { return Singleton<yade::Omega>::instance().getScene()->iter; }

} // namespace

void refuseParallelEngine() {
    if (!parallelMet.exchange(false)) return;
    const std::lock_guard<std::mutex> held(parallel);
    const auto sentence = std::exchange(parallelEngine, {});
    if (parallelStep == presentStep()) throw std::invalid_argument(sentence);
}

bool standsAlone(const yade::Engine& engine) {
    if (omp_get_level() == 0) return true;
    const std::lock_guard<std::mutex> held(parallel);
    const bool first = parallelEngine.empty();
    parallelEngine = engine.getClassName() +
                     " stands in a ParallelEngine and does nothing: put it into O.engines itself, it uses all threads";
    parallelStep = presentStep();
    parallelMet = true;
    if (first) std::cerr << "error: " + parallelEngine + "\n" << std::flush;
    return false;
}

namespace {

struct LookForCollapse {
    long step = -1; // in which a collapse was last looked for in a scene that no engine watches over
};

void add(std::vector<std::string>& all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

// All that is wrong with O.engines, in one sentence; empty if nothing is.
std::string problemOfEngines(const yade::Scene& scene, bool jointed) {
    std::vector<std::string> wrong;
    std::string loop, integrator;
    bool reset = false, loaded = false;
    const bool looped = std::any_of(scene.engines.begin(), scene.engines.end(), [](const auto& engine) {
        const auto name = engine->getClassName();
        return !engine->dead && (name == "MasonryJointLoop" || name == "InteractionLoop");
    });
    if (jointed && !looped) wrong.push_back("there is no MasonryJointLoop");
    std::vector<const yade::Engine*> met;
    for (const auto& engine : scene.engines) {
        if (engine->dead) continue;
        const std::string name = engine->getClassName();
        const auto fail = [&](const std::string& what) { wrong.push_back(name + " " + what); };
        if (std::find(met.begin(), met.end(), engine.get()) != met.end()) {
            if (name.rfind("Masonry", 0) == 0) fail("\"" + engine->label + "\" stands there twice");
            continue;
        }
        met.push_back(engine.get());
        reset |= name == "ForceResetter";
        if (name == "MasonryJointLoop" || name == "InteractionLoop") {
            if (!loop.empty()) fail("stands beside " + loop);
            if (!reset) fail("must stand after a ForceResetter");
            loop = name;
            continue;
        }
        const bool moves = name == "MasonryIntegrator" || name == "NewtonIntegrator";
        const bool touches = dynamic_cast<const Contacts*>(engine.get()) != nullptr;
        if (touches && !reset) fail("must stand after a ForceResetter");
        const bool connects = touches || dynamic_cast<const Connectors*>(engine.get()) != nullptr;
        loaded |= name == "MasonryLoad";
        if (connects && loaded) fail("must stand before MasonryLoad");
        const bool loads = connects || name == "MasonryLoad" || name == "MasonryEnergy";
        if (looped && loop.empty() && (moves || loads || name == "MasonryZones"))
            fail("must stand after the joints' loop");
        if (loads && !integrator.empty()) fail("must stand before " + integrator);
        if (moves && !integrator.empty()) fail("stands beside " + integrator);
        if (moves) integrator = name;
    }
    if (integrator.empty()) wrong.push_back("there is no MasonryIntegrator");
    return wrong.empty() ? "" : "O.engines: " + joined(wrong, "; ") + " (masonry.engines() puts them in order)";
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
                    bodyAt(scene, id, "MasonryZones: body");
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
            fail("needs its MasonryZones in O.engines, and not dead");
        for (int id : {interaction.id1, interaction.id2})
            if (owner[id] && own != owner[id])
                fail("was made before MasonryZones had body " + std::to_string(id) +
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
        if (const auto found = findCollapse(store, {}); found.block >= 0)
            throw std::runtime_error("collapsed: " + found.what);
    }
}

} // namespace masonry
