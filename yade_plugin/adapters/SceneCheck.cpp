#include "SceneCheck.hpp"
#include "MasonryJointGeom.hpp"
#include "MasonryJointPhys.hpp"
#include "MasonryMat.hpp"
#include "SceneStore.hpp"
#include "common/Text.hpp"
#include <algorithm>

namespace masonry {

const yade::Body& bodyAt(const yade::Scene& scene, int id, const std::string& what) {
    const auto& all = scene.bodies->body;
    if (id < 0 || std::size_t(id) >= all.size() || !all[id])
        throw std::invalid_argument(what + " " + std::to_string(id) + " does not exist");
    return *all[id];
}

std::vector<std::string> problemsOf(const yade::Body& body) {
    std::vector<std::string> wrong;
    const auto fail = [&](const std::string& what) { wrong.push_back("body " + std::to_string(body.id) + " " + what); };
    const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
    if (!dynamic_cast<const MasonryMat*>(body.material.get()))
        fail("has " + (body.material ? body.material->getClassName() : "no material") + ", must have a MasonryMat");
    const auto& s = *body.state;
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
            zones.push_back(one);
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
        if (body && dynamic_cast<const yade::Polyhedra*>(body->shape.get())) {
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
        const auto& hung = geom->reference().hung;
        const MasonryZones* own = hung ? hung->zones.get() : nullptr;
        if (own && std::find(zones.begin(), zones.end(), own) == zones.end())
            fail("needs its MasonryZones in O.engines");
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
