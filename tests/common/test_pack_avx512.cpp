// SPDX-License-Identifier: GPL-2.0-or-later
// Packs for the vector units of AVX-512. The standard headers stand before the pragma, so that their functions are not
// compiled for these units.
#include "common/Vectorised.hpp"
#if MASONRY_VECTOR_UNITS
#include <cmath>
#include <cstdint>
#include <cstring>
#include <immintrin.h>
#include <limits>
#include <string>
#pragma GCC target("avx512f,avx512vl,avx512dq")
#define MASONRY_PACK_BYTES 64
#define PACK_CLAIMS packs_avx512
#include "pack_claims.hpp"

std::string differences_avx512(double a, double b) { return PACK_CLAIMS::differences(a, b); }
int foundByAny_avx512() { return PACK_CLAIMS::foundByAny(); }
int width_avx512() { return PACK_CLAIMS::width(); }
#endif
