#include "JointColumns.hpp"
#include "common/Text.hpp"
#include <functional>
#include <stdexcept>

namespace masonry {

namespace {

SofteningTable tableOr(const std::vector<TableRow>& rows, double strength, double stiffness, double fractureEnergy) {
    return SofteningTable(rows.empty() ? SofteningTable::exponentialOf(strength, stiffness, fractureEnergy) : rows);
}

// A length that is at most this one and an energy that is at least this one, in four digits.
double inFourDigits(double value, double (*rounded)(double)) {
    const double digit = std::pow(10, std::floor(std::log10(value)) - 3);
    return rounded(value / digit) * digit;
}
std::string atMost(double value) { return text(inFourDigits(value * (1 - 1e-9), std::floor)); }
std::string atLeast(double value) { return text(inFourDigits(value * (1 + 1e-9), std::ceil)); }

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

Yield JointLaw::yield(const ElasticStiffness& k, const JointState& s) const {
    if (p_.elastic) return {-1, -1, -1};
    const Equations e = equations(k);
    const double intact = Equations::intact(s.tensionDamage, s.shearDamage);
    const double tauSquared = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
    const double elasticOpening = s.opening + (s.crushing - s.dilation);
    Yield f{s.normalStress - e.ft * intact,
            std::sqrt(tauSquared) - e.slipStrength(intact, s.normalStress, elasticOpening), -1};
    if (e.cap) {
        const double fc = e.curve.strength(s.largestClosure, e.stretch);
        f.cap = e.capStress(s.normalStress, tauSquared) - fc * fc;
    }
    return f;
}

std::unique_ptr<LawColumns> JointLaw::columns(const ElasticStiffness& k, int joints, int points) const {
    return std::make_unique<JointColumns>(std::static_pointer_cast<const JointLaw>(shared_from_this()), k, joints,
                                          points);
}

std::vector<std::string> JointLaw::snapsBack(const ElasticStiffness& k, double distance) const {
    std::vector<std::string> found;
    if (p_.elastic) return found;
    const Equations e = equations(k);
    // `excess` is the slope of the softening branch over the stiffness of the units, `remedy` what gives 1 less of it.
    const auto check = [&](const char* mode, double excess, const std::function<std::string()>& remedy) {
        if (excess < 1) return;
        found.push_back(std::string("softening in ") + mode +
                        " would snap back between rigid units whose centroids are " + text(distance) +
                        " m apart: at most " + atMost(distance / excess) + " m work with these units, " + remedy() +
                        " helps, too");
    };
    const auto checkBond = [&](const char* mode, const SofteningTable& table, bool given, double shift, double strength,
                               double stiffness, const char* named, double energy) {
        const double excess = shift * table.steepest();
        check(mode, excess, [&] {
            if (given) return "a table whose damage grows by less than " + atMost(1 / shift) + " per unit of the ratio";
            const double enough = SofteningTable::fractureEnergyOf(strength, stiffness, energy, excess);
            return std::string(named) + " of at least " + atLeast(enough) + " J/m²";
        });
    };
    checkBond("tension", tension_, !p_.tensionTable.empty(), e.normalShift, p_.tensileStrength, p_.normalStiffness,
              "a mode I fracture energy", p_.modeIFractureEnergy);
    checkBond("shear", shear_, !p_.shearTable.empty(), e.shearShift, p_.cohesion, p_.shearStiffness,
              "a mode II fracture energy", p_.modeIIFractureEnergy);
    if (e.cap) {
        const double excess = e.stretch * e.curve.steepest();
        check("compression", excess, [&] {
            return "a compressive fracture energy of at least " + atLeast(e.curve.fractureEnergyOf(excess)) + " J/m²";
        });
    }
    return found;
}

JointProperties brittleCoulomb(JointProperties p) {
    p.tensionTable = SofteningTable::brittle();
    p.shearTable = SofteningTable::brittle();
    p.cap = false;
    return p;
}

} // namespace masonry
