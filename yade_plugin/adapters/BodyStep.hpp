// A step of one rigid body, in the host's equations: the reference for RigidMotion, and the way of bodies that are free
// to turn in space.
#pragma once
#include "host/Yade.hpp"
#include "motion/EnergyLedger.hpp"

namespace masonry {

inline bool isBlocked(const yade::State& s, int axis) { return s.blockedDOFs >> axis & 1; } // 0-2 move, 3-5 turn
inline bool rotationRestrained(const yade::State& s) { return s.blockedDOFs >> 3 != 0; }
inline bool isFreeOrMoves(const yade::State& s) {
    return (s.blockedDOFs & 63) != 63 || !s.vel.isZero(0) || !s.angVel.isZero(0);
}

// Inverse inertia in global axes as the integrator uses it: with a blocked rotation the three values stand for the
// global axes, without for the body's own.
yade::Matrix3r inverseInertia(const yade::State&);
yade::Vector3r inverseMass(const yade::State&);

struct BodyForces {
    yade::Vector3r force, torque;
};

struct BodyDamping {
    double alpha = 0;  // of a body that is damped
    bool host = false; // the host's rule, which takes all of alpha |F| and may turn a motion round
    BodyForces* last;  // combined damping: per mass and inertia in the step before, brought up to date; else null
};

// A step takes v- to v+ with the forces at x_n. Between x_n and x_n+1 a force does the work of its mean over both ends:
// half of it with v- at n, half with v+ (pending until n+1). With the kinetic energy m v-·v+ / 2 the balance at x_n is
// then an identity, and the joints' trapezoidal work is its counterpart.
struct BodyStep {
    yade::Vector3r vel, angVel; // after the step
    yade::Vector3r torque;      // less what damping takes
    EnergyLedger energies;
};
BodyStep stepOf(const yade::State&, const BodyForces&, const yade::Vector3r& gravity, double dt, const BodyDamping&);

// Turns a body that is free to turn in space by a step.
void turnInSpace(yade::State&, const BodyStep&, double dt);

} // namespace masonry
