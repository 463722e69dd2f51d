#pragma once
#include "Ledger.hpp"

namespace masonry {

class SceneStore;

class MasonryEnergy : public Adapter<MasonryEnergy, yade::GlobalEngine>, public EnergyLedger {
public:
    static constexpr const char* className = "MasonryEnergy";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Keeps the energy balance of a run: work of loads, prescribed motions and gravity = kinetic + elastic + "
        "dissipated in the joints by mode + damping. MasonryIntegrator and MasonryZones count the energies of what "
        "they "
        "move. With NewtonIntegrator this engine must stand directly before it, and counts them by its equations. The "
        "error of the balance is round-off and the small terms of finite rotation. It also watches over the run: a "
        "time "
        "step above its limit, motion that grows without work and numbers that are not finite stop it with an error.";

    // See attributes() for the meaning and unit of each. Users set `watch` only.
    bool watch = true;
    bool begun = false;
    double largestError = 0;
    double largestMade = 0;
    double largestInput = 0;
    Vector3r mostLost = Vector3r::Zero();

    template <class Visit> static void attributes(Visit&& visit) {
        using E = MasonryEnergy;
        ledgerOfBodies<E>(visit);
        visit("watch", &E::watch,
              described(
                  "Whether an unstable run is stopped. If it is not, a time step above criticalTimeStep() gives wrong "
                  "results that look sound, because damping keeps the unstable motion within bounds"));
        visit("largestError", &E::largestError,
              number("-", "Largest error of the balance seen by balance(), relative to the work done"), ReadOnly);
        visit("largestMade", &E::largestMade,
              number("-", "Largest fall of the dissipated energies below their largest values, as seen by balance(), "
                          "relative to the work done: energy made by joints that open or close within a step"),
              ReadOnly);
        visit("mostLost", &E::mostLost, number("J", "Largest dissipated energies seen by balance(), by mode"), Hidden);
        visit("largestInput", &E::largestInput,
              number("J", "Largest work of loads, prescribed motions and gravity so far"), Hidden);
        visit("begun", &E::begun, described("Whether the kinetic energy at the first step has been counted"), Hidden);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("balance", &MasonryEnergy::balance,
                "All energies of the last step [J]: external, gravity, kinetic, damping, elastic_ and dissipated_ "
                "tension, shear, compression; and error, the balance's error relative to the work done [-].")
            .def("given", &MasonryEnergy::given,
                 "Count the kinetic energy of the present motion as work done from outside. Call this directly after "
                 "setting velocities by hand, if the run has made a step before.");
    }

    void action() override;

private:
    struct Inventory {      // energies that the engines of a scene keep, without those of the joints [J]
        double work = 0;    // of loads and prescribed motions
        double falls = 0;   // work of gravity
        double moving = 0;  // kinetic energy
        double drag = 0;    // taken by damping
        double inUnits = 0; // elastic energy of deformable units
    };
    Inventory inventory(const SceneStore&) const;
    py::dict balance();
    void given();
    void countPresentMotion(SceneStore&);
    void watchOver(SceneStore&);

    double checkedStep_ = 0;    // time step at the last check [s]
    long checkedRevision_ = -1; // SceneStore::revision() at the last check
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryEnergy, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryEnergy)
