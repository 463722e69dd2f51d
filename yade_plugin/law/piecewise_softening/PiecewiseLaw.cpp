// SPDX-License-Identifier: GPL-2.0-or-later
#include "PiecewiseLaw.hpp"
#include "PiecewiseSideBySide.hpp"
#include "common/Text.hpp"
#include "law/common/ColumnsSideBySide.hpp"
#include <functional>
#include <set>

namespace masonry {

namespace {

using Problems = std::vector<Problem>;

// A bound that is another property.
void checkAtMost(Problems& found, const char* property, double value, const char* unit, double bound) {
    if (std::isfinite(value) && value >= 0 && bound >= 0 && value > bound)
        found.push_back(about(property, text(value) + unit + " must be at most " + text(bound)));
}

// The ratios of an exponential table reach 1 + 12/decay: numbers must hold them.
void checkExponential(Problems& found, const char* mode, double strength, double stiffness, double energy) {
    const double decay = strength * strength / (stiffness * energy);
    if (strength > 0 && stiffness > 0 && energy > 0 && !(decay > 1e-300 && decay < 1e300))
        found.push_back({std::string(mode) + "FractureEnergy", inWords(mode) + " strength " + text(strength) +
                                                                   " Pa, stiffness " + text(stiffness) +
                                                                   " Pa/m and fracture energy " + text(energy) +
                                                                   " J/m² are too far apart for an exponential table"});
}

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

bool PiecewiseLaw::reads(const std::string& property) {
    static const std::set<std::string> all{"tensileStrength",
                                           "modeIFractureEnergy",
                                           "tensionTable",
                                           "cohesion",
                                           "residualCohesion",
                                           "friction",
                                           "residualFriction",
                                           "dilatancy",
                                           "dilatancyDecay",
                                           "modeIIFractureEnergy",
                                           "shearTable",
                                           "cap",
                                           "compressiveStrength",
                                           "elasticLimitRatio",
                                           "residualStrengthRatio",
                                           "peakRatio",
                                           "compressiveFractureEnergy",
                                           "capNormal",
                                           "capShear",
                                           "capLinear",
                                           "restitution"};
    return all.count(property) > 0;
}

std::vector<Problem> PiecewiseLaw::problems(const JointProperties& p, bool (*reads)(const std::string&)) {
    const std::set<std::string> ofCap{"compressiveStrength",
                                      "elasticLimitRatio",
                                      "residualStrengthRatio",
                                      "peakRatio",
                                      "capNormal",
                                      "capShear",
                                      "capLinear",
                                      "compressiveFractureEnergy"};
    Problems found = p.outOfBounds([&](const std::string& property) {
        if (property == "modeIFractureEnergy" && !p.tensionTable.empty()) return false;
        if (property == "modeIIFractureEnergy" && !p.shearTable.empty()) return false;
        return reads(property) && (p.cap || !ofCap.count(property));
    });
    if (p.elastic) return found;

    checkAtMost(found, "residualCohesion", p.residualCohesion, " Pa", p.cohesion);
    checkAtMost(found, "residualFriction", p.residualFriction, "", p.friction);
    checkAtMost(found, "dilatancy", p.dilatancy, "", p.residualFriction);
    if (p.cohesion >= 0 && p.tensileStrength * p.friction > p.cohesion * (1 + 1e-12))
        found.push_back(about("tensileStrength", text(p.tensileStrength) +
                                                     " Pa is above the apex of the Coulomb cone, " +
                                                     "cohesion/friction = " + text(p.cohesion / p.friction) + " Pa"));
    if (p.tensionTable.empty())
        checkExponential(found, "modeI", p.tensileStrength, p.normalStiffness, p.modeIFractureEnergy);
    if (p.shearTable.empty()) {
        if (p.cohesion == 0 && p.friction > p.residualFriction)
            found.push_back(
                about("friction",
                      "softens from " + text(p.friction) + " to " + text(p.residualFriction) +
                          " without cohesion: give a shear table, no exponential one follows from zero cohesion"));
        checkExponential(found, "modeII", p.cohesion, p.shearStiffness, p.modeIIFractureEnergy);
    }

    const bool capIsBounded = p.normalStiffness > 0 && p.outOfBounds([&](const std::string& property) {
                                                            return ofCap.count(property) > 0;
                                                        }).empty();
    if (!p.cap || !capIsBounded) return found;
    const double smallest = CompressionCurve::smallestFractureEnergy(
        p.normalStiffness, p.compressiveStrength, p.elasticLimitRatio, p.residualStrengthRatio, p.peakRatio);
    const double without = CompressionCurve::smallestFractureEnergy(p.normalStiffness, p.compressiveStrength,
                                                                    p.elasticLimitRatio, p.residualStrengthRatio, 0);
    const double largest = p.peakRatio * (p.compressiveFractureEnergy - without) / (smallest - without);
    if (!(p.compressiveFractureEnergy > smallest)) // eq. (24): m <= 1 has no meaning
        found.push_back(about(
            "compressiveFractureEnergy",
            text(p.compressiveFractureEnergy) + " J/m² is too small for peak ratio " + text(p.peakRatio) +
                " (needs at least " + text(std::ceil(smallest)) + " J/m², more between rigid units" +
                (largest < 1 ? "" : ", or a peak ratio of at most " + text(std::floor(100 * largest) / 100)) + ")",
            "smallEnergy"));
    return found;
}

PiecewiseLaw::PiecewiseLaw(const JointProperties& p, const Problems& problems) : Law(p, problems) {
    own_.ownKn = p.normalStiffness;
    own_.ownKs = p.shearStiffness;
    own_.ft = HUGE_VAL; // of an elastic joint
    if (!p.elastic) {
        own_.ft = p.tensileStrength;
        own_.cp = p.cohesion;
        own_.cr = p.residualCohesion;
        own_.tanPhiP = p.friction;
        own_.tanPhiR = p.residualFriction;
        own_.tanPsi = p.dilatancy;
        own_.delta = p.dilatancyDecay;
        tension_ = tableOr(p.tensionTable, p.tensileStrength, p.normalStiffness, p.modeIFractureEnergy);
        shear_ = tableOr(p.shearTable, p.cohesion, p.shearStiffness, p.modeIIFractureEnergy);
    }
    if (!p.elastic && p.cap) {
        own_.cap = true;
        own_.Cnn = p.capNormal;
        own_.Css = p.capShear;
        own_.Cn = p.capLinear;
        own_.curve = CompressionCurve(p.normalStiffness, p.compressiveStrength, p.elasticLimitRatio,
                                      p.residualStrengthRatio, p.peakRatio, p.compressiveFractureEnergy);
        const double smallest = std::min(own_.curve.elasticLimit, own_.curve.residual);
        own_.smallestFcSquared = smallest * smallest;
    }
    own_ = equations({p.normalStiffness, p.shearStiffness});
}

Yield PiecewiseLaw::yield(const ElasticStiffness& k, const PiecewiseState& s) const {
    const PiecewiseEquations e = equations(k);
    const double intact = PiecewiseEquations::intact(s.tensionDamage, s.shearDamage);
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

Yield PiecewiseLaw::relative(const Yield& f, const ElasticStiffness& k, const PiecewiseState& s) const {
    const auto& p = properties();
    const double sigma = std::abs(s.normalStress), tau = std::hypot(s.shearStress.a, s.shearStress.b);
    const double elastic = k.normal * (s.largestOpening + s.largestClosure) + k.shear * s.slip;
    const double quadratic =
        p.capNormal * sigma * (sigma + elastic) + p.capShear * tau * (tau + elastic) + std::abs(f.cap);
    const auto share = [](double value, double size) { return value == -1 ? -1 : size > 0 ? value / size : 0; };
    return {share(f.tension, sigma + p.tensileStrength + elastic),
            share(f.slip, tau + sigma * p.friction + p.cohesion + elastic),
            share(f.cap, quadratic + std::abs(p.capLinear) * sigma)};
}

std::unique_ptr<LawColumns> PiecewiseLaw::columns(const ElasticStiffness& k, int joints, int points) const {
    return std::make_unique<ColumnsSideBySide<PiecewiseLaw>>(
        std::static_pointer_cast<const PiecewiseLaw>(shared_from_this()), k, joints, points);
}

std::vector<std::string> PiecewiseLaw::snapsBack(const ElasticStiffness& k, double distance) const {
    std::vector<std::string> found;
    const auto& p = properties();
    if (p.elastic) return found;
    const PiecewiseEquations e = equations(k);
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
    checkBond("tension", tension_, !p.tensionTable.empty(), e.normalShift, p.tensileStrength, p.normalStiffness,
              "a mode I fracture energy", p.modeIFractureEnergy);
    checkBond("shear", shear_, !p.shearTable.empty(), e.shearShift, p.cohesion, p.shearStiffness,
              "a mode II fracture energy", p.modeIIFractureEnergy);
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
