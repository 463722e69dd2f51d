// SPDX-License-Identifier: GPL-2.0-or-later
#include "MonolithicPairs.hpp"

namespace masonry {

std::vector<MonolithicPair> monolithicPairs(const SceneContents& scene) {
    std::vector<MonolithicPair> found;
    std::vector<int> jointOf(scene.bodies.size(), -1); // of every body, the number of its monolithic joint
    for (std::size_t n = 0; n < scene.joints.size(); ++n) {
        const auto& joint = scene.joints[n];
        if (!joint.phys->propertySet()->monolithic) continue;
        const auto& r = joint.geom->reference();
        for (const auto& side : r.sides) {
            auto& other = jointOf[side.body];
            if (other >= 0)
                throw std::invalid_argument(
                    "body " + std::to_string(side.body) + " has two joints that are monolithic, \"" +
                    scene.joints[other].phys->propertySet()->name + "\" and \"" + joint.phys->propertySet()->name +
                    "\": a brick that is whole until it cracks has two blocks and one crack "
                    "surface; use monolithic=False for bricks of more blocks");
            other = int(n);
        }
        found.push_back({r.sides[0].body, r.sides[1].body, int(n), r.split});
    }
    return found;
}

} // namespace masonry
