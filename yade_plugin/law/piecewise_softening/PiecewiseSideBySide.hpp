// SPDX-License-Identifier: GPL-2.0-or-later
// The paper's law on subcontacts side by side in columns, with the equations of PiecewiseLaw and the same numbers to
// the last bit.
//
// So the order of a step stands twice: in PiecewiseLaw::advance, and here in passes over a batch of up to 32. Written
// once for packs, as the step of the cyclic law is, it took 18 % to 53 % longer where most subcontacts yield: a step is
// one chain of divisions and roots, and a pack waits for each of them, while a pass calculates with the next pack
// meanwhile. The step of the cyclic law has so many cases that passes over all of them would cost more.
#pragma once
#include "PiecewiseEquations.hpp"
#include "PiecewiseState.hpp"
#include "law/common/SofteningTable.hpp"

namespace masonry {

struct PiecewiseDerived { // what the columns Irreversible to CapSquared hold, of one subcontact
    double irreversible = 0, intact = 0, secant = 0, reach = 0, capSquared = 0;
};

inline double normalStress(const PiecewiseEquations& e, const Columns& columns, std::size_t i, bool yielded) {
    if (!yielded) return e.kn * columns[PiecewiseColumn::Opening][i];
    const double elastic = columns[PiecewiseColumn::Opening][i] + columns[PiecewiseColumn::Irreversible][i];
    return e.stiffness(elastic, columns[PiecewiseColumn::Secant][i]) * elastic;
}

inline PiecewiseDerived derive(const PiecewiseEquations& e, const PiecewiseState& s) {
    const double intact = PiecewiseEquations::intact(s.tensionDamage, s.shearDamage);
    const double fc = e.cap ? e.curve.strength(s.largestClosure, e.stretch) : HUGE_VAL;
    return {s.crushing - s.dilation, intact, e.secant(intact, s.largestOpening), e.reach(intact, s.largestOpening),
            fc * fc};
}

inline void keep(const PiecewiseDerived& c, const Columns& columns, std::size_t i) {
    columns[PiecewiseColumn::Irreversible][i] = c.irreversible;
    columns[PiecewiseColumn::Intact][i] = c.intact;
    columns[PiecewiseColumn::Secant][i] = c.secant;
    columns[PiecewiseColumn::Reach][i] = c.reach;
    columns[PiecewiseColumn::CapSquared][i] = c.capSquared;
}

inline bool neverYielded(const PiecewiseEquations& e, const PiecewiseState& s) {
    const bool whole = s.crushing == 0 && s.dilation == 0 && s.slip == 0 && s.tensionDamage == 0 && s.shearDamage == 0;
    const double limit = e.cap ? e.curve.limit(e.stretch) : HUGE_VAL;
    return whole && s.largestOpening <= e.reach(1.0, 0.0) && s.largestClosure <= limit;
}

// Of subcontacts that never yielded. With a linear term of the cap above zero, a tensile stress takes more of the cap
// than a small pressure does, and the domain is not convex.
inline bool isLinear(const PiecewiseEquations&) { return true; }
inline bool hasConvexDomain(const PiecewiseEquations& e) { return !e.cap || e.Cn <= 0; }

// Joints cease to be intact so little before they yield [-]. Rounding then cannot let one yield before.
constexpr double marginOfIntact = 1e-9;

// See LawColumns::findYielding() and LawColumns::remember().
void markYielding(const PiecewiseEquations& equations, const PiecewiseDerived& neverYielded, int count,
                  const double* opening, const double* slideA, const double* slideB, Mask* yielding);
void rememberElastic(const PiecewiseEquations& equations, const Columns& columns, int count, const double* opening);

// One step of the subcontacts that stay elastic in it. The others stay as they were and become pending. If none of all
// has ever yielded, `neverYielded` is what holds for all of them, and their columns from Crushing on are not read; else
// it is null.
Waiting stayElastic(const PiecewiseEquations& equations, const PiecewiseDerived* neverYielded, const SideBySide& all);

// One step of the pending subcontacts that are open before and after it, carry nothing but round-off and take no more
// damage: most of those that yield where joints are dry. Their steps are the same as by advanceSideBySide() in a small
// part of its time. They are pending no more; gives how many they are.
Mask slideOpen(const PiecewiseEquations& equations, const SofteningTable& tension, const SofteningTable& shear,
               const SideBySide& all);

// One step of the pending subcontacts.
void advanceSideBySide(const PiecewiseEquations& equations, const SofteningTable& tension, const SofteningTable& shear,
                       TableRows* rows, const SideBySide& all);

// Adds the energies of up to eight joints at a point; `yielded` tells whether one of them has ever yielded.
void addEnergies(const PiecewiseEquations& equations, const Columns& columns, int count, bool yielded,
                 const double* area, LaneSums& sums);

} // namespace masonry
