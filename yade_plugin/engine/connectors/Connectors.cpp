// SPDX-License-Identifier: GPL-2.0-or-later
#include "Connectors.hpp"
#include "engine/bodies/BodyCheck.hpp"

namespace masonry {

void Connectors::checkBodies(const SceneContents& contents) const {
    for (const auto* bodies : {&bodies1, &bodies2})
        for (int body : *bodies) {
            if (body == ground) continue;
            bodyAt(contents.scene(), body, "a connector holds body");
            if (contents.bodies.isUnit[body])
                throw std::invalid_argument("a connector holds body " + std::to_string(body) +
                                            ", which is a deformable unit; connect a rigid block that is joined to it");
        }
}

Connectors::End Connectors::endOf(const SceneContents& contents, int body, const Vector3r& point) {
    if (body == ground) return {point, Vector3r::Zero()};
    const auto& s = contents.bodies.state(body);
    const Vector3r arm = s.ori * (s.refOri.conjugate() * (point - s.refPos));
    return {s.pos + arm, arm};
}

Vector3r Connectors::turnOf(const SceneContents& contents, int body) {
    if (body == ground) return Vector3r::Zero();
    const auto& s = contents.bodies.state(body);
    const Eigen::AngleAxisd turn(s.ori * s.refOri.conjugate());
    return turn.angle() * turn.axis();
}

std::vector<std::string> Connectors::problemsOfEnds() const {
    std::vector<std::string> found;
    const auto size = bodies1.size();
    if (bodies2.size() != size || points1.size() != size || points2.size() != size) {
        found.push_back("bodies1, points1, bodies2 and points2 must be of one length");
        return found;
    }
    for (std::size_t i = 0; i < size; ++i) {
        const auto name = "connector " + std::to_string(i);
        for (int body : {bodies1[i], bodies2[i]})
            if (body < ground)
                found.push_back("body " + std::to_string(body) + " of " + name +
                                " must be at least 0, or -1 for the ground");
        if (bodies1[i] == bodies2[i]) found.push_back(name + " must have two ends on different bodies");
        for (const auto* point : {&points1[i], &points2[i]})
            if (!point->allFinite()) found.push_back("the points of " + name + " must be finite numbers [m]");
    }
    return found;
}

void Connectors::check(std::vector<std::string>& problems, const char* name, const std::vector<double>& column,
                       int count, const Property& property) {
    if (int(column.size()) != count) {
        problems.push_back(std::string(name) + " must have a number for each of the " + std::to_string(count) +
                           " connectors, got " + std::to_string(column.size()));
        return;
    }
    for (double value : column)
        if (const auto wrong = property.problem(name, value); !wrong.empty()) {
            problems.push_back(wrong);
            return;
        }
}

} // namespace masonry
