#include "JointProperties.hpp"
#include "CompressionCurve.hpp"
#include "common/Text.hpp"
#include <cmath>

namespace masonry {

namespace {

constexpr double infinity = HUGE_VAL;

class Door {
public:
    std::vector<std::string> found;

    // A finite number within [low, high]; `above` excludes low itself.
    void number(const char* what, double value, const char* unit, double low, double high = infinity,
                bool above = false) {
        const std::string shown = std::string(what) + " " + text(value) + (*unit ? " " : "") + unit;
        if (!std::isfinite(value))
            found.push_back(shown + " must be a finite number");
        else if (value < low || (above && value == low))
            found.push_back(shown + " must be " + (above ? "above " : "at least ") + text(low));
        else if (value > high)
            found.push_back(shown + " must be at most " + text(high));
    }

    // The ratios of an exponential table reach 1 + 12/decay, law.md §3: numbers must hold them.
    void exponential(const char* mode, double strength, double stiffness, double energy) {
        const double decay = strength * strength / (stiffness * energy);
        if (strength > 0 && stiffness > 0 && energy > 0 && !(decay > 1e-300 && decay < 1e300))
            found.push_back(std::string(mode) + " strength " + text(strength) + " Pa, stiffness " + text(stiffness) +
                            " Pa/m and fracture energy " + text(energy) +
                            " J/m² are too far apart for an exponential table");
    }

    void table(const char* what, const std::vector<TableRow>& rows) {
        if (rows.empty()) return;
        for (const auto& problem : SofteningTable::problems(rows))
            found.push_back(std::string(what) + ", " + problem);
    }
};

} // namespace

std::vector<std::string> JointProperties::problems() const {
    Door door;
    if (name.empty()) door.found.push_back("name must not be empty");
    door.number("normal stiffness", normalStiffness, "Pa/m", 0, infinity, true);
    door.number("shear stiffness", shearStiffness, "Pa/m", 0, infinity, true);
    if (elastic) return door.found;

    door.number("tensile strength", tensileStrength, "Pa", 0);
    door.number("cohesion", cohesion, "Pa", 0);
    door.number("residual cohesion", residualCohesion, "Pa", 0, cohesion >= 0 ? cohesion : infinity);
    const double highest = friction >= 0 ? friction : infinity;
    door.number("friction", friction, "", 0);
    door.number("residual friction", residualFriction, "", 0, highest);
    door.number("dilatancy", dilatancy, "", 0, residualFriction >= 0 ? residualFriction : infinity);
    door.number("dilatancy decay", dilatancyDecay, "1/m", 0);
    if (cohesion >= 0 && tensileStrength * friction > cohesion * (1 + 1e-12))
        door.found.push_back("tensile strength " + text(tensileStrength) +
                             " Pa is above the apex of the Coulomb cone, " +
                             "cohesion/friction = " + text(cohesion / friction) + " Pa");

    door.table("tension table", tensionTable);
    if (tensionTable.empty()) {
        door.number("mode I fracture energy", modeIFractureEnergy, "J/m²", 0, infinity, true);
        door.exponential("mode I", tensileStrength, normalStiffness, modeIFractureEnergy);
    }
    door.table("shear table", shearTable);
    if (shearTable.empty() && cohesion == 0 && friction > residualFriction)
        door.found.push_back("friction softens from " + text(friction) + " to " + text(residualFriction) +
                             " without cohesion: give a shear table, no exponential one follows from zero cohesion");
    if (shearTable.empty()) {
        door.number("mode II fracture energy", modeIIFractureEnergy, "J/m²", 0, infinity, true);
        door.exponential("mode II", cohesion, shearStiffness, modeIIFractureEnergy);
    }

    if (!cap) return door.found;
    const auto before = door.found.size();
    door.number("compressive strength", compressiveStrength, "Pa", 0, infinity, true);
    door.number("elastic limit ratio", elasticLimitRatio, "", 0, 0.999, true);
    door.number("residual strength ratio", residualStrengthRatio, "", 0, 0.999);
    door.number("peak ratio", peakRatio, "", 1);
    door.number("compressive fracture energy", compressiveFractureEnergy, "J/m²", 0, infinity, true);
    door.number("cap constant Cnn", capNormal, "", 0, infinity, true);
    door.number("cap constant Css", capShear, "", 0);
    door.number("cap constant Cn", capLinear, "Pa", -infinity);
    if (door.found.size() == before && normalStiffness > 0) {
        const double smallest = CompressionCurve::smallestFractureEnergy(
            normalStiffness, compressiveStrength, elasticLimitRatio, residualStrengthRatio, peakRatio);
        if (!(compressiveFractureEnergy > smallest)) // law.md §4: m <= 1 has no meaning
            door.found.push_back("compressive fracture energy " + text(compressiveFractureEnergy) +
                                 " J/m² is too small for peak ratio " + text(peakRatio) + " (needs at least " +
                                 text(std::ceil(smallest)) + " J/m²)");
    }
    return door.found;
}

ElasticStiffness inSeriesWithUnits(const JointProperties& p, double normalCompliance, double shearCompliance) {
    return {1 / (1 / p.normalStiffness + normalCompliance), 1 / (1 / p.shearStiffness + shearCompliance)};
}

} // namespace masonry
