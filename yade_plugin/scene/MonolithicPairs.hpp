// SPDX-License-Identifier: GPL-2.0-or-later
// The bricks of two blocks that move as one until their crack surface yields (JointProperties::monolithic).
#pragma once
#include "SceneContents.hpp"

namespace masonry {

struct MonolithicPair {
    int body1, body2; // ids of the two blocks
    int joint;        // number of their joint in SceneContents::joints
    bool split;       // whether the joint has yielded: JointReference::split
};

// All pairs of a scene, in the order of its joints, those that have split among them. Throws std::invalid_argument if a
// block belongs to two such joints: how the parts of a brick in three or more blocks hold each other is not known.
std::vector<MonolithicPair> monolithicPairs(const SceneContents&);

} // namespace masonry
