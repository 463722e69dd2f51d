// SPDX-License-Identifier: GPL-2.0-or-later
// The step of all rigid bodies in columns, by the equations of NewtonIntegrator (see BodyStep). An engine derives from
// it.
#pragma once
#include "BodyColumns.hpp"
#include "GravityWork.hpp"
#include "GroundMotion.hpp"
#include "motion/EnergyLedger.hpp"

namespace masonry {

class Load;
struct ForeignForce;

class Integrator : public EnergyLedger, public GravityWork {
public:
    double damping = 0.8;                     // damping constant alpha [-]
    std::string dampingKind = "combined";     // or "local"
    double massDamping = 0;                   // mass-proportional viscous damping [1/s]
    Vector3r gravity = Vector3r(0, 0, -9.81); // [m/s²]
    GroundMotion shaking;                     // sets the gravity of every step while it has a record
    double stepChange = 0;                    // of a time step that follows the state, in the present step [s]

    // Factors on mass and moments of inertia of bodies by their ids, without a weight [-]; beyond its end 1. For states
    // of rest: inertia of the few bodies that set the time step makes it longer, and changes no force at rest.
    std::vector<double> inertiaFactors;
    std::vector<double> factorsBefore; // in the last step
    double inertiaFactor(int body) const { return factorOf(inertiaFactors, body); }

    // What is wrong with these values, one sentence for each problem; empty if nothing is.
    std::vector<std::string> problems() const;

    // Makes a step of all rigid bodies, and counts its energies and the work of the loads.
    void advance(yade::Scene&, BodyColumns&, const std::vector<Load*>&, const std::vector<ForeignForce>&);

    // In saved files and checkpoints: two vectors for each body, force per mass [m/s²] and torque per inertia [1/s²] in
    // the last step.
    std::vector<Vector3r> lastForces();
    void setLastForces(const std::vector<Vector3r>&);

private:
    bool combined() const { return dampingKind == "combined"; }
    struct Sums {                           // of some bodies
        EnergyLedger energies;              // `fallen` is the sum of m g·u
        Vector3r moment = Vector3r::Zero(); // sum of m u [kg m]; see GravityWork
    };
    bool combines_ = false; // scratch of a step: combined(), whose comparison of texts takes too long for every body
    // Makes a step of bodies `first` up to, but without, `beyond`.
    Sums advancePiece(const yade::Scene&, BodyColumns&, const Vector3r* forces, const Vector3r* torques, int first,
                      int beyond);
    void followInertia(BodyColumns&);
    double gainedPower(const BodyColumns&, int body, const Vector3r& force, const Vector3r& torque) const;
    void findWeights(const BodyColumns&, int first, int count, Sums&) const;

    std::vector<double> last_[6]; // for combined damping: force per mass [m/s²] and torque per inertia [1/s²] of all
                                  // bodies in the last step; empty until then
};

} // namespace masonry
