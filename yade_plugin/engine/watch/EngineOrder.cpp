// SPDX-License-Identifier: GPL-2.0-or-later
#include "EngineOrder.hpp"
#include "common/Text.hpp"
#include "engine/bodies/ClassRole.hpp"
#include <algorithm>
#include <atomic>
#include <iostream>
#include <mutex>
#include <omp.h>
#include <utility>

namespace masonry {

std::string problemOfEngines(const yade::Scene& scene, bool jointed) {
    std::vector<std::string> wrong;
    std::string loop, integrator;
    bool reset = false, loaded = false;
    const bool looped = std::any_of(scene.engines.begin(), scene.engines.end(), [](const auto& engine) {
        return !engine->dead && roleOf(*engine) == ClassRole::Joints;
    });
    if (jointed && !looped) wrong.push_back("there is no " + nameOf(ClassRole::Joints));
    std::vector<const yade::Engine*> met;
    for (const auto& engine : scene.engines) {
        if (engine->dead) continue;
        const auto role = roleOf(*engine);
        const std::string name = engine->getClassName();
        const auto fail = [&](const std::string& what) { wrong.push_back(name + " " + what); };
        if (std::find(met.begin(), met.end(), engine.get()) != met.end()) {
            if (isOurs(*engine)) fail("\"" + engine->label + "\" stands there twice");
            continue;
        }
        met.push_back(engine.get());
        reset |= role == ClassRole::ForceResetter;
        if (role == ClassRole::Joints) {
            if (!loop.empty()) fail("stands beside " + loop);
            if (!reset) fail("must stand after a ForceResetter");
            loop = name;
            continue;
        }
        if (role == ClassRole::Contacts && !reset) fail("must stand after a ForceResetter");
        const bool connects = role == ClassRole::Contacts || role == ClassRole::Connectors;
        loaded |= role == ClassRole::Load;
        if (connects && loaded) fail("must stand before " + nameOf(ClassRole::Load));
        const bool moves = role == ClassRole::Integrator;
        const bool loads = connects || role == ClassRole::Load || role == ClassRole::Watch;
        if (looped && loop.empty() && (moves || loads || role == ClassRole::Units))
            fail("must stand after the joints' loop");
        if (loads && !integrator.empty()) fail("must stand before " + integrator);
        if (moves && !integrator.empty()) fail("stands beside " + integrator);
        if (moves) integrator = name;
    }
    if (integrator.empty()) wrong.push_back("there is no " + nameOf(ClassRole::Integrator));
    return wrong.empty() ? "" : "O.engines: " + joined(wrong, "; ") + " (masonry.engines() puts them in order)";
}

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

} // namespace masonry
