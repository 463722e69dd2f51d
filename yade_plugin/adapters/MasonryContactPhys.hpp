// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "scene/ContactFunctor.hpp"

namespace masonry {

class MasonryContactPhys : public Adapter<MasonryContactPhys, yade::IPhys>, public ContactPhysics {
    MASONRY_DISPATCHED(MasonryContactPhys, yade::IPhys)
    static constexpr const char* className = "MasonryContactPhys";
    static constexpr const char* baseName = "IPhys";
    static constexpr const char* doc =
        "The law of a contact of two blocks, what it remembers, and its force.  A contact that ends loses all of "
        "it.";

    template <class Visit> static void attributes(Visit&& visit) {
        using P = MasonryContactPhys;
        visit("normalStiffness", &P::normalStiffness, number("Pa/m", "Stiffness of two faces per area").atLeast(0));
        visit("tangentialRatio", &P::tangentialRatio,
              number("-", "Elastic stiffness along the face over that along the normal").above(0).atMost(1));
        visit("friction", &P::friction, number("-", "Coefficient of friction").atLeast(0).atMost(10));
        visit("dampingRatio", &P::dampingRatio,
              number("-", "Damping ratio of two faces that press on each other; 0: without damping")
                  .atLeast(0)
                  .atMost(10)
                  .source("of the restitution, yade_plugin/contact/README.md"));
        visit("force", computed(&P::force), number("N", "Force on body 2 in the last step, global axes"), Shown);
        visit("stored", computed(&P::stored),
              number("J", "Elastic energy beside the potential: of slip and twist, and what is "
                          "kept where a contact begins within the step"),
              Shown);
        visit("record", computed<ContactPhysics, std::vector<double>>(&P::record, &P::setRecord),
              described("What friction, damping and the elastic force remember"), Hidden);
    }

    MasonryContactPhys() { createIndex(); }
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryContactPhys, yade::IPhys>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryContactPhys)
