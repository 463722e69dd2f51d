// SPDX-License-Identifier: GPL-2.0-or-later
// The stiffness that a joint shows: its own in series with the elasticity of its rigid units (law/README.md, Rigid
// units).
#pragma once
#include "JointView.hpp"
#include "UnitMaterial.hpp"

namespace masonry {

// The stiffness of a joint between units whose centres lie these distances from its plane [m]; zero for a deformable
// unit, whose zones deform themselves. Throws std::invalid_argument if a softening branch of the joint would snap back.
ElasticStiffness lumpedStiffness(const PropertySet&, const UnitMaterial&, const UnitMaterial&, double distance1,
                                 double distance2);

} // namespace masonry
