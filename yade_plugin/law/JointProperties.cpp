#include "JointProperties.hpp"
#include "CompressionCurve.hpp"
#include "common/Text.hpp"
#include <cmath>
#include <type_traits>

namespace masonry {

namespace {

using Problems = std::vector<std::string>;

// A bound that is another property.
void checkAtMost(Problems& found, const char* what, double value, const char* unit, double bound) {
    if (std::isfinite(value) && value >= 0 && bound >= 0 && value > bound)
        found.push_back(std::string(what) + " " + text(value) + unit + " must be at most " + text(bound));
}

void checkTable(Problems& found, const std::string& what, const std::vector<TableRow>& rows) {
    if (rows.empty()) return;
    for (const auto& problem : SofteningTable::problems(rows))
        found.push_back(what + ", " + problem);
}

// The ratios of an exponential table reach 1 + 12/decay: numbers must hold them.
void checkExponential(Problems& found, const char* mode, double strength, double stiffness, double energy) {
    const double decay = strength * strength / (stiffness * energy);
    if (strength > 0 && stiffness > 0 && energy > 0 && !(decay > 1e-300 && decay < 1e300))
        found.push_back(std::string(mode) + " strength " + text(strength) + " Pa, stiffness " + text(stiffness) +
                        " Pa/m and fracture energy " + text(energy) +
                        " J/m² are too far apart for an exponential table");
}

} // namespace

std::vector<std::string> JointProperties::problems() const {
    using P = JointProperties;
    Problems found;
    if (name.empty()) found.push_back("name must not be empty");
    bool acts = true;
    bool capIsBounded = false; // whether all numbers of the cap are within their own bounds
    bool isCyclic = false;     // whether the visit has come to the properties of the cyclic law
    describe([&](const char* called, auto member, const Property& description) {
        using Value = std::decay_t<decltype(this->*member)>;
        if constexpr (std::is_same_v<Value, bool>) {
            if (member == &P::elastic && elastic) acts = false;
            if (member == &P::cap) {
                if (!cap) acts = false;
                capIsBounded = normalStiffness > 0; // what follows are the cap's
            }
            if (member == &P::cyclic) {
                isCyclic = true;
                acts = cyclic && !elastic;
            }
        }
        if constexpr (std::is_same_v<Value, double>) {
            if (!acts) return;
            if (member == &P::modeIFractureEnergy && !tensionTable.empty()) return;
            if (member == &P::modeIIFractureEnergy && !shearTable.empty()) return;
            const auto problem = description.problem(inWords(called), this->*member);
            if (problem.empty()) return;
            found.push_back(problem);
            if (!isCyclic) capIsBounded = false;
        }
        if constexpr (std::is_same_v<Value, std::vector<TableRow>>)
            if (acts) checkTable(found, inWords(called), this->*member);
    });
    if (elastic) return found;

    checkAtMost(found, "residual cohesion", residualCohesion, " Pa", cohesion);
    checkAtMost(found, "residual friction", residualFriction, "", friction);
    checkAtMost(found, "dilatancy", dilatancy, "", residualFriction);
    if (cohesion >= 0 && tensileStrength * friction > cohesion * (1 + 1e-12))
        found.push_back("tensile strength " + text(tensileStrength) + " Pa is above the apex of the Coulomb cone, " +
                        "cohesion/friction = " + text(cohesion / friction) + " Pa");
    if (tensionTable.empty()) checkExponential(found, "mode I", tensileStrength, normalStiffness, modeIFractureEnergy);
    if (shearTable.empty()) {
        if (cohesion == 0 && friction > residualFriction)
            found.push_back("friction softens from " + text(friction) + " to " + text(residualFriction) +
                            " without cohesion: give a shear table, no exponential one follows from zero cohesion");
        checkExponential(found, "mode II", cohesion, shearStiffness, modeIIFractureEnergy);
    }

    // From here on a joint that slides back would fall by itself: it loses pressure, and with it strength, faster than
    // its shear stress falls.
    const double steepest = (1 - shearStiffnessLoss) * shearStiffness / (friction * normalStiffness);
    if (cyclic && dilatancy > 0 && friction > 0 && !(dilatancy < steepest))
        found.push_back("dilatancy " + text(dilatancy) +
                        " must be below (1 - shear stiffness loss)·ks/(friction·kn) = " + text(steepest) +
                        " in the cyclic law");
    if (cyclic && cap && capLinear < 0)
        found.push_back("cap linear " + text(capLinear) + " Pa must be at least 0 in the cyclic law");
    if (cyclic && cap && compressionStiffnessLoss > 0 && (capNormal != 1 || capLinear != 0))
        found.push_back("cap normal " + text(capNormal) + " and cap linear " + text(capLinear) +
                        " Pa must be 1 and 0 in the cyclic law, or compression stiffness loss " +
                        text(compressionStiffnessLoss) +
                        " must be 0: how much of a closure is irreversible is only known "
                        "for a cap whose strength under pure closure is that of the compression curve");
    if (cyclic && initialClosingStiffness > 0) {
        if (initialClosingStiffness >= normalStiffness)
            found.push_back("initial closing stiffness " + text(initialClosingStiffness) +
                            " Pa/m must be below the normal stiffness " + text(normalStiffness) +
                            " Pa/m, that of the closed joint");
        if (tensileStrength > 0)
            found.push_back("tensile strength " + text(tensileStrength) +
                            " Pa must be 0 for a joint that closes on a curve: it is a dry joint");
        if (!(closureLimit > 0))
            found.push_back("closure limit " + text(closureLimit) +
                            " m must be above 0 where there is an initial closing stiffness");
        if (cap && compressionStiffnessLoss > 0)
            found.push_back("compression stiffness loss " + text(compressionStiffnessLoss) +
                            " must be 0 for a joint that closes on a curve");
    } else if (cyclic && closureLimit > 0)
        found.push_back("closure limit " + text(closureLimit) + " m needs an initial closing stiffness above 0");

    if (!cap || !capIsBounded) return found;
    const double smallest = CompressionCurve::smallestFractureEnergy(
        normalStiffness, compressiveStrength, elasticLimitRatio, residualStrengthRatio, peakRatio);
    const double without = CompressionCurve::smallestFractureEnergy(normalStiffness, compressiveStrength,
                                                                    elasticLimitRatio, residualStrengthRatio, 0);
    const double largest = peakRatio * (compressiveFractureEnergy - without) / (smallest - without);
    if (!(compressiveFractureEnergy > smallest)) // eq. (24): m <= 1 has no meaning
        found.push_back(
            "compressive fracture energy " + text(compressiveFractureEnergy) + " J/m² is too small for peak ratio " +
            text(peakRatio) + " (needs at least " + text(std::ceil(smallest)) + " J/m², more between rigid units" +
            (largest < 1 ? "" : ", or a peak ratio of at most " + text(std::floor(100 * largest) / 100)) + ")");
    return found;
}

ElasticStiffness inSeriesWithUnits(const JointProperties& p, double normalCompliance, double shearCompliance) {
    return {1 / (1 / p.normalStiffness + normalCompliance), 1 / (1 / p.shearStiffness + shearCompliance)};
}

} // namespace masonry
