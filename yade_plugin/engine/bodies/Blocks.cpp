// SPDX-License-Identifier: GPL-2.0-or-later
#include "Blocks.hpp"

namespace masonry {

using yade::Polyhedra;
using yade::Quaternionr;
using yade::Shape;
using yade::Vector3r;

namespace {

// A YADE that was built without CGAL has no Polyhedra and exports no type information of it, so no cast can ask for it.
const Polyhedra* polyhedraOf(const Shape* shape) {
    return shape && shape->getClassName() == "Polyhedra" ? static_cast<const Polyhedra*>(shape) : nullptr;
}

} // namespace

const std::vector<Vector3r>* cornersOf(const Shape* shape) {
    if (const auto* block = dynamic_cast<const BlockSurface*>(shape)) return &block->v;
    if (const auto* polyhedra = polyhedraOf(shape)) return &polyhedra->v;
    return nullptr;
}

ConvexBlock blockOf(Shape& shape) { return blockOf(shape, Vector3r::Zero(), Quaternionr::Identity()); }

ConvexBlock blockOf(Shape& shape, const Vector3r& position, const Quaternionr& orientation) {
    const auto* own = dynamic_cast<const BlockSurface*>(&shape);
    // Asked first: it also brings the corners of a new Polyhedra into the order of its triangles.
    const auto corners = own ? own->triangles : static_cast<Polyhedra&>(shape).GetSurfaceTriangulation();
    ConvexBlock block;
    for (const auto& v : *cornersOf(&shape))
        block.vertices.push_back(position + orientation * v);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        std::array<int, 3> t{corners[i], corners[i + 1], corners[i + 2]};
        const auto &a = block.vertices[t[0]], &b = block.vertices[t[1]], &c = block.vertices[t[2]];
        if ((b - a).cross(c - a).dot(a - position) < 0) std::swap(t[1], t[2]); // outward from the centre
        block.triangles.push_back(t);
    }
    return block;
}

} // namespace masonry
