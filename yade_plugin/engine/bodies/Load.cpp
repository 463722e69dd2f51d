// SPDX-License-Identifier: GPL-2.0-or-later
#include "Load.hpp"
#include "BodyCheck.hpp"
#include "BodyStep.hpp"
#include <algorithm>
#include <numeric>
#include <set>

namespace masonry {

std::vector<std::string> Load::problems() const {
    std::vector<std::string> found;
    if (direction.allFinite() && !(direction.norm() > 0)) found.push_back("direction must not be zero");
    if (ramp < 0) found.push_back("ramp is " + std::to_string(ramp) + " steps, and must be at least 0");
    const auto count = others.size();
    if (otherPoints.size() != count || shares.size() != (count ? count + 1 : 0))
        found.push_back("others, otherPoints and shares must have a number of each other body, and shares one of body");
    else if (count && !(std::abs(std::accumulate(shares.begin(), shares.end(), -1.0)) < 1e-9))
        found.push_back("shares must be 1 in sum");
    if (machineStiffness().isZero(0) ? engaged : driven || count > 0)
        found.push_back("a testing machine has stiffness or friction, no drive and no others");
    if (friction > 0 && !(guideStiffness > 0)) found.push_back("friction needs a guideStiffness above 0");
    std::set<int> bodies;
    eachBody([&](int id) { bodies.insert(id); });
    if (bodies.size() != count + 1) found.push_back("body and others must be different bodies");
    return found;
}

void Load::act(yade::Scene& scene, const Vector3r& gravity, const std::function<double(int)>& inertiaFactor) {
    parts_.clear();
    eachBody([&](int id) { parts_.push_back({id, parts_.empty() ? force : Vector3r::Zero(), Vector3r::Zero()}); });
    const auto shareOf = [&](std::size_t n) { return shares.empty() ? 1.0 : shares[n]; };
    const int last =
        std::max_element(parts_.begin(), parts_.end(), [](auto& a, auto& b) { return a.body < b.body; })->body;
    const auto sums = scene.forces().sums(last + 1);
    const Vector3r d = direction.normalized();
    const double aim = ramp > 0 ? this->velocity - acceleration * scene.dt * (ramp - 1) : this->velocity;
    ramp = std::max(0, ramp - 1);
    // The drive takes the force R along d that gives the points, in the mean by their shares s, the velocity V = `aim`
    // after this step: V = Σ s d·(v' + w' × arm), where v' = v + dt (F + s R d) / m + dt g and
    // w' = w + dt I^-1 (T + arm × s R d).
    double missing = aim, mobility = 0;
    for (std::size_t n = 0; n < parts_.size(); ++n) {
        auto& [id, force, arm] = parts_[n];
        auto& state = *bodyAt(scene, id, ".body", ClassRole::Load).state;
        if (!damped) state.isDamped = false;
        arm = state.ori * state.refOri.conjugate() * ((n ? otherPoints[n - 1] : point) - state.refPos);
        if (!driven) continue;
        const double share = shareOf(n);
        const double factor = inertiaFactor(id);
        const Vector3r perMass = inverseMass(state) / factor, lever = arm.cross(d);
        const yade::Matrix3r perInertia = inverseInertia(state) / factor;
        const Vector3r push = sums.forces[id] + force + state.mass * gravity;
        const Vector3r twist = sums.torques[id] + arm.cross(force);
        const Vector3r v = state.vel + scene.dt * perMass.cwiseProduct(push);
        const Vector3r w = state.angVel + scene.dt * (perInertia * twist);
        const double own = d.dot(perMass.cwiseProduct(d)) + lever.dot(perInertia * lever);
        if (own <= 0)
            throw std::invalid_argument(nameOf(ClassRole::Load) + ": body " + std::to_string(id) +
                                        " is blocked in the driven direction");
        missing = missing - share * d.dot(v) - share * lever.dot(w);
        mobility += share * share * own;
    }
    if (engaged) {
        const auto& state = *bodyAt(scene, body, ".body", ClassRole::Load).state;
        reaction = followMachine(scene.dt * d.dot(state.vel + state.angVel.cross(parts_[0].arm)));
    } else {
        reaction = driven ? missing / (mobility * scene.dt) : 0;
        uplift = slip = stored = 0;
    }
    for (std::size_t n = 0; n < parts_.size(); ++n) {
        auto& [id, force, arm] = parts_[n];
        if (driven || engaged) force += shareOf(n) * reaction * d;
        sums.forces[id] += force;
        sums.torques[id] += arm.cross(force);
    }
}

// With an uplift u, the machine loads with N = F + k u, not below 0, and friction keeps back G = kg (u - p), at most
// its share of N: then the slip p grows. What the trapezoidal rule takes up and the springs do not store, friction has
// dissipated.
double Load::followMachine(double moved) {
    uplift -= moved;
    const double load = std::max(0.0, force.dot(direction.normalized()));
    const double spring = std::max(stiffness * uplift, -load), most = friction * (load + spring);
    const double kept = std::clamp(guideStiffness * (uplift - slip), -most, most);
    if (friction > 0) slip = uplift - kept / guideStiffness;
    const double inMachine = stiffness > 0 ? spring * (uplift - 0.5 * spring / stiffness) : 0;
    const double inGuides = friction > 0 ? 0.5 * kept * kept / guideStiffness : 0;
    dissipated += stored - inMachine - inGuides - 0.5 * (reaction + spring + kept) * moved;
    stored = inMachine + inGuides;
    return spring + kept;
}

Vector3r Load::machineStiffness() const {
    const Vector3r d = direction.normalized().cwiseAbs();
    return (stiffness + guideStiffness) * d.sum() * d;
}

Vector3r Load::displacementIn(const yade::Scene& scene) const {
    const auto& state = *bodyAt(scene, body, ".body", ClassRole::Load).state;
    const Vector3r r = point - state.refPos;
    return state.pos + state.ori * state.refOri.conjugate() * r - point;
}

} // namespace masonry
