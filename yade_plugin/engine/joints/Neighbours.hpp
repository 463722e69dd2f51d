// SPDX-License-Identifier: GPL-2.0-or-later
// Which blocks of a scene share a face, and which nearly do.
#pragma once
#include "blocks/FaceContact.hpp"
#include "host/Yade.hpp"

namespace masonry {

// Looks at all blocks of the present scene, and gives a tuple of three lists. The lower id stands first in a pair.
// - (id1, id2) of all pairs that share a face
// - (id1, id2, gap, bound) of all pairs that nearly share one or that overlap: the gap, which is negative for an
//   overlap, and the largest gap that would be accepted [m]
// - (id, thickness) of the thinnest block and (id, diagonal) of the largest [m]
// With `keepFaces` the shared faces are kept for takeFace(), until dropFaces() is called.
boost::python::tuple neighbours(double tolerance, bool keepFaces);
// The first of these lists.
boost::python::list touchingPairs(double tolerance);

// The face that two bodies of a scene share, as neighbours() has found it with this tolerance. Each face is given once:
// the joint keeps it then. Nothing if no such face is kept.
std::optional<FaceContact> takeFace(const yade::Scene&, int id1, int id2, double tolerance);
// Share of a body's shear compliance that each of its joints takes, by the faces that are kept (law/README.md, Rigid
// units).
double shearShareOf(const yade::Scene&, int id);
// Frees the memory of all faces that are still kept.
void dropFaces();

} // namespace masonry
