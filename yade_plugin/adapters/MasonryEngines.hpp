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
        visit("work", &L::work,
              "Work done on the block by force and drive so far [J]; kept by the engine that keeps the energies of "
              "rigid bodies.",
              ReadOnly);
        visit("pendingWork", &L::pendingWork, "", Hidden);
    }

    void postLoad();
    void action() override;
    Vector3r displacement() const; // of the point, since the reference state
    void workBefore(double dt);    // of a step, for the energy balance: to be called with the old velocity of the body
    void workAfter(double dt, const Vector3r& vel, const Vector3r& angVel); // and with the new one

    Vector3r total = Vector3r::Zero(), arm = Vector3r::Zero(); // of the current step: force and its arm

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("displacement", &MasonryLoad::displacement,
                "Displacement of the loaded point since the reference state [m].");
    }
};

struct BodyEnergies {                                                        // of rigid bodies [J]
    double external = 0, damped = 0, pendingExternal = 0, pendingDamped = 0; // so far; pending is for the next step
    double kinetic = 0, fallen = 0;
    void beginStep();
    void add(const BodyEnergies&);

    template <class Class, class Visit> static void attributes(Visit&& visit) {
        visit("external", &Class::external,
              "Work of prescribed motions of bodies so far, without that of MasonryLoad [J].", ReadOnly);
        visit("damped", &Class::damped, "Energy taken by damping so far [J].", ReadOnly);
        visit("kinetic", &Class::kinetic, "Kinetic energy [J].", ReadOnly);
        visit("fallen", &Class::fallen, "Work of gravity since the reference state [J].", ReadOnly);
        visit("pendingExternal", &Class::pendingExternal, "", Hidden);
        visit("pendingDamped", &Class::pendingDamped, "", Hidden);
    }
};

class MasonryEnergy : public Adapter<MasonryEnergy, yade::GlobalEngine>, public BodyEnergies {
public:
    static constexpr const char* className = "MasonryEnergy";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Keeps the energy balance of a run: work of loads, prescribed motions and gravity = kinetic + elastic + "
        "dissipated in the joints by mode + damping. MasonryIntegrator and MasonryZones keep what is theirs; for "
        "NewtonIntegrator it stands directly before it and follows its equations. The balance closes to round-off and "
        "the small terms of finite rotation.";

    double largestError = 0;

    template <class Visit> static void attributes(Visit&& visit) {
        BodyEnergies::attributes<MasonryEnergy>(visit);
        visit("largestError", &MasonryEnergy::largestError,
              "Largest error of the balance seen by balance(), relative to the work done [-].", ReadOnly);
    }

    void action() override;
    py::dict balance();

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("balance", &MasonryEnergy::balance,
                "All energies of the last step [J]: external, gravity, kinetic, damping, elastic_ and dissipated_ "
                "tension, shear, compression; and error, the balance's error relative to the work done [-].");
    }
};

class MasonryIntegrator : public Adapter<MasonryIntegrator, yade::GlobalEngine>, public BodyEnergies {
public:
    static constexpr const char* className = "MasonryIntegrator";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Moves the rigid bodies, in the equations of NewtonIntegrator (paper eqs. (1)-(3)) without what masonry does "
        "not need (periodic cells, clumps, bounds for a collider), and keeps their energies. NewtonIntegrator and "
        "MasonryEnergy stay as the reference.";

    double damping = 0.8;
    std::string dampingKind = "local";
    Vector3r gravity = Vector3r(0, 0, -9.81);
    std::vector<Vector3r> last; // force per mass and torque per inertia of the step before, for combined damping

    template <class Visit> static void attributes(Visit&& visit) {
        using I = MasonryIntegrator;
        visit("damping", &I::damping, "Damping constant alpha [-], 0 to 0.99 (paper eq. (3): 0.8).");
        visit("dampingKind", &I::dampingKind,
              "'local': -alpha |F| sgn(v), paper eq. (3); 'combined': alpha |F| (sgn(dF/dt) - sgn(v)) / 2, which "
              "calms what swings about a steady motion, too.");
        visit("gravity", &I::gravity, "Gravity [m/s²].");
        BodyEnergies::attributes<I>(visit);
        visit("last", &I::last, "", Hidden);
    }

    void postLoad();
    void action() override;
};

// The largest stable time step of joints and zones under the damping of the engines [s], a bound that is safe, and the
// ids of the two bodies whose joint, or of the unit whose zone, sets it: (dt, id1, id2). Without any (inf, -1, -1).
py::tuple criticalTimeStep();

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryLoad)
BOOST_CLASS_EXPORT_KEY(masonry::MasonryEnergy)
BOOST_CLASS_EXPORT_KEY(masonry::MasonryIntegrator)
