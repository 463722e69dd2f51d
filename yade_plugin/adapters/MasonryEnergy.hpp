// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "engine/bodies/GravityWork.hpp"
#include "engine/bodies/Ledger.hpp"
#include "engine/watch/Collapse.hpp"
#include "engine/watch/SceneCheck.hpp"
#include "law/common/JointState.hpp"

namespace masonry {

class EngineScope;
class SceneStore;

class MasonryEnergy : public Adapter<MasonryEnergy, yade::GlobalEngine>, public EnergyLedger, public GravityWork {
public:
    static constexpr const char* className = "MasonryEnergy";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Keeps the energy balance of a run: work of loads, prescribed motions and gravity = kinetic + elastic + "
        "dissipated in the joints by mode + damping. MasonryIntegrator and MasonryZones count the energies of what "
        "they move. With NewtonIntegrator this engine must stand directly before it, and counts them by its equations. "
        "The error of the balance is round-off and the small terms of finite rotation. It also watches over the run: a "
        "time step above its limit, motion that grows without work and numbers that are not finite stop it with an "
        "error that begins with 'unstable:' or 'numbers'. A collapse ends it with an error that begins with "
        "'collapsed:': a block has turned, slid, been crushed or gone away so far that the joints, whose geometry is "
        "that of the reference state, mean nothing any more; see turnLimit, slideLimit, closureLimit and openingLimit. "
        "An energy balance that is off by more than 1 % of the work done is reported on the terminal's error stream, "
        "and again if it becomes twice as large.";

    // See attributes() for the meaning and unit of each. Users set `watch` and the limits only.
    bool watch = true;
    double turnLimit = CollapseLimits().turn;
    double slideLimit = CollapseLimits().slide;
    double closureLimit = CollapseLimits().closure;
    double openingLimit = CollapseLimits().opening;
    int collapsedBlock = -1;
    std::string collapse;
    bool warned = false;
    double reportedError = 0;
    Vector3r storedThen = Vector3r::Zero();
    Vector3r lostThen = Vector3r::Zero();
    double dampingThen = 0;
    double givenThen = 0;
    Vector3r connectorsThen = Vector3r::Zero();
    Vector3r contactsThen = Vector3r::Zero();
    int stepThen = -1;
    bool begun = false;
    double largestError = 0;
    double largestMade = 0;
    double largestInput = 0;
    double largestWork = 0;
    Vector3r mostLost = Vector3r::Zero();

