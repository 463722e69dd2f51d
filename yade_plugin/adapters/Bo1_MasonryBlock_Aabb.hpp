// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"

namespace masonry {

class Bo1_MasonryBlock_Aabb : public Adapter<Bo1_MasonryBlock_Aabb, yade::BoundFunctor> {
public:
    static constexpr const char* className = "Bo1_MasonryBlock_Aabb";
    static constexpr const char* baseName = "BoundFunctor";
    static constexpr const char* doc =
        "The box of a MasonryBlock along the global axes, for YADE's colliders. They look at bodies whose attribute "
        "`bounded` is True only.";

    bool anyTurn = true;

    template <class Visit> static void attributes(Visit&& visit) {
        visit(
            "anyTurn", &Bo1_MasonryBlock_Aabb::anyTurn,
            described("Whether the box of a block that can turn holds it however it turns about its centre. A collider "
                      "with verletDist above 0 needs that, because it makes boxes anew by how far centres have moved. "
                      "False gives smaller boxes, for verletDist = 0"));
    }

    std::string get1DFunctorType1() const override { return "MasonryBlock"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryBlock"}; }
    void go(const shared_ptr<yade::Shape>&, shared_ptr<yade::Bound>&, const yade::Se3&, const yade::Body*) override;
    using FunctorCalls::go;
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Bo1_MasonryBlock_Aabb, yade::BoundFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Bo1_MasonryBlock_Aabb)
