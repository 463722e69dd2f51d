// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "EngineAdapter.hpp"
#include "engine/bodies/Ledger.hpp"
#include "engine/watch/EnergyAudit.hpp"

namespace masonry {

class MasonryEnergy : public EngineAdapter<MasonryEnergy>, public EnergyAudit {
    MASONRY_CLASS(MasonryEnergy, GlobalEngine)
    static constexpr ClassRole declares = ClassRole::Watch;
    static constexpr const char* doc =
        "Keeps the energy balance of a run: work of loads, prescribed motions and gravity = kinetic + elastic + "
        "dissipated in the joints by mode + damping. MasonryIntegrator and MasonryZones count the energies of what "
        "they move. With NewtonIntegrator this engine must stand directly before it, and counts them by its equations. "
        "The error of the balance is round-off and the small terms of finite rotation. It also watches over the run: a "
        "time step above its limit, motion that grows without work and numbers that are not finite stop it with an "
        "error whose `code` is 'unstable' or 'not finite'. A collapse ends it with one whose `code` is 'collapsed' and "
        "whose `block` says which: a block has turned, slid, been crushed or gone away so far that the joints, whose "
        "geometry is "
        "that of the reference state, mean nothing any more; see turnLimit, slideLimit, closureLimit and openingLimit. "
        "An energy balance that is off by more than 1 % of the work done is reported on the terminal's error stream, "
        "and again if it becomes twice as large.";

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
        visit("snapshot", &E::visitSnapshot,
              described("Energies of joints, connectors and contacts at the last look at the balance"));
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

    void step(SceneStore&);

private:
    py::dict balance();
    void given();
};

} // namespace masonry

MASONRY_DECLARE(MasonryEnergy)
