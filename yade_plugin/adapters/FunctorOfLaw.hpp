// SPDX-License-Identifier: GPL-2.0-or-later
// What the functors of the joint laws have in common: in YADE's InteractionLoop each takes one joint after the other.
//
// The functor of a law is one source file with a class
//     class Law2_MasonryJointGeom_MasonryJointPhys_MyLaw
//         : public FunctorOfLaw<Law2_MasonryJointGeom_MasonryJointPhys_MyLaw> {
//     public:
//         static constexpr const char* className = "Law2_MasonryJointGeom_MasonryJointPhys_MyLaw";
//         static constexpr const char* law = "...";    the name of the law in MasonryJoint.law
//         static constexpr const char* doc = "...";
//     };
// and, after the namespace, the line MASONRY_FUNCTOR_OF_LAW(Law2_MasonryJointGeom_MasonryJointPhys_MyLaw). The module
// registers all of them, and Python finds the functor of a law by MasonryJoint.laws().
#pragma once
#include "MasonryJointGeom.hpp"
#include "MasonryJointPhys.hpp"
#include "engine/joints/JointFunctor.hpp"

namespace masonry {

template <class Derived> class FunctorOfLaw : public Adapter<Derived, yade::LawFunctor> {
public:
    static constexpr const char* baseName = "LawFunctor";

    template <class Visit> static void attributes(Visit&&) {}

    MASONRY_FOR_PAIRS(MasonryJointGeom, MasonryJointPhys)
    bool go(shared_ptr<yade::IGeom>& geom, shared_ptr<yade::IPhys>& phys, yade::Interaction* interaction) override {
        advanceJoint(*this->scene, static_cast<MasonryJointGeom&>(*geom), static_cast<MasonryJointPhys&>(*phys),
                     *interaction, Derived::law);
        return true;
    }
    using yade::LawFunctor::FunctorWrapper::go;
};

// What brings the functors of laws into YADE: each has entered itself here when the module is loaded.
using Enrolment = void (*)(std::vector<std::string>& names);
std::vector<Enrolment>& enrolmentsOfFunctors();

template <class Functor> struct EnrolledFunctor {
    EnrolledFunctor() {
        functorsOfLaws()[Functor::law] = Functor::className;
        enrolmentsOfFunctors().push_back(&enroll<Functor>);
    }
};

} // namespace masonry

#define MASONRY_FUNCTOR_OF_LAW(Class)                                                                                  \
    BOOST_CLASS_EXPORT_KEY(masonry::Class)                                                                             \
    BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Class)                                                                       \
    template class masonry::Adapter<masonry::Class, yade::LawFunctor>;                                                 \
    static const masonry::EnrolledFunctor<masonry::Class> enrolled_##Class;
