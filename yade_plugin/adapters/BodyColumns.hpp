// Where the bodies of a scene are and how they move, in columns: the home of what MasonryIntegrator moves. A body's
// number is its id. The host's State is written once a step; what somebody else changed in it is noticed before it is
// used.
#pragma once
#include "host/Yade.hpp"
#include "motion/RigidMotion.hpp"
#include <cstdint>
#include <cstring>

namespace masonry {

class BodyColumns : public RigidColumns {
public:
    // Takes all bodies of a scene from the host.
    void read(const yade::Scene&);
    // Whether the scene's bodies are still those that were read; `thoroughly`: whether their States are, too.
    bool fits(const yade::Scene&, bool thoroughly) const;

    int size() const { return int(states_.size()); }
    bool has(int body) const { return states_[body] != nullptr; }
    yade::State& state(int body) const { return *states_[body]; }
    bool isBlocked(int body, int axis) const { return seen_[body].blocked >> axis & 1; } // 0-2 move, 3-5 turn
    bool isDamped(int body) const { return seen_[body].damped; }
    bool spins(int body) const { return seen_[body].blocked >> 3 == 0; } // no rotation is blocked: it turns in space
    // Bits of the translations and rotations in which the body is free or moves.
    unsigned axes(int body) const { return seen_[body].axes; }

    // Takes from the host what somebody changed there: places; place, motion, mass and blocked motions; or all.
    void noticePlace(int body) {
        if (!samePlace(body)) take(body);
    }
    void notice(int body) {
        if (!samePlace(body) || !sameMotion(body)) take(body);
    }
    void noticeAll(int body) {
        if (!samePlace(body) || !sameMotion(body) || !sameFrame(body)) take(body);
    }
    void prefetch(int body) const;
    // Gives the host place and motion of a body in the translations and rotations whose bits are set.
    void give(int body, unsigned axes);
    // Gives the body a new place, here and in the host.
    void setPlace(int body, const yade::Vector3r& place, const yade::Quaternionr& turned);
    // Takes all of a body from the host.
    void take(int body);

    std::vector<double> referencePosition[3]; // [m]
    std::vector<double> fromReference[4];     // inverse of the reference orientation

    std::vector<bool> isUnit; // a deformable unit, which MasonryZones moves

private:
    struct Seen { // beside the columns, what the host's State held when it was last taken or given
        unsigned blocked;
        bool damped;
        unsigned char axes;
    };
    bool samePlace(int body) const;
    bool sameMotion(int body) const;
    bool sameFrame(int body) const; // inertia and reference place, which hardly ever change

    std::vector<Seen> seen_;
    std::vector<const yade::Body*> bodies_;
    std::vector<boost::shared_ptr<yade::State>> states_;
};

// The bits of a number: a comparison of bits is quicker than one of numbers, and knows NaN again.
inline std::uint64_t bitsOf(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

inline bool BodyColumns::samePlace(int b) const {
    const auto& s = *states_[b];
    const double* q = s.ori.coeffs().data(); // x, y, z, w
    std::uint64_t differs = bitsOf(q[3]) ^ bitsOf(orientation[0][b]);
    for (int d = 0; d < 3; ++d)
        differs |= (bitsOf(s.pos[d]) ^ bitsOf(position[d][b])) | (bitsOf(q[d]) ^ bitsOf(orientation[1 + d][b]));
    return differs == 0;
}

inline bool BodyColumns::sameMotion(int b) const {
    const auto& s = *states_[b];
    const auto& seen = seen_[b];
    std::uint64_t differs = bitsOf(s.mass) ^ bitsOf(mass[b]);
    for (int d = 0; d < 3; ++d)
        differs |= (bitsOf(s.vel[d]) ^ bitsOf(velocity[d][b])) | (bitsOf(s.angVel[d]) ^ bitsOf(velocity[3 + d][b]));
    return (differs | (s.blockedDOFs ^ seen.blocked) | std::uint64_t(s.isDamped != seen.damped)) == 0;
}

inline void BodyColumns::prefetch(int b) const {
    const char* state = reinterpret_cast<const char*>(states_[b].get());
    for (int line = 1; line < 5; ++line) // States lie all over the memory
        __builtin_prefetch(state + 64 * line);
}

inline void BodyColumns::give(int b, unsigned axes) {
    auto& s = *states_[b];
    for (int d = 0; d < 3; ++d) {
        if (axes >> d & 1) {
            s.pos[d] = position[d][b];
            s.vel[d] = velocity[d][b];
        }
        if (axes >> (3 + d) & 1) s.angVel[d] = velocity[3 + d][b];
    }
    if (!(axes >> 3)) return;
    s.ori.w() = orientation[0][b];
    for (int d = 0; d < 3; ++d)
        s.ori.coeffs()[d] = orientation[1 + d][b];
}

} // namespace masonry
