// SPDX-License-Identifier: GPL-2.0-or-later
#include "Springs.hpp"

namespace masonry {

std::vector<std::string> Springs::problems() const {
    auto found = problemsOfEnds();
    const std::pair<const char*, const std::vector<Vector3r>*> columns[] = {
        {"stiffness", &stiffness}, {"rotationalStiffness", &rotationalStiffness}};
    for (const auto& [name, column] : columns) {
        if (int(column->size()) != count())
            found.push_back(std::string(name) + " must have three numbers for each connector");
        for (const auto& k : *column)
            if (!(k.allFinite() && k.minCoeff() >= 0))
                found.push_back(std::string(name) + " must be finite numbers of at least 0");
    }
    return found;
}

// Force -k times the displacement of the first end against the second, and moment likewise with the turns. Both are
// taken along axes that do not turn, so turns are small. The energy is that of the present displacements.
void Springs::act(SceneContents& contents) {
    const auto sums = contents.scene().forces().sums(contents.bodies.size());
    const std::size_t n = bodies1.size();
    fit(forces, int(n), Vector3r(Vector3r::Zero()));
    fit(moments, int(n), Vector3r(Vector3r::Zero()));
    stored = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const int one = bodies1[i], other = bodies2[i];
        const End a = endOf(contents, one, points1[i]), b = endOf(contents, other, points2[i]);
        const Vector3r moved = (a.place - points1[i]) - (b.place - points2[i]);
        forces[i] = -stiffness[i].cwiseProduct(moved);
        stored -= 0.5 * forces[i].dot(moved);
        moments[i] = Vector3r::Zero();
        if (!rotationalStiffness[i].isZero(0)) {
            const Vector3r turned = turnOf(contents, one) - turnOf(contents, other);
            moments[i] = -rotationalStiffness[i].cwiseProduct(turned);
            stored -= 0.5 * moments[i].dot(turned);
        }
        if (one != ground) {
            sums.forces[one] += forces[i];
            sums.torques[one] += a.arm.cross(forces[i]) + moments[i];
        }
        if (other != ground) {
            sums.forces[other] -= forces[i];
            sums.torques[other] -= b.arm.cross(forces[i]) + moments[i];
        }
    }
}

Connectors::View Springs::view(const SceneContents&, int spring) const {
    View view;
    if (std::size_t(spring) < forces.size()) view.force = forces[spring];
    return view;
}

} // namespace masonry
