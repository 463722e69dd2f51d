// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law on subcontacts side by side in columns: what ColumnsSideBySide needs of it.
#pragma once
#include "CyclicEquations.hpp"
#include "CyclicState.hpp"
#include "law/common/SofteningTable.hpp"
#include "law/piecewise_softening/PiecewiseSideBySide.hpp"

namespace masonry {

struct CyclicDerived { // what the columns hold that follow from a state
    double irreversible, intact, secant, reach, strength, shearing, closing, squaredHardening;
};

inline double normalStress(const CyclicEquations& e, const Columns& columns, std::size_t i, bool yielded) {
    const double opening = columns[CyclicColumn::Opening][i];
    if (!yielded) return e.normal(opening, e.kn, e.kn);
    return e.normal(opening + columns[CyclicColumn::Irreversible][i], columns[CyclicColumn::Secant][i],
                    columns[CyclicColumn::ClosingStiffness][i]);
}

inline CyclicDerived derive(const CyclicEquations& e, const CyclicState& s) {
    const double fc = e.cap ? e.curve.strength(s.largestClosure, e.stretch) : HUGE_VAL;
    const double intact =
        PiecewiseEquations::intact(s.tensionDamage, s.shearDamage) * e.remainingByCrushing(s.largestClosure, fc);
    const double closing = e.closingStiffness(s.largestClosure, fc);
    return {s.crushing - s.dilation,
            intact,
            e.opened(intact, s.largestOpening, closing),
            e.reach(intact, s.largestOpening),
            fc,
            e.shearStiffness(s.shearStiffnessLoss),
            closing,
            e.cap ? e.squaredHardening(s.largestClosure, s.capDisplacement) : HUGE_VAL};
}

inline void keep(const CyclicDerived& c, const Columns& columns, std::size_t i) {
    columns[CyclicColumn::Irreversible][i] = c.irreversible;
    columns[CyclicColumn::Intact][i] = c.intact;
    columns[CyclicColumn::Secant][i] = c.secant;
    columns[CyclicColumn::Reach][i] = c.reach;
    columns[CyclicColumn::CapSquared][i] = c.strength * c.strength;
    columns[CyclicColumn::ShearStiffness][i] = c.shearing;
    columns[CyclicColumn::ClosingStiffness][i] = c.closing;
    columns[CyclicColumn::SquaredHardening][i] = c.squaredHardening;
}

inline bool neverYielded(const CyclicEquations& e, const CyclicState& s) {
    const bool whole = s.crushing == 0 && s.dilation == 0 && s.slip == 0 && s.tensionDamage == 0 &&
                       s.shearDamage == 0 && s.shearSoftening == 0 && s.shearStiffnessLoss == 0;
    return whole && s.largestOpening <= e.reach(1.0, 0.0) && s.largestClosure == 0;
}

// See piecewise_softening/PiecewiseSideBySide.hpp. A joint that closes on a curve is not linear.
inline bool isLinear(const CyclicEquations& e) { return !e.curved; }
void markYielding(const CyclicEquations& equations, const CyclicDerived& neverYielded, int count, const double* opening,
                  const double* slideA, const double* slideB, Mask* yielding);
void rememberElastic(const CyclicEquations& equations, const Columns& columns, int count, const double* opening);
Waiting stayElastic(const CyclicEquations& equations, const CyclicDerived* neverYielded, const SideBySide& all);
// Open subcontacts have no short step here.
inline Mask slideOpen(const CyclicEquations&, const SofteningTable&, const SofteningTable&, const SideBySide&) {
    return 0;
}
void advanceSideBySide(const CyclicEquations& equations, const SofteningTable& tension, const SofteningTable& shear,
                       TableRows* rows, const SideBySide& all);
void addEnergies(const CyclicEquations& equations, const Columns& columns, int count, bool yielded, const double* area,
                 LaneSums& sums);

} // namespace masonry
