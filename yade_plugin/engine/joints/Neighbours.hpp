// SPDX-License-Identifier: GPL-2.0-or-later
// Which blocks of a scene share a face, and which nearly do.
#pragma once
#include "blocks/FaceContact.hpp"
#include "host/Yade.hpp"
#include <map>
#include <optional>

namespace masonry {

// Shared faces for the joints that are made next.
struct SharedFaces {
    struct Face {
        std::pair<int, int> ids; // of two bodies, the lower one first
        FaceContact contact;     // from the body with the lower id to the other one
        bool operator<(const Face& other) const { return ids < other.ids; }
    };
    double tolerance = 0;              // with which they were found
    std::vector<Face> faces;           // in the order of their ids
    std::map<int, double> shearShares; // by body

    // The face of two bodies. Each face is given once: the joint keeps it then. Nothing if there is no such face.
    std::optional<FaceContact> take(int id1, int id2, double tolerance);
    // Share of a body's shear compliance that each of its joints takes (law/README.md, Rigid units).
    double shearShareOf(int body) const;
};

// Looks at all blocks of the present scene, and gives a tuple of three lists. The lower id stands first in a pair.
// - (id1, id2) of all pairs that share a face
// - (id1, id2, gap, bound) of all pairs that nearly share one or that overlap: the gap, which is negative for an
//   overlap, and the largest gap that would be accepted [m]
// - (id, thickness) of the thinnest block and (id, diagonal) of the largest [m]
// `faces`, if it is given, keeps the shared faces.
boost::python::tuple neighbours(double tolerance, SharedFaces* faces);

} // namespace masonry
