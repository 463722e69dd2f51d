// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryIntegrator.hpp"

MASONRY_DEFINE(MasonryIntegrator)

namespace masonry {

void MasonryIntegrator::step(SceneStore& store) { advance(*scene, store.bodies, store.loads, store.foreignForces); }

} // namespace masonry
