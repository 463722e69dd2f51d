// SPDX-License-Identifier: GPL-2.0-or-later
// How inner loops use the vector units of a processor. A function marked MASONRY_VECTORISED is compiled for several
// instruction sets, and the program takes the best one that the processor has. All give the same numbers, because the
// project is built without contraction of products and sums.
#pragma once

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define MASONRY_VECTORISED __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define MASONRY_VECTORISED
#endif

// Whether files of their own are compiled for AVX2 and AVX-512, which takes a pragma of GCC.
#if defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&           \
    !defined(__SANITIZE_THREAD__)
#define MASONRY_VECTOR_UNITS 1
#else
#define MASONRY_VECTOR_UNITS 0
#endif

// A function that uses the instruction set of the vectorised one that calls it.
#define MASONRY_INLINED [[gnu::always_inline]] inline

// Stands before a loop whose iterations do not depend on each other, which the compiler cannot know: pointers might
// lead to the same memory.
#if defined(__GNUC__) && !defined(__clang__)
#define MASONRY_INDEPENDENT _Pragma("GCC ivdep")
#else
#define MASONRY_INDEPENDENT
#endif

namespace masonry {

constexpr int lanes = 8; // how many numbers of a Row stand side by side

struct alignas(64) Row { // as many numbers as the widest vector units take at a time
    double lane[lanes];
};

} // namespace masonry
