// SPDX-License-Identifier: GPL-2.0-or-later
// What any joint law knows of a subcontact, is given and answers in a step. Opening and tension are positive.
#pragma once
#include "Columns.hpp"
#include <cstdint>

namespace masonry {

struct Shear { // a vector in the joint plane
    double a = 0, b = 0;
};

struct Jump { // increment of the displacement jump in a step [m]
    double opening = 0;
    Shear slide;
};

enum class Regime : std::int8_t { Elastic, Opening, Slipping, Crushing }; // what acted in the last step

// Subcontacts side by side that make a step together.
struct SideBySide {
    Columns columns; // which begin with the first of them
    Jumps jumps;
    Regime* regime;
    Mask* pending; // 1 where the step is still to be made, else 0
    int count;     // at most Columns::most
    double* normalStress;

    SideBySide part(int from, int beyond) const {
        return {columns.from(from), {jumps.opening + from, jumps.slideA + from, jumps.slideB + from, jumps.plane},
                regime + from,      pending + from,
                beyond - from,      normalStress + from};
    }
};

// The state of a law derives from this one and adds what the law remembers.
struct JointState {
    double opening = 0;      // [m] un, total, positive open
    double normalStress = 0; // [Pa] sigma; follows from the other numbers, so that no column or file holds it
    Shear shearStress;       // [Pa] tau
    Regime regime = Regime::Elastic;

    // Calls visit(name, number, column) for every number of a state that is kept.
    template <class State, class Visit> static void visitNumbers(State& s, Visit&& visit) {
        visit("opening", s.opening, SharedColumn::Opening);
        visit("shearStressA", s.shearStress.a, SharedColumn::ShearStressA);
        visit("shearStressB", s.shearStress.b, SharedColumn::ShearStressB);
    }
};

struct Energies { // [J/m²] by mode; what a step dissipates is its work less the stored energy, so that a balance closes
    double tension = 0, shear = 0, compression = 0;
};

// The yield functions of a law at a state, each over the size of its terms [-]: at most zero but for round-off after
// every step. A function that does not apply is -1.
struct Yield {
    double tension = -1, slip = -1, cap = -1;
};

} // namespace masonry
