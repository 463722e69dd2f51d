// SPDX-License-Identifier: GPL-2.0-or-later
#include "Load.hpp"
#include "BodyCheck.hpp"
#include "BodyStep.hpp"
#include <algorithm>

namespace masonry {

std::vector<std::string> Load::problems() const {
    std::vector<std::string> found;
    if (direction.allFinite() && !(direction.norm() > 0)) found.push_back("direction must not be zero");
    if (ramp < 0) found.push_back("ramp is " + std::to_string(ramp) + " steps, and must be at least 0");
    if (driven && damped) found.push_back("damped must be off if the block is driven");
    return found;
}

void Load::act(yade::Scene& scene, const Vector3r& gravity) {
    auto& state = *bodyAt(scene, body, "MasonryLoad.body").state;
    if (!damped) state.isDamped = false;
    arm_ = state.ori * state.refOri.conjugate() * (point - state.refPos);
    total_ = force;
    const auto sums = scene.forces().sums(body + 1);
    const double aim = ramp > 0 ? this->velocity - acceleration * scene.dt * (ramp - 1) : this->velocity;
    ramp = std::max(0, ramp - 1);
    if (driven) {
        // R is the force along d that gives the point its velocity V = `aim` after this step, d·(v' + w' × arm) = V,
        // where v' = v + dt (F + R d) / m + dt g and w' = w + dt I^-1 (T + arm × R d).
        const Vector3r d = direction.normalized();
        const Vector3r perMass = inverseMass(state), lever = arm_.cross(d);
        const yade::Matrix3r perInertia = inverseInertia(state);
        const Vector3r push = sums.forces[body] + total_ + state.mass * gravity;
        const Vector3r twist = sums.torques[body] + arm_.cross(total_);
        const Vector3r v = state.vel + scene.dt * perMass.cwiseProduct(push);
        const Vector3r w = state.angVel + scene.dt * (perInertia * twist);
        const double mobility = d.dot(perMass.cwiseProduct(d)) + lever.dot(perInertia * lever);
        if (mobility <= 0)
            throw std::invalid_argument("MasonryLoad: body " + std::to_string(body) +
                                        " is blocked in the driven direction");
        reaction = (aim - d.dot(v) - lever.dot(w)) / (mobility * scene.dt);
        total_ += reaction * d;
    } else
        reaction = 0;
    sums.forces[body] += total_;
    sums.torques[body] += arm_.cross(total_);
}

Vector3r Load::displacementIn(const yade::Scene& scene) const {
    const auto& state = *bodyAt(scene, body, "MasonryLoad.body").state;
    const Vector3r r = point - state.refPos;
    return state.pos + state.ori * state.refOri.conjugate() * r - point;
}

void Load::workBefore(double dt, const yade::State& s) {
    work += pendingWork + 0.5 * dt * total_.dot(s.vel + s.angVel.cross(arm_));
}

void Load::workAfter(double dt, const Vector3r& vel, const Vector3r& angVel) {
    pendingWork = 0.5 * dt * total_.dot(vel + angVel.cross(arm_));
}

} // namespace masonry
