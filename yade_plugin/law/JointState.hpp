// What one subcontact remembers, and what it is told and answers in a step. Opening and tension are positive.
#pragma once
#include <cstdint>

namespace masonry {

struct Shear { // a vector in the joint plane
    double a = 0, b = 0;
};

struct Jump { // increment of the displacement jump in a step [m]
    double opening = 0;
    Shear slide;
};

enum class Regime : std::int8_t { Elastic, Opening, Slipping, Crushing }; // what acted in the last step

struct JointState {
    double opening = 0;        // [m] un, total, positive open
    double crushing = 0;       // [m] up, plastic closure, >= 0
    double dilation = 0;       // [m] ud, dilatant opening, >= 0
    double slip = 0;           // [m] s, accumulated plastic slip, >= 0
    double largestOpening = 0; // [m] of the elastic opening
    double largestClosure = 0; // [m] of the total closure; of the cyclic law kappa, which counts slip on the cap, too
    double tensionDamage = 0;  // [-] d_t
    double shearDamage = 0;    // [-] d_s
    double normalStress = 0;   // [Pa] sigma
    Shear shearStress;         // [Pa] tau
    Regime regime = Regime::Elastic;
    // of the cyclic law alone
    Shear plasticSlip;             // [m] p, plastic slip as a vector
    double shearSoftening = 0;     // [-] r, displacement ratio of the shear table less 1
    double shearStiffnessLoss = 0; // [-] omega
    double capDisplacement = 0;    // [m] pi, accumulated plastic displacement on the cap
};

struct Energies { // [J/m²] by mode; what a step dissipates is its work less the stored energy, so that a balance closes
    double tension = 0, shear = 0, compression = 0;
};

} // namespace masonry
