// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom.hpp"

namespace masonry {

class Ig2_MasonryBlock_Polyhedra_MasonryContactGeom
    : public Adapter<Ig2_MasonryBlock_Polyhedra_MasonryContactGeom, Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom> {
public:
    static constexpr const char* className = "Ig2_MasonryBlock_Polyhedra_MasonryContactGeom";
    static constexpr const char* baseName = "Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom";
    static constexpr const char* doc = "Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom for a MasonryBlock and a "
                                       "Polyhedra. Only a YADE that has Polyhedra knows this class.";

    template <class Visit> static void attributes(Visit&&) {}

    std::string get2DFunctorType1() const override { return "MasonryBlock"; }
    std::string get2DFunctorType2() const override { return "Polyhedra"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryBlock", "Polyhedra"}; }
    std::string checkOrder() const override { return "MasonryBlock Polyhedra"; }
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Ig2_MasonryBlock_Polyhedra_MasonryContactGeom,
                                       masonry::Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom>;
BOOST_CLASS_EXPORT_KEY(masonry::Ig2_MasonryBlock_Polyhedra_MasonryContactGeom)
