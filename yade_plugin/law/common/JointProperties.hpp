// SPDX-License-Identifier: GPL-2.0-or-later
// The parameters of one kind of joint: constant, shared by all joints of that kind.
// Defaults: bed joint of the calcium-silicate walls (paper table 2, and law/README.md where the paper gives no value).
#pragma once
#include "SofteningTable.hpp"
#include "common/Property.hpp"
#include <functional>
#include <string>
#include <vector>

namespace masonry {

// A property is a member here, with its default, and one call in describe() below, with all that is said about it.
struct JointProperties {
    std::string name = "bed";
    double normalStiffness = 3.352e11;
    double shearStiffness = 1.445e11;

    std::string law = "softening";
    bool elastic = false;
    bool monolithic = false;
    double tensileStrength = 0.10e6;
    double modeIFractureEnergy = 16;
    std::vector<TableRow> tensionTable;
    double cohesion = 0.11e6;
    double residualCohesion = 0;
    double friction = 0.43;
    double residualFriction = 0.43;
    double dilatancy = 0;
    double dilatancyDecay = 0;
    double modeIIFractureEnergy = 160;
    std::vector<TableRow> shearTable;

    bool cap = true;
    double compressiveStrength = 7.55e6;
    double elasticLimitRatio = 0.30;
    double residualStrengthRatio = 0.20;
    double peakRatio = 68.5;
    double compressiveFractureEnergy = 15000;
    double capNormal = 1;
    double capShear = 9;
    double capLinear = 0;

    double shearStiffnessLoss = 0;
    double compressionStiffnessLoss = 0.5;
    double bondLossByCrushing = 1;
    double restitution = 0;
    double initialClosingStiffness = 0;
    double closureLimit = 0;

    // Calls visit(name, member, description) for every property.
    template <class Visit> static void describe(Visit&& visit);

