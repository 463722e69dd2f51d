// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "engine/bodies/UnitMaterial.hpp"

namespace masonry {

class MasonryMat : public Adapter<MasonryMat, yade::Material>, public UnitMaterial, public Assumptions {
    MASONRY_DISPATCHED(MasonryMat, Material)
    static constexpr ClassRole declares = ClassRole::Material;
    static constexpr const char* doc =
        "Material of a masonry unit, which deforms elastically between the joints. Its density [kg/m³] is that of "
        "Material. The properties of joints are in MasonryJoint objects; "
        "Ip2_MasonryMat_MasonryMat_MasonryJointPhys chooses one for each pair of units.";

    std::string jointSet = "brick";

    template <class Visit> static void attributes(Visit&& visit) {
        using M = MasonryMat;
        visit(
            "young", &M::young,
            number("Pa", "Young's modulus of the unit").above(0).source("paper table 2").usually(1e6, infinity, "MPa"));
        visit("poisson", &M::poisson,
              number("-", "Poisson's ratio of the unit").above(-1).below(0.5).source("paper table 2"));
        visit("jointSet", &M::jointSet, described("Name by which MasonryJoint.jointSet picks the joints of this unit"));
        visit("density", &M::density, number("kg/m³", "Density").above(0), OfHost); // the host accepts any number
    }

    MasonryMat() { createIndex(); }

    std::vector<std::string> problems() const { return changedTooLate(); }
    std::string title() const { return "MasonryMat \"" + label + "\""; }

    // Puts the States of units beside each other in memory, because every step reads and writes all of them.
    shared_ptr<yade::State> newAssocState() const override;

private:
    static constexpr double infinity = Property::infinity;
};

} // namespace masonry

MASONRY_DECLARE(MasonryMat)
