// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointConversion.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/joints/Resultant.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

namespace {

// Elastic energy of a joint [J].
double stored(const JointView& joint) {
    const int points = joint.geom->points();
    JointStates alone(joint.phys->propertySet(), joint.phys->stiffness(), 1, points);
    alone.take(0, *joint.phys->group, joint.phys->index);
    std::vector<double> areas;
    for (int p = 0; p < points; ++p)
        areas.push_back(joint.geom->area(p));
    const auto e = alone.columns->energies(areas.data(), false).stored;
    return e.tension + e.shear + e.compression;
}

} // namespace

void JointConversion::measure(const SceneContents& store) {
    sizes_.clear();
    for (const auto& joint : store.joints) {
        const auto& r = joint.geom->reference();
        const auto& columns = *joint.phys->group->columns.unsynchronised();
        sizes_.push_back({extent(r.polygon(), r.tangent), extent(r.polygon(), r.normal.cross(r.tangent)),
                          r.sides[1].orientation.conjugate() * r.sides[0].orientation, columns.isBonded()});
    }
    revision_ = store.stiffnessRevision();
}

bool JointConversion::isDue(const SceneContents& store, const JointView& joint, const Size& size) const {
    const auto& shapes = *joint.geom->group;
    const auto& r = joint.geom->reference();
    const int j = joint.geom->index;
    if (shapes.converted[j] || r.attached) return false;
    if (!shapes.pointwise[j] && size.bonded) return false; // it has always been elastic
    const auto& columns = *joint.phys->group->columns.unsynchronised();
    double least = HUGE_VAL, along = 0, across = 0;
    bool bond = false, openBond = false;
    for (int p = 0; p < shapes.points; ++p) {
        const Vector3r jump = shapes.pointwise[j] ? Vector3r(joint.geom->jump(p)) : shapes.intactJumpAt(p, j);
        least = std::min(least, jump[0]);
        along += jump[1];
        across += jump[2];
        const bool bondHere = size.bonded && *columns.column(Role::BondDamage, p, j) < bondGone;
        bond = bond || bondHere;
        openBond = openBond || (bondHere && jump[0] > 0);
    }
    if (!std::isfinite(least + along + across)) return false; // other checks say that
    if (least > opening * std::max(size.along, size.across)) return true;
    if (openBond) return false;
    const double w = std::abs(
        (store.bodies.turnOf(r.sides[0].body).conjugate() * store.bodies.turnOf(r.sides[1].body) * size.back).w());
    if (bond) return w < std::cos(0.5 * hingeTurn);
    const double n = shapes.points;
    if (std::abs(along) / n > slide * size.along || std::abs(across) / n > slide * size.across) return true;
    return w < std::cos(0.5 * turn);
}

std::vector<JointView> JointConversion::due(const SceneContents& store) {
    if (revision_ != store.stiffnessRevision()) measure(store);
    std::vector<JointView> found;
    for (std::size_t n = 0; n < store.joints.size(); ++n)
        if (isDue(store, store.joints[n], sizes_[n])) found.push_back(store.joints[n]);
    return found;
}

double JointConversion::release(const JointView& joint) {
    auto& geom = *joint.geom;
    const int j = geom.index;
    geom.group->endIntact(j);
    auto& columns = *joint.phys->group->columns;
    const double before = stored(joint);
    for (int p = 0; p < geom.points(); ++p) {
        columns.release(p, joint.phys->index);
        geom.group->setViscous(p, j, Vector3r::Zero());
        geom.group->setImpact(p, j, {});
    }
    geom.group->converted[j] = 1;
    return before - stored(joint);
}

void JointConversion::act(SceneContents& store, Contacts& contacts) {
    if (!contacts.takesJoints || store.scene().iter % Contacts::lookEvery != 0) return;
    std::vector<Contacts::Joint> all;
    for (const auto& joint : due(store)) {
        const auto& r = joint.geom->reference();
        const int body1 = r.sides[0].body, body2 = r.sides[1].body;
        if (!contacts.covers(body1) || !contacts.covers(body2)) continue; // nothing would take its place
        const auto normalBy = [&](int side) {
            return Vector3r(store.bodies.turnOf(r.sides[side].body) *
                            (r.sides[side].orientation.conjugate() * r.normal));
        };
        const auto at1 = resultantOf(store.scene(), *joint.interaction, store.bodies.placeOf(body1));
        const auto at2 = resultantOf(store.scene(), *joint.interaction, store.bodies.placeOf(body2));
        all.push_back({body1, body2, (normalBy(0) + normalBy(1)).normalized(), at1.force, at1.moment, -at2.moment});
        contacts.conversionEnergy -= release(joint);
    }
    if (!all.empty()) contacts.takeOver(store, all);
}

} // namespace masonry
