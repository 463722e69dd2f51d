// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <array>

namespace masonry {

// How a subcontact moves with the surface of a deformable unit: by the weighted mean of three of its nodes. A
// subcontact at a node has the weights 1, 0, 0.
struct Attachment {
    std::array<int, 3> nodes{0, 0, 0};      // numbers in the lists of Zones
    std::array<double, 3> weights{1, 0, 0}; // their sum is 1

    template <class Visit> void visitState(Visit&& visit) { visit(nodes, weights); }
};

} // namespace masonry
