// How inner loops use the vector units. A marked function is compiled for several instruction sets, and the one that
// the processor has is taken when the program starts. All give the same numbers, because the project is built without
// contraction of products and sums.
#pragma once

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define MASONRY_VECTORISED __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define MASONRY_VECTORISED
#endif

// A function that is compiled into its callers, so that it uses the instruction set of a vectorised one.
#define MASONRY_INLINED [[gnu::always_inline]] inline

// Stands before a loop whose turns do not depend on each other, which the compiler cannot know of several pointers.
#if defined(__GNUC__) && !defined(__clang__)
#define MASONRY_INDEPENDENT _Pragma("GCC ivdep")
#else
#define MASONRY_INDEPENDENT
#endif

namespace masonry {

constexpr int lanes = 8; // numbers side by side

struct alignas(64) Row { // of numbers side by side
    double lane[lanes];
};

} // namespace masonry
