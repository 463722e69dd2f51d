// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law side by side with the vector units of AVX-512; see CyclicOnAvx2.cpp.
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
#pragma GCC target("arch=x86-64-v4")
#define MASONRY_PACK_BYTES 64
#include "CyclicSideBySide.hpp"

void masonry::cyclic::advanceOnAvx512(const Numbers& numbers, TableRows* rows, const SideBySide& all) {
    advanceAs(numbers, rows, all);
}
#endif
