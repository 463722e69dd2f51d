// SPDX-License-Identifier: GPL-2.0-or-later
// A load on a rigid block, at a point fixed to it, from which an engine derives; and loads that are not ours.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

using yade::Vector3r;

// What engines of others load a rigid body with in a step, about its centre.
struct ForeignForce {
    int body;
    Vector3r force, torque; // [N], [N m]
};

class Load {
public:
    int body = 0;                           // id of the loaded body
    Vector3r point = Vector3r::Zero();      // loaded point in the reference state of the body, global axes [m]
    Vector3r force = Vector3r::Zero();      // at the point [N]
    Vector3r direction = Vector3r::UnitX(); // of the driven velocity
    bool driven = false;                    // whether the velocity of the point along `direction` is prescribed
    bool damped = false;                    // whether the block keeps its numerical damping
    double velocity = 0;                    // of the point along `direction`, when `ramp` is over [m/s]
    int ramp = 0;                           // steps until then, in each of which the velocity grows evenly
    double acceleration = 0;                // in the ramp [m/s²]
    double reaction = 0;                    // force of the drive along `direction` [N]
    double work = 0;                        // of force and drive so far [J]
    double pendingWork = 0;                 // second half of the last step's work, which the next step adds [J]

    // What is wrong with these values, one sentence for each problem; empty if nothing is.
    std::vector<std::string> problems() const;
    // Adds force and reaction to the forces of the present step. `gravity` is that of the integrator [m/s²].
    void act(yade::Scene&, const Vector3r& gravity);
    // Displacement of the loaded point since the reference state [m].
    Vector3r displacementIn(const yade::Scene&) const;

    // For the engine that counts energies. Half of a load's work is done with the velocity before the step, and half
    // with the one after it, as in BodyStep.
    void workBefore(double dt, const yade::State&);
    void workAfter(double dt, const Vector3r& vel, const Vector3r& angVel);

private:
    Vector3r total_ = Vector3r::Zero(); // force and reaction in the present step [N]
    Vector3r arm_ = Vector3r::Zero();   // from the body's centre to the point in the present step [m]
};

} // namespace masonry
