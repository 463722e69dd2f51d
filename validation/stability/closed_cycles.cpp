// SPDX-License-Identifier: GPL-2.0-or-later
// Looks for closed paths on which the cyclic law gives work back: closed_cycles [seconds] [seed].
#include "../../tests/law/closed_cycles.hpp"
#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int count, char** arguments) {
    using namespace masonry;
    using Clock = std::chrono::steady_clock;
    const double seconds = count > 1 ? std::atof(arguments[1]) : 60;
    Chance chance(count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1);
    const auto start = Clock::now();
    double coarse = HUGE_VAL;
    double fine = HUGE_VAL;
    long joints = 0;
    long paths = 0;
    while (std::chrono::duration<double>(Clock::now() - start).count() < seconds) {
        const auto joint = DrawnJoint::of(chance);
        const auto found = climb(chance, joint, 3, 300, 60, 32);
        ++joints;
        paths += 3 * 301;
        coarse = std::min(coarse, found.coarse);
        if (found.fine < fine) {
            fine = found.fine;
            const auto& p = joint.properties;
            std::printf(
                "%.2e (in 60 steps a side %.2e): omega %.2f, rho %.2f, chi %.2f, dilatancy %.2f, decay %.2g 1/m, "
                "kn0 %.2g Pa/m, lumped %.2f, cohesion %g Pa\n",
                fine, found.coarse, p.shearStiffnessLoss, p.compressionStiffnessLoss, p.bondLossByCrushing, p.dilatancy,
                p.dilatancyDecay, p.initialClosingStiffness, joint.stiffness.normal / p.normalStiffness, p.cohesion);
            std::fflush(stdout);
        }
    }
    std::printf("%ld joints, %ld closed paths: least work over work without its signs %.2e in 60 steps a side, %.2e in "
                "1920\n",
                joints, paths, coarse, fine);
    return fine < -1e-3; // what is more is no matter of steps
}
