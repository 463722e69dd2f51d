#include "BodyColumns.hpp"
#include <cstring>

namespace masonry {

using yade::State;

namespace {

// What changes with a step, and what hardly ever does, each stand in one piece in the host's State
// (host/SelfCheck.cpp).
constexpr std::size_t placeSize = 7 * sizeof(double);
const void* motionOf(const State& s) { return s.pos.data(); }
const void* frameOf(const State& s) { return s.inertia.data(); }

} // namespace

void BodyColumns::read(const yade::Scene& scene) {
    const auto& all = scene.bodies->body;
    const int count = int(all.size());
    resize(count);
    for (auto& column : referencePosition)
        column.assign(count, 0);
    fromReference.assign(count, yade::Quaternionr::Identity());
    seen_.assign(count, Seen{});
    bodies_.assign(count, nullptr);
    states_.assign(count, nullptr);
    for (int b = 0; b < count; ++b) {
        if (!all[b]) continue;
        bodies_[b] = all[b].get();
        states_[b] = all[b]->state;
        if (states_[b])
            take(b);
        else
            seen_[b].blocked = 63;
    }
    for (int b = 0; b < count; ++b)
        if (!states_[b]) seen_[b].blocked = 63; // an empty place: nothing in it moves
}

bool BodyColumns::fits(const yade::Scene& scene, bool thoroughly) const {
    const auto& all = scene.bodies->body;
    if (all.size() != bodies_.size()) return false;
    for (std::size_t b = 0; b < all.size(); ++b)
        if (all[b].get() != bodies_[b] || (thoroughly && all[b] && all[b]->state != states_[b])) return false;
    return true;
}

bool BodyColumns::samePlace(int body) const {
    return std::memcmp(motionOf(*states_[body]), seen_[body].motion, placeSize) == 0;
}

bool BodyColumns::same(int body) const {
    const auto& s = *states_[body];
    const auto& seen = seen_[body];
    return std::memcmp(motionOf(s), seen.motion, sizeof seen.motion) == 0 &&
           std::memcmp(frameOf(s), seen.frame, sizeof seen.frame) == 0;
}

void BodyColumns::prefetch(int body) const {
    const char* state = reinterpret_cast<const char*>(states_[body].get());
    for (int line = 1; line < 5; ++line) // States lie all over the memory
        __builtin_prefetch(state + 64 * line);
}

void BodyColumns::take(int b) {
    const auto& s = *states_[b];
    auto& seen = seen_[b];
    std::memcpy(seen.motion, motionOf(s), sizeof seen.motion);
    std::memcpy(seen.frame, frameOf(s), sizeof seen.frame);
    seen.blocked = s.blockedDOFs & 63;
    seen.damped = s.isDamped;
    seen.axes = ~s.blockedDOFs & 63;
    mass[b] = s.mass;
    orientation[0][b] = s.ori.w();
    for (int d = 0; d < 3; ++d) {
        position[d][b] = s.pos[d];
        orientation[1 + d][b] = s.ori.coeffs()[d];
        velocity[d][b] = s.vel[d];
        velocity[3 + d][b] = s.angVel[d];
        inertia[d][b] = s.inertia[d];
        referencePosition[d][b] = s.refPos[d];
        seen.axes |= (s.vel[d] != 0) << d | (s.angVel[d] != 0) << (3 + d);
    }
    fromReference[b] = s.refOri.conjugate();
}

void BodyColumns::give(int b) {
    auto& s = *states_[b];
    s.ori.w() = orientation[0][b];
    for (int d = 0; d < 3; ++d) {
        s.pos[d] = position[d][b];
        s.ori.coeffs()[d] = orientation[1 + d][b];
        s.vel[d] = velocity[d][b];
        s.angVel[d] = velocity[3 + d][b];
    }
    std::memcpy(seen_[b].motion, motionOf(s), sizeof seen_[b].motion);
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
    std::memcpy(seen_[b].motion, motionOf(s), placeSize);
}

} // namespace masonry
