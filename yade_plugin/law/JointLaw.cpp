#include "JointLaw.hpp"
#include "common/Text.hpp"
#include <stdexcept>

namespace masonry {

namespace {

// law.md §3: the exponential that dissipates the fracture energy; without strength there is nothing to soften.
SofteningTable tableOr(const std::vector<TableRow>& rows, double strength, double stiffness, double fractureEnergy) {
    if (!rows.empty()) return SofteningTable(rows);
    if (strength == 0) return SofteningTable(SofteningTable::brittle());
    return SofteningTable(SofteningTable::exponential(strength * strength / (stiffness * fractureEnergy)));
}

} // namespace

JointLaw::JointLaw(const JointProperties& properties) : p_(properties) {
    const auto problems = p_.problems();
    if (!problems.empty())
        throw std::invalid_argument("joint \"" + p_.name +
                                    "\": " + joined(problems, ("\njoint \"" + p_.name + "\": ").c_str()));
    if (p_.elastic) return;
    tension_ = tableOr(p_.tensionTable, p_.tensileStrength, p_.normalStiffness, p_.modeIFractureEnergy);
    shear_ = tableOr(p_.shearTable, p_.cohesion, p_.shearStiffness, p_.modeIIFractureEnergy);
    if (!p_.cap) return;
    curve_ = CompressionCurve(p_.normalStiffness, p_.compressiveStrength, p_.elasticLimitRatio,
                              p_.residualStrengthRatio, p_.peakRatio, p_.compressiveFractureEnergy);
    const double smallest = std::min(curve_.elasticLimit, curve_.residual);
    smallestStrengthSquared_ = smallest * smallest;
}

JointLaw::Yield JointLaw::yield(const ElasticStiffness& k, const JointState& s) const {
    if (p_.elastic) return {-1, -1, -1};
    const double sigma = s.normalStress, tau2 = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
    Yield f{sigma - p_.tensileStrength * (1 - coupled(s)), std::sqrt(tau2) - slipStrength(s), -1};
    if (p_.cap && sigma < 0) {
        const double fc = compressiveStrength(k, s.largestClosure);
        f.cap = p_.capNormal * sigma * sigma + p_.capShear * tau2 + p_.capLinear * sigma - fc * fc;
    }
    return f;
}

JointProperties brittleCoulomb(JointProperties p) {
    p.tensionTable = p.shearTable = SofteningTable::brittle();
    p.cap = false;
    return p;
}

} // namespace masonry
