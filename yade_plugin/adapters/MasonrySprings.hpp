// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "engine/connectors/Springs.hpp"
#include "engine/watch/EngineOrder.hpp"

namespace masonry {

class MasonrySprings : public Adapter<MasonrySprings, yade::GlobalEngine>, public Springs {
public:
    static constexpr const char* className = "MasonrySprings";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr ClassRole declares = ClassRole::Connectors;
    static constexpr const char* doc = "Linear springs between points of two rigid bodies, or of one and the ground, "
                                       "along and about the global axes. They "
                                       "have no mass and no force in the reference state. Turns are taken as small. "
                                       "Stands after the loop of the joints "
                                       "and before MasonryLoad.";

    template <class Visit> static void attributes(Visit&& visit) {
        using S = MasonrySprings;
        Connectors::describe<S>(visit);
        visit("stiffness", &S::stiffness, described("Of each spring along x, y and z [N/m], at least 0"), Given);
        visit("rotationalStiffness", &S::rotationalStiffness,
              described("Of each spring about x, y and z [N m], at least 0"), Given);
        visit("forces", &S::forces, described("Force of each spring on its first body in the last step [N]"), ReadOnly);
        visit("moments", &S::moments,
              described("Moment of each spring on its first body in the last step, about its end [N m]"), ReadOnly);
    }

    using Springs::problems;
    bool isActivated() override { return standsAlone(*this); }
    void action() override;
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonrySprings, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonrySprings)
