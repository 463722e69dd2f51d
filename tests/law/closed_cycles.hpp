// SPDX-License-Identifier: GPL-2.0-or-later
// Search for paths on which a joint gives back more work than it was given: hill climbing over closed paths of the
// displacement jump in three dimensions, for joints drawn at random with all that the cyclic law can do.
#pragma once
#include "../chance.hpp"
#include "law/cyclic_softening/CyclicLaw.hpp"
#include <array>
#include <cmath>
#include <vector>

namespace masonry {

// A joint whose strengths lie close together and whose bond is brittle, so that a path of a few elastic displacements
// opens, slips and crushes it.
struct DrawnJoint {
    JointProperties properties;
    ElasticStiffness stiffness; // its own, or in series with units
    double reach;               // [m] displacement at which the joint is crushed or its bond lost

    static DrawnJoint of(Chance& chance) {
        JointProperties p;
        p.law = "cyclic";
        p.normalStiffness = 1e11;
        p.shearStiffness = p.normalStiffness * chance.between(0.2, 1);
        p.friction = chance.between(0, 1.2);
        p.residualFriction = p.friction * (chance.happens(0.3) ? 1 : chance.between(0, 1));
        const bool dry = chance.happens(0.3);
        const double cohesion = 1e5;
        p.cohesion = dry ? 0 : cohesion;
        if (dry) p.residualFriction = p.friction;
        p.residualCohesion = p.cohesion * (chance.happens(0.5) ? 0 : chance.between(0, 1));
        p.tensileStrength = dry ? 0 : cohesion * chance.between(0, 1) / std::max(1., p.friction);
        const double elastic = cohesion * cohesion / p.normalStiffness; // [J/m²]
        p.modeIFractureEnergy = elastic * chance.between(10, 40);
        p.modeIIFractureEnergy = elastic * chance.between(50, 200);
        p.shearStiffnessLoss = chance.happens(0.4) ? 0 : chance.between(0, 0.9);
        p.bondLossByCrushing = chance.happens(0.4) ? 0 : chance.between(0, 1);
        const double steepest =
            (1 - p.shearStiffnessLoss) * p.shearStiffness / (std::max(p.friction, 0.01) * p.normalStiffness);
        p.dilatancy = chance.happens(0.4) ? 0 : std::min(p.residualFriction, 0.9 * steepest) * chance.between(0, 1);
        p.dilatancyDecay = chance.happens(0.5) ? 0 : p.normalStiffness / cohesion * chance.logarithmic(0.01, 1);
        p.cap = chance.happens(0.8);
        p.compressiveStrength = cohesion * chance.between(1, 15);
        p.elasticLimitRatio = chance.between(0.1, 0.9);
        p.residualStrengthRatio = chance.between(0, 0.9);
        p.peakRatio = chance.between(1.5, 5);
        p.compressiveFractureEnergy =
            CompressionCurve::smallestFractureEnergy(p.normalStiffness, p.compressiveStrength, p.elasticLimitRatio,
                                                     p.residualStrengthRatio, p.peakRatio) *
            chance.between(1.1, 3);
        p.capShear = chance.happens(0.2) ? 0 : chance.logarithmic(0.3, 30);
        p.compressionStiffnessLoss = chance.happens(0.4) ? 0 : chance.between(0, 0.9);
        if (dry && chance.happens(0.5)) { // it closes on a curve
            p.compressionStiffnessLoss = 0;
            p.initialClosingStiffness = p.normalStiffness * chance.between(0.1, 0.9);
            p.closureLimit = p.compressiveStrength / p.normalStiffness * chance.between(0.3, 3);
        }
        const double softer = chance.happens(0.5) ? 1 : chance.between(0.5, 1);
        const double reach = (cohesion + (p.cap ? 3 * p.compressiveStrength : 10 * cohesion)) / p.normalStiffness;
        return {p, {p.normalStiffness * softer, p.shearStiffness * softer}, reach};
    }
};

using Corner = std::array<double, 3>; // [m] opening and slide

struct Balance {
    double work = 0;  // [J/m²] of the whole path
    double moved = 0; // [J/m²] work without its signs
    double lost = 0;  // [J/m²] dissipated by the law's own account
    double step = 0;  // [m] longest step
};

// The path from a new joint through the corners, and back to no displacement; `laps` times, every side in equal steps.
inline Balance walk(const CyclicLaw& law, const ElasticStiffness& k, const std::vector<Corner>& corners, int steps,
                    int laps) {
    CyclicState state;
    Balance balance;
    Corner at{};
    for (int lap = 0; lap < laps; ++lap)
        for (std::size_t i = 0; i <= corners.size(); ++i) {
            const Corner to = i < corners.size() ? corners[i] : Corner{};
            const Jump jump{(to[0] - at[0]) / steps, {(to[1] - at[1]) / steps, (to[2] - at[2]) / steps}};
            at = to;
            balance.step = std::max(balance.step, std::sqrt(jump.opening * jump.opening + jump.slide.a * jump.slide.a +
                                                            jump.slide.b * jump.slide.b));
            for (int step = 0; step < steps; ++step) {
                const double normal = state.normalStress;
                const Shear shear = state.shearStress;
                const auto lost = law.advance(k, state, jump);
                const double work = 0.5 * ((normal + state.normalStress) * jump.opening +
                                           (shear.a + state.shearStress.a) * jump.slide.a +
                                           (shear.b + state.shearStress.b) * jump.slide.b);
                balance.work += work;
                balance.moved += std::abs(work);
                balance.lost += lost.tension + lost.shear + lost.compression;
            }
        }
    return balance;
}

struct Found {
    double coarse; // [-] smallest share of work given back, with the steps of the search
    double fine;   // [-] the same path in finer steps: a fault of the law stays, one of the finite steps goes away
};

// Climbs from random closed paths towards less work. The work, or what the law says it has lost, is taken as a share of
// the work without its signs and a thousand times kn·h², h the longest step: a step across contact, or the first one
// that slips, can give back up to kn·h²/8 by the trapezoidal rule, whatever the law (yade_plugin/law/README.md).
inline Found climb(Chance& chance, const DrawnJoint& joint, int starts, int tries, int steps, int finer) {
    const CyclicLaw law(joint.properties);
    const auto share = [&](const std::vector<Corner>& corners, int count, int laps) {
        const Balance b = walk(law, joint.stiffness, corners, count, laps);
        return std::min(b.work, b.lost) / (b.moved + 1e3 * joint.stiffness.normal * b.step * b.step);
    };
    const auto drawn = [&] {
        const double size = joint.reach * chance.logarithmic(0.02, 1);
        Corner c;
        for (auto& x : c)
            x = chance.happens(0.15) ? 0 : size * chance.between(-1, 1);
        return c;
    };
    Found worst{HUGE_VAL, HUGE_VAL};
    for (int start = 0; start < starts; ++start) {
        std::vector<Corner> path(3 + chance.oneOf(5));
        for (auto& corner : path)
            corner = drawn();
        const int laps = 1 + int(chance.oneOf(2));
        double best = share(path, steps, laps);
        double stride = 0.5;
        for (int i = 0; i < tries; ++i) {
            auto other = path;
            auto& corner = other[chance.oneOf(other.size())];
            const double kind = chance.between(0, 1);
            if (kind < 0.1)
                corner = drawn();
            else if (kind < 0.2)
                corner[chance.oneOf(3)] = 0;
            else if (kind < 0.3)
                corner = other[chance.oneOf(other.size())];
            else
                for (auto& x : corner)
                    x = x * (1 + stride * chance.between(-1, 1)) + 0.01 * stride * joint.reach * chance.between(-1, 1);
            const double found = share(other, steps, laps);
            if (found < best) {
                best = found;
                path = other;
                stride = std::min(1., 1.3 * stride);
            } else
                stride = std::max(1e-3, 0.97 * stride);
        }
        worst.coarse = std::min(worst.coarse, best);
        worst.fine = std::min(worst.fine, share(path, steps * finer, laps));
    }
    return worst;
}

} // namespace masonry
