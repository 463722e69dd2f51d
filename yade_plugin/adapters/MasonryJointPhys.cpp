// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryJointPhys.hpp"
#include "engine/store/SceneStore.hpp"

MASONRY_DEFINE(MasonryJointPhys)

namespace masonry {

shared_ptr<MasonryJoint> MasonryJointPhys::joint() {
    return group ? boost::static_pointer_cast<MasonryJoint>(propertySet()) : shared_ptr<MasonryJoint>();
}

// A file holds the property set before the record.
void MasonryJointPhys::setJoint(const shared_ptr<MasonryJoint>& kind) {
    group.reset();
    loaded_ = kind;
}

double MasonryJointPhys::normalStiffness() { return group ? stiffness().normal : 0; }
double MasonryJointPhys::shearStiffness() { return group ? stiffness().shear : 0; }

Vector3r MasonryJointPhys::dissipated() {
    Vector3r sum = Vector3r::Zero();
    if (!group) return sum;
    group->check();
    if (!group->inScene) SceneStore::present().update(); // a new joint gets its areas only now
    for (int p = 0; group->shapes && p < points(); ++p) {
        const auto e = lost(p);
        sum += group->shapes->areaAt(p, index) * Vector3r(e.tension, e.shear, e.compression);
    }
    return sum;
}

void MasonryJointPhys::visitRecord(StateNumbers& n) {
    if (group) group->check();
    std::size_t count = points();
    n.visitCount(count);
    if (count == 0) return;
    ElasticStiffness k = group ? stiffness() : ElasticStiffness();
    n(k.normal, k.shear);
    if (n.back) {
        if (!loaded_ || !(k.normal > 0) || !(k.shear > 0)) n.refuse();
        group.reset(new JointStates(loaded_, k, 1, int(count)));
        index = 0;
        loaded_.reset();
    }
    group->visitState(index, n);
}

// ---- for Python -------------------------------------------------------------------------------------------------

template <class F> py::list MasonryJointPhys::perSubcontact(F&& value) {
    const BetweenSteps still;
    py::list all;
    if (!group) return all;
    group->check();
    for (int p = 0; p < points(); ++p)
        all.append(value(p));
    return all;
}

py::list MasonryJointPhys::stress() {
    return perSubcontact([this](int p) {
        const auto s = state(p);
        return Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b);
    });
}

py::list MasonryJointPhys::opening() {
    return perSubcontact([this](int p) { return state(p).opening; });
}

py::list MasonryJointPhys::slip() {
    return perSubcontact([this](int p) { return shown(p, field::slip); });
}

py::list MasonryJointPhys::damage() {
    return perSubcontact([this](int p) {
        return Vector3r(shown(p, field::damageTension), shown(p, field::damageShear),
                        shown(p, field::damageCompression));
    });
}

py::list MasonryJointPhys::largest() {
    return perSubcontact([this](int p) {
        const auto& columns = *group->columns;
        const auto number = [&](Role role) {
            const double* at = columns.column(role, p, index);
            return at ? *at : 0;
        };
        return py::make_tuple(number(Role::LargestOpening), number(Role::LargestClosure));
    });
}

py::list MasonryJointPhys::yielding() {
    return perSubcontact([this](int p) {
        const auto f = group->columns->yielding(p, index);
        return Vector3r(f.tension, f.slip, f.cap);
    });
}

py::list MasonryJointPhys::regime() {
    static const char* const names[] = {"elastic", "opening", "slipping", "crushing"};
    return perSubcontact([this](int p) { return py::str(names[int(state(p).regime)]); });
}

} // namespace masonry
