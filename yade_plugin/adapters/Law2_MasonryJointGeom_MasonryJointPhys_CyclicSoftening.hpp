#pragma once
#include "Adapter.hpp"

namespace masonry {

class Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening
    : public Adapter<Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening, yade::LawFunctor> {
public:
    static constexpr const char* className = "Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening";
    static constexpr const char* baseName = "LawFunctor";
    static constexpr const char* doc =
        "The cyclic law at every subcontact, one joint at a time: the strengths of the paper's law, with softening by "
        "rate, stiffness that degrades and dilatancy that turns back. Its parameters are those of the MasonryJoint "
        "objects, which must all be cyclic or elastic. MasonryJointLoop is the fast way through the same law.";

    template <class Visit> static void attributes(Visit&&) {}

    std::string get2DFunctorType1() const override { return "MasonryJointGeom"; }
    std::string get2DFunctorType2() const override { return "MasonryJointPhys"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryJointGeom", "MasonryJointPhys"}; }
    std::string checkOrder() const override { return "MasonryJointGeom MasonryJointPhys"; }
    bool go(shared_ptr<yade::IGeom>&, shared_ptr<yade::IPhys>&, yade::Interaction*) override;
    using FunctorCalls::go;
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening,
                                       yade::LawFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening)
