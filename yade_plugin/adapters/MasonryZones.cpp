// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryZones.hpp"
#include "engine/joints/CrackedBricks.hpp"
#include "engine/joints/JointFunctor.hpp"

MASONRY_DEFINE(MasonryZones)

namespace masonry {

void MasonryZones::postLoad() {
    check();
    divideAnew();
}

void MasonryZones::step(SceneStore& store) {
    if (!store.loop) gatherFromFunctors(store.joints, *this);
    followMasses(newlyCracked(*this, store.kinds));
    advance(*scene, store.bodies, store.gravity(), store.massDamping());
}

py::tuple MasonryZones::nodesOf(int body) {
    const BetweenSteps still;
    checkAlive();
    const auto* unit = unitOf(body);
    if (!unit) throw std::invalid_argument("body " + std::to_string(body) + " is no deformable unit");
    return py::make_tuple(unit->firstNode, unit->firstNode + int(unit->elasticity->masses().size()));
}

Vector3r MasonryZones::referencePoint(int body, int node) {
    const BetweenSteps still;
    checkAlive();
    const auto* unit = unitOf(body);
    if (!unit || node < unit->firstNode || node - unit->firstNode >= int(unit->elasticity->masses().size()))
        throw std::invalid_argument("body " + std::to_string(body) + " has no node " + std::to_string(node));
    return reference(*unit, node);
}

void MasonryZones::setVelocityOf(int node, const Vector3r& velocity) {
    const BetweenSteps still;
    checkAlive();
    setVelocity(node, velocity);
}

py::list MasonryZones::masses() {
    const BetweenSteps still;
    checkAlive();
    py::list all;
    for (const auto& unit : units())
        for (double mass : unit.elasticity->masses())
            all.append(mass);
    return all;
}

} // namespace masonry
