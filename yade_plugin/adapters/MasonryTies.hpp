// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "EngineAdapter.hpp"
#include "engine/connectors/Ties.hpp"

namespace masonry {

class MasonryTies : public EngineAdapter<MasonryTies>, public Ties {
    MASONRY_CLASS(MasonryTies, GlobalEngine)
    static constexpr ClassRole declares = ClassRole::Connectors;
    static constexpr const char* doc =
        "Bars between points of two rigid bodies, or of one and the ground: elastic, yielding at a force, breaking at "
        "an elongation, with prestress or slack, with or without compression. A bar has no mass and does not bend. Its "
        "force acts along the line between its ends, which move with their bodies however far. Stands after the loop "
        "of the joints and before MasonryLoad.";

    template <class Visit> static void attributes(Visit&& visit) {
        using T = MasonryTies;
        Connectors::describe<T>(visit);
        visit("stiffness", &T::stiffness, described("E A / L of each bar [N/m], above 0"), Given);
        visit("strength", &T::strength, described("Force at which each bar yields [N], above 0; 1e300: never"), Given);
        visit(
            "breaking", &T::breaking,
            described("Elongation of each bar, its prestress included, at which it breaks [m], above 0; 1e300: never"),
            Given);
        visit("compression", &T::compression, described("1 for a bar that carries compression, too, else 0"), Given);
        visit("rest", &T::rest,
              described("Elongation of the distance between the ends at which each bar has no force [m]: below 0 it is "
                        "prestressed, above 0 slack. It may change during a run: the energy balance counts the work"));
        visit("elongations", &T::elongations, described("Of the distance between the ends, in the last step [m]"),
              ReadOnly);
        visit("forces", &T::forces, described("Force of each bar in the last step, positive in tension [N]"), ReadOnly);
        visit("flows", &T::flows, described("Plastic elongation of each bar so far [m]"), ReadOnly);
        visit("yieldedAt", &T::yieldedAt, described("Step in which each bar yielded first; -1: it has not"), ReadOnly);
        visit("brokenAt", &T::brokenAt, described("Step in which each bar broke; -1: it has not"), ReadOnly);
        visit("restBefore", &T::restBefore, described("rest in the last step [m]"), Hidden);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("forceOf", &MasonryTies::forceOf, py::args("tie"),
                "Force of a tie in the last step, by its number from 0 [N]; 0 before the first step.");
    }

    using Ties::problems;
    void postLoad() {
        Adapter::check();
        forgetReference();
    }
    void step(SceneStore&);

private:
    double forceOf(int tie);
};

} // namespace masonry

MASONRY_DECLARE(MasonryTies)
