// SPDX-License-Identifier: GPL-2.0-or-later
// Packs for the vector units of AVX2.
#include "common/Vectorised.hpp"
#if MASONRY_VECTOR_UNITS
#include <cmath>
#include <cstring>
#include <immintrin.h>
#include <string>
#pragma GCC target("avx2")
#define MASONRY_PACK_BYTES 32
#define PACK_CLAIMS differencesAvx2
#include "pack_claims.hpp"
#endif
