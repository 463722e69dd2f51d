// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "MasonryJoint.hpp"
#include "engine/joints/JointView.hpp"

namespace masonry {

class MasonryJointPhys : public Adapter<MasonryJointPhys, yade::IPhys>, public JointPhysics {
    MASONRY_DISPATCHED(MasonryJointPhys, IPhys)
    static constexpr const char* doc =
        "State of a joint: the property set that it shares with others of its kind, its stiffness, which includes that "
        "of rigid units, and the state of every subcontact. Opening and tension are positive.";

    template <class Visit> static void attributes(Visit&& visit) {
        using P = MasonryJointPhys;
        visit("joint", computed(&P::joint, &P::setJoint), described("The MasonryJoint of this joint"), ReadOnly);
        visit("normalStiffness", computed(&P::normalStiffness),
              number("Pa/m", "Normal stiffness of the joint in series with its rigid units")
                  .source("yade_plugin/law/README.md, rigid units"),
              Shown);
        visit("shearStiffness", computed(&P::shearStiffness),
              number("Pa/m", "Shear stiffness of the joint in series with its rigid units")
                  .source("yade_plugin/law/README.md, rigid units"),
              Shown);
        visit("dissipated", computed(&P::dissipated),
              number("J", "Energy dissipated so far in tension, shear and compression"), Shown);
        visit("record", &P::visitRecord, described("All numbers of the joint"));
    }

    MasonryJointPhys() {
        createIndex();
        ++changes;
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.add_property("stress", &MasonryJointPhys::stress,
                         "Per subcontact: normal stress and shear stress along and across the tangent [Pa].")
            .add_property("opening", &MasonryJointPhys::opening,
                          "Per subcontact: total opening [m]; negative where the joint is closed.")
            .add_property("slip", &MasonryJointPhys::slip, "Per subcontact: accumulated plastic slip [m].")
            .add_property("damage", &MasonryJointPhys::damage,
                          "Per subcontact: damage in tension, shear and compression [-], 0 to 1.")
            .add_property(
                "largest", &MasonryJointPhys::largest,
                "Per subcontact: largest opening and largest closure so far [m]. The opening is measured "
                "from the place to which crushing and dilation have moved the surfaces. Of a joint of the "
                "cyclic law the closure is kappa, which counts slip on the cap, too, and is 0 up to the elastic limit "
                "(yade_plugin/law/cyclic_softening/README.md).")
            .add_property(
                "yielding", &MasonryJointPhys::yielding,
                "Per subcontact: yield functions F1, F2 and F3 of the paper's eqs. (8) and (9) [-]. Each is divided by "
                "the sum of the sizes of its terms and of the elastic stress of the largest jumps so far, so that it "
                "exceeds zero by round-off only. -1: this yield function does not apply now.")
            .add_property(
                "regime", &MasonryJointPhys::regime,
                "Per subcontact: its regime in the last step: 'elastic', 'opening', 'slipping' or 'crushing'.");
    }

    shared_ptr<MasonryJoint> joint(); // the property set

private:
    void setJoint(const shared_ptr<MasonryJoint>&);
    double normalStiffness();
    double shearStiffness();
    Vector3r dissipated();
    void visitRecord(StateNumbers&);
    template <class F> py::list perSubcontact(F&& value);
    py::list stress();
    py::list opening();
    py::list slip();
    py::list damage();
    py::list largest();
    py::list yielding();
    py::list regime();

    shared_ptr<MasonryJoint> loaded_; // while a file is loaded: the property set, which is read before the record
};

} // namespace masonry

MASONRY_DECLARE(MasonryJointPhys)
