#include "JointColumns.hpp"
#include "Vectorised.hpp"

namespace masonry {

namespace {
constexpr std::uint8_t pending = 255; // beside the values of Regime: the full law must see this subcontact
}

JointColumns::JointColumns(const JointLaw& law, const ElasticStiffness& k, std::size_t size) : k_(k) {
    for (auto* column : {&opening_, &crushing_, &dilation_, &slip_, &largestOpening_, &largestClosure_, &tensionDamage_,
                         &shearDamage_, &normalStress_, &shearStressA_, &shearStressB_, &flow_, &intact_,
                         &capStrength2_, &lostTension_, &lostShear_, &lostCompression_})
        column->assign(size, 0);
    regime_.assign(size, 0);
    const auto& p = law.properties();
    const bool cap = p.cap && !p.elastic;
    limits_ = {k.normal,
               k.shear,
               p.tensileStrength,
               p.tensileStrength / k.normal,
               p.residualCohesion,
               p.cohesion - p.residualCohesion,
               p.residualFriction,
               p.friction - p.residualFriction,
               p.capNormal,
               p.capShear,
               p.capLinear,
               cap ? law.limitClosure(k) : HUGE_VAL,
               cap};
    if (p.elastic) { // no strength is ever reached
        limits_.tensileStrength = limits_.onset = limits_.residualCohesion = HUGE_VAL;
        limits_.cohesionLoss = limits_.residualFriction = limits_.frictionLoss = 0;
    }
    for (std::size_t i = 0; i < size; ++i)
        set(law, i, JointState{});
}

JointState JointColumns::get(std::size_t i) const {
    return {
        opening_[i],        crushing_[i],      dilation_[i],    slip_[i],         largestOpening_[i],
        largestClosure_[i], tensionDamage_[i], shearDamage_[i], normalStress_[i], {shearStressA_[i], shearStressB_[i]},
        Regime(regime_[i])};
}

void JointColumns::set(const JointLaw& law, std::size_t i, const JointState& s) {
    opening_[i] = s.opening, crushing_[i] = s.crushing, dilation_[i] = s.dilation, slip_[i] = s.slip;
    largestOpening_[i] = s.largestOpening, largestClosure_[i] = s.largestClosure;
    tensionDamage_[i] = s.tensionDamage, shearDamage_[i] = s.shearDamage;
    normalStress_[i] = s.normalStress, shearStressA_[i] = s.shearStress.a, shearStressB_[i] = s.shearStress.b;
    regime_[i] = std::uint8_t(s.regime);
    flow_[i] = s.crushing - s.dilation;
    intact_[i] = 1 - JointLaw::coupled(s);
    const double strength = limits_.cap ? law.compressiveStrength(k_, s.largestClosure) : HUGE_VAL;
    capStrength2_[i] = strength * strength;
}

Energies JointColumns::takeDissipated(std::size_t i) {
    const Energies lost{lostTension_[i], lostShear_[i], lostCompression_[i]};
    lostTension_[i] = lostShear_[i] = lostCompression_[i] = 0;
    return lost;
}

// law.md §5 where no strength is passed: eqs. (6), (7), the secant of eq. (11), and the three conditions of eq. (8).
MASONRY_VECTORISED
void JointColumns::advanceIntact(const Limits& m, std::size_t count, const double* __restrict jumpN,
                                 const double* __restrict jumpA, const double* __restrict jumpB,
                                 const double* __restrict flow, const double* __restrict intact,
                                 const double* __restrict capStrength2, double* __restrict opening,
                                 double* __restrict largestOpening, double* __restrict largestClosure,
                                 double* __restrict normalStress, double* __restrict shearStressA,
                                 double* __restrict shearStressB, double* __restrict lostTension,
                                 std::uint8_t* __restrict regime) {
    const double kn = m.normalStiffness, ks = m.shearStiffness, ft = m.tensileStrength, onset = m.onset;
    const double cr = m.residualCohesion, dc = m.cohesionLoss, fr = m.residualFriction, df = m.frictionLoss;
    const double cnn = m.capNormal, css = m.capShear, cn = m.capLinear, limit = m.limitClosure;
    const bool cap = m.cap;
    for (std::size_t i = 0; i < count; ++i) {
        const double total = opening[i] + jumpN[i], before = opening[i] + flow[i], elastic = total + flow[i];
        const double whole = intact[i], farthest = largestOpening[i], closest = largestClosure[i];
        const double weakened = ft * whole / farthest, secant = weakened < kn ? weakened : kn;
        const bool open = elastic > 0;
        const double sigma = (open ? secant : kn) * elastic;
        const double a = shearStressA[i] + ks * jumpA[i], b = shearStressB[i] + ks * jumpB[i], tau2 = a * a + b * b;
        const double strength = cr + dc * whole - sigma * (fr + df * whole), slips = strength > 0 ? strength : 0;
        const double reach = whole == 1 ? onset : farthest, hardens = closest > limit ? closest : limit;
        const double crush = sigma < 0 ? cnn * sigma * sigma + css * tau2 + cn * sigma : 0;
        const double closure = sigma < 0 && cap ? -total : 0;
        const bool quick =
            (elastic <= reach) & (tau2 <= slips * slips) & (crush <= capStrength2[i]) & (closure <= hardens);
        const double lost = open | (before > 0) ? 0.5 * (normalStress[i] * elastic - sigma * before) : 0;
        lostTension[i] += quick ? lost : 0;
        opening[i] = quick ? total : opening[i];
        normalStress[i] = quick ? sigma : normalStress[i];
        shearStressA[i] = quick ? a : shearStressA[i];
        shearStressB[i] = quick ? b : shearStressB[i];
        largestOpening[i] = quick & (elastic > farthest) ? elastic : farthest;
        largestClosure[i] = quick & (closure > closest) ? closure : closest;
        regime[i] = quick ? std::uint8_t(Regime::Elastic) : pending;
    }
}

void JointColumns::advance(const JointLaw& law, std::size_t first, std::size_t count, const double* jumpN,
                           const double* jumpA, const double* jumpB) {
    advanceIntact(limits_, count, jumpN, jumpA, jumpB, &flow_[first], &intact_[first], &capStrength2_[first],
                  &opening_[first], &largestOpening_[first], &largestClosure_[first], &normalStress_[first],
                  &shearStressA_[first], &shearStressB_[first], &lostTension_[first], &regime_[first]);
    for (std::size_t n = 0; n < count; ++n) {
        const std::size_t i = first + n;
        if (regime_[i] != pending) continue;
        JointState s = get(i);
        const auto lost = law.advance(k_, s, {jumpN[n], {jumpA[n], jumpB[n]}});
        set(law, i, s);
        lostTension_[i] += lost.tension, lostShear_[i] += lost.shear, lostCompression_[i] += lost.compression;
    }
}

} // namespace masonry
