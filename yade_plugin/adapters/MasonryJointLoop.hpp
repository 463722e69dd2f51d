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
        "All masonry joints in one pass: what InteractionLoop does with the functors of this plugin, which stay as the "
        "reference, in columns and on all threads. A run is the same, bit for bit, with any number of threads. Stands "
        "in InteractionLoop's place; new joints are made by masonry.connect().";

    shared_ptr<Ig2_Polyhedra_Polyhedra_MasonryJointGeom> geometry;
    shared_ptr<Ip2_MasonryMat_MasonryMat_MasonryJointPhys> physics;

    template <class Visit> static void attributes(Visit&& visit) {
        using L = MasonryJointLoop;
        visit("geometry", &L::geometry, described("Ig2 functor with which masonry.connect() makes joints"));
        visit("physics", &L::physics, described("Ip2 functor with which masonry.connect() makes joints"));
    }

    void action() override;

private:
    JointPlan plan_; // nothing in it outlives a step but what follows from the scene
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryJointLoop, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryJointLoop)
