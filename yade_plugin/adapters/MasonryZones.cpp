// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryZones.hpp"
#include "engine/joints/CrackedBricks.hpp"
#include "engine/joints/JointFunctor.hpp"
#include "engine/watch/EngineScope.hpp"

template class masonry::Adapter<masonry::MasonryZones, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryZones)

namespace masonry {

void MasonryZones::postLoad() {
    check();
    divideAnew();
}

void MasonryZones::action() {
    const EngineScope scope(*scene, *this);
    if (!scope->loop) gatherFromFunctors(scope->joints, *this);
    followMasses(newlyCracked(*this, scope->kinds));
    advance(*scene, scope->bodies, scope->gravity(), scope->massDamping());
    scope.end();
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
