#pragma once
#include "Adapter.hpp"

namespace masonry {

class Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening
    : public Adapter<Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening, yade::LawFunctor> {
public:
    static constexpr const char* className = "Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening";
    static constexpr const char* baseName = "LawFunctor";
    static constexpr const char* doc =
        "The joint law of the paper at every subcontact, one joint at a time: tension cut-off, Coulomb slip and "
        "elliptical cap with piecewise linear softening (paper §3). Its parameters are those of the MasonryJoint "
        "objects, of which none may be cyclic. MasonryJointLoop is the fast way through the same law and the same "
        "columns.";

    template <class Visit> static void attributes(Visit&&) {}

    std::string get2DFunctorType1() const override { return "MasonryJointGeom"; }
    std::string get2DFunctorType2() const override { return "MasonryJointPhys"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryJointGeom", "MasonryJointPhys"}; }
    std::string checkOrder() const override { return "MasonryJointGeom MasonryJointPhys"; }
    bool go(shared_ptr<yade::IGeom>&, shared_ptr<yade::IPhys>&, yade::Interaction*) override;
    using FunctorCalls::go;
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening,
                                       yade::LawFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening)
