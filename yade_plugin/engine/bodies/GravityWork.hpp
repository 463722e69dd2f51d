// SPDX-License-Identifier: GPL-2.0-or-later
// Work of a gravity that may change during a run, as it does when it is raised step by step, or turned to tilt a scene.
#pragma once
#include "common/Property.hpp"
#include "host/Yade.hpp"

namespace masonry {

using yade::Vector3r;

// While gravity g is constant, its work is the sum of m g·u over all masses m and their displacements u since the
// reference state, less that sum at the first step: blocks that a script has moved before bring none.
//
// Between two steps with different gravities the work is that of their mean, as of every force that changes (BodyStep):
// with the moment S, the sum of m u, it is (g + g')·(S' - S) / 2. Then the balance stays an identity.
struct GravityWork {
    bool falling = false;    // whether there was a step
    double fallenBefore = 0; // what the work is more than the present sum of m g·u [J]
    Vector3r lastGravity = Vector3r::Zero();
    Vector3r lastMoment = Vector3r::Zero(); // S at the last step [kg m]

    // The work up to now [J]. `sum` is the sum of m g·u under the present gravity, and `before` the work at the last
    // step.
    double workOfGravity(double sum, const Vector3r& gravity, const Vector3r& moment, double before) {
        if (!falling)
            fallenBefore = 0 - sum;
        else if (gravity != lastGravity)
            fallenBefore = before + 0.5 * (gravity + lastGravity).dot(moment - lastMoment) - sum;
        falling = true;
        lastGravity = gravity;
        lastMoment = moment;
        return fallenBefore + sum;
    }

    template <class Class, class Visit> static void describe(Visit&& visit) {
        visit("falling", &Class::falling, described("Whether the work of gravity is counted already"), Hidden);
        visit("fallenBefore", &Class::fallenBefore,
              number("J", "Work of gravity less the sum of mass times present gravity times displacement"), Hidden);
        visit("lastGravity", &Class::lastGravity, number("m/s²", "Gravity in the last step"), Hidden);
        visit("lastMoment", &Class::lastMoment, number("kg m", "Sum of mass times displacement at the last step"),
              Hidden);
    }
};

} // namespace masonry
