// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "EngineAdapter.hpp"
#include "engine/connectors/Springs.hpp"

namespace masonry {

class MasonrySprings : public EngineAdapter<MasonrySprings>, public Springs {
    MASONRY_CLASS(MasonrySprings, GlobalEngine)
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
    void step(SceneStore&);
};

} // namespace masonry

MASONRY_DECLARE(MasonrySprings)
