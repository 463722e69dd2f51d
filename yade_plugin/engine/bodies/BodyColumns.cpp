// SPDX-License-Identifier: GPL-2.0-or-later
#include "BodyColumns.hpp"
#include "common/Parallel.hpp"
#include <algorithm>
#include <atomic>

namespace masonry {

using yade::State;

void BodyColumns::read(const yade::Scene& scene) {
    const auto& all = scene.bodies->body;
    const int count = int(all.size());
    const auto before = states_;
    resize(count);
    earlier_.resize(count);
    taken_.resize(count);
    for (auto& column : referencePosition)
        column.assign(count, 0);
    for (auto& column : fromReference)
        column.assign(count, 0);
    weighed.assign(count, 0);
    seen_.resize(count);
    isUnit.assign(count, false);
    bodies_.assign(count, nullptr);
    states_.assign(count, nullptr);
    for (int b = 0; b < count; ++b) {
        bodies_[b] = all[b].get();
        if (all[b]) states_[b] = all[b]->state;
        if (states_[b])
            take(b);
        else
            seen_[b].blocked = 63;
        // a body that was added since was not there in the last step, and did no work
        if (before.empty() || (b < int(before.size()) && before[b] != states_[b])) forgetEarlier(b);
    }
}

bool BodyColumns::fits(const yade::Scene& scene) const {
    const auto& all = scene.bodies->body;
    if (all.size() != bodies_.size()) return false;
    std::atomic<bool> same{true};
    Parallel::instance().overPieces(int(all.size()), 4096, [&](int first, int beyond) {
        if (!std::equal(all.begin() + first, all.begin() + beyond, bodies_.begin() + first,
                        [](const auto& body, const auto* known) { return body.get() == known; }))
            same = false;
    });
    return same;
}

bool BodyColumns::sameFrame(int b) const {
    const auto& s = *states_[b];
    bool same = s.refOri.w() == fromReference[0][b];
    for (int d = 0; d < 3; ++d)
        same = same && -s.refOri.vec()[d] == fromReference[1 + d][b] &&
               s.inertia[d] * inertiaFactor(b) == inertia[d][b] && s.refPos[d] == referencePosition[d][b];
    return same;
}

void BodyColumns::take(int b) {
    const auto& s = *states_[b];
    auto& seen = seen_[b];
    if (!taken_[b]) { // of several changes between two steps the velocity before the first one counts
        taken_[b] = true;
        earlier_[b].blocked = seen.blocked;
        for (int d = 0; d < 6; ++d)
            earlier_[b].velocity[d] = velocity[d][b];
    }
    seen.blocked = s.blockedDOFs;
    seen.damped = s.isDamped;
    seen.axes = ~s.blockedDOFs & 63;
    weighed[b] = s.mass;
    mass[b] = s.mass * inertiaFactor(b);
    orientation[0][b] = s.ori.w();
    for (int d = 0; d < 3; ++d) {
        position[d][b] = s.pos[d];
        orientation[1 + d][b] = s.ori.coeffs()[d];
        velocity[d][b] = s.vel[d];
        velocity[3 + d][b] = s.angVel[d];
        inertia[d][b] = s.inertia[d] * inertiaFactor(b);
        referencePosition[d][b] = s.refPos[d];
        seen.axes |= (s.vel[d] != 0) << d | (s.angVel[d] != 0) << (3 + d);
    }
    fromReference[0][b] = s.refOri.w();
    for (int d = 0; d < 3; ++d)
        fromReference[1 + d][b] = -s.refOri.vec()[d];
}

void BodyColumns::scaleInertia(const std::vector<double>& factors) {
    if (factors == factors_) return;
    factors_ = factors;
    for (int b = 0; b < size(); ++b) {
        if (!has(b)) continue;
        mass[b] = weighed[b] * inertiaFactor(b);
        for (int d = 0; d < 3; ++d)
            inertia[d][b] = state(b).inertia[d] * inertiaFactor(b);
    }
}

void BodyColumns::setPlace(int b, const yade::Vector3r& place, const yade::Quaternionr& turned) {
    auto& s = *states_[b];
    s.pos = place;
    s.ori = turned;
    orientation[0][b] = turned.w();
    for (int d = 0; d < 3; ++d) {
        position[d][b] = place[d];
        orientation[1 + d][b] = turned.coeffs()[d];
    }
}

} // namespace masonry
