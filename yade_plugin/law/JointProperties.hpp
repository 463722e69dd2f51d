// The parameters of one kind of joint: constant, shared by all joints of that kind. Checked once, at the door.
// Defaults: bed joint of the calcium-silicate walls, paper table 2, with the values law.md §1 decided.
#pragma once
#include "SofteningTable.hpp"
#include <string>
#include <vector>

namespace masonry {

struct JointProperties {
    std::string name = "bed";
    bool elastic = false; // linear elastic: no strength is ever reached (supports, paper §4.1)

    double normalStiffness = 3.352e11; // [Pa/m] kn, eq. (26), > 0
    double shearStiffness = 1.445e11;  // [Pa/m] ks, eq. (26), > 0

    double tensileStrength = 0.10e6;    // [Pa] ft, >= 0, at most the apex cp/tan(phi_p)
    double modeIFractureEnergy = 16;    // [J/m²] GfI, > 0 [decided]; unused with a tension table
    std::vector<TableRow> tensionTable; // (ratio, damage); empty: exponential from GfI

    double cohesion = 0.11e6;          // [Pa] cp, >= 0
    double residualCohesion = 0;       // [Pa] cr, 0 to cp [decided]
    double friction = 0.43;            // [-] tan(phi_p), >= 0
    double residualFriction = 0.43;    // [-] tan(phi_r), 0 to tan(phi_p) [decided]
    double dilatancy = 0;              // [-] tan(psi), 0 to tan(phi_r) [decided]
    double dilatancyDecay = 0;         // [1/m] delta in tan(psi) exp(-delta s), >= 0
    double modeIIFractureEnergy = 160; // [J/m²] GfII at zero normal stress, > 0 [decided]; unused with a shear table
    std::vector<TableRow> shearTable;  // (ratio, damage); empty: exponential from GfII

    bool cap = true;                          // whether the joint can crush
    double compressiveStrength = 7.55e6;      // [Pa] fcp, > 0
    double elasticLimitRatio = 0.30;          // [-] fel/fcp, 0 to 1
    double residualStrengthRatio = 0.20;      // [-] fcr/fcp, 0 to 1 [decided]
    double peakRatio = 68.5;                  // [-] n, eq. (19), >= 1
    double compressiveFractureEnergy = 15000; // [J/m²] Gc, eq. (24)
    double capNormal = 1;                     // [-] Cnn, > 0 [decided]
    double capShear = 9;                      // [-] Css, >= 0 [decided]
    double capLinear = 0;                     // [Pa] Cn [decided]

    // Everything that is wrong, one sentence each, in the user's words; empty if all is well.
    std::vector<std::string> problems() const;
};

// Stiffness that a joint shows: its own, or in series with the rigid units at both sides (law.md §7).
struct ElasticStiffness {
    double normal, shear; // [Pa/m] kn*, ks*
};

// 1/kn* = 1/kn + L/E, 1/ks* = 1/ks + L/G, with the units' part (sum of L/E and L/G over both sides) given in m/Pa.
ElasticStiffness inSeriesWithUnits(const JointProperties&, double normalCompliance, double shearCompliance);

} // namespace masonry
