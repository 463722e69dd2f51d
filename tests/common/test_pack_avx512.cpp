// SPDX-License-Identifier: GPL-2.0-or-later
// Packs for the vector units of AVX-512.
#include "common/Vectorised.hpp"
#if MASONRY_VECTOR_UNITS
#include <cmath>
#include <cstring>
#include <immintrin.h>
#include <string>
#pragma GCC target("avx512f,avx512vl,avx512dq")
#define MASONRY_PACK_BYTES 64
#define PACK_CLAIMS differencesAvx512
#include "pack_claims.hpp"
#endif
