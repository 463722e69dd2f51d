// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "engine/bodies/Load.hpp"
#include "engine/watch/EngineOrder.hpp"

namespace masonry {

class MasonryLoad : public Adapter<MasonryLoad, yade::GlobalEngine>, public Load {
public:
    static constexpr const char* className = "MasonryLoad";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr ClassRole declares = ClassRole::Load;
    static constexpr const char* doc =
        "Loads a rigid block at a point fixed to it: with a constant force and, if it is driven, with a prescribed "
        "velocity of that point in one direction. The block remains free to rotate and to move in other directions. "
        "Stands after the loop of the joints and before the integrator. It switches off the damping of the block, so "
        "that the velocity is exact, unless damped keeps it; two driven loads on one block are exact only if the block "
        "cannot rotate. A drive can move several blocks with forces in a fixed proportion; the velocity is then the "
        "mean of their points by the shares of the force. Undriven, it can be the load of a testing machine, which "
        "follows how far the point moves against the direction by a stiffness, and which friction keeps back.";

    template <class Visit> static void attributes(Visit&& visit) {
        using L = MasonryLoad;
        visit("body", &L::body, number("", "Id of the loaded body").atLeast(0));
        visit("point", &L::point, number("m", "Loaded point in the reference state of the body, global axes"));
        visit("force", &L::force, number("N", "Force at the point"));
        visit("others", &L::others, described("Ids of further blocks that the drive moves"));
        visit("otherPoints", &L::otherPoints, described("Their points, likewise [m]"));
        visit("shares", &L::shares,
              described("Of the force of the drive that body and the others take, 1 in sum; empty without others"));
        visit("direction", &L::direction, described("Direction of the driven velocity; not zero"));
        visit("driven", &L::driven, described("Whether the velocity is prescribed"));
        visit("damped", &L::damped,
              described("Whether the blocks keep their numerical damping; a drive then meets its velocity but for what "
                        "damping takes in a step"));
        visit("velocity", &L::velocity,
              number("m/s", "Velocity of the point along the direction, when the ramp is over"));
        visit("ramp", &L::ramp,
              number("",
                     "Steps in which the velocity still grows evenly, with `acceleration`, to `velocity`; the engine "
                     "counts them down")
                  .atLeast(0));
        visit("acceleration", &L::acceleration, number("m/s²", "Growth of the velocity in the ramp"));
        visit("reaction", &L::reaction,
              number("N",
                     "Force that the drive, or a testing machine beside the force, applied along the direction in the "
                     "last step; whoever turns the direction turns it, too"));
        visit(
            "stiffness", &L::stiffness,
            number("N/m", "Stiffness with which the load of a testing machine follows the point against the direction")
                .atLeast(0));
        visit("friction", &L::friction,
              number("-", "Share of this load up to which friction of the machine keeps it back").atLeast(0).below(1));
        visit("guideStiffness", &L::guideStiffness,
              number("N/m", "Stiffness of the guides of the machine until their friction slips").atLeast(0));
        visit("engaged", &L::engaged, described("Whether stiffness and friction act; they begin without force"));
        visit("uplift", &L::uplift, number("m", "Displacement of the point against the direction since then"),
              ReadOnly);
        visit("slip", &L::slip, number("m", "Part of the uplift by which the friction has slipped"), ReadOnly);
        visit("elastic", &L::stored, number("J", "Elastic energy of machine and guides"), ReadOnly);
        visit("dissipated", &L::dissipated, number("J", "Energy that their friction has dissipated so far"), ReadOnly);
        visit("work", &L::work,
              number("J", "Work done on the block by force and drive so far; counted by the engine that counts the "
                          "energies of rigid bodies"),
              ReadOnly);
        visit("pendingWork", &L::pendingWork, number("J", "Work of the last step"), Hidden);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("displacement", &MasonryLoad::displacement,
                "Displacement of the loaded point since the reference state [m].");
    }

    using Load::problems;
    bool isActivated() override { return standsAlone(*this); }
    void action() override;

private:
    Vector3r displacement() const; // of the point since the reference state [m]
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryLoad, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryLoad)
