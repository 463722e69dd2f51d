// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "EngineAdapter.hpp"
#include "engine/bodies/Integrator.hpp"
#include "engine/bodies/Ledger.hpp"

namespace masonry {

class MasonryIntegrator : public EngineAdapter<MasonryIntegrator>, public Integrator {
    MASONRY_CLASS(MasonryIntegrator, GlobalEngine)
    static constexpr ClassRole declares = ClassRole::Integrator;
    static constexpr const char* doc =
        "Moves the rigid bodies by the equations of NewtonIntegrator (paper eqs. (1)-(3)) and counts their energies. "
        "Leaves out what masonry does not need: periodic cells, clumps and bounds for a collider. NewtonIntegrator "
        "with MasonryEnergy remains as the reference.";

    template <class Visit> static void attributes(Visit&& visit) {
        using I = MasonryIntegrator;
        visit("damping", &I::damping,
              number("-", "Damping constant alpha").atLeast(0).atMost(0.99).source("paper eq. (3): 0.8"));
        visit("dampingKind", &I::dampingKind,
              described(
                  "'local': -alpha abs(F) sgn(v), paper eq. (3); 'combined': alpha abs(F) (sgn(dF/dt) - sgn(v)) / 2, "
                  "which also calms vibration about a steady motion"));
        visit("massDamping", &I::massDamping,
              number("1/s", "Mass-proportional viscous damping: every free axis of a damped body, and the nodes of "
                            "MasonryZones, get the force -massDamping times momentum. A mode of angular frequency w "
                            "then has the damping ratio massDamping/(2w); the limit of the time step stays. Blocks "
                            "under a MasonryLoad and axes whose motion is prescribed are left out")
                  .atLeast(0));
        visit("gravity", &I::gravity,
              number("m/s²",
                     "Gravity. It may change during a run: MasonryZones follows it, and the energy balance counts "
                     "its work"));
        visit("inertiaFactors", &I::inertiaFactors,
              described(
                  "Factors, at least 1, on the inertia of bodies by their ids, without a weight [-]; beyond its end "
                  "1. For states of rest: inertia of the few bodies that set the time step makes it longer"));
        ledgerOfBodies<I>(visit);
        GravityWork::describe<I>(visit);
        visit("factorsBefore", &I::factorsBefore, described("inertiaFactors in the last step"), Hidden);
        visit("stepChange", &I::stepChange, described("Time step that follows the state, less the one before [s]"),
              Hidden);
        visit("last", computed(&I::lastForces, &I::setLastForces),
              described("Force per mass and torque per inertia of every body in the last step"), Hidden);
        visit("shaking", &MasonryIntegrator::visitShaking, described("How far the record of the ground's motion is"));
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("shake", &MasonryIntegrator::shake, py::args("samples", "axes", "interval", "factor"),
                "From now on gravity is the present one less the acceleration of the ground: its samples [m/s² over "
                "factor] along axes, a list of unit vectors, one axis after the other, interval [s] apart. Each step "
                "has the acceleration of its middle. Gravity that is set meanwhile acts beside the record. Checkpoints "
                "hold how far the record is, but not its samples. An empty list ends it.");
    }

    using Integrator::problems;
    void step(SceneStore&);

private:
    void shake(const std::vector<double>& samples, const std::vector<Vector3r>& axes, double interval, double factor);
    void visitShaking(StateNumbers& n) { shaking.visitState(n); }
};

} // namespace masonry

MASONRY_DECLARE(MasonryIntegrator)
