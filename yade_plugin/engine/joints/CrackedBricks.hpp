// SPDX-License-Identifier: GPL-2.0-or-later
// Bricks in two deformable units that move as one until their crack surface yields.
#pragma once
#include "JointGroup.hpp"
#include "engine/units/Zones.hpp"

namespace masonry {

// First bodies of the whole bricks whose crack surface yields in this step. If the scaling of masses has changed, also
// of those whose crack surface has ever lost energy.
std::vector<int> newlyCracked(const Zones&, const std::vector<JointKind>&);

} // namespace masonry
