// SPDX-License-Identifier: GPL-2.0-or-later
#include "EngineScope.hpp"
#include "CriticalTimeStep.hpp"
#include "EngineOrder.hpp"
#include "SceneCheck.hpp"
#include "common/Parallel.hpp"
#include "engine/bodies/StepLock.hpp"
#include <exception>
#include <stdexcept>
#include <utility>

namespace masonry {

EngineScope::EngineScope(yade::Scene& scene, const yade::Engine& engine)
    : engine_(&engine), errors_(std::uncaught_exceptions()) {
    StepLock::instance().enter();
    try {
        store_ = &SceneStore::of(scene);
        if (store_->isOpenFor(engine))
            refuseParallelEngine();
        else {
            store_->update(SceneStore::ScanScope::Step);
            checkBeforeStep(*store_);
            followTimeStep(*store_);
            store_->opened();
            Parallel::instance().stepBegins();
        }
    } catch (...) {
        StepLock::instance().exit(true);
        throw;
    }
}

EngineScope::EngineScope(yade::Scene& scene) : errors_(std::uncaught_exceptions()) {
    StepLock::instance().enter();
    try {
        store_ = &SceneStore::of(scene);
        store_->update(SceneStore::ScanScope::Step);
    } catch (...) {
        StepLock::instance().exit(true);
        throw;
    }
}

void EngineScope::end() const {
    if (engine_ != store_->last) return;
    if (const auto ended = std::exchange(store_->endsWith, std::nullopt)) throw *ended;
}

EngineScope::~EngineScope() {
    const bool failed = std::uncaught_exceptions() > errors_;
    StepLock::instance().exit(failed || (engine_ && store_->last == engine_));
}

} // namespace masonry
