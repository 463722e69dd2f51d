#include "MasonryJointPhys.hpp"
#include "scene/SceneStore.hpp"

template class masonry::Adapter<masonry::MasonryJointPhys, yade::IPhys>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointPhys)

namespace masonry {

shared_ptr<MasonryJoint> MasonryJointPhys::joint() {
    return home ? boost::static_pointer_cast<MasonryJoint>(propertySet()) : shared_ptr<MasonryJoint>();
}

// A file holds the property set before the record.
void MasonryJointPhys::setJoint(const shared_ptr<MasonryJoint>& kind) {
    home.reset();
    loaded_ = kind;
}

double MasonryJointPhys::normalStiffness() { return home ? stiffness().normal : 0; }
double MasonryJointPhys::shearStiffness() { return home ? stiffness().shear : 0; }

Vector3r MasonryJointPhys::dissipated() {
    Vector3r sum = Vector3r::Zero();
    if (!home) return sum;
    home->check();
    if (!home->inScene) SceneStore::present().update(); // a new joint gets its areas only now
    for (int p = 0; home->shapes && p < points(); ++p) {
        const auto e = lost(p);
        sum += home->shapes->areaAt(p, index) * Vector3r(e.tension, e.shear, e.compression);
    }
    return sum;
}

// Holds the two stiffnesses [Pa/m], then of every subcontact the seventeen numbers of its state and the energies
// dissipated in tension, shear and compression [J/m²].
std::vector<double> MasonryJointPhys::record() {
    if (!home) return {};
    home->check();
    std::vector<double> flat{stiffness().normal, stiffness().shear};
    for (int p = 0; p < points(); ++p) {
        auto s = state(p);
        numbers(s, [&](double& value) { flat.push_back(value); });
        const auto e = lost(p);
        flat.insert(flat.end(), {e.tension, e.shear, e.compression});
    }
    return flat;
}

void MasonryJointPhys::setRecord(const std::vector<double>& flat) {
    constexpr std::size_t width = 17 + 3;
    if (flat.empty()) return;
    const bool whole = flat.size() >= 2 && (flat.size() - 2) % width == 0;
    if (!whole || !loaded_ || !(flat[0] > 0) || !(flat[1] > 0))
        throw std::runtime_error("saved file is damaged at the state of a joint");
    const int count = int((flat.size() - 2) / width);
    home.reset(new JointStates(loaded_, {flat[0], flat[1]}, 1, count));
    index = 0;
    loaded_.reset();
    auto next = flat.begin() + 2;
    for (int p = 0; p < count; ++p) {
        JointState s;
        numbers(s, [&](double& value) { value = *next++; });
        const Energies e{next[0], next[1], next[2]};
        next += 3;
        home->columns->set(p, 0, s);
        home->columns->setDissipated(p, 0, e);
    }
}

// ---- for Python -------------------------------------------------------------------------------------------------

template <class F> py::list MasonryJointPhys::perSubcontact(F&& value) {
    const BetweenSteps still;
    py::list all;
    if (!home) return all;
    home->check();
    for (int p = 0; p < points(); ++p)
        all.append(value(state(p)));
    return all;
}

py::list MasonryJointPhys::stress() {
    return perSubcontact(
        [](const JointState& s) { return Vector3r(s.normalStress, s.shearStress.a, s.shearStress.b); });
}

py::list MasonryJointPhys::opening() {
    return perSubcontact([](const JointState& s) { return s.opening; });
}

py::list MasonryJointPhys::slip() {
    return perSubcontact([](const JointState& s) { return s.slip; });
}

py::list MasonryJointPhys::damage() {
    return perSubcontact([this](const JointState& s) {
        return Vector3r(s.tensionDamage, s.shearDamage, law().compressionDamage(stiffness(), s));
    });
}

py::list MasonryJointPhys::largest() {
    return perSubcontact([](const JointState& s) { return py::make_tuple(s.largestOpening, s.largestClosure); });
}

py::list MasonryJointPhys::yielding() {
    return perSubcontact([this](const JointState& s) {
        const auto& p = law().properties();
        const auto f = law().yield(stiffness(), s);
        const double sigma = std::abs(s.normalStress), tau = std::hypot(s.shearStress.a, s.shearStress.b);
        const double elastic = stiffness().normal * (s.largestOpening + s.largestClosure) + stiffness().shear * s.slip;
        const double quadratic =
            p.capNormal * sigma * (sigma + elastic) + p.capShear * tau * (tau + elastic) + std::abs(f.cap);
        const auto share = [](double value, double size) { return value == -1 ? -1 : size > 0 ? value / size : 0; };
        return Vector3r(share(f.tension, sigma + p.tensileStrength + elastic),
                        share(f.slip, tau + sigma * p.friction + p.cohesion + elastic),
                        share(f.cap, quadratic + std::abs(p.capLinear) * sigma));
    });
}

py::list MasonryJointPhys::regime() {
    static const char* const names[] = {"elastic", "opening", "slipping", "crushing"};
    return perSubcontact([](const JointState& s) { return py::str(names[int(s.regime)]); });
}

} // namespace masonry
