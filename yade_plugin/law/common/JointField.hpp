// SPDX-License-Identifier: GPL-2.0-or-later
// What files and Python show of the state of a subcontact. A law tells its own numbers in its folder; those that
// several laws have are described here, so that a name means the same everywhere.
#pragma once
#include "common/Property.hpp"
#include <functional>

namespace masonry {

struct JointField {
    const char* name;
    Property about;
};

// Receives the numbers that a law shows, one after the other.
using ShowField = std::function<void(const JointField&, double value)>;

namespace field {

inline const JointField slip{"slip", number("m", "Accumulated plastic slip of a subcontact")};
inline const JointField damageTension{"damage_tension", number("-", "Damage in tension, 0 to 1")};
inline const JointField damageShear{"damage_shear", number("-", "Damage in shear, 0 to 1")};
inline const JointField damageCompression{"damage_compression", number("-", "Damage in compression, 0 to 1")};
inline const JointField crushing{"crushing", number("m", "Plastic closure of a subcontact")};

// Figures, crack tables and measures read these, whatever the law. Where a law has no such number, it is zero.
inline const JointField* const always[] = {&slip, &damageTension, &damageShear, &damageCompression, &crushing};

} // namespace field

} // namespace masonry
