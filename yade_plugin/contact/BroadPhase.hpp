// SPDX-License-Identifier: GPL-2.0-or-later
// Which boxes overlap: sweep and prune along one axis.
#pragma once
#include <utility>
#include <vector>

namespace masonry {

struct Box {
    double low[3], high[3]; // [m]
};

// All pairs of overlapping boxes, one of which at least is awake, the smaller number first, sorted. Boxes that share a
// boundary overlap.
std::vector<std::pair<int, int>> overlappingBoxes(const std::vector<Box>&, const std::vector<unsigned char>& awake);

} // namespace masonry
