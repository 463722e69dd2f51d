// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "MasonryContactGeom.hpp"

namespace masonry {

class Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom
    : public Adapter<Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom, yade::IGeomFunctor>,
      public ContactSearch {
public:
    static constexpr const char* className = "Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom";
    static constexpr const char* baseName = "IGeomFunctor";
    static constexpr const char* doc =
        "Finds where two blocks press on each other, as MasonryContacts does. It is for scenes that are built body by "
        "body, "
        "without joints, with a collider and YADE's InteractionLoop; MasonryContacts is quicker.";

    template <class Visit> static void attributes(Visit&&) {}

    std::string get2DFunctorType1() const override { return "MasonryBlock"; }
    std::string get2DFunctorType2() const override { return "MasonryBlock"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryBlock", "MasonryBlock"}; }
    std::string checkOrder() const override { return "MasonryBlock MasonryBlock"; }
    bool go(const shared_ptr<yade::Shape>&, const shared_ptr<yade::Shape>&, const yade::State&, const yade::State&,
            const Vector3r& shift, const bool& force, const shared_ptr<yade::Interaction>&) override;
    using FunctorCalls::go;
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom, yade::IGeomFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom)
