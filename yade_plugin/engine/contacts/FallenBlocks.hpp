// SPDX-License-Identifier: GPL-2.0-or-later
// What has come loose in a scene whose joints are handed over to contact: when, how fast it was at most, and when it
// had fallen.
#pragma once
#include "engine/joints/SceneContents.hpp"
#include <vector>

namespace masonry {

// A block that no joints hold.
struct Fall {
    int body;
    double since; // when it was first seen so [s]
    double fell;  // when it had fallen [s]; -1: it has not
    double most;  // largest kinetic energy since then [J]
    double at;    // when it had that [s]

    template <class Visit> void visitState(Visit&& visit) { visit(body, since, fell, most, at); }
};

class FallenBlocks {
public:
    // Twice the largest distance of a corner of a block from its centre, and its thickness [m].
    struct Size {
        double diameter, thickness;
    };
    // A block has fallen when it has turned by so much since the reference state [rad], ...
    static constexpr double turn = 1.0471975511965976; // 60°
    static constexpr double travel = 1; // ... or when its centre has moved by so many of its diameters [-], ...
    static constexpr double drop = 0.5; // ... and come down by so many of its thicknesses [-]: it has not just slid

    // Looks at bodies, sorted by their ids, whose sizes are given by id. Down is the axis that is nearest to gravity;
    // without gravity nothing need come down.
    void look(const SceneContents&, const std::vector<int>& loose, const std::vector<Size>& sizes,
              const yade::Vector3r& gravity);
    // Keeps the largest kinetic energy of each block that has come loose; to be called in every step.
    void watch(const SceneContents&);
    const std::vector<Fall>& all() const { return all_; } // sorted by body

    void visitState(StateNumbers& visit) { visit(all_); }

private:
    std::vector<Fall> all_;
};

// Whether each body, by its id, is held by joints that were not handed over, one after the other, from a body whose
// axes are all blocked, which counts as held itself.
std::vector<unsigned char> heldByJoints(const SceneContents&);

} // namespace masonry
