// SPDX-License-Identifier: GPL-2.0-or-later
// The stiffness that a joint shows: its own in series with the elasticity of its rigid units (law/README.md, Rigid
// units).
#pragma once
#include "JointView.hpp"
#include "UnitMaterial.hpp"

namespace masonry {

class SceneStore;

// The stiffness of a joint with this geometry between these units, of which the rigid ones add their elasticity. Zones
// of a deformable unit deform themselves. Throws std::invalid_argument if a softening branch of the joint would snap
// back.
ElasticStiffness lumpedStiffness(const PropertySet&, const UnitMaterial& unit1, const UnitMaterial& unit2,
                                 const JointReference&);

// Gives the joints of bricks that are whole until they crack the stiffness that they have between whole bricks: the
// centre of the brick counts, not that of its half. The crack surfaces themselves are between halves. For connect().
void lumpWholeBricks(SceneStore&);

} // namespace masonry
