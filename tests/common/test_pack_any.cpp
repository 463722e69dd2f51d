// SPDX-License-Identifier: GPL-2.0-or-later
// Packs of two numbers, for any processor of this kind.
#include "common/Vectorised.hpp"
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#define MASONRY_PACK_BYTES 16
#define PACK_CLAIMS packs_any
#include "pack_claims.hpp"

std::string differences_any(double a, double b) { return PACK_CLAIMS::differences(a, b); }
int foundByAny_any() { return PACK_CLAIMS::foundByAny(); }
int width_any() { return PACK_CLAIMS::width(); }
