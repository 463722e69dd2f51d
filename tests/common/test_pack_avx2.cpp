// SPDX-License-Identifier: GPL-2.0-or-later
// Packs for the vector units of AVX2. The standard headers stand before the pragma, so that their functions are not
// compiled for these units.
#include "common/Vectorised.hpp"
#if MASONRY_VECTOR_UNITS
#include <cmath>
#include <cstdint>
#include <cstring>
#include <immintrin.h>
#include <limits>
#include <string>
#pragma GCC target("avx2")
#define MASONRY_PACK_BYTES 32
#define PACK_CLAIMS packs_avx2
#include "pack_claims.hpp"

std::string differences_avx2(double a, double b) { return PACK_CLAIMS::differences(a, b); }
int foundByAny_avx2() { return PACK_CLAIMS::foundByAny(); }
int width_avx2() { return PACK_CLAIMS::width(); }
#endif
