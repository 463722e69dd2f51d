// SPDX-License-Identifier: GPL-2.0-or-later
#include "FallenBlocks.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace masonry {

using yade::Quaternionr;
using yade::Vector3r;

namespace {

double kineticEnergy(const BodyColumns& bodies, int body) {
    const auto& s = bodies.state(body);
    double twice = (s.ori.conjugate() * bodies.spinOf(body)).cwiseAbs2().dot(s.inertia);
    for (int d = 0; d < 3; ++d)
        twice += s.mass * bodies.velocity[d][body] * bodies.velocity[d][body];
    return 0.5 * twice;
}

} // namespace

void FallenBlocks::watch(const SceneContents& contents) {
    for (auto& fall : all_) {
        const double energy = kineticEnergy(contents.bodies, fall.body);
        if (energy <= fall.most) continue;
        fall.most = energy;
        fall.at = contents.scene().time;
    }
}

void FallenBlocks::look(const SceneContents& contents, const std::vector<int>& loose, const std::vector<Size>& sizes,
                        const Vector3r& gravity) {
    Eigen::Index down;
    gravity.cwiseAbs().maxCoeff(&down);
    const double now = contents.scene().time;
    auto known = all_.begin();
    for (int body : loose) {
        known = std::lower_bound(known, all_.end(), body, [](const Fall& fall, int id) { return fall.body < id; });
        if (known == all_.end() || known->body != body) known = all_.insert(known, {body, now, -1, 0, now});
        auto& fall = *known;
        if (fall.fell >= 0) continue;
        const auto& s = contents.bodies.state(body);
        const bool turned = std::abs((s.refOri.conjugate() * s.ori).w()) < std::cos(0.5 * turn);
        const auto& size = sizes[body];
        const Vector3r moved = s.pos - s.refPos;
        const double sunk = gravity[down] > 0 ? moved[down] : -moved[down];
        const bool cameDown = gravity.isZero(0) || sunk > drop * size.thickness;
        if (turned || (cameDown && moved.norm() > travel * size.diameter)) fall.fell = now;
    }
}

std::vector<unsigned char> heldByJoints(const SceneContents& contents) {
    constexpr unsigned allAxes = 63;
    const int count = contents.bodies.size();
    // One set for all that is joined: every body points to another one of its set, the first of it to itself.
    std::vector<int> next(count);
    std::iota(next.begin(), next.end(), 0);
    const auto first = [&](int body) {
        while (next[body] != body)
            body = next[body] = next[next[body]];
        return body;
    };
    contents.eachJoint([&](const JointView& joint) {
        const auto& sides = joint.geom->reference().sides;
        next[first(sides[0].body)] = first(sides[1].body);
    });
    std::vector<unsigned char> held(count, 0);
    for (int b = 0; b < count; ++b)
        if (contents.bodies.has(b) && contents.bodies.blockedAxes(b) == allAxes) held[first(b)] = 1;
    for (int b = 0; b < count; ++b)
        held[b] = held[first(b)];
    return held;
}

} // namespace masonry
