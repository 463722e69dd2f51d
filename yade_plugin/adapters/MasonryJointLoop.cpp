// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryJointLoop.hpp"
#include "engine/watch/EngineScope.hpp"
#include <algorithm>

template class masonry::Adapter<masonry::MasonryJointLoop, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointLoop)

namespace masonry {

void MasonryJointLoop::action() {
    const EngineScope scope(*scene, *this);
    if (refining_.look(scope.store())) scope->pointsChanged();
    plan_.advance(scope.store());
    refining_.count(scope.store());
}

int MasonryJointLoop::groups() const {
    const BetweenSteps still;
    auto& store = SceneStore::present();
    store.update();
    return int(store.kinds.size());
}

int MasonryJointLoop::intactJoints() const {
    const BetweenSteps still;
    auto& store = SceneStore::present();
    store.update();
    int count = 0;
    for (const auto& kind : store.kinds)
        count += int(
            std::count(kind.shapes->pointwise.begin(), kind.shapes->pointwise.begin() + kind.shapes->joints.size(), 0));
    return count;
}

int MasonryJointLoop::refinedJoints() const {
    const BetweenSteps still;
    auto& store = SceneStore::present();
    store.update();
    return int(std::count_if(store.joints.begin(), store.joints.end(),
                             [](const JointView& joint) { return joint.geom->refined().coarse != nullptr; }));
}

} // namespace masonry
