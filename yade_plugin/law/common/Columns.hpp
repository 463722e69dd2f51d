// SPDX-License-Identifier: GPL-2.0-or-later
// Where the states of subcontacts stand side by side in memory: a column for each quantity.
#pragma once
#include "common/Vectorised.hpp"
#include <cstddef>
#include <cstdint>

namespace masonry {

using Mask = std::int64_t; // a switch as wide as the numbers beside it, for the vector units

// How many subcontacts have not made their step after those that stay elastic.
struct Waiting {
    Mask all;
    Mask open; // 0 if none of them is open and without bond, for which a law may have a shorter step
};

// What a column of a law means to those who do not know the law.
enum class Role {
    BondDamage,     // in tension [-]: 0 as the bond was made, 1 where it is gone
    LargestOpening, // [m] so far
    LargestClosure, // [m] so far
};

// The columns that every law has. A law counts on from `count`, and says which of its columns have a role:
//   struct ColumnOfMyLaw : SharedColumn {
//       enum { Slip = SharedColumn::count, Damage, count };
//       static constexpr int of(Role role) { return role == Role::BondDamage ? int(Damage) : none; }
//   };
struct SharedColumn {
    static constexpr int none = -1;
    static constexpr int of(Role) { return none; }
    enum {
        Opening, // [m]
        ShearStressA,
        ShearStressB,    // [Pa] along both tangents of the joint
        Irreversible,    // [m] plastic closure less dilatant opening; the elastic opening is Opening + Irreversible
        LostTension,     // [J/m²] dissipated so far
        LostShear,       // [J/m²]
        LostCompression, // [J/m²]
        count
    };
};

struct Columns {                    // side by side in memory
    static constexpr int most = 32; // subcontacts that are advanced at a time

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

// One step of joints without strength, with the stiffnesses kn and ks [Pa/m].
void advanceElastic(double kn, double ks, const Columns& columns, int count, const Jumps& jumps, double* normalStress);

} // namespace masonry
