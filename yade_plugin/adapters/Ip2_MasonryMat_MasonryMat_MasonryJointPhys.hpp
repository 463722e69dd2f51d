// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "MasonryJointPhys.hpp"
#include "MasonryMat.hpp"

namespace masonry {

class Ip2_MasonryMat_MasonryMat_MasonryJointPhys
    : public Adapter<Ip2_MasonryMat_MasonryMat_MasonryJointPhys, yade::IPhysFunctor> {
public:
    static constexpr const char* className = "Ip2_MasonryMat_MasonryMat_MasonryJointPhys";
    static constexpr const char* baseName = "IPhysFunctor";
    static constexpr const char* doc =
        "Gives every joint its property set: the first of `joints` whose jointSet and direction fit. For any other "
        "rule call assign(interaction, joint).";

    std::vector<shared_ptr<MasonryJoint>> joints;

    template <class Visit> static void attributes(Visit&& visit) {
        visit("joints", &Ip2_MasonryMat_MasonryMat_MasonryJointPhys::joints,
              described("MasonryJoint objects; the first that fits a pair is taken"));
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("assign", &Ip2_MasonryMat_MasonryMat_MasonryJointPhys::assignTo, py::args("interaction", "joint"),
                "Give an interaction this MasonryJoint, before the first step, whatever `joints` says.");
    }

    std::string get2DFunctorType1() const override { return "MasonryMat"; }
    std::string get2DFunctorType2() const override { return "MasonryMat"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryMat", "MasonryMat"}; }
    std::string checkOrder() const override { return "MasonryMat MasonryMat"; }
    void go(const shared_ptr<yade::Material>&, const shared_ptr<yade::Material>&,
            const shared_ptr<yade::Interaction>&) override;
    using FunctorWrapper::go;
    void assignTo(const shared_ptr<yade::Interaction>&, const shared_ptr<MasonryJoint>&) const;

private:
    void assign(const MasonryMat&, const MasonryMat&, yade::Interaction&, const shared_ptr<MasonryJoint>&) const;
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Ip2_MasonryMat_MasonryMat_MasonryJointPhys, yade::IPhysFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Ip2_MasonryMat_MasonryMat_MasonryJointPhys)
