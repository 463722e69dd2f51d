// Which blocks of a scene share a face, and which nearly do.
#pragma once
#include "blocks/FaceContact.hpp"
#include "host/Yade.hpp"

namespace masonry {

// The block that a body's Polyhedra stands for at a place, in global axes.
ConvexBlock blockOf(yade::Polyhedra&, const yade::Vector3r& position, const yade::Quaternionr& orientation);

// Of the blocks of the scene: pairs (id1, id2) that share a face, the lower id first; pairs (id1, id2, gap, bound)
// that nearly do, or overlap (gap below 0), and the gap that would be accepted [m]; the thinnest (id, thickness) and
// the largest (id, diagonal) [m].
boost::python::tuple neighbours(double tolerance);
boost::python::list touchingPairs(double tolerance); // the first of these

} // namespace masonry
