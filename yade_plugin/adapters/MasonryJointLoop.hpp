// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "EngineAdapter.hpp"
#include "Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom.hpp"
#include "Ip2_MasonryMat_MasonryMat_MasonryJointPhys.hpp"
#include "engine/joints/JointPlan.hpp"
#include "engine/joints/Refinement.hpp"

namespace masonry {

class MasonryJointLoop : public EngineAdapter<MasonryJointLoop>, public JointLoop {
    MASONRY_CLASS(MasonryJointLoop, GlobalEngine)
    static constexpr ClassRole declares = ClassRole::Joints;
    static constexpr const char* doc =
        "A step of all masonry joints, in columns and on all threads. Stands in the place of InteractionLoop, which "
        "does the same with the functors of this plugin and remains as the reference. A run is the same, bit for bit, "
        "with any number of threads. It makes no joints: masonry.connect() does.";

    shared_ptr<Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom> geometry;
    shared_ptr<Ip2_MasonryMat_MasonryMat_MasonryJointPhys> physics;

    template <class Visit> static void attributes(Visit&& visit) {
        using L = MasonryJointLoop;
        visit("stiffnessDamping", &L::stiffnessDamping,
              number("s",
                     "Stiffness-proportional viscous damping of joints: a subcontact that is elastic, and intact or "
                     "pressed, gets this time times its stiffness times the rate of its jump as a stress beside "
                     "that of the law. It does not pull where there is no bond, and is none where the joint is "
                     "open or yields. A mode of angular frequency w, elastic in joints alone, then has the damping "
                     "ratio d = stiffnessDamping w/2. The limit of the time step falls by the factor "
                     "sqrt(1 + d²) - d for the highest mode; criticalTimeStep() counts that")
                  .atLeast(0));
        visit("dampingWork", &L::dampingWork, number("J", "Energy taken by stiffnessDamping so far"), ReadOnly);
        visit("impacts", &L::impacts,
              described("Whether impacts of joints that close take energy, as their restitution says: for motions in "
                        "real time alone")
                  .source("yade_plugin/README.md, Impacts"));
        visit("impactWork", &L::impactWork, number("J", "Energy taken by impacts so far"), ReadOnly);
        visit("points", &L::points,
              number(
                  "-",
                  "Points along a joint between rigid blocks from when it is about to yield or, dry and compliant, "
                  "to open; in space along each side of its face that yields or opens. 0: 8, 5 in space, and 14 "
                  "where it opens; 3: joints keep the three that they are made with. Every "
                  "tenth step looks for joints that bear 0.9 of the elastic limit of the cap, and, of joints with a "
                  "bond that stand in space or cannot crush, 0.9 of the strength of the bond, and takes those at 0.75 "
                  "along. The points of Gauss and Lobatto take over the state. A dry joint that cannot crush and has a "
                  "stiff bed, a joint that was made with as many points or with fewer than three along a side, and "
                  "joints of deformable "
                  "units keep theirs")
                  .atLeast(0)
                  .atMost(Refinement::most)
                  .source("yade_plugin/README.md, Points where a joint yields"));
        visit("refiningEnergy", &L::refiningEnergy,
              number("J", "Elastic energy that joints got so far when they were refined: 0 of those that were elastic, "
                          "the difference between few and many points of those that were cracked"),
              ReadOnly);
        visit("overestimate", &L::overestimate,
              number("-", "Estimate of the largest share of its load by which the structure would fall earlier if the "
                          "beds of dry joints that have opened and keep three points were continuous")
                  .source("yade_plugin/README.md, Points where a joint yields"),
              ReadOnly);
        visit("geometry", &L::geometry, described("Ig2 functor with which masonry.connect() makes joints"));
        visit("physics", &L::physics, described("Ip2 functor with which masonry.connect() makes joints"));
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.add_property("groups", &MasonryJointLoop::groups,
                         "Number of groups of joints that a step takes together: their properties have equal values, "
                         "whether in one MasonryJoint or in many, and they share stiffness and number of subcontacts. "
                         "A step of many small groups takes longer than one of a few large ones.");
        cls.add_property("intactJoints", &MasonryJointLoop::intactJoints,
                         "Number of joints whose points need not be advanced, because they are between rigid blocks "
                         "and have always been elastic. It is known from the first step on.");
        cls.add_property("refinedJoints", &MasonryJointLoop::refinedJoints,
                         "Number of joints that have more points than they were made with; see points.");
    }

    void step(SceneStore&);

private:
    int groups() const;
    int intactJoints() const;
    int refinedJoints() const;

    // Both hold no state: all that they keep from step to step follows from the scene.
    JointPlan plan_;
    Refinement refining_;
};

} // namespace masonry

MASONRY_DECLARE(MasonryJointLoop)
