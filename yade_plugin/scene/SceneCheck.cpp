#include "SceneCheck.hpp"
#include "Blocks.hpp"
#include "SceneStore.hpp"
#include "adapters/MasonryJointGeom.hpp"
#include "adapters/MasonryJointPhys.hpp"
#include "adapters/MasonryMat.hpp"
#include "common/Text.hpp"
#include <algorithm>
#include <iostream>
#include <mutex>
#include <omp.h>
#include <utility>

namespace masonry {

const yade::Body& bodyAt(const yade::Scene& scene, int id, const std::string& what) {
    const auto& all = scene.bodies->body;
    if (id < 0 || std::size_t(id) >= all.size() || !all[id])
        throw std::invalid_argument(what + " " + std::to_string(id) + " does not exist");
    if (!all[id]->state) throw std::invalid_argument(what + " " + std::to_string(id) + " has no State");
    return *all[id];
}

namespace {

std::mutex parallel;        // guards what follows
std::string parallelEngine; // the sentence about an engine in a ParallelEngine, until it is thrown
long parallelStep = -1;     // the step in which that engine should have acted

long presentStep() { return Singleton<yade::Omega>::instance().getScene()->iter; }

} // namespace

std::string refusalInParallel() {
    const std::lock_guard<std::mutex> held(parallel);
    const auto told = std::exchange(parallelEngine, {});
    return parallelStep == presentStep() ? told : "";
}

bool standsAlone(const yade::Engine& engine) {
    if (omp_get_level() == 0) return true;
    const std::lock_guard<std::mutex> held(parallel);
    const bool first = parallelEngine.empty();
    parallelEngine = engine.getClassName() +
                     " stands in a ParallelEngine and does nothing: put it into O.engines itself, it uses all threads";
    parallelStep = presentStep();
    if (first) std::cerr << "error: " + parallelEngine + "\n" << std::flush;
    return false;
}

std::vector<std::string> problemsOf(const yade::Body& body) {
    std::vector<std::string> wrong;
    const auto fail = [&](const std::string& what) { wrong.push_back("body " + std::to_string(body.id) + " " + what); };
    const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
    if (!dynamic_cast<const MasonryMat*>(body.material.get()))
        fail("has " + (body.material ? body.material->getClassName() : "no material") + ", must have a MasonryMat");
    if (!body.state) {
        fail("has no State");
        return wrong;
    }
    if (body.clumpId >= 0)
        fail("belongs to clump " + std::to_string(body.clumpId) +
             ", which would not move as one: join blocks by stiff "
             "joints instead");
    const auto& s = *body.state;
    if (const auto* corners = cornersOf(body.shape.get()); corners && corners->empty())
        fail("has a " + body.shape->getClassName() + " without corners");
    if (!positive(s.mass)) fail("has a mass of " + text(s.mass) + " kg, must be a finite number above 0");
    for (double inertia : {s.inertia[0], s.inertia[1], s.inertia[2]})
        if (!positive(inertia)) {
            fail("has an inertia of " + text(inertia) + " kg m², must be a finite number above 0");
            break;
        }
    if (!s.pos.allFinite() || !s.ori.coeffs().allFinite() || !s.vel.allFinite() || !s.angVel.allFinite())
        fail("has a place or velocity that is no finite number");
    return wrong;
}

namespace {

void add(std::vector<std::string>& all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

// All that is wrong with O.engines, in one sentence; empty if nothing is.
std::string problemOfEngines(const yade::Scene& scene, bool jointed) {
    std::vector<std::string> wrong;
    std::string loop, integrator;
    bool reset = false;
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
        const bool loads = name == "MasonryLoad" || name == "MasonryEnergy";
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
    std::vector<const MasonryZones*> owner(scene.bodies->body.size(), nullptr), zones;
    for (const auto& engine : scene.engines)
        if (const auto* one = dynamic_cast<const MasonryZones*>(engine.get())) {
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
        const auto* geom = dynamic_cast<const MasonryJointGeom*>(interaction.geom.get());
        const auto* phys = dynamic_cast<const MasonryJointPhys*>(interaction.phys.get());
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
        const auto& hung = geom->reference().hung;
        const MasonryZones* own = hung ? hung->zones.get() : nullptr;
        if (own && std::find(zones.begin(), zones.end(), own) == zones.end())
            fail("needs its MasonryZones in O.engines, and not dead");
        for (int id : {interaction.id1, interaction.id2})
            if (owner[id] && own != owner[id])
                fail("was made before MasonryZones had body " + std::to_string(id) +
                     ": give the zones to masonry.engines(), then connect()");
    }
    for (int id : store.strangers())
        wrong.push_back("body " + std::to_string(id) +
                        " was added after connect() and has no joint, so nothing would hold it: build all blocks "
                        "first, then call connect()");
    if (!jointed && blocks > 1) wrong.push_back("no joints: call masonry.connect() before the first step");
    if (const auto problem = problemOfEngines(scene, jointed); !problem.empty()) wrong.push_back(problem);
    if (!wrong.empty()) throw std::invalid_argument(firstOf(wrong));
}

} // namespace masonry
