// SPDX-License-Identifier: GPL-2.0-or-later
// What the cyclic law remembers of a subcontact beside what the paper's law does, and the columns in which that stands.
#pragma once
#include "law/piecewise_softening/PiecewiseState.hpp"

namespace masonry {

struct CyclicColumn : PiecewiseColumn {
    enum {
        PlasticSlipA = PiecewiseColumn::count, // [m]
        PlasticSlipB,                          // [m]
        ShearSoftening,                        // [-]
        ShearStiffnessLoss,                    // [-]
        CapDisplacement,                       // [m]
        ShearStiffness,   // [Pa/m] of the subcontact; this and what comes below follow from the above
        ClosingStiffness, // [Pa/m] of the closed subcontact
        SquaredHardening, // [m²] square of the elastic displacement at which the cap hardens further
        count
    };
};

struct CyclicState : PiecewiseState {
    Shear plasticSlip;             // [m] p, plastic slip as a vector
    double shearSoftening = 0;     // [-] r, displacement ratio of the shear table less 1
    double shearStiffnessLoss = 0; // [-] omega
    double capDisplacement = 0;    // [m] pi, accumulated plastic displacement on the cap

    template <class State, class Visit> static void visitNumbers(State& s, Visit&& visit) {
        PiecewiseState::visitNumbers(s, visit);
        visit("plasticSlipA", s.plasticSlip.a, CyclicColumn::PlasticSlipA);
        visit("plasticSlipB", s.plasticSlip.b, CyclicColumn::PlasticSlipB);
        visit("shearSoftening", s.shearSoftening, CyclicColumn::ShearSoftening);
        visit("shearStiffnessLoss", s.shearStiffnessLoss, CyclicColumn::ShearStiffnessLoss);
        visit("capDisplacement", s.capDisplacement, CyclicColumn::CapDisplacement);
    }
};

} // namespace masonry
