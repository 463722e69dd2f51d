// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "scene/ContactFunctor.hpp"

namespace masonry {

class MasonryContactGeom : public Adapter<MasonryContactGeom, yade::IGeom>, public ContactGeometry {
    MASONRY_DISPATCHED(MasonryContactGeom, yade::IGeom)
    static constexpr const char* className = "MasonryContactGeom";
    static constexpr const char* baseName = "IGeom";
    static constexpr const char* doc = "The overlap of two convex blocks in the last step, in global axes. Pairs whose "
                                       "boxes overlap have it, too, before "
                                       "they touch; their interaction is real while they touch.";

    template <class Visit> static void attributes(Visit&& visit) {
        using G = MasonryContactGeom;
        visit("touches", &G::touches, described("Whether the blocks press on each other"), Shown);
        visit("contactPoint", computed(&G::contactPoint), number("m", "Centre of pressure"), Shown);
        visit("normal", computed(&G::normal), described("Direction of the elastic force on body 2"), Shown);
        visit("area", computed(&G::area), number("m²", "Contact area, projected along the normal"), Shown);
        visit("depth", computed(&G::depth),
              number("m", "Elastic force over stiffness and contact area: the depth of two faces that press on each "
                          "other, and the mean depth at edges and corners"),
              Shown);
        visit(
            "potential", computed(&G::potential),
            number("m⁴", "Elastic energy of the overlap for a normal stiffness of 1 Pa/m; reading it takes some time"),
            Shown);
        visit("record", computed<ContactGeometry, std::vector<double>>(&G::record, &G::setRecord),
              described("All numbers of the overlap"), Hidden);
    }

    MasonryContactGeom() { createIndex(); }
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryContactGeom, yade::IGeom>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryContactGeom)
