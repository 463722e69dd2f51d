// The paper's law on subcontacts side by side in columns, with the equations that JointLaw takes for one. A marked
// function uses the vector units, and tells the same numbers as the law for one to the last bit.
#pragma once
#include "Equations.hpp"
#include "law/SofteningTable.hpp"
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
        Intact,       // [-] 1 - d_ts
        Secant,       // [Pa/m] stiffness of the open subcontact
        Reach,        // [m] elastic opening up to which no damage grows and the secant stays
        CapSquared,   // [Pa²] square of the cap's strength
        count
    };

    double* first = nullptr;
    std::size_t pitch = 0; // from a column to the next

    double* operator[](int column) const { return first + column * pitch; }
    Columns from(std::size_t at) const { return {first + at, pitch}; }
};

struct Consequences { // what the columns Irreversible to CapSquared hold, of one subcontact
    double irreversible = 0, intact = 0, secant = 0, reach = 0, capSquared = 0;
};

struct TableRows { // where the tables were read last
    std::int32_t tension, shear;
};

struct Jumps { // increments of a step, in columns [m]
    const double *opening, *slideA, *slideB;
    bool plane; // whether shear stresses along b are zero and stay so
};

// One step of joints without strength.
void advanceElastic(double kn, double ks, const Columns& columns, std::size_t at, int count, const Jumps& jumps,
                    double* normalStress);

// One step of the subcontacts that stay elastic in it. The others stay as they were and are marked in `waits`; gives
// how many they are. If none of all has ever yielded, `neverYielded` is what holds for all of them, and their columns
// from Crushing on are not read; else it is null.
Mask stayElastic(const Equations& equations, const Consequences* neverYielded, const Columns& columns, std::size_t at,
                 int count, const Jumps& jumps, double* normalStress, Mask* waits);

// One step of those of the first `count` subcontacts that are marked in `waits`.
void advanceSideBySide(const Equations& equations, const SofteningTable& tension, const SofteningTable& shear,
                       const Columns& columns, TableRows* rows, Regime* regime, const Jumps& jumps, const Mask* waits,
                       int count, double* normalStress);

struct LaneSums { // of lanes, so that the order of adding is the same with any vector unit
    double storedTension[lanes] = {}, storedShear[lanes] = {}, storedCompression[lanes] = {};
    double lostTension[lanes] = {}, lostShear[lanes] = {}, lostCompression[lanes] = {};
};

// Adds the energies of the joints at a point; `yielded` tells of every eight joints whether one has ever yielded.
void addEnergies(double kn, double ks, const Columns& columns, const std::uint8_t* yielded, int joints, int stride,
                 const double* area, bool alike, int point, LaneSums& sums);

} // namespace masonry
