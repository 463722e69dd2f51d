// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ties.hpp"
#include <algorithm>

namespace masonry {

std::vector<std::string> Ties::problems() const {
    auto found = problemsOfEnds();
    check(found, "stiffness", stiffness, count(), ofStiffness());
    check(found, "strength", strength, count(), ofStrength());
    check(found, "breaking", breaking, count(), ofBreaking());
    check(found, "rest", rest, count(), ofRest());
    if (int(compression.size()) != count()) found.push_back("compression must have 0 or 1 for each connector");
    for (std::size_t i = 0; found.empty() && i < points1.size(); ++i)
        if (!((points2[i] - points1[i]).norm() > 0))
            found.push_back("the ends of connector " + std::to_string(i) + " must not be at the same place");
    return found;
}

// Let e be the elongation of the distance between the ends, u = e - rest that of the bar since it got its length, and p
// its plastic part. The force is F = k (u - p), not below 0 in a bar without compression, and p grows where F would
// pass the strength. By the trapezoidal rule the bar takes up (F + F') / 2 (u' - u) in a step: what is not stored in
// F² / (2 k) is dissipated. Where `rest` changes, the bar is tightened from outside, which does -(F + F') / 2 times
// that change.
void Ties::act(SceneContents& contents) {
    const int n = count();
    fit(elongations, n, 0.0);
    fit(forces, n, 0.0);
    fit(flows, n, 0.0);
    fit(yieldedAt, n, -1);
    fit(brokenAt, n, -1);
    if (int(restBefore.size()) != n) restBefore.assign(std::size_t(n), 0.0);
    auto& scene = contents.scene();
    const auto sums = scene.forces().sums(contents.bodies.size());
    const int step = int(scene.iter);
    stored = 0;
    for (std::size_t i = 0; i < std::size_t(n); ++i) {
        if (brokenAt[i] >= 0) {
            restBefore[i] = rest[i];
            continue;
        }
        const int one = bodies1[i], other = bodies2[i];
        const End a = endOf(contents, one, points1[i]), b = endOf(contents, other, points2[i]);
        const Vector3r span = b.place - a.place, spanThen = points2[i] - points1[i];
        const double length = span.norm(), lengthThen = spanThen.norm();
        // (l² - L²) / (l + L) in place of l - L, which would lose digits
        const double elongation = (span - spanThen).dot(span + spanThen) / (length + lengthThen);
        const double k = stiffness[i], before = forces[i], u = elongation - rest[i];
        double force = k * (u - flows[i]);
        if (force < 0 && compression[i] == 0) force = 0;
        if (std::abs(force) > strength[i]) {
            const double most = std::copysign(strength[i], force);
            flows[i] += (force - most) / k;
            force = most;
            if (yieldedAt[i] < 0) yieldedAt[i] = step;
        }
        const double tightened = rest[i] - restBefore[i];
        const double stretched = elongation - elongations[i];
        const double mean = 0.5 * (before + force);
        given -= mean * tightened;
        dissipated += mean * (stretched - tightened) - 0.5 * (force - before) * (force + before) / k;
        if (u > breaking[i]) {
            dissipated += 0.5 * force * force / k;
            force = 0;
            brokenAt[i] = step;
        }
        elongations[i] = elongation;
        restBefore[i] = rest[i];
        forces[i] = force;
        stored += 0.5 * force * force / k;
        if (force == 0) continue;
        const Vector3r pull = force / length * span;
        if (one != ground) {
            sums.forces[one] += pull;
            sums.torques[one] += a.arm.cross(pull);
        }
        if (other != ground) {
            sums.forces[other] -= pull;
            sums.torques[other] -= b.arm.cross(pull);
        }
    }
}

} // namespace masonry
