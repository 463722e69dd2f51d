// SPDX-License-Identifier: GPL-2.0-or-later
#include "Lumping.hpp"
#include "MonolithicPairs.hpp"
#include "SceneStore.hpp"
#include "common/Text.hpp"
#include <cmath>

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

void lumpWholeBricks(SceneStore& store) {
    const auto pairs = monolithicPairs(store);
    std::vector<Vector3r> centres(store.bodies.size());
    std::vector<bool> isHalf(store.bodies.size(), false);
    std::vector<bool> isCrack(store.joints.size(), false);
    for (const auto& pair : pairs) {
        const auto &one = store.bodies.state(pair.body1), &two = store.bodies.state(pair.body2);
        isCrack[pair.joint] = true;
        for (int body : {pair.body1, pair.body2}) {
            centres[body] = (one.mass * one.pos + two.mass * two.pos) / (one.mass + two.mass);
            isHalf[body] = true;
        }
    }
    for (std::size_t n = 0; n < store.joints.size(); ++n) {
        const auto& r = store.joints[n].geom->reference();
        if (isCrack[n] || !(isHalf[r.sides[0].body] || isHalf[r.sides[1].body])) continue;
        const UnitMaterial* units[2];
        for (int side = 0; side < 2; ++side) {
            const int body = r.sides[side].body;
            units[side] = dynamic_cast<const UnitMaterial*>(store.scene().bodies->body[body]->material.get());
        }
        if (!units[0] || !units[1]) continue; // of a scene that was loaded from a file
        auto& phys = *store.joints[n].phys;
        const auto k = lumpedStiffness(*phys.propertySet(), *units[0], *units[1], r);
        const bool same = sameButRoundOff(k.normal, phys.stiffness().normal, k.normal) &&
                          sameButRoundOff(k.shear, phys.stiffness().shear, k.shear);
        if (!same) phys.define(phys.propertySet(), k, phys.points());
    }
}

} // namespace masonry
