// SPDX-License-Identifier: GPL-2.0-or-later
#include "EngineTurn.hpp"
#include "SceneCheck.hpp"
#include "StepGate.hpp"
#include "common/Parallel.hpp"
#include <exception>
#include <stdexcept>
#include <utility>

namespace masonry {

EngineTurn::EngineTurn(yade::Scene& scene, const yade::Engine& engine)
    : engine_(&engine), errors_(std::uncaught_exceptions()) {
    StepGate::instance().enter();
    try {
        store_ = &SceneStore::of(scene);
        if (store_->isOpenFor(engine))
            refuseParallelEngine();
        else {
            store_->update(SceneStore::Look::InStep);
            checkBeforeStep(*store_);
            store_->opened();
            Parallel::instance().stepBegins();
        }
    } catch (...) {
        StepGate::instance().exit(true);
        throw;
    }
}

EngineTurn::EngineTurn(yade::Scene& scene) : errors_(std::uncaught_exceptions()) {
    StepGate::instance().enter();
    try {
        store_ = &SceneStore::of(scene);
        store_->update(SceneStore::Look::InStep);
    } catch (...) {
        StepGate::instance().exit(true);
        throw;
    }
}

void EngineTurn::end() const {
    if (engine_ == store_->last && !store_->endsWith.empty())
        throw std::runtime_error(std::exchange(store_->endsWith, {}));
}

EngineTurn::~EngineTurn() {
    const bool failed = std::uncaught_exceptions() > errors_;
    StepGate::instance().exit(failed || (engine_ && store_->last == engine_));
}

} // namespace masonry
