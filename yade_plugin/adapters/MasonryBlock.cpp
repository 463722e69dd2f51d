// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryBlock.hpp"

MASONRY_DEFINE(MasonryBlock)

namespace masonry {

void MasonryBlock::postLoad() {
    check();
    for (int corner : triangles)
        if (corner < 0 || std::size_t(corner) >= v.size())
            throw std::runtime_error("saved file is damaged at MasonryBlock.triangles");
}

py::tuple MasonryBlock::around(const std::vector<Vector3r>& points) {
    const auto shape = blockAround(points);
    const shared_ptr<MasonryBlock> block(new MasonryBlock);
    block->v = shape.vertices;
    for (const auto& t : shape.triangles)
        block->triangles.insert(block->triangles.end(), t.begin(), t.end());
    block->volume = shape.volume;
    block->inertia = shape.inertia;
    return py::make_tuple(block, shape.centroid, shape.orientation);
}

} // namespace masonry
