// SPDX-License-Identifier: GPL-2.0-or-later
#include "Lumping.hpp"
#include "common/Text.hpp"

namespace masonry {

ElasticStiffness lumpedStiffness(const PropertySet& joint, const UnitMaterial& unit1, const UnitMaterial& unit2,
                                 double distance1, double distance2) {
    const auto k = inSeriesWithUnits(joint, distance1 / unit1.young + distance2 / unit2.young,
                                     distance1 / unit1.shearModulus() + distance2 / unit2.shearModulus());
    const auto problems = joint.ownLaw()->snapsBack(k, distance1 + distance2);
    if (!problems.empty())
        throw std::invalid_argument("joint \"" + joint.name +
                                    "\": " + joined(problems, ("\njoint \"" + joint.name + "\": ").c_str()));
    return k;
}

} // namespace masonry
