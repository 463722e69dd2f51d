// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "EngineAdapter.hpp"
#include "engine/contacts/FallenBlocks.hpp"
#include "engine/contacts/JointConversion.hpp"

namespace masonry {

class MasonryContacts : public EngineAdapter<MasonryContacts>, public Contacts {
    MASONRY_CLASS(MasonryContacts, GlobalEngine)
    static constexpr ClassRole declares = ClassRole::Contacts;
    static constexpr const char* doc =
        "Contacts of rigid blocks wherever they meet, also after large motions: of all pairs that no joint connects. "
        "The force comes from a potential of the overlap, with Coulomb friction and viscous damping in compression. "
        "Ground and platens are blocks whose axes are all blocked. Stands after the loop of the joints, if there is "
        "one, and before MasonryLoad. normalStiffness and friction must be given.";

    template <class Visit> static void attributes(Visit&& visit) {
        using C = MasonryContacts;
        visit("normalStiffness", &C::normalStiffness,
              number("Pa/m", "Stiffness of two faces per area; must be given, as that of a joint between the blocks")
                  .atLeast(0));
        visit("tangentialRatio", &C::tangentialRatio,
              number("-", "Elastic stiffness along the face over that along the normal")
                  .above(0)
                  .atMost(1)
                  .source("[decided]: G/E of masonry"));
        visit("friction", &C::friction,
              number("-", "Coefficient of friction; -1 stands for none given, which the first step refuses")
                  .atLeast(-1)
                  .atMost(10));
        visit("restitution", &C::restitution,
              number("-", "Speed after a central impact of two faces over that before it; 1: without damping. Measured "
                          "ones of stone depend on speed, mass and hardness")
                  .atLeast(0.1)
                  .atMost(1)
                  .source("convention, no measured value"));
        visit("skin", &C::skin,
              number("m", "By which the boxes of the search are larger than their blocks; 0: a tenth of the thinnest "
                          "block that moves. It changes the time of a step, and no result")
                  .atLeast(0));
        visit("takesJoints", &C::takesJoints,
              described("Whether joints are handed over to contact: those whose bond is gone at every point and whose "
                        "blocks have slid by 2 % of the joint or turned by 1° against each other, and those that are "
                        "open by 2 % of their size everywhere. Blocks that have kept their joints and their places are "
                        "then left out of the search"));
        visit(
            "dampsLoose", &MasonryContacts::dampsLoose,
            described("Whether numerical damping acts on blocks that no joints hold any more, where joints are handed "
                      "over. It would brake their fall"));
        visit("handing", &C::conversionEnergy,
              number("J", "Elastic energy that joints got so far when they were handed over: an input of the energy "
                          "balance"),
              ReadOnly);
        visit("handed", &C::converted, number("", "Number of joints that were handed over so far"), ReadOnly);
        visit("bodies", &C::bodies, described("Ids of the blocks; empty: all blocks of the scene"), Given);
        visit("begun", &C::begun, described("Whether there was a step"), Hidden);
        visit("given", &C::given,
              number("J", "Elastic energy that contacts had in the first step, because blocks were put into each "
                          "other: an input of the energy balance"),
              ReadOnly);
        visit("lostInFriction", &C::lostInFriction, number("J", "Energy that friction took so far"), ReadOnly);
        visit("lostInDamping", &C::lostInDamping, number("J", "Energy that damping took so far"), ReadOnly);
        visit("following", &C::stepShare,
              number("-", "Time step over its limit while it follows the state (follow); 0: it stays"), Shown);
        visit("memory", &MasonryContacts::visitMemory,
              described("Pairs of blocks that are near each other, and what they remember; blocks that are awake, and "
                        "those that no joints hold any more"));
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("touching", &MasonryContacts::countTouching,
                "Number of pairs that pressed on each other in the last step.")
            .def("forceOf", &MasonryContacts::forceBetween, py::args("id1", "id2"),
                 "Force of body id1 on body id2 in the last step [N], global axes. It is zero if they do not touch, "
                 "but for the first step after a contact, in which they may get energy back.")
            .def("pairs", &MasonryContacts::pairs,
                 "Pairs of blocks between which a force acted in the last step, that is, which touch or have just "
                 "parted: a list of tuples of the ids of both, and the force [N] and the torque about its centre [N m] "
                 "on the second, global axes.")
            .def("impulse", &MasonryContacts::impulse,
                 "Impulse of all contacts so far on a body whose axes are all blocked, as the ground [N s], global "
                 "axes. The force of an impact depends on stiffness and time step, and its impulse does not.")
            .def("follow", &MasonryContacts::follow, py::args("share"),
                 "From now on O.dt is this share of the limit that the present pairs of blocks allow, and changes "
                 "when other blocks are near each other; call it again when masses or blocked axes have changed. 0: it "
                 "stays, and its limit is that of any contacts that may "
                 "come.")
            .def("fallen", &MasonryContacts::fallen,
                 "Blocks that have come loose where joints are handed over, by their ids: a dict of id -> dict with "
                 "since, when that was [s]; fell, when the block had turned by 60°, or moved by its diameter and come "
                 "down by half its thickness, since the reference state [s], None if it has not; most, its largest "
                 "kinetic energy since then [J]; and at, "
                 "when it had that [s]. Looked at every fifth step.");
    }

    bool dampsLoose = true;

    using Contacts::problems;
    void step(SceneStore&);

private:
    int countTouching();
    void follow(double share);
    Vector3r forceBetween(int id1, int id2);
    Vector3r impulse(int body);
    py::dict fallen();
    py::list pairs();
    void lookAtFalls(SceneStore&);
    void undamp(SceneStore&, const std::vector<int>& loose);
    void visitMemory(StateNumbers& n) {
        visitState(n);
        n(falls_);
    }

    JointConversion conversion_; // holds no state: what it keeps follows from the scene
    FallenBlocks falls_;
};

} // namespace masonry

MASONRY_DECLARE(MasonryContacts)
