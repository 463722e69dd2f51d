// SPDX-License-Identifier: GPL-2.0-or-later
// Place, motion and mass of the bodies of a scene, in columns; the row of a body is its id. Integrator moves the rigid
// bodies here, and writes the host's State once a step. Scripts and other engines may change a State between two steps;
// the engines of this plugin detect that before they use the columns.
#pragma once
#include "host/Yade.hpp"
#include "motion/RigidMotion.hpp"
#include <cstdint>
#include <cstring>

namespace masonry {

// The factor of a body, of factors by ids beyond whose end it is 1.
inline double factorOf(const std::vector<double>& factors, int body) {
    return body < int(factors.size()) ? factors[body] : 1;
}

class BodyColumns : public RigidColumns {
public:
    // Takes all bodies of a scene from the host.
    void read(const yade::Scene&);
    // Whether the scene's bodies are still those that were read.
    bool fits(const yade::Scene&) const;

    int size() const { return int(states_.size()); }
    bool has(int body) const { return states_[body] != nullptr; }
    yade::State& state(int body) const { return *states_[body]; }
    // A vector of a body from three columns.
    static yade::Vector3r row(const std::vector<double>* columns, int body) {
        return {columns[0][body], columns[1][body], columns[2][body]};
    }
    yade::Vector3r placeOf(int body) const { return row(position, body); }
    yade::Vector3r spinOf(int body) const { return row(velocity + 3, body); }
    yade::Quaternionr turnOf(int body) const {
        return {orientation[0][body], orientation[1][body], orientation[2][body], orientation[3][body]};
    }
    // Axes 0 to 2 are the translations along x, y and z, axes 3 to 5 the rotations about them.
    bool isBlocked(int body, int axis) const { return seen_[body].blocked >> axis & 1; }
    unsigned blockedAxes(int body) const { return seen_[body].blocked; } // as in State.blockedDOFs
    bool isDamped(int body) const { return seen_[body].damped; }
    // Whether no rotation is blocked, so that the body turns freely in space.
    bool spins(int body) const { return seen_[body].blocked >> 3 == 0; }
    // One bit for each of the six axes in which the body is free or has a velocity.
    unsigned axes(int body) const { return seen_[body].axes; }

    // Each of these takes a body from the host if its State has changed since it was last taken or given: detectMove()
    // compares position and orientation, detectChange() also velocities, mass, blocked axes and damping,
    // detectAnyChange() also inertia and reference place, which hardly ever change.
    void detectMove(int body) {
        if (!samePlace(body)) take(body);
    }
    void detectChange(int body) {
        if (!samePlace(body) || !sameMotion(body)) take(body);
    }
    void detectAnyChange(int body) {
        if (!samePlace(body) || !sameMotion(body) || !sameFrame(body)) take(body);
    }
    // The motion along blocked axes with which a body made its last step, if it has been taken since, else null.
    struct Prescribed {
        unsigned blocked; // as blockedAxes()
        double velocity[6];
    };
    const Prescribed* earlier(int body) const { return taken_[body] ? &earlier_[body] : nullptr; }
    void forgetEarlier(int body) { taken_[body] = false; }
    // Asks the processor for the body's State, so that it is in the cache when it is needed.
    void prefetch(int body) const;
    // Writes place and motion of a body into the host's State, for the axes whose bits are set.
    void give(int body, unsigned axes);
    // Sets position and orientation of a body, here and in the host's State.
    void setPlace(int body, const yade::Vector3r& place, const yade::Quaternionr& turned);
    // Reads all of a body from the host's State.
    void take(int body);
    // Takes the factors on the inertia of bodies, see Integrator.
    void scaleInertia(const std::vector<double>& factors);
    double inertiaFactor(int body) const { return factorOf(factors_, body); }
    bool isScaled() const { return !factors_.empty(); }

    std::vector<double> referencePosition[3]; // [m]
    std::vector<double> fromReference[4];     // inverse of the reference orientation: w, x, y, z
    std::vector<double> weighed;              // mass that has a weight [kg]

    std::vector<unsigned char> isUnit; // whether the body is a deformable unit, which Zones moves

private:
    struct Seen {           // what the host's State held beside the columns when the body was last taken
        unsigned blocked;   // one bit for each blocked axis, as in State.blockedDOFs
        bool damped;        // whether the integrator damps the body
        unsigned char axes; // see axes()
    };
    bool samePlace(int body) const;
    bool sameMotion(int body) const;
    bool sameFrame(int body) const; // compares inertia and reference place

    std::vector<Seen> seen_;
    std::vector<double> factors_;
    std::vector<Prescribed> earlier_;
    std::vector<unsigned char> taken_; // whether earlier_ holds something
    std::vector<const yade::Body*> bodies_;
    std::vector<boost::shared_ptr<yade::State>> states_;
};

// The bits of a number: to compare them is quicker, and a NaN is then equal to itself.
inline std::uint64_t bitsOf(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

inline bool BodyColumns::samePlace(int b) const {
    const auto& s = *states_[b];
    const double* q = s.ori.coeffs().data(); // in the order x, y, z, w
    std::uint64_t differs = bitsOf(q[3]) ^ bitsOf(orientation[0][b]);
    for (int d = 0; d < 3; ++d)
        differs |= (bitsOf(s.pos[d]) ^ bitsOf(position[d][b])) | (bitsOf(q[d]) ^ bitsOf(orientation[1 + d][b]));
    return differs == 0;
}

inline bool BodyColumns::sameMotion(int b) const {
    const auto& s = *states_[b];
    const auto& seen = seen_[b];
    std::uint64_t differs = bitsOf(s.mass) ^ bitsOf(weighed[b]);
    for (int d = 0; d < 3; ++d)
        differs |= (bitsOf(s.vel[d]) ^ bitsOf(velocity[d][b])) | (bitsOf(s.angVel[d]) ^ bitsOf(velocity[3 + d][b]));
    return (differs | (s.blockedDOFs ^ seen.blocked) | std::uint64_t(s.isDamped != seen.damped)) == 0;
}

inline void BodyColumns::prefetch(int b) const {
    const char* state = reinterpret_cast<const char*>(states_[b].get());
    for (int line = 1; line < 5; ++line) // the cache lines that hold what a step needs
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
