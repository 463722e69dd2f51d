// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockLanes.hpp"
#include "motion/Damping.hpp"
#include <cstddef>

// The functions use vectors of a fixed width. The compiler keeps these in registers only if it knows the instruction
// set when it compiles them, so BlockLanes.inl is included once for each instruction set.
namespace masonry {

namespace plain {
#define WIDTH 2
#include "BlockLanes.inl"
#undef WIDTH
} // namespace plain

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2")
namespace avx2 {
#define WIDTH 4
#include "BlockLanes.inl"
#undef WIDTH
} // namespace avx2
#pragma GCC target("arch=x86-64-v4")
namespace avx512 {
#define WIDTH 8
#include "BlockLanes.inl"
#undef WIDTH
} // namespace avx512
#pragma GCC pop_options
#endif

namespace {

// The version of a function for the widest instruction set that the processor has.
template <class F> F* choose(F* forAll, [[maybe_unused]] F* forAvx2, [[maybe_unused]] F* forAvx512) {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) return forAvx512;
    if (__builtin_cpu_supports("avx2")) return forAvx2;
#endif
    return forAll;
}

} // namespace

#if !defined(__x86_64__)
namespace avx2 = plain;
namespace avx512 = plain;
#endif

void addBlockForces(const BlockMatrix& m, const Row* displacements, const Row* moments, Row* forces, Row* rotation,
                    Row* energy, Row* scratch) {
    static const auto best = choose(plain::addForces, avx2::addForces, avx512::addForces);
    best(m, displacements, moments, forces, rotation, energy, scratch);
}

void moveBlocks(const NodeMotion& motion, LaneUnits& units) {
    static const auto best = choose(plain::move, avx2::move, avx512::move);
    best(motion, units);
}

void moveScaled(const NodeMotion& motion, double scaling, LaneUnits* units, int count, const Row& whole, Row* scratch) {
    static const auto best = choose(plain::moveScaledUnits, avx2::moveScaledUnits, avx512::moveScaledUnits);
    best(motion, scaling, units, count, whole, scratch);
}

} // namespace masonry
