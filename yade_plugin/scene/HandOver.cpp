// SPDX-License-Identifier: GPL-2.0-or-later
#include "HandOver.hpp"
#include "Blocks.hpp"
#include "Resultant.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace masonry {

namespace {

Quaternionr turnOf(const SceneStore& store, int body) {
    const auto& q = store.bodies.orientation;
    return {q[0][body], q[1][body], q[2][body], q[3][body]};
}

Vector3r placeOf(const SceneStore& store, int body) {
    const auto& x = store.bodies.position;
    return {x[0][body], x[1][body], x[2][body]};
}

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

void HandOver::measure(const SceneStore& store) {
    sizes_.clear();
    for (const auto& joint : store.joints) {
        const auto& r = joint.geom->reference();
        const auto& columns = *joint.phys->group->columns.asTheyStand();
        const bool bonded = columns.law().properties().tensileStrength > 0 && columns.tensionDamage(0, 0);
        sizes_.push_back({extent(r.polygon(), r.tangent), extent(r.polygon(), r.normal.cross(r.tangent)),
                          r.sides[1].orientation.conjugate() * r.sides[0].orientation, bonded});
    }
    revision_ = store.revision();
}

bool HandOver::isDue(const SceneStore& store, const JointView& joint, const Size& size) const {
    const auto& shapes = *joint.geom->group;
    const auto& r = joint.geom->reference();
    const int j = joint.geom->index;
    if (r.handed || r.attached) return false;
    if (!shapes.byPoints[j] && size.bonded) return false; // it has always been elastic
    const auto& columns = *joint.phys->group->columns.asTheyStand();
    double least = HUGE_VAL, along = 0, across = 0;
    bool bond = false;
    for (int p = 0; p < shapes.points; ++p) {
        const Vector3r jump = shapes.byPoints[j] ? Vector3r(joint.geom->jump(p)) : shapes.intactJumpAt(p, j);
        least = std::min(least, jump[0]);
        along += jump[1];
        across += jump[2];
        bond = bond || (size.bonded && *columns.tensionDamage(p, j) < bondGone);
    }
    if (!std::isfinite(least + along + across)) return false; // other checks say that
    if (least > opening * std::max(size.along, size.across)) return true;
    if (bond) return false;
    const double n = shapes.points;
    if (std::abs(along) / n > slide * size.along || std::abs(across) / n > slide * size.across) return true;
    const double w =
        std::abs((turnOf(store, r.sides[0].body).conjugate() * turnOf(store, r.sides[1].body) * size.back).w());
    return w < std::cos(0.5 * turn);
}

std::vector<JointView> HandOver::due(const SceneStore& store) {
    if (revision_ != store.revision()) measure(store);
    std::vector<JointView> found;
    for (std::size_t n = 0; n < store.joints.size(); ++n)
        if (isDue(store, store.joints[n], sizes_[n])) found.push_back(store.joints[n]);
    return found;
}

double HandOver::release(const JointView& joint) {
    auto& geom = *joint.geom;
    const int j = geom.index;
    if (!geom.group->byPoints[j]) geom.group->endIntact(j);
    auto& columns = *joint.phys->group->columns;
    const double before = stored(joint);
    for (int p = 0; p < geom.points(); ++p) {
        double irreversible = 0;
        columns.read(p, joint.phys->index, [&](const char* name, double number) {
            if (!std::strcmp(name, "crushing")) irreversible += number;
            if (!std::strcmp(name, "dilation")) irreversible -= number;
        });
        columns.write(p, joint.phys->index, [&](const char* name, double& number) {
            if (!std::strcmp(name, "shearStressA") || !std::strcmp(name, "shearStressB")) number = 0;
            if (!std::strcmp(name, "opening")) number = std::max(number, -irreversible);
        });
    }
    for (int p = 0; p < geom.points(); ++p) {
        geom.group->setViscous(p, j, Vector3r::Zero());
        geom.group->setImpact(p, j, {});
    }
    geom.group->joints[j].handed = true;
    return before - stored(joint);
}

void HandOver::act(SceneStore& store, Contacts& contacts) {
    if (!contacts.takesJoints || store.scene().iter % Contacts::lookEvery != 0) return;
    std::vector<Contacts::Joint> all;
    for (const auto& joint : due(store)) {
        const auto& r = joint.geom->reference();
        const int body1 = r.sides[0].body, body2 = r.sides[1].body;
        if (!contacts.covers(body1) || !contacts.covers(body2)) continue; // nothing would take its place
        const auto normalBy = [&](int side) {
            return Vector3r(turnOf(store, r.sides[side].body) * (r.sides[side].orientation.conjugate() * r.normal));
        };
        const auto at1 = resultantOf(store.scene(), *joint.interaction, placeOf(store, body1));
        const auto at2 = resultantOf(store.scene(), *joint.interaction, placeOf(store, body2));
        all.push_back({body1, body2, (normalBy(0) + normalBy(1)).normalized(), at1.force, at1.moment, -at2.moment});
        contacts.handing -= release(joint);
    }
    if (all.empty()) return;
    store.jointsChanged();
    contacts.takeOver(store, all);
}

} // namespace masonry
