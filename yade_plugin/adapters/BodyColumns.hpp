// Where the bodies of a scene are and how they move, in columns: the home of what MasonryIntegrator moves. A body's
// number is its id. The host's State is written once a step; what somebody else changed in it is noticed before it is
// used.
#pragma once
#include "host/Yade.hpp"
#include "motion/RigidMotion.hpp"

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
    yade::Quaternionr orientationOf(int body) const {
        return {orientation[0][body], orientation[1][body], orientation[2][body], orientation[3][body]};
    }

    // Takes from the host what somebody changed there: places, or all.
    void noticePlace(int body) {
        if (!samePlace(body)) take(body);
    }
    void notice(int body) {
        if (!same(body)) take(body);
    }
    void prefetch(int body) const;
    // Gives the host the body's place and motion.
    void give(int body);
    // Gives the body a new place, here and in the host.
    void setPlace(int body, const yade::Vector3r& place, const yade::Quaternionr& turned);
    // Takes all of a body from the host.
    void take(int body);

    std::vector<double> referencePosition[3];     // [m]
    std::vector<yade::Quaternionr> fromReference; // inverse of the reference orientation

private:
    struct Seen {         // what the host's State held when it was last taken or given
        char motion[112]; // position, orientation, velocity, mass, angular velocity, as they stand in a State
        char frame[85];   // inertia, reference place, blocked motions, whether damped, as they stand in a State
        unsigned char blocked;
        bool damped;
        unsigned char axes;
    };
    bool samePlace(int body) const;
    bool same(int body) const;

    std::vector<Seen> seen_;
    std::vector<const yade::Body*> bodies_;
    std::vector<boost::shared_ptr<yade::State>> states_;
};

} // namespace masonry
