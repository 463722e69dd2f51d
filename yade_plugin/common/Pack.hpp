// Eight numbers side by side, which are calculated with like one. A function template for a number type T holds for
// double and for Pack, and gives the same bits for both.
#pragma once
#include "Vectorised.hpp"
#include <cmath>
#include <cstdint>
#include <cstring>

namespace masonry {

using Pack = double __attribute__((vector_size(64)));
using PackMask = std::int64_t __attribute__((vector_size(64))); // what comparing two packs gives

MASONRY_INLINED bool any(bool m) { return m; }
MASONRY_INLINED bool any(const PackMask& m) { // by halves, which stay in the vector units
    using Four = std::int64_t __attribute__((vector_size(32)));
    using Two = std::int64_t __attribute__((vector_size(16)));
    Four half[2];
    std::memcpy(half, &m, sizeof m);
    const Four four = half[0] | half[1];
    Two quarter[2];
    std::memcpy(quarter, &four, sizeof four);
    const Two two = quarter[0] | quarter[1];
    return (two[0] | two[1]) != 0;
}

MASONRY_INLINED double root(double x) { return std::sqrt(x); }
MASONRY_INLINED Pack root(const Pack& x) { // in memory, where the compiler sees a loop for the vector units
    alignas(64) double y[lanes];
    std::memcpy(y, &x, sizeof x);
    for (int i = 0; i < lanes; ++i)
        y[i] = std::sqrt(y[i]);
    Pack z;
    std::memcpy(&z, y, sizeof z);
    return z;
}

// One number in all places.
template <class T> MASONRY_INLINED T all(double x) { return T{} + x; }

MASONRY_INLINED double choose(bool m, double a, double b) { return m ? a : b; }
MASONRY_INLINED Pack choose(const PackMask& m, const Pack& a, const Pack& b) { return m ? a : b; }
template <class T> MASONRY_INLINED T larger(const T& a, const T& b) { return choose(a > b, a, b); }
template <class T> MASONRY_INLINED T smaller(const T& a, const T& b) { return choose(a < b, a, b); }

MASONRY_INLINED Pack load(const double* from) {
    Pack x;
    std::memcpy(&x, from, sizeof x);
    return x;
}
MASONRY_INLINED void store(double* to, const Pack& x) { std::memcpy(to, &x, sizeof x); }

} // namespace masonry
