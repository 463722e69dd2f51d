// SPDX-License-Identifier: GPL-2.0-or-later
// The beginning and the end of an engine's action.
#pragma once
#include "engine/store/SceneStore.hpp"

namespace masonry {

// Stands at the beginning of an engine's action. While it exists, Python's readers wait. The first engine of a step
// brings the store up to date and checks the scene. Those after it do so only if something between them has changed
// engines or joints.
class EngineScope {
public:
    EngineScope(yade::Scene&, const yade::Engine&);
    explicit EngineScope(yade::Scene&); // for the functors of the host's interaction loop; does not check the scene
    ~EngineScope();
    EngineScope(const EngineScope&) = delete;
    EngineScope& operator=(const EngineScope&) = delete;

    SceneStore* operator->() const { return store_; }
    SceneStore& store() const { return *store_; }
    // The last engine of a step ends the run here if one has found a reason to. Throws RunEnded then.
    void end() const;

private:
    SceneStore* store_ = nullptr;
    const yade::Engine* engine_ = nullptr;
    int errors_; // exceptions under way when it was made, so that its end knows whether the action failed
};

} // namespace masonry
