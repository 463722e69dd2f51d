// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryJointPhys.hpp"
#include "scene/SceneStore.hpp"

template class masonry::Adapter<masonry::MasonryJointPhys, yade::IPhys>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointPhys)

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

// Holds the two stiffnesses [Pa/m], then of every subcontact the numbers of its law and the energies dissipated in
// tension, shear and compression [J/m²].
std::vector<double> MasonryJointPhys::record() {
    if (!group) return {};
    group->check();
    std::vector<double> flat{stiffness().normal, stiffness().shear};
    for (int p = 0; p < points(); ++p) {
        group->columns->read(p, index, [&](const char*, double number) { flat.push_back(number); });
        const auto e = lost(p);
        flat.insert(flat.end(), {e.tension, e.shear, e.compression});
    }
    return flat;
}

void MasonryJointPhys::setRecord(const std::vector<double>& flat) {
    if (flat.empty()) return;
    const auto damaged = std::runtime_error("saved file is damaged at the state of a joint");
    if (flat.size() < 2 || !loaded_ || !(flat[0] > 0) || !(flat[1] > 0)) throw damaged;
    const ElasticStiffness k{flat[0], flat[1]};
    const std::size_t ofEnergies = 3;
    const std::size_t width = JointStates(loaded_, k, 1, 1).columns->numbersOfState() + ofEnergies;
    if ((flat.size() - 2) % width != 0) throw damaged;
    const int count = int((flat.size() - 2) / width);
    group.reset(new JointStates(loaded_, k, 1, count));
    index = 0;
    loaded_.reset();
    auto next = flat.begin() + 2;
    for (int p = 0; p < count; ++p) {
        group->columns->write(p, 0, [&](const char*, double& number) { number = *next++; });
        group->columns->setDissipated(p, 0, {next[0], next[1], next[2]});
        next += ofEnergies;
    }
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
        return py::make_tuple(columns.number(p, index, "largestOpening"), columns.number(p, index, "largestClosure"));
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
