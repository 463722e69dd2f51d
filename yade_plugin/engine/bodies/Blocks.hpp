// SPDX-License-Identifier: GPL-2.0-or-later
// Which bodies are blocks: those whose shape has a BlockSurface, and those with a Polyhedra of a YADE that has this
// class.
#pragma once
#include "blocks/FaceContact.hpp"
#include "host/Yade.hpp"

namespace masonry {

// The surface of a convex block, relative to its centroid and in its principal axes. A shape derives from it.
struct BlockSurface {
    std::vector<yade::Vector3r> v; // corners [m]
    std::vector<int> triangles;    // three numbers of corners each, counter-clockwise seen from outside
};

// The corners of a block [m], relative to its centroid and in the axes of its body. Null if the shape is none of a
// block, or if there is no shape.
const std::vector<yade::Vector3r>* cornersOf(const yade::Shape*);

inline bool isBlock(const yade::Shape* shape) { return cornersOf(shape) != nullptr; }

// A block in the axes of its body. The shape must be that of a block.
ConvexBlock blockOf(yade::Shape&);
// The same block at a position and orientation, in global axes.
ConvexBlock blockOf(yade::Shape&, const yade::Vector3r& position, const yade::Quaternionr& orientation);

// Extent of points along a direction [m].
template <class Points> double extent(const Points& points, const yade::Vector3r& direction) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (const auto& p : points) {
        const double at = direction.dot(p);
        least = std::min(least, at);
        most = std::max(most, at);
    }
    return most - least;
}

} // namespace masonry
