// SPDX-License-Identifier: GPL-2.0-or-later
// Where a scene has left the small displacements that its joints are made for: a block that has tipped over, slid off
// its neighbour, gone through it or left it. What a run computes from then on means nothing, so it ends.
#pragma once
#include <string>

namespace masonry {

class SceneStore;

// How far the two blocks of a joint may move against each other. Joints act at points of the polygon that two faces
// shared in the reference state; these are the ends of what that can describe.
struct CollapseLimits {
    // Rotation [rad]. The normal of a joint is the mean of both blocks' faces, so at 60° it lies 30° off either face.
    // An edge that stands still on a face would then slip, for tan 30° = 0.58 is the friction of masonry.
    double turn = 1.0471975511965976;
    double slide = 1; // over the joint's own size in the direction of the slide [-]: beyond 1 the faces have parted
    double closure =
        1; // over the smaller of the two blocks' sizes across the joint [-]: beyond 1 nothing is left of it
    // Smallest opening of the joint over the largest extent of the smaller block [-]. A block that rocks keeps an edge
    // closed; beyond 1 it has left its neighbour by more than its own size.
    double opening = 1;
};

struct Collapse {
    int block = -1; // id of the block that has moved farther of the two; -1: none has collapsed
    std::string what;
};

// The joint of a scene that is farthest beyond a limit, if any is.
Collapse findCollapse(SceneStore&, const CollapseLimits&);
constexpr int collapseEvery = 100; // steps between two looks

} // namespace masonry
