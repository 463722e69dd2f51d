// SPDX-License-Identifier: GPL-2.0-or-later
// A load on rigid blocks, at points fixed to them, from which an engine derives; and loads that are not ours.
#pragma once
#include "host/Yade.hpp"
#include <functional>

namespace masonry {

using yade::Vector3r;

// What engines of others and permanent forces load a rigid body with in a step, about its centre.
struct ForeignForce {
    int body;
    Vector3r force, torque; // [N], [N m]
};

// Half of the work of these forces in a step [J]; `motionOf` gives `vel` and `angVel` of a body.
template <class F> double halfWork(const std::vector<ForeignForce>& foreign, double dt, F&& motionOf) {
    double power = 0;
    for (const auto& [body, force, torque] : foreign) {
        const auto& motion = motionOf(body);
        power += force.dot(motion.vel) + torque.dot(motion.angVel);
    }
    return 0.5 * dt * power;
}

class Load {
public:
    int body = 0;                           // id of the loaded body
    Vector3r point = Vector3r::Zero();      // loaded point in the reference state of the body, global axes [m]
    Vector3r force = Vector3r::Zero();      // at the point [N]
    Vector3r direction = Vector3r::UnitX(); // of the driven velocity
    // Further bodies that the drive moves, their points likewise, and the shares of the drive's force that `body` and
    // the others take: 1 in sum, or empty without others. The velocity that is prescribed is that of all points along
    // `direction` in the mean by these shares, which is the one that the force of the drive does work on.
    std::vector<int> others;
    std::vector<Vector3r> otherPoints;
    std::vector<double> shares;
    bool driven = false;     // whether the velocity of the point along `direction` is prescribed
    bool damped = false;     // whether the block keeps its numerical damping
    double velocity = 0;     // of the point along `direction`, when `ramp` is over [m/s]
    int ramp = 0;            // steps until then, in each of which the velocity grows evenly
    double acceleration = 0; // in the ramp [m/s²]
    double reaction = 0;     // force of the drive, or of a testing machine beside `force`, along `direction` [N]
    double work = 0;         // of force and drive so far [J]
    double pendingWork = 0;  // second half of the last step's work, which the next step adds [J]

    // A testing machine, whose load follows how far the point moves against `direction` and is kept back by friction.
    double stiffness = 0;      // of the machine, with which the load follows [N/m]
    double friction = 0;       // share of the load up to which friction keeps it back [-]
    double guideStiffness = 0; // of the guides, until this friction slips [N/m]
    bool engaged = false;      // whether stiffness and friction act; they begin without force
    double uplift = 0;         // of the point since then, against `direction` [m]
    double slip = 0;           // how much of that the friction has slipped [m]
    double stored = 0;         // elastic energy of machine and guides [J]
    double dissipated = 0;     // by the friction so far [J]

    // What is wrong with these values, one sentence for each problem; empty if nothing is.
    std::vector<std::string> problems() const;
    // Adds force and reaction to the forces of the present step. The integrator has this gravity [m/s²], and this
    // factor on the inertia of a body by its id [-].
    void act(yade::Scene&, const Vector3r& gravity, const std::function<double(int)>& inertiaFactor);
    // Displacement of the loaded point since the reference state [m].
    Vector3r displacementIn(const yade::Scene&) const;

    // Stiffness of machine and guides along the global axes [N/m] for the time step: never too small.
    Vector3r machineStiffness() const;

    // Calls a function with the id of each body that is loaded.
    template <class F> void eachBody(F&& act) const {
        act(body);
        for (const int other : others)
            act(other);
    }

    // For the engine that counts energies. Half of a load's work is done with the velocity before the step, and half
    // with the one after it, as in BodyStep. `motionOf` gives `vel` and `angVel` of a body.
    template <class F> void workBefore(double dt, F&& motionOf) { work += pendingWork + 0.5 * dt * power(motionOf); }
    template <class F> void workAfter(double dt, F&& motionOf) { pendingWork = 0.5 * dt * power(motionOf); }

private:
    struct Part {
        int body;
        Vector3r force, arm; // force and drive on it [N], and from its centre to its point [m], in the present step
    };
    std::vector<Part> parts_;

    // The force beside `force` after a step in which the point has moved so far along `direction` [N].
    double followMachine(double moved);

    template <class F> double power(F&& motionOf) const {
        double sum = 0;
        for (const auto& part : parts_) {
            const auto& motion = motionOf(part.body);
            sum += part.force.dot(motion.vel + motion.angVel.cross(part.arm));
        }
        return sum;
    }
};

} // namespace masonry
