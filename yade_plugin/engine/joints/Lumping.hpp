// SPDX-License-Identifier: GPL-2.0-or-later
// The stiffness that a joint shows: its own in series with the elasticity of its rigid units (law/README.md, Rigid
// units).
#pragma once
#include "JointView.hpp"
#include "engine/bodies/UnitMaterial.hpp"

namespace masonry {

// The stiffness of a joint with this geometry between these units, of which the rigid ones add their elasticity. Zones
// of a deformable unit deform themselves. Throws std::invalid_argument if a softening branch of the joint would snap
// back.
ElasticStiffness lumpedStiffness(const PropertySet&, const UnitMaterial& unit1, const UnitMaterial& unit2,
                                 const JointReference&);

} // namespace masonry
