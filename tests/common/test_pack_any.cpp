// SPDX-License-Identifier: GPL-2.0-or-later
// Packs of two numbers, for any processor of this kind.
#include "common/Vectorised.hpp"
#include <cmath>
#include <cstring>
#include <string>
#define MASONRY_PACK_BYTES 16
#define PACK_CLAIMS differencesAny
#include "pack_claims.hpp"
