// Engines: loading of a rigid block, energies of the run, and the time step that is stable.
#pragma once
#include "Adapter.hpp"

namespace masonry {

class MasonryLoad : public Adapter<MasonryLoad, yade::GlobalEngine> {
public:
    static constexpr const char* className = "MasonryLoad";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Loads a rigid block at a point fixed to it: with a constant force, and, when driven, with a velocity of that "
        "point in one direction, while the block stays free to rotate and to move otherwise. Stands after the "
        "interaction loop and before the integrator. The block is taken out of the integrator's damping, so that the "
        "velocity is met exactly; of two driven loads on one block that is true only if it cannot turn.";

    int body = 0;
    Vector3r point = Vector3r::Zero(), force = Vector3r::Zero(), direction = Vector3r::UnitX();
    bool driven = false;
    double velocity = 0, reaction = 0, pendingWork = 0, work = 0;

    template <class Visit> static void attributes(Visit&& visit) {
        using L = MasonryLoad;
        visit("body", &L::body, "Id of the loaded body.");
        visit("point", &L::point, "Loaded point in the reference state of the body [m], global axes.");
        visit("force", &L::force, "Force at the point [N].");
        visit("direction", &L::direction, "Direction of the driven velocity; not zero.");
        visit("driven", &L::driven, "Whether the velocity is prescribed.");
        visit("velocity", &L::velocity, "Velocity of the point along the direction [m/s].");
        visit("reaction", &L::reaction, "Force that the drive applies along the direction [N].", ReadOnly);
        visit("work", &L::work, "Work done on the block by force and drive so far [J]; kept by MasonryEnergy.",
              ReadOnly);
        visit("pendingWork", &L::pendingWork, "", Hidden);
    }

    void action() override;
    Vector3r displacement() const; // of the point, since the reference state

    Vector3r total = Vector3r::Zero(), arm = Vector3r::Zero(); // of the current step: force and its arm

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("displacement", &MasonryLoad::displacement,
                "Displacement of the loaded point since the reference state [m].");
    }
};

class MasonryEnergy : public Adapter<MasonryEnergy, yade::GlobalEngine> {
public:
    static constexpr const char* className = "MasonryEnergy";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Keeps the energy balance of a run: work of loads, prescribed motions and gravity = kinetic + elastic + "
        "dissipated in the joints by mode + damping. Stands directly before NewtonIntegrator and follows its "
        "equations, "
        "so that the balance closes to round-off and the small terms of finite rotation.";

    double external = 0, damping = 0, pendingExternal = 0, pendingDamping = 0, kinetic = 0, gravity = 0,
           largestError = 0;

    template <class Visit> static void attributes(Visit&& visit) {
        using E = MasonryEnergy;
        visit("external", &E::external, "Work of prescribed motions of bodies so far, without that of MasonryLoad [J].",
              ReadOnly);
        visit("damping", &E::damping, "Energy taken by the integrator's damping so far [J].", ReadOnly);
        visit("kinetic", &E::kinetic, "Kinetic energy [J].", ReadOnly);
        visit("gravity", &E::gravity, "Work of gravity since the reference state [J].", ReadOnly);
        visit("largestError", &E::largestError,
              "Largest error of the balance seen by balance(), relative to the work done [-].", ReadOnly);
        visit("pendingExternal", &E::pendingExternal, "", Hidden);
        visit("pendingDamping", &E::pendingDamping, "", Hidden);
    }

    void action() override;
    py::dict balance();

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("balance", &MasonryEnergy::balance,
                "All energies of the last step [J]: external, gravity, kinetic, damping, elastic_ and dissipated_ "
                "tension, shear, compression; and error, the balance's error relative to the work done [-].");
    }
};

// The largest stable time step of joints and zones under the damping of the engines [s], a bound that is safe, and the
// ids of the two bodies whose joint, or of the unit whose zone, sets it: (dt, id1, id2). Without any (inf, -1, -1).
py::tuple criticalTimeStep();

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryLoad)
BOOST_CLASS_EXPORT_KEY(masonry::MasonryEnergy)
