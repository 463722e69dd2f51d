// The states of joints that follow the cyclic law, and what ColumnsWith needs of it.
#pragma once
#include "CyclicLaw.hpp"
#include "law/ColumnsWith.hpp"
#include "law/piecewise_softening/SideBySide.hpp"

namespace masonry {

struct CyclicConsequences { // what the columns hold that follow from a state
    double irreversible, intact, secant, reach, strength, shearing, closing, squaredHardening;
};

inline double normalStress(const CyclicEquations& e, const Columns& columns, std::size_t i, bool yielded) {
    const double opening = columns[Columns::Opening][i];
    if (!yielded) return e.normal(opening, e.kn, e.kn);
    return e.normal(opening + columns[Columns::Irreversible][i], columns[Columns::Secant][i],
                    columns[Columns::ClosingStiffness][i]);
}

inline CyclicConsequences consequences(const CyclicEquations& e, const JointState& s) {
    const double fc = e.cap ? e.curve.strength(s.largestClosure, e.stretch) : HUGE_VAL;
    const double intact = Equations::intact(s.tensionDamage, s.shearDamage) * e.leftByCrushing(s.largestClosure, fc);
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

inline void keep(const CyclicConsequences& c, const Columns& columns, std::size_t i) {
    columns[Columns::Irreversible][i] = c.irreversible;
    columns[Columns::Intact][i] = c.intact;
    columns[Columns::Secant][i] = c.secant;
    columns[Columns::Reach][i] = c.reach;
    columns[Columns::CapSquared][i] = c.strength * c.strength;
    columns[Columns::ShearStiffness][i] = c.shearing;
    columns[Columns::ClosingStiffness][i] = c.closing;
    columns[Columns::SquaredHardening][i] = c.squaredHardening;
}

inline bool neverYielded(const CyclicEquations& e, const JointState& s) {
    const bool whole = s.crushing == 0 && s.dilation == 0 && s.slip == 0 && s.tensionDamage == 0 &&
                       s.shearDamage == 0 && s.shearSoftening == 0 && s.shearStiffnessLoss == 0;
    return whole && s.largestOpening <= e.reach(1.0, 0.0) && s.largestClosure == 0;
}

inline void write(const CyclicEquations& e, const Columns& columns, std::size_t i, const JointState& s) {
    write(static_cast<const Equations&>(e), columns, i, s);
    columns[Columns::PlasticSlipA][i] = s.plasticSlip.a;
    columns[Columns::PlasticSlipB][i] = s.plasticSlip.b;
    columns[Columns::ShearSoftening][i] = s.shearSoftening;
    columns[Columns::ShearStiffnessLoss][i] = s.shearStiffnessLoss;
    columns[Columns::CapDisplacement][i] = s.capDisplacement;
}

inline void read(const CyclicEquations& e, const Columns& columns, std::size_t i, JointState& s) {
    read(static_cast<const Equations&>(e), columns, i, s);
    s.plasticSlip = {columns[Columns::PlasticSlipA][i], columns[Columns::PlasticSlipB][i]};
    s.shearSoftening = columns[Columns::ShearSoftening][i];
    s.shearStiffnessLoss = columns[Columns::ShearStiffnessLoss][i];
    s.capDisplacement = columns[Columns::CapDisplacement][i];
}

// See piecewise_softening/SideBySide.hpp.
Mask stayElastic(const CyclicEquations& equations, const CyclicConsequences* neverYielded, const Columns& columns,
                 std::size_t at, int count, const Jumps& jumps, double* normalStress, Mask* waits);
void advanceSideBySide(const CyclicEquations& equations, const SofteningTable& tension, const SofteningTable& shear,
                       const Columns& columns, TableRows* rows, Regime* regime, const Jumps& jumps, const Mask* waits,
                       int count, double* normalStress);
void addEnergies(const CyclicEquations& equations, const Columns& columns, std::size_t at, int count, bool yielded,
                 const double* area, LaneSums& sums);

using CyclicColumns = ColumnsWith<CyclicLaw>;

} // namespace masonry
