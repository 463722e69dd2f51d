// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law side by side with the vector units of AVX2. The standard headers stand before the pragma, so that
// their functions are not compiled for these units.
#include "common/Vectorised.hpp"
#if MASONRY_VECTOR_UNITS
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <immintrin.h>
#include <memory>
#include <string>
#include <vector>
#pragma GCC target("avx2")
#define MASONRY_PACK_BYTES 32
#include "CyclicSideBySide.hpp"

void masonry::cyclic::advanceOnAvx2(const Numbers& numbers, TableRows* rows, const SideBySide& all) {
    advanceAs(numbers, rows, all);
}
#endif
