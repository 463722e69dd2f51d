// SPDX-License-Identifier: GPL-2.0-or-later
// What a step of the joints takes from nodes and gives to bodies and nodes.
#pragma once
#include "JointBatches.hpp"

namespace masonry {

// Finds the displacements of all dependent points. In a planar run nothing moves along y.
template <bool plane> void moveDependentPoints(const JointBatches&, const SceneContents&);
// Brings the forces at joints and points to the host's forces and to the rows of Zones.
template <bool plane> void gatherForces(const JointBatches&, const SceneContents&);

extern template void moveDependentPoints<true>(const JointBatches&, const SceneContents&);
extern template void moveDependentPoints<false>(const JointBatches&, const SceneContents&);
extern template void gatherForces<true>(const JointBatches&, const SceneContents&);
extern template void gatherForces<false>(const JointBatches&, const SceneContents&);

} // namespace masonry
