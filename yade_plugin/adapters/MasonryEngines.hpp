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
    void add(const BodyEnergies& other) {
        external += other.external, pendingExternal += other.pendingExternal;
        damped += other.damped, pendingDamped += other.pendingDamped;
        kinetic += other.kinetic, fallen += other.fallen;
    }

    template <class Class, class Visit> static void attributes(Visit&& visit) {
        visit(
            "external", &Class::external,
            "Work of prescribed motions of bodies so far, without that of MasonryLoad [J]; for MasonryEnergy with the "
            "energy of motion at the first step and at given().",
            ReadOnly);
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
        "the small terms of finite rotation. It also watches over the run: a time step above its limit, motion that "
        "grows out of nothing and numbers that are not finite stop it with an error.";

    bool watch = true, begun = false;
    double largestError = 0, largestMade = 0, largestInput = 0;
    Vector3r mostLost = Vector3r::Zero(); // largest dissipated_ tension, shear, compression seen by balance() [J]

    template <class Visit> static void attributes(Visit&& visit) {
        BodyEnergies::attributes<MasonryEnergy>(visit);
        visit("watch", &MasonryEnergy::watch,
              "Whether an unstable run is stopped. Where it is not, a time step above criticalTimeStep() gives answers "
              "that look sound and are not: damping keeps what should blow up within bounds.");
        visit("largestError", &MasonryEnergy::largestError,
              "Largest error of the balance seen by balance(), relative to the work done [-].", ReadOnly);
        visit("largestMade", &MasonryEnergy::largestMade,
              "Most that dissipated energies have fallen below their largest values seen by balance(), relative to the "
              "work done [-]: energy made by joints that open or close within a step.",
              ReadOnly);
        visit("mostLost", &MasonryEnergy::mostLost, "", Hidden);
        visit("largestInput", &MasonryEnergy::largestInput, "", Hidden);
        visit("begun", &MasonryEnergy::begun, "", Hidden);
    }

    void action() override;
    py::dict balance();

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("balance", &MasonryEnergy::balance,
                "All energies of the last step [J]: external, gravity, kinetic, damping, elastic_ and dissipated_ "
                "tension, shear, compression; and error, the balance's error relative to the work done [-].")
            .def("given", &MasonryEnergy::given,
                 "Count the present motion as given from outside: to be called at once when velocities were set by "
                 "hand after the first step.");
    }

private:
    void given();
    void check();
    double lastStep_ = 0;   // [s] and
    long lastChanges_ = -1; // count of changes, when the limit was last looked at
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

private:
    struct Place {
        const yade::Body* body;
        yade::State* state;
        bool rigid; // moved here, not by MasonryZones
    };
    std::vector<Place> places_; // bodies lie all over the memory, and cost as much as their motion to look up
    bool stale() const;
};

// The largest time step [s] that is safe under the damping of the engines, and the two bodies whose joint, or twice the
// unit, sets it: (dt, id1, id2); without any (inf, -1, -1). It is 2/sqrt(w²) with w² the largest eigenvalue of
// stiffness over mass, damped masses over 1 + alpha, and at most 1.1 % below it (motion/LargestEigenvalue.hpp).
//
// Why it is safe, in degrees of freedom scaled by sqrt(mass), a = -A x the acceleration without damping: a step of
// leapfrog is half a kick dt a/2, in whose middle the velocity is w, damping's impulse, the other half kick, and the
// motion. Without the impulse it keeps E = w·w/2 + x·(A - dt² A²/4) x/2, which is positive while dt² A < 4, so that the
// motion is bounded. Damping draws each w by dt alpha |a| towards zero, at most to zero (stepOf): E falls with every
// such impulse, whatever alpha, local or combined. So dt² A < 4 is enough for stability, and 1 + alpha a margin: close
// to that limit the highest motions go to and fro with w near zero, unseen by damping, and joints that yield let them
// drift.
// All this is for elastic joints and small turns; joints that yield, open or crush are softer. The host's damping may
// draw w past zero; that it is calm below the bound is measured (validation/stability).
py::tuple criticalTimeStep();

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryLoad)
BOOST_CLASS_EXPORT_KEY(masonry::MasonryEnergy)
BOOST_CLASS_EXPORT_KEY(masonry::MasonryIntegrator)
