// SPDX-License-Identifier: GPL-2.0-or-later
// Where a scene has left the small displacements that its joints are made for: a block that has tipped over, slid off
// its neighbour, gone through it or left it. What a run computes from then on means nothing, so it ends.
#pragma once
#include "engine/store/RunEnded.hpp"
#include <optional>

namespace masonry {

class SceneStore;

// How far the two blocks of a joint may move against each other; yade_plugin/README.md, Collapse, says why.
struct CollapseLimits {
    double turnLimit = 1.0471975511965976; // rotation [rad]: 60°
    double slideLimit = 1;                 // over the joint's own size in the direction of the slide [-]
    double closureLimit = 1;               // over the smaller of the two blocks' sizes across the joint [-]
    double openingLimit = 1; // smallest opening of the joint over the largest extent of the smaller block [-]
};

struct Collapse {
    int block = -1; // id of the block that has moved farther of the two; -1: none has collapsed
    std::string what;

    std::optional<RunEnded> ended() const; // the error by which the run ends; nothing if no block has collapsed
};

// The joint of a scene that is farthest beyond a limit, if any is.
Collapse findCollapse(SceneStore&, const CollapseLimits&);
constexpr int collapseEvery = 100; // steps between two looks

} // namespace masonry
