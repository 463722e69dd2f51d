// SPDX-License-Identifier: GPL-2.0-or-later
// What tests of all laws have in common: states and energies.
#pragma once
#include "../chance.hpp"
#include "law/common/JointState.hpp"
#include <array>
#include <string>
#include <vector>

namespace masonry {

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
