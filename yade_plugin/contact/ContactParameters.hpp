// SPDX-License-Identifier: GPL-2.0-or-later
// What a user gives for contacts. The engine of contacts and their physics functor derive from it.
#pragma once
#include "ContactPair.hpp"
#include "common/Property.hpp"

namespace masonry {

struct ContactParameters {
    double normalStiffness = 0;   // per area [Pa/m]
    double tangentialRatio = 0.4; // stiffness along the face over that along the normal [-]
    double friction = -1;         // coefficient [-]
    double restitution = 0.5;     // of a central impact of two faces [-]

    template <class Visit> static void describe(Visit&& visit) {
        using C = ContactParameters;
        visit("normalStiffness", &C::normalStiffness,
              number("Pa/m", "Stiffness of two faces per area; must be given, as that of a joint between the blocks")
                  .atLeast(0));
        visit("tangentialRatio", &C::tangentialRatio,
              number("-", "Elastic stiffness along the face over that along the normal")
                  .above(0)
                  .atMost(1)
                  .source("[decided]: G/E of masonry"));
        visit("friction", &C::friction,
              number("-", "Coefficient of friction; -1 stands for none given, which the first step refuses")
                  .atLeast(-1)
                  .atMost(10));
        visit("restitution", &C::restitution,
              number("-", "Speed after a central impact of two faces over that before it; 1: without damping. Measured "
                          "ones of stone depend on speed, mass and hardness")
                  .atLeast(0.1)
                  .atMost(1)
                  .source("convention, no measured value"));
    }

    // Which parameter of `owner` must be given and is not; empty if all are.
    std::string missing(const std::string& owner) const {
        if (!(normalStiffness > 0))
            return owner + ".normalStiffness " + text(normalStiffness) + " Pa/m must be given, above 0";
        if (!(friction >= 0)) return owner + ".friction " + text(friction) + " must be given, at least 0";
        return {};
    }

    ContactProperties law() const { return {normalStiffness, tangentialRatio, friction, dampingRatio(restitution)}; }
};

} // namespace masonry