    // Every value that is out of its bounds; empty if all is well. The name and the two stiffnesses are looked at in
    // any case, of the others, unless the joint is elastic, those that `acts` says the law reads. What a law demands
    // beyond these bounds, it checks itself (law/Laws.hpp).
    std::vector<Problem> outOfBounds(const std::function<bool(const std::string& property)>& acts) const;
};

// The error about the properties of a joint of this name, which each sentence begins with.
WrongProperties wrongJoint(const std::string& name, std::vector<Problem> problems);

template <class Visit> void JointProperties::describe(Visit&& visit) {
    using P = JointProperties;
    constexpr double infinity = Property::infinity;
    visit("name", &P::name, described("Name of this kind of joint, as files and messages show it"));
    visit("normalStiffness", &P::normalStiffness,
          number("Pa/m", "Normal stiffness kn. A joint takes its elastic stiffness from it when it is made; a later "
                         "change acts on its tables alone")
              .above(0)
              .usually(1e7, infinity, "N/mm³")
              .source("paper eq. (26)"));
    visit("shearStiffness", &P::shearStiffness,
          number("Pa/m", "Shear stiffness ks. A joint takes its elastic stiffness from it when it is made; a later "
                         "change acts on its tables alone")
              .above(0)
              .usually(1e7, infinity, "N/mm³")
              .source("paper eq. (26)"));

    visit("law", &P::law,
          described("Name of the law that the joint follows; MasonryJoint.laws() lists them. Chosen before the first "
                    "step")
              .source("law/README.md"));
    visit("elastic", &P::elastic,
          described("Whether the joint is linear elastic: no strength is ever reached").source("paper section 4.1"));
    visit("monolithic", &P::monolithic,
          described(
              "Whether the joint is the crack surface of a brick in two deformable units whose masses are scaled as "
              "those of one block until the surface first yields. A unit can belong to one such joint only. It means "
              "nothing to rigid units")
              .source("yade_plugin/README.md, Scaled masses"));
    visit("tensileStrength", &P::tensileStrength,
          number("Pa", "Tensile strength ft, at most the apex of the Coulomb cone cohesion/friction")
              .atLeast(0)
              .usually(1e3, 1e9, "MPa")
              .source("paper table 2"));
    visit("modeIFractureEnergy", &P::modeIFractureEnergy,
          number("J/m²", "Mode I fracture energy GfI, of which the exponential tension table is made")
              .above(0)
              .usually(0.1, 1e6, "N/mm")
              .source("[decided]: law/README.md, Parameters"));
    visit("tensionTable", &P::tensionTable,
          described("Softening in tension as rows (displacement ratio, damage) from (1, 0) on, in place of the "
                    "exponential table; none by default")
              .source("paper eq. (12)"));
    visit("cohesion", &P::cohesion,
          number("Pa", "Peak cohesion cp").atLeast(0).usually(1e3, 1e9, "MPa").source("paper table 2"));
    visit("residualCohesion", &P::residualCohesion,
          number("Pa", "Residual cohesion cr, at most the peak cohesion")
              .atLeast(0)
              .source("paper eq. (17a); value [decided]: law/README.md, Parameters"));
    visit("friction", &P::friction,
          number("-", "Peak friction coefficient tan(phi_p)")
              .atLeast(0)
              .usually(0, 5, "degrees")
              .source("paper table 2"));
    visit("residualFriction", &P::residualFriction,
          number("-", "Residual friction coefficient tan(phi_r), at most the peak one")
              .atLeast(0)
              .usually(0, 5, "degrees")
              .source("paper eq. (17b); value [decided]: law/README.md, Parameters"));
    visit("dilatancy", &P::dilatancy,
          number("-", "Dilatancy tan(psi), at most the residual friction coefficient")
              .atLeast(0)
              .usually(0, 5, "degrees")
              .source("paper eq. (9); value [decided]: law/README.md, Parameters"));
    visit("dilatancyDecay", &P::dilatancyDecay,
          number("1/m", "Decay delta of the dilatancy with slip s, tan(psi)·exp(-delta·s); 0 keeps it constant")
              .atLeast(0)
              .source("[decided]: law/README.md, Slip"));
    visit("modeIIFractureEnergy", &P::modeIIFractureEnergy,
          number("J/m²", "Mode II fracture energy GfII without normal stress, of which the exponential shear table is "
                         "made")
              .above(0)
              .usually(0.1, 1e6, "N/mm")
              .source("[decided]: law/README.md, Parameters"));
    visit("shearTable", &P::shearTable,
          described("Softening in shear as rows (displacement ratio, damage) from (1, 0) on, in place of the "
                    "exponential table; none by default")
              .source("paper eq. (13)"));

    visit("cap", &P::cap, described("Whether the joint can crush").source("paper eq. (8c)"));
    visit("compressiveStrength", &P::compressiveStrength,
          number("Pa", "Compressive strength fcp").above(0).usually(1e3, 1e9, "MPa").source("paper table 2"));
    visit("elasticLimitRatio", &P::elasticLimitRatio,
          number("-", "Elastic limit over compressive strength").above(0).atMost(0.999).source("paper eq. (18)"));
    visit("residualStrengthRatio", &P::residualStrengthRatio,
          number("-", "Residual over peak compressive strength")
              .atLeast(0)
              .atMost(0.999)
              .source("paper eq. (21); value [decided]: law/README.md, Parameters"));
    visit("peakRatio", &P::peakRatio,
          number("-", "Peak ratio n: the closure at the compressive strength is n·fcp/kn")
              .atLeast(1)
              .source("paper eq. (19)"));
    visit("compressiveFractureEnergy", &P::compressiveFractureEnergy,
          number("J/m²", "Compressive fracture energy Gc; one that is too small for the peak ratio is refused")
              .above(0)
              .source("paper eq. (24)"));
    visit("capNormal", &P::capNormal,
          number("-", "Constant Cnn of the cap")
              .above(0)
              .source("paper eq. (8c); value [decided]: law/README.md, Parameters"));
    visit("capShear", &P::capShear,
          number("-", "Constant Css of the cap")
              .atLeast(0)
              .source("paper eq. (8c); value [decided]: law/README.md, Parameters"));
    visit("capLinear", &P::capLinear,
          number("Pa", "Constant Cn of the cap").source("paper eq. (8c); value [decided]: law/README.md, Parameters"));

    visit("shearStiffnessLoss", &P::shearStiffnessLoss,
          number("-",
                 "Share omega_m of the shear stiffness that a joint without bond has lost; 0: it slips only. Read by "
                 "the cyclic law")
              .atLeast(0)
              .atMost(0.99)
              .source("[decided]: law/cyclic_softening/README.md"));
    visit("compressionStiffnessLoss", &P::compressionStiffnessLoss,
          number("-",
                 "Share rho of what crushing makes irreversible that is lost stiffness, and not plastic closure. Read "
                 "by the cyclic law")
              .atLeast(0)
              .atMost(0.99)
              .source("[decided]: law/cyclic_softening/README.md"));
    visit("bondLossByCrushing", &P::bondLossByCrushing,
          number("-", "Share chi of the bond that a wholly crushed joint has lost. Read by the cyclic law")
              .atLeast(0)
              .atMost(1)
              .source("[decided]: law/cyclic_softening/README.md"));
    visit("restitution", &P::restitution,
          number("-",
                 "Speed after over before an impact at an end of the joint that closes after it has been open, without "
                 "bond, between rigid blocks and while MasonryJointLoop.impacts is on; 1: no loss. With 0 a block that "
                 "rocks keeps what G. W. Housner's (1963) keeps, or a little more, near what F. Peña, F. Prieto, P. B. "
                 "Lourenço, A. Campos Costa and J. V. Lemos (2007) measured on blocks of granite")
              .atLeast(0)
              .atMost(1)
              .source("yade_plugin/README.md, Impacts"));
    visit("initialClosingStiffness", &P::initialClosingStiffness,
          number("Pa/m",
                 "Normal stiffness kn0 of a dry joint without stress; 0: joints close with kn, not on a curve. Read "
                 "by the cyclic law")
              .atLeast(0)
              .source("law/cyclic_softening/README.md; no default, it is measured"));
    visit("closureLimit", &P::closureLimit,
          number("m", "Closure cm at which the curve of a dry joint would be vertical. Read by the cyclic law")
              .atLeast(0)
              .usually(0, 0.01, "mm")
              .source("law/cyclic_softening/README.md; no default, it is measured"));
}

// Stiffness that a joint shows: its own, or in series with the rigid units at both sides.
struct ElasticStiffness {
    double normal, shear; // [Pa/m] kn*, ks*
};

// 1/kn* = 1/kn + L/E and 1/ks* = 1/ks + L/G: law/README.md, Rigid units. The units' part, the sum of L/E and of L/G
// over both sides, is given in m/Pa.
ElasticStiffness inSeriesWithUnits(const JointProperties&, double normalCompliance, double shearCompliance);

} // namespace masonry
