// SPDX-License-Identifier: GPL-2.0-or-later
#include "Lumping.hpp"
#include "common/Text.hpp"

namespace masonry {

ElasticStiffness lumpedStiffness(const PropertySet& joint, const UnitMaterial& unit1, const UnitMaterial& unit2,
                                 const JointReference& r) {
    double normal = 0, shear = 0, distance = 0;
    for (int side = 0; side < 2; ++side) {
        if (!r.rigid(side)) continue;
        const auto& unit = side == 0 ? unit1 : unit2;
        normal += r.distance(side) / unit.young;
        shear += r.sides[side].shearShare * r.distance(side) / unit.shearModulus();
        distance += r.distance(side);
    }
    const auto k = inSeriesWithUnits(joint, normal, shear);
    const auto problems = joint.ownLaw()->snapsBack(k, distance);
    if (!problems.empty())
        throw std::invalid_argument("joint \"" + joint.name +
                                    "\": " + joined(problems, ("\njoint \"" + joint.name + "\": ").c_str()));
    return k;
}

} // namespace masonry
