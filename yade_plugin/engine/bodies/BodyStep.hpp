// SPDX-License-Identifier: GPL-2.0-or-later
// A step of one rigid body by NewtonIntegrator, for the energies of bodies that the host moves. RigidMotion makes the
// same steps, but for its damping.
#pragma once
#include "host/Yade.hpp"
#include "motion/EnergyLedger.hpp"

namespace masonry {

// Axes 0 to 2 are the translations along x, y and z, axes 3 to 5 the rotations about them.
inline bool isBlocked(const yade::State& s, int axis) { return s.blockedDOFs >> axis & 1; }
inline bool rotationRestrained(const yade::State& s) { return s.blockedDOFs >> 3 != 0; }
inline bool isFreeOrMoves(const yade::State& s) {
    return (s.blockedDOFs & 63) != 63 || !s.vel.isZero(0) || !s.angVel.isZero(0);
}

// Inverse inertia in global axes [1/(kg m²)], as the integrator uses it. If a rotation is blocked, the three values of
// State.inertia belong to the global axes; if none is, they belong to the body's own axes. Zero for blocked rotations.
yade::Matrix3r inverseInertia(const yade::State&);
// Inverse mass along the global axes [1/kg], zero for blocked translations.
yade::Vector3r inverseMass(const yade::State&);

struct BodyForces {
    yade::Vector3r force;  // [N]
    yade::Vector3r torque; // about the centre [N m]
};

// A step takes the velocity v- to v+ with the forces at the place x_n. Between x_n and x_n+1 a force does the work of
// its mean over both ends: half of the force at x_n works with v-, before that place, and half with v+, after it, which
// is pending until step n+1. With the kinetic energy m v-·v+ / 2 the energy balance at x_n is then an identity. The
// joints count their work alike.
struct BodyStep {
    yade::Vector3r vel;    // after the step [m/s]
    yade::Vector3r angVel; // after the step [1/s]; of a body that turns in space to first order
    EnergyLedger energies;
};
// `damping` is the host's constant [-]. Its damping takes all of alpha |F| and may reverse a motion.
BodyStep stepOf(const yade::State&, const BodyForces&, const yade::Vector3r& gravity, double dt, double damping);

} // namespace masonry
