// SPDX-License-Identifier: GPL-2.0-or-later
// What the paper's law remembers of a subcontact, and the columns in which that stands.
#pragma once
#include "law/common/JointState.hpp"

namespace masonry {

struct PiecewiseColumn : SharedColumn {
    enum {
        LargestOpening = SharedColumn::count, // [m]
        LargestClosure,                       // [m]
        Crushing,                             // [m]; from here on nothing is written before a subcontact nearby yields
        Dilation,                             // [m]
        Slip,                                 // [m]
        TensionDamage,                        // [-]
        ShearDamage,                          // [-]
        Intact,     // [-] what the bond has left; this and what comes below follow from the above
        Secant,     // [Pa/m] stiffness of the open subcontact
        Reach,      // [m] elastic opening up to which no damage grows and the secant stays
        CapSquared, // [Pa²] square of the cap's strength
        count
    };
    static constexpr int of(Role role) {
        return role == Role::BondDamage       ? int(TensionDamage)
               : role == Role::LargestOpening ? int(LargestOpening)
                                              : int(LargestClosure);
    }
};

struct PiecewiseState : JointState {
    double crushing = 0;       // [m] up, plastic closure, >= 0
    double dilation = 0;       // [m] ud, dilatant opening, >= 0
    double slip = 0;           // [m] s, accumulated plastic slip, >= 0
    double largestOpening = 0; // [m] of the elastic opening
    double largestClosure = 0; // [m] of the total closure; of the cyclic law kappa, which counts slip on the cap, too
    double tensionDamage = 0;  // [-] d_t
    double shearDamage = 0;    // [-] d_s

    template <class State, class Visit> static void visitNumbers(State& s, Visit&& visit) {
        JointState::visitNumbers(s, visit);
        visit("largestOpening", s.largestOpening, PiecewiseColumn::LargestOpening);
        visit("largestClosure", s.largestClosure, PiecewiseColumn::LargestClosure);
        visit("crushing", s.crushing, PiecewiseColumn::Crushing);
        visit("dilation", s.dilation, PiecewiseColumn::Dilation);
        visit("slip", s.slip, PiecewiseColumn::Slip);
        visit("tensionDamage", s.tensionDamage, PiecewiseColumn::TensionDamage);
        visit("shearDamage", s.shearDamage, PiecewiseColumn::ShearDamage);
    }
};

} // namespace masonry
