// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "MasonryJointPhys.hpp"
#include "MasonryMat.hpp"

namespace masonry {

class Ip2_MasonryMat_MasonryMat_MasonryJointPhys
    : public Adapter<Ip2_MasonryMat_MasonryMat_MasonryJointPhys, yade::IPhysFunctor> {
    MASONRY_CLASS(Ip2_MasonryMat_MasonryMat_MasonryJointPhys, IPhysFunctor)
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

    MASONRY_FOR_PAIRS(MasonryMat, MasonryMat)
    void go(const shared_ptr<yade::Material>&, const shared_ptr<yade::Material>&,
            const shared_ptr<yade::Interaction>&) override;
    using FunctorWrapper::go;
    void assignTo(const shared_ptr<yade::Interaction>&, const shared_ptr<MasonryJoint>&) const;

private:
    void assign(const MasonryMat&, const MasonryMat&, yade::Interaction&, const shared_ptr<MasonryJoint>&) const;
};

} // namespace masonry

MASONRY_DECLARE(Ip2_MasonryMat_MasonryMat_MasonryJointPhys)
