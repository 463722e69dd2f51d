// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers side by side, which are calculated with like one. A function template for a number type T holds for double
// and for Pack, and gives the same bits for both.
#pragma once
#include "Vectorised.hpp"
#include <cmath>
#include <cstdint>
#include <cstring>

// As many bytes as the vector units take that a file is compiled for: the compiler splits wider packs into single
// numbers. A file for vector units which not every processor has defines this before it includes Pack.hpp.
#ifndef MASONRY_PACK_BYTES
#define MASONRY_PACK_BYTES 16
#endif
#if MASONRY_PACK_BYTES > 16
#include <immintrin.h>
#endif

namespace masonry {

using Pack = double __attribute__((vector_size(MASONRY_PACK_BYTES)));
using PackMask = std::int64_t __attribute__((vector_size(MASONRY_PACK_BYTES))); // what comparing two packs gives
constexpr int packed = MASONRY_PACK_BYTES / sizeof(double);

template <class T> using MaskOf = decltype(T{} > T{}); // bool or PackMask

MASONRY_INLINED bool any(bool m) { return m; }
MASONRY_INLINED bool any(const PackMask& m) {
#if MASONRY_PACK_BYTES == 64
    return _mm512_movepi64_mask(__m512i(m)) != 0;
#elif MASONRY_PACK_BYTES == 32
    return _mm256_movemask_pd(__m256d(m)) != 0;
#else
    return (m[0] | m[1]) != 0;
#endif
}

MASONRY_INLINED double root(double x) { return std::sqrt(x); }
MASONRY_INLINED Pack root(const Pack& x) { // in memory, where the compiler sees a loop for the vector units
    alignas(64) double y[packed];
    std::memcpy(y, &x, sizeof x);
    for (int i = 0; i < packed; ++i)
        y[i] = std::sqrt(y[i]);
    Pack z;
    std::memcpy(&z, y, sizeof z);
    return z;
}

// One number in all places.
template <class T> MASONRY_INLINED T all(double x) { return T{} + x; }

MASONRY_INLINED double choose(bool m, double a, double b) { return m ? a : b; }
MASONRY_INLINED Pack choose(const PackMask& m, const Pack& a, const Pack& b) { return m ? a : b; }
// The number a for 1 and b for 0, by their bits. Where a loop writes several columns on one condition, the compiler
// makes of `which ? a : b` stores that leave places out, and a processor waits when it reads such a place again.
MASONRY_INLINED double pick(std::int64_t which, double a, double b) {
    std::int64_t one, other;
    std::memcpy(&one, &a, sizeof a);
    std::memcpy(&other, &b, sizeof b);
    one = (one & -which) | (other & ~-which);
    std::memcpy(&a, &one, sizeof a);
    return a;
}
template <class T> MASONRY_INLINED T larger(const T& a, const T& b) { return choose(a > b, a, b); }
template <class T> MASONRY_INLINED T smaller(const T& a, const T& b) { return choose(a < b, a, b); }

MASONRY_INLINED Pack load(const double* from) {
    Pack x;
    std::memcpy(&x, from, sizeof x);
    return x;
}
MASONRY_INLINED void store(double* to, const Pack& x) { std::memcpy(to, &x, sizeof x); }

} // namespace masonry
