// The paper's law on subcontacts side by side in columns, with the equations that PiecewiseLaw takes for one. A marked
// function uses the vector units, and tells the same numbers as the law for one to the last bit.
#pragma once
#include "PiecewiseEquations.hpp"
#include "PiecewiseState.hpp"
#include "law/common/SofteningTable.hpp"

namespace masonry {

struct PiecewiseConsequences { // what the columns Irreversible to CapSquared hold, of one subcontact
    double irreversible = 0, intact = 0, secant = 0, reach = 0, capSquared = 0;
};

inline double normalStress(const PiecewiseEquations& e, const Columns& columns, std::size_t i, bool yielded) {
    if (!yielded) return e.kn * columns[PiecewiseColumn::Opening][i];
    const double elastic = columns[PiecewiseColumn::Opening][i] + columns[PiecewiseColumn::Irreversible][i];
    return e.stiffness(elastic, columns[PiecewiseColumn::Secant][i]) * elastic;
}

inline PiecewiseConsequences consequences(const PiecewiseEquations& e, const PiecewiseState& s) {
    const double intact = PiecewiseEquations::intact(s.tensionDamage, s.shearDamage);
    const double fc = e.cap ? e.curve.strength(s.largestClosure, e.stretch) : HUGE_VAL;
    return {s.crushing - s.dilation, intact, e.secant(intact, s.largestOpening), e.reach(intact, s.largestOpening),
            fc * fc};
}

inline void keep(const PiecewiseConsequences& c, const Columns& columns, std::size_t i) {
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

// One step of the subcontacts that stay elastic in it. The others stay as they were and are marked in `waits`; gives
// how many they are. If none of all has ever yielded, `neverYielded` is what holds for all of them, and their columns
// from Crushing on are not read; else it is null.
Mask stayElastic(const PiecewiseEquations& equations, const PiecewiseConsequences* neverYielded, const Columns& columns,
                 std::size_t at, int count, const Jumps& jumps, double* normalStress, Mask* waits);

// One step of those of the first `count` subcontacts that are marked in `waits`.
void advanceSideBySide(const PiecewiseEquations& equations, const SofteningTable& tension, const SofteningTable& shear,
                       const Columns& columns, TableRows* rows, Regime* regime, const Jumps& jumps, const Mask* waits,
                       int count, double* normalStress);

// Adds the energies of up to eight joints at a point; `yielded` tells whether one of them has ever yielded.
void addEnergies(const PiecewiseEquations& equations, const Columns& columns, std::size_t at, int count, bool yielded,
                 const double* area, LaneSums& sums);

} // namespace masonry
