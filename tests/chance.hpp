// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers that a test draws, the same in every run.
#pragma once
#include <cmath>
#include <random>

namespace masonry {

struct Chance {
    std::mt19937_64 engine;
    explicit Chance(std::uint64_t seed) : engine(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); }
    double logarithmic(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    bool happens(double p) { return between(0, 1) < p; }
    std::size_t oneOf(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine); }
};

} // namespace masonry
