// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom.hpp"
#include "Ip2_MasonryMat_MasonryMat_MasonryJointPhys.hpp"
#include "scene/JointPlan.hpp"
#include "scene/SceneCheck.hpp"

namespace masonry {

class MasonryJointLoop : public Adapter<MasonryJointLoop, yade::GlobalEngine>, public JointLoop {
public:
    static constexpr const char* className = "MasonryJointLoop";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "A step of all masonry joints, in columns and on all threads. Stands in the place of InteractionLoop, which "
        "does "
        "the same with the functors of this plugin and remains as the reference. A run is the same, bit for bit, with "
        "any number of threads. It makes no joints: masonry.connect() does.";

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
    }

    bool isActivated() override { return standsAlone(*this); }
    void action() override;

private:
    int groups() const;
    int intactJoints() const;

    JointPlan plan_; // holds no state: all that it keeps from step to step follows from the scene
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryJointLoop, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryJointLoop)
