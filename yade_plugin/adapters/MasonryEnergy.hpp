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
        "dissipated in the joints by mode + damping. MasonryIntegrator and MasonryZones keep what is theirs; for "
        "NewtonIntegrator it stands directly before it and follows its equations. The balance closes to round-off and "
        "the small terms of finite rotation. It also watches over the run: a time step above its limit, motion that "
        "grows out of nothing and numbers that are not finite stop it with an error.";

    bool watch = true;
    bool begun = false;
    double largestError = 0;
    double largestMade = 0;
    double largestInput = 0;              // most work of loads, prescribed motions and gravity so far [J]
    Vector3r mostLost = Vector3r::Zero(); // most that balance() has seen dissipated in tension, shear, compression [J]

    template <class Visit> static void attributes(Visit&& visit) {
        using E = MasonryEnergy;
        ledgerOfBodies<E>(visit);
        visit(
            "watch", &E::watch,
            described("Whether an unstable run is stopped. Where it is not, a time step above criticalTimeStep() gives "
                      "answers that look sound and are not: damping keeps what should blow up within bounds"));
        visit("largestError", &E::largestError,
              number("-", "Largest error of the balance seen by balance(), relative to the work done"), ReadOnly);
        visit("largestMade", &E::largestMade,
              number("-", "Most that dissipated energies have fallen below their largest values seen by balance(), "
                          "relative to the work done: energy made by joints that open or close within a step"),
              ReadOnly);
        visit("mostLost", &E::mostLost, number("J", "Most dissipated so far by mode"), Hidden);
        visit("largestInput", &E::largestInput, number("J", "Most work done so far"), Hidden);
        visit("begun", &E::begun, described("Whether the energy of the first motion is counted"), Hidden);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("balance", &MasonryEnergy::balance,
                "All energies of the last step [J]: external, gravity, kinetic, damping, elastic_ and dissipated_ "
                "tension, shear, compression; and error, the balance's error relative to the work done [-].")
            .def("given", &MasonryEnergy::given,
                 "Count the present motion as given from outside: to be called at once when velocities were set by "
                 "hand after the first step.");
    }

    void action() override;

private:
    struct Inventory { // what the engines of a scene keep, without the joints [J]
        double work = 0, falls = 0, moving = 0, drag = 0, inUnits = 0;
    };
    Inventory inventory(const SceneStore&) const;
    py::dict balance();
    void given();
    void countPresentMotion(SceneStore&);
    void watchOver(SceneStore&);

    double checkedStep_ = 0;    // time step at the last check [s]
    long checkedRevision_ = -1; // of the scene, at the last check
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryEnergy, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryEnergy)
