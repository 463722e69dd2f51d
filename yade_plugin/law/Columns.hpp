// Where the states of subcontacts stand side by side in memory: a column for each quantity, so that the vector units
// take several subcontacts at a time.
#pragma once
#include "common/Vectorised.hpp"
#include <cstddef>
#include <cstdint>

namespace masonry {

using Mask = std::int64_t; // a switch as wide as the numbers beside it, for the vector units

struct Columns {                    // side by side in memory
    static constexpr int most = 32; // subcontacts that are advanced at a time

    enum Column { // what is kept of a subcontact
        Opening,  // these are JointState's
        ShearStressA,
        ShearStressB,
        LargestOpening,
        LargestClosure,
        Crushing, // from here on nothing is written before a subcontact nearby yields
        Dilation,
        Slip,
        TensionDamage,
        ShearDamage,
        LostTension, // [J/m²] dissipated so far
        LostShear,
        LostCompression,
        Irreversible, // [m] crushing less dilation; this and what comes below follow from the above
        Intact,       // [-] what the bond has left
        Secant,       // [Pa/m] stiffness of the open subcontact
        Reach,        // [m] elastic opening up to which no damage grows and the secant stays
        CapSquared,   // [Pa²] square of the cap's strength
        PlasticSlipA, // from here on for the cyclic law; JointState's
        PlasticSlipB,
        ShearSoftening,
        ShearStiffnessLoss,
        CapDisplacement,
        ShearStiffness,   // [Pa/m] of the subcontact; this and what comes below follow from the above
        ClosingStiffness, // [Pa/m] of the closed subcontact
        SquaredHardening, // [m²] square of the elastic displacement at which the cap hardens further
        count,
        ofPaper = PlasticSlipA // how many columns the paper's law has
    };

    double* first = nullptr;
    std::size_t pitch = 0; // from a column to the next

    double* operator[](int column) const { return first + column * pitch; }
    Columns from(std::size_t at) const { return {first + at, pitch}; }
};

struct TableRows { // where the tables were read last
    std::int32_t tension, shear;
};

struct Jumps { // increments of a step, in columns [m]
    const double *opening, *slideA, *slideB;
    bool plane; // whether shear stresses along b are zero and stay so
};

struct LaneSums { // of lanes, so that the order of adding is the same with any vector unit
    double storedTension[lanes] = {}, storedShear[lanes] = {}, storedCompression[lanes] = {};
    double lostTension[lanes] = {}, lostShear[lanes] = {}, lostCompression[lanes] = {};
};

// One step of joints without strength.
void advanceElastic(double kn, double ks, const Columns& columns, std::size_t at, int count, const Jumps& jumps,
                    double* normalStress);

} // namespace masonry
