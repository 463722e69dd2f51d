#pragma once
#include "Ig2_Polyhedra_Polyhedra_MasonryJointGeom.hpp"
#include "Ip2_MasonryMat_MasonryMat_MasonryJointPhys.hpp"
#include "JointPlan.hpp"

namespace masonry {

class MasonryJointLoop : public Adapter<MasonryJointLoop, yade::GlobalEngine> {
public:
    static constexpr const char* className = "MasonryJointLoop";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "A step of all masonry joints, in columns and on all threads. Stands in the place of InteractionLoop, which "
        "does "
        "the same with the functors of this plugin and remains as the reference. A run is the same, bit for bit, with "
        "any number of threads. It makes no joints: masonry.connect() does.";

    shared_ptr<Ig2_Polyhedra_Polyhedra_MasonryJointGeom> geometry;
    shared_ptr<Ip2_MasonryMat_MasonryMat_MasonryJointPhys> physics;

    template <class Visit> static void attributes(Visit&& visit) {
        using L = MasonryJointLoop;
        visit("geometry", &L::geometry, described("Ig2 functor with which masonry.connect() makes joints"));
        visit("physics", &L::physics, described("Ip2 functor with which masonry.connect() makes joints"));
    }

    void action() override;

private:
    JointPlan plan_; // holds no state: all that it keeps from step to step follows from the scene
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryJointLoop, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryJointLoop)
