// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryJointLoop.hpp"
#include <algorithm>

MASONRY_DEFINE(MasonryJointLoop)

namespace masonry {

void MasonryJointLoop::step(SceneStore& store) {
    if (refining_.look(store)) store.pointsChanged();
    plan_.advance(store);
    refining_.count(store);
}

int MasonryJointLoop::groups() const { return int(StillScene()->kinds.size()); }

int MasonryJointLoop::intactJoints() const {
    const StillScene scene;
    int count = 0;
    for (const auto& kind : scene->kinds)
        count += int(
            std::count(kind.shapes->pointwise.begin(), kind.shapes->pointwise.begin() + kind.shapes->joints.size(), 0));
    return count;
}

int MasonryJointLoop::refinedJoints() const {
    const StillScene scene;
    return int(std::count_if(scene->joints.begin(), scene->joints.end(),
                             [](const JointView& joint) { return joint.geom->refined().coarse != nullptr; }));
}

} // namespace masonry
