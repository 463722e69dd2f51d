// SPDX-License-Identifier: GPL-2.0-or-later
// What tests of all laws have in common: chance, states and energies.
#pragma once
#include "law/common/JointState.hpp"
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace masonry {

struct Chance {
    std::mt19937_64 engine;
    double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); }
    double logarithmic(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    bool happens(double p) { return between(0, 1) < p; }
    std::size_t oneOf(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine); }
};

inline double sum(const Energies& e) { return e.tension + e.shear + e.compression; }

// Names of the numbers in which a subcontact after the law for one subcontact differs from the same one in columns, to
// the last bit; empty if none does.
template <class State>
std::string difference(const State& one, const Energies& lostByOne, const State& other, const Energies& lostByOther) {
    const auto visit = [](const State& s, const Energies& lost, auto&& see) {
        State::visitNumbers(s, [&](const char* name, double number, int) { see(name, number); });
        see("normal stress", s.normalStress), see("regime", double(s.regime));
        see("tension", lost.tension), see("shear", lost.shear), see("compression", lost.compression);
    };
    std::array<double, 64> numbers;
    std::size_t n = 0;
    std::string found;
    visit(one, lostByOne, [&](const char*, double number) { numbers.at(n++) = number; });
    n = 0;
    visit(other, lostByOther, [&](const char* name, double number) {
        if (number != numbers[n++]) found += std::string(name) + " ";
    });
    return found;
}

} // namespace masonry
