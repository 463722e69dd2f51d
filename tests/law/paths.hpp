// SPDX-License-Identifier: GPL-2.0-or-later
// A subcontact that a law moves along a path of the displacement jump, joints drawn at random, and how states differ.
#pragma once
#include "closed_cycles.hpp"
#include "law/Laws.hpp"
#include <array>
#include <functional>
#include <string>
#include <type_traits>

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

inline ElasticStiffness own(const JointProperties& p) { return {p.normalStiffness, p.shearStiffness}; }

template <class L> struct PathOf {
    L law;
    ElasticStiffness k;
    typename L::State state{};
    Energies dissipated{}; // [J/m²]
    double work = 0;       // [J/m²]

    PathOf(const JointProperties& p, const ElasticStiffness& stiffness) : law(p), k(stiffness) {}
    explicit PathOf(const JointProperties& p) : PathOf(p, own(p)) {}

    double step(const Jump& jump) { // returns what is dissipated
        const double normal = state.normalStress;
        const Shear shear = state.shearStress;
        const auto lost = law.properties().elastic ? stepWithoutStrength(jump) : law.advance(k, state, jump);
        dissipated.tension += lost.tension;
        dissipated.shear += lost.shear;
        dissipated.compression += lost.compression;
        work += 0.5 * ((normal + state.normalStress) * jump.opening + (shear.a + state.shearStress.a) * jump.slide.a +
                       (shear.b + state.shearStress.b) * jump.slide.b);
        return sum(lost);
    }
    Energies stepWithoutStrength(const Jump& jump) { // columns do it without asking the law
        state.opening += jump.opening;
        state.normalStress = k.normal * (state.opening + (state.crushing - state.dilation));
        state.shearStress.a += k.shear * jump.slide.a;
        state.shearStress.b += k.shear * jump.slide.b;
        state.regime = Regime::Elastic;
        return {};
    }
    void move(
        const Jump& to, int steps, const std::function<void()>& look = [] {}) {
        for (int i = 0; i < steps; ++i) {
            step({to.opening / steps, {to.slide.a / steps, to.slide.b / steps}});
            look();
        }
    }
    double elasticOpening() const { return state.opening + state.crushing - state.dilation; }
    void press(double sigma, int steps = 10) { move({sigma / k.normal - elasticOpening(), {}}, steps); }
    void slideUnder( // constant normal stress, so that it may rise
        double sigma, const Shear& by, int steps, const std::function<void()>& look = [] {}) {
        for (int i = 0; i < steps; ++i) {
            step({sigma / k.normal - elasticOpening(), {by.a / steps, by.b / steps}});
            look();
        }
    }
    double stored() const { return sum(law.stored(k, state)); }
    double lost() const { return sum(dissipated); }
};

struct Dice : Chance {
    using Chance::Chance;
    JointProperties properties() {
        JointProperties p;
        p.normalStiffness = logarithmic(1e9, 1e13);
        p.shearStiffness = p.normalStiffness * between(0.1, 1);
        p.friction = happens(0.1) ? 0 : between(0, 2);
        p.residualFriction = p.friction * (happens(0.3) ? 1 : between(0, 1));
        p.cohesion = happens(0.1) ? 0 : logarithmic(1e2, 1e8);
        if (p.cohesion == 0) p.residualFriction = p.friction;
        p.residualCohesion = p.cohesion * (happens(0.5) ? 0 : between(0, 1));
        p.tensileStrength = p.friction > 0 ? std::min(1e9, p.cohesion / p.friction) * between(0, 1) : p.cohesion;
        p.dilatancy = happens(0.5) ? 0 : p.residualFriction * between(0, 1);
        p.dilatancyDecay = happens(0.5) ? 0 : logarithmic(1, 1e5);
        p.modeIFractureEnergy = logarithmic(0.1, 1e3);
        p.modeIIFractureEnergy = logarithmic(0.1, 1e4);
        if (happens(0.3)) p.tensionTable = {{1, 0}, {between(1.1, 5), between(0, 0.5)}, {50, between(0.5, 1)}};
        if (happens(0.3)) p.shearTable = SofteningTable::brittle();
        p.cap = happens(0.8);
        p.compressiveStrength = logarithmic(1e5, 1e9);
        p.elasticLimitRatio = between(0.05, 0.95);
        p.residualStrengthRatio = happens(0.3) ? 0 : between(0, 0.95);
        p.peakRatio = logarithmic(1, 100);
        p.compressiveFractureEnergy =
            CompressionCurve::smallestFractureEnergy(p.normalStiffness, p.compressiveStrength, p.elasticLimitRatio,
                                                     p.residualStrengthRatio, p.peakRatio) *
            logarithmic(1.01, 10);
        p.capShear = happens(0.2) ? 0 : logarithmic(0.1, 100);
        p.capNormal = logarithmic(0.1, 10);
        p.capLinear = happens(0.5) ? 0 : between(-0.3, 0.3) * p.compressiveStrength;
        return p;
    }
};

// A joint for a law: for the cyclic one with strengths that lie close together.
template <class L> DrawnJoint drawn(Dice& dice) {
    if constexpr (std::is_same_v<L, CyclicLaw>) return DrawnJoint::of(dice);
    const auto p = dice.properties();
    const double softer = dice.happens(0.5) ? 1 : dice.between(0.05, 1), kn = p.normalStiffness * softer;
    const double strongest = std::max(p.tensileStrength, p.cohesion) + (p.cap ? p.compressiveStrength : 0) + 1;
    return {p, {kn, p.shearStiffness * softer}, strongest / kn};
}

} // namespace masonry
