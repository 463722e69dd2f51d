#include "JointLaw.hpp"
#include "common/Text.hpp"
#include <stdexcept>

namespace masonry {

namespace {

// The exponential table that dissipates the fracture energy; without strength there is nothing to soften.
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
    own_.ownKn = p_.normalStiffness;
    own_.ownKs = p_.shearStiffness;
    own_.elastic = p_.elastic;
    own_.ft = HUGE_VAL; // of an elastic joint
    if (!p_.elastic) {
        own_.ft = p_.tensileStrength;
        own_.cp = p_.cohesion;
        own_.cr = p_.residualCohesion;
        own_.tanPhiP = p_.friction;
        own_.tanPhiR = p_.residualFriction;
        own_.tanPsi = p_.dilatancy;
        own_.delta = p_.dilatancyDecay;
        tension_ = tableOr(p_.tensionTable, p_.tensileStrength, p_.normalStiffness, p_.modeIFractureEnergy);
        shear_ = tableOr(p_.shearTable, p_.cohesion, p_.shearStiffness, p_.modeIIFractureEnergy);
    }
    if (!p_.elastic && p_.cap) {
        own_.cap = true;
        own_.Cnn = p_.capNormal;
        own_.Css = p_.capShear;
        own_.Cn = p_.capLinear;
        own_.curve = CompressionCurve(p_.normalStiffness, p_.compressiveStrength, p_.elasticLimitRatio,
                                      p_.residualStrengthRatio, p_.peakRatio, p_.compressiveFractureEnergy);
        const double smallest = std::min(own_.curve.elasticLimit, own_.curve.residual);
        own_.smallestFcSquared = smallest * smallest;
    }
    own_ = equations({p_.normalStiffness, p_.shearStiffness});
}

JointLaw::Yield JointLaw::yield(const ElasticStiffness& k, const JointState& s) const {
    if (p_.elastic) return {-1, -1, -1};
    const Equations e = equations(k);
    const double intact = Equations::intact(s.tensionDamage, s.shearDamage);
    const double tauSquared = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
    Yield f{s.normalStress - e.ft * intact, std::sqrt(tauSquared) - e.slipStrength(intact, s.normalStress), -1};
    if (e.cap && s.normalStress < 0) {
        const double fc = e.curve.strength(s.largestClosure, e.stretch);
        f.cap = e.capStress(s.normalStress, tauSquared) - fc * fc;
    }
    return f;
}

JointProperties brittleCoulomb(JointProperties p) {
    p.tensionTable = SofteningTable::brittle();
    p.shearTable = SofteningTable::brittle();
    p.cap = false;
    return p;
}

} // namespace masonry
