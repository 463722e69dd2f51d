// SPDX-License-Identifier: GPL-2.0-or-later
// The attributes of an engine that keeps the energies of rigid bodies.
#pragma once
#include "common/Property.hpp"
#include "motion/EnergyLedger.hpp"

namespace masonry {

template <class Class, class Visit> void ledgerOfBodies(Visit&& visit) {
    visit("external", &Class::external,
          number("J", "Work of prescribed motions and of YADE's own engines so far, without that of loads; in the "
                      "energy balance also the kinetic energy present at the first step and at given()"),
          ReadOnly);
    visit("damped", &Class::damped, number("J", "Energy taken by damping so far"), ReadOnly);
    visit("kinetic", &Class::kinetic, number("J", "Kinetic energy"), ReadOnly);
    visit("fallen", &Class::fallen, number("J", "Work of gravity since the first step"), ReadOnly);
    visit("pendingExternal", &Class::pendingExternal, number("J", "External work of the last step"), Hidden);
    visit("pendingDamped", &Class::pendingDamped, number("J", "Damping of the last step"), Hidden);
}

} // namespace masonry
