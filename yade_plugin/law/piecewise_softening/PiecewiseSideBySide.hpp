// SPDX-License-Identifier: GPL-2.0-or-later
// The paper's law on subcontacts side by side in columns, with the equations that PiecewiseLaw takes for one. A marked
// function uses the vector units, and tells the same numbers as the law for one to the last bit.
//
// So the order of a step stands twice: in PiecewiseLaw::advance for one subcontact, and here in passes over a batch of
// up to 32. Written once for packs of four or eight, as the step of the cyclic law is, it gives the same bits in 250
// lines less. But where most subcontacts yield, such a step took 18 % (slip), 24 % (opening), 25 % (dilatancy) and 53 %
// (crushing) longer with AVX2. The profile shows why: a step is one chain of divisions and roots, each of which needs
// the result of the one before, and a pack waits for each of them. A pass over a batch has eight packs at hand that do
// not depend on each other, and calculates with the next one meanwhile. Two packs at a time took longer still: their
// numbers do not fit into the registers. The cyclic law waits likewise, but its step has so many cases that passes over
// all of them would cost more.
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
void rememberElastic(const PiecewiseEquations& equations, const Columns& columns, std::size_t at, int count,
                     const double* opening);

// One step of the subcontacts that stay elastic in it. The others stay as they were and are marked in `pending`. If
// none of all has ever yielded, `neverYielded` is what holds for all of them, and their columns from Crushing on are
// not read; else it is null.
Waiting stayElastic(const PiecewiseEquations& equations, const PiecewiseDerived* neverYielded, const Columns& columns,
                    std::size_t at, int count, const Jumps& jumps, double* normalStress, Mask* pending);

// One step of those of the subcontacts marked in `pending` that are open before and after it, carry nothing but
// round-off and take no more damage: most of those that yield where joints are dry. Their steps are the same as by
// advanceSideBySide() below in a small part of its time. They are taken out of `pending`; gives how many they are.
Mask slideOpen(const PiecewiseEquations& equations, const SofteningTable& tension, const SofteningTable& shear,
               const Columns& columns, Regime* regime, const Jumps& jumps, Mask* pending, int count,
               double* normalStress);

// One step of those of the first `count` subcontacts that are marked in `pending`.
void advanceSideBySide(const PiecewiseEquations& equations, const SofteningTable& tension, const SofteningTable& shear,
                       const Columns& columns, TableRows* rows, Regime* regime, const Jumps& jumps, const Mask* pending,
                       int count, double* normalStress);

// Adds the energies of up to eight joints at a point; `yielded` tells whether one of them has ever yielded.
void addEnergies(const PiecewiseEquations& equations, const Columns& columns, std::size_t at, int count, bool yielded,
                 const double* area, LaneSums& sums);

} // namespace masonry
