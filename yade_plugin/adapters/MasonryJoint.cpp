// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryJoint.hpp"
#include "engine/joints/JointFunctor.hpp"
#include "law/Laws.hpp"
#include "law/piecewise_softening/PiecewiseLaw.hpp"

MASONRY_DEFINE(MasonryJoint)

namespace masonry {

void MasonryJoint::postLoad() {
    if (!std::isfinite(direction.norm()))
        throw std::invalid_argument("joint \"" + name + "\": direction must be finite numbers");
    makeLaw();
    describe([&](const char* property, auto member, const Property& own) {
        // what only other laws read is checked here, so that it does not wait for the law to be chosen
        if constexpr (std::is_same_v<std::decay_t<decltype(this->*member)>, double>) {
            const auto reads = [&](const LawEntry& one) { return one.reads(property); };
            if (laws().front().reads(property) || std::none_of(laws().begin(), laws().end(), reads)) return;
            const auto problem = own.problem(inWords(property), this->*member);
            if (!problem.empty()) throw wrongJoint(name, {{property, problem, "bounds"}});
        }
    });
}

bool MasonryJoint::appliesTo(const std::string& set1, const std::string& set2, const Vector3r& normal) const {
    constexpr double within = 0.8660254; // cos 30°
    if (!jointSet.empty() && jointSet != set1 && jointSet != set2) return false;
    return direction.isZero() || std::abs(direction.normalized().dot(normal)) >= within;
}

py::list MasonryJoint::compressionCurve(const std::vector<double>& closures) const {
    py::list strengths;
    for (double u : closures) {
        if (!std::isfinite(u)) throw std::invalid_argument("closure " + text(u) + " m must be a finite number");
        strengths.append(ownLaw()->compression().strength(u));
    }
    return strengths;
}

py::dict MasonryJoint::softening() const {
    const auto rows = [](const SofteningTable& table) {
        py::list all;
        for (const auto& row : table.rows())
            all.append(py::make_tuple(row.ratio, row.damage));
        return all;
    };
    py::dict both;
    both["tension"] = rows(ownLaw()->tension());
    both["shear"] = rows(ownLaw()->shear());
    return both;
}

py::list MasonryJoint::listOfLaws() {
    py::list all;
    for (const auto& law : laws()) {
        py::list read;
        describe([&](const char* property, auto, const Property&) {
            if (law.reads(property)) read.append(property);
        });
        py::dict one;
        one["name"] = law.name;
        one["meaning"] = law.meaning;
        one["functor"] = functorsOfLaws()[law.name];
        one["properties"] = read;
        all.append(one);
    }
    return all;
}

shared_ptr<MasonryJoint> MasonryJoint::brittle() const {
    shared_ptr<MasonryJoint> made(new MasonryJoint);
    static_cast<JointProperties&>(*made) = brittleCoulomb(*this);
    made->jointSet = jointSet;
    made->direction = direction;
    made->postLoad();
    made->assumed = assumed;
    for (const auto* chosen : {"tensionTable", "shearTable", "cap"})
        made->assumed.erase(chosen);
    return made;
}

} // namespace masonry