    template <class Visit> static void attributes(Visit&& visit) {
        using E = MasonryEnergy;
        ledgerOfBodies<E>(visit);
        GravityWork::describe<E>(visit);
        visit("watch", &E::watch,
              described("Whether a run that is unstable or has collapsed is stopped, and a wrong energy balance is "
                        "reported. If an unstable run is not stopped, a time step above criticalTimeStep() gives wrong "
                        "results that look sound, because damping keeps the unstable motion within bounds"));
        visit("turnLimit", &E::turnLimit,
              number("rad", "Rotation of two joined blocks against each other at which a run has collapsed, looked at "
                            "every hundredth step. At 60° the normal of a joint, the mean of both faces, lies 30° off "
                            "either face, which is the angle of friction of masonry: from there an edge that stands "
                            "still in reality would slip. A block that rocks about an edge is exact up to there")
                  .above(0)
                  .source("[decided]: yade_plugin/README.md, Collapse"));
        visit("slideLimit", &E::slideLimit,
              number("-", "Slide in a joint, mean of its subcontacts, over the joint's own size in that direction, at "
                          "which a run has collapsed: at 1 the two faces have parted")
                  .above(0)
                  .source("[decided]: yade_plugin/README.md, Collapse"));
        visit("closureLimit", &E::closureLimit,
              number("-", "Largest closure of a joint over the size of the smaller of its two blocks across the joint, "
                          "at which a run has collapsed: at 1 one block has gone through the other")
                  .above(0)
                  .source("[decided]: yade_plugin/README.md, Collapse"));
        visit("openingLimit", &E::openingLimit,
              number("-", "Smallest opening of a joint over the largest extent of the smaller of its two blocks, at "
                          "which a run has collapsed. A block that rocks keeps an edge closed; at 1 it has left its "
                          "neighbour by its own size")
                  .above(0)
                  .source("[decided]: yade_plugin/README.md, Collapse"));
        visit("collapsedBlock", &E::collapsedBlock,
              number("", "Id of the block whose collapse has ended the run; -1: none has collapsed"), ReadOnly);
        visit("collapse", &E::collapse, described("What that block did, and when; empty: none has collapsed"),
              ReadOnly);
        visit("warned", &E::warned,
              described("Whether a balance that is off by more than 1 % has been reported on the terminal"), ReadOnly);
        visit("reportedError", &E::reportedError,
              number("-", "Error of the balance that was reported last; one of twice that is reported again"), Hidden);
        visit("storedThen", &E::storedThen,
              number("J", "Energies stored in the joints at the last look at the balance, by mode"), Hidden);
        visit("lostThen", &E::lostThen,
              number("J", "Energies dissipated in the joints at the last look at the balance, by mode"), Hidden);
        visit("dampingThen", &E::dampingThen, number("J", "Work of the damping of joints at that look"), Hidden);
        visit("givenThen", &E::givenThen,
              number("J", "Energy that joints got when they were refined and handed over, at that look"), Hidden);
        visit("connectorsThen", &E::connectorsThen,
              number("J", "Work of tightening, and energies stored and dissipated in ties and springs, at that look"),
              Hidden);
        visit("contactsThen", &E::contactsThen,
              number("J", "Elastic energy of contacts, and energies lost in their friction and damping, at that look"),
              Hidden);
        visit("stepThen", &E::stepThen, number("", "Step of the last look at the balance; -1: there was none"), Hidden);
        visit(
            "largestError", &E::largestError,
            number("-", "Largest error of the balance seen by balance(), relative to the largest work done until then"),
            ReadOnly);
        visit("largestMade", &E::largestMade,
              number("-",
                     "Largest fall of the dissipated energies below their largest values, as seen by balance(), "
                     "relative to the largest work done until then: energy made by joints that open or close within "
                     "a step"),
              ReadOnly);
        visit("mostLost", &E::mostLost, number("J", "Largest dissipated energies seen by balance(), by mode"), Hidden);
        visit("largestInput", &E::largestInput,
              number("J", "Largest work of loads, prescribed motions and gravity so far"), Hidden);
        visit(
            "largestWork", &E::largestWork,
            number("J", "Largest work done so far, or if it is more, that of the weight of the scene over a nanometre"),
            Hidden);
        visit("begun", &E::begun, described("Whether the kinetic energy at the first step has been counted"), Hidden);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("balance", &MasonryEnergy::balance,
                "All energies of the last step [J]: external, gravity, refining, kinetic, damping; elastic_tension and "
                "dissipated_tension, and likewise of shear and compression; elastic_connectors and "
                "dissipated_connectors of ties and "
                "springs where there are some; handing, elastic_contacts, friction_contacts and damping_contacts of "
                "MasonryContacts where there is one; and error, the balance's error relative to the largest work done "
                "until now [-].")
            .def("given", &MasonryEnergy::given,
                 "Count the kinetic energy of the present motion as work done from outside. Call this directly after "
                 "setting velocities by hand, if the run has made a step before.");
    }

    bool isActivated() override { return standsAlone(*this); }
    void action() override;

private:
    struct Inventory {           // energies that the engines of a scene keep, without those of the joints [J]
        double work = 0;         // of loads and prescribed motions
        double falls = 0;        // work of gravity
        double moving = 0;       // kinetic energy
        double drag = 0;         // taken by damping
        double inUnits = 0;      // elastic energy of deformable units
        double given = 0;        // elastic energy that joints got when they were refined and when they were handed over
        double inConnectors = 0; // elastic energy of ties and springs
        double lostInConnectors = 0; // dissipated by them
        // Elastic energy of contacts, and what their friction and damping took. Only a balance has them, because the
        // elastic energy takes longer to find than the forces.
        Vector3r inContacts = Vector3r::Zero();
    };
    Inventory inventory(const SceneStore&) const;
    struct Balance {
        Inventory all;
        Vector3r stored, lost; // in the joints, by mode: tension, shear, compression [J]
        double error;          // [J]
        double size;           // of the work done [J]
    };
    static Balance balanceOf(const Inventory&, const Vector3r& stored, const Vector3r& lost);
    Balance presentBalance(const SceneStore&) const;
    double comparedWith(double size); // the work [J] to which an error of the balance is relative
    void lookAtBalance(const SceneStore&);
    py::dict balance();
    void given();
    void countPresentMotion(SceneStore&);
    void watchOver(SceneStore&);
    void countBodies(const EngineScope&);
    // Looks whether a block has collapsed. Returns why the run ends, or an empty text.
    std::string findCollapse(SceneStore&);
    // Ends the run at once if a block has collapsed; `besides` says what else is wrong.
    void stopIfCollapsed(SceneStore&, const std::string& besides = "");
    void warnOfBalance(const SceneStore&, double error);

    double checkedStep_ = 0;    // time step at the last check [s]
    long checkedRevision_ = -1; // SceneStore::revision() at the last check
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryEnergy, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryEnergy)
