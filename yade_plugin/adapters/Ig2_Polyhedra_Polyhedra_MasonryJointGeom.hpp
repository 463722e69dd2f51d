// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom.hpp"

namespace masonry {

class Ig2_Polyhedra_Polyhedra_MasonryJointGeom
    : public Adapter<Ig2_Polyhedra_Polyhedra_MasonryJointGeom, Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom> {
    MASONRY_CLASS(Ig2_Polyhedra_Polyhedra_MasonryJointGeom, Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom)
    static constexpr const char* doc =
        "Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom for two Polyhedra. Only a YADE that has Polyhedra knows this "
        "class.";

    template <class Visit> static void attributes(Visit&&) {}

    MASONRY_FOR_PAIRS(Polyhedra, Polyhedra)
};

} // namespace masonry

MASONRY_DECLARE(Ig2_Polyhedra_Polyhedra_MasonryJointGeom)
