// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "MasonryContactPhys.hpp"

namespace masonry {

class Ip2_MasonryMat_MasonryMat_MasonryContactPhys
    : public Adapter<Ip2_MasonryMat_MasonryMat_MasonryContactPhys, yade::IPhysFunctor>,
      public ContactParameters {
public:
    static constexpr const char* className = "Ip2_MasonryMat_MasonryMat_MasonryContactPhys";
    static constexpr const char* baseName = "IPhysFunctor";
    static constexpr const char* doc = "Gives contacts of blocks their law, which is that of MasonryContacts: the same "
                                       "for all pairs. normalStiffness and "
                                       "friction must be given. A change acts on contacts that begin later.";

    template <class Visit> static void attributes(Visit&& visit) { describe(visit); }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("timeStep", &Ip2_MasonryMat_MasonryMat_MasonryContactPhys::timeStep,
                "The stable time step [s] of the blocks of the scene with these contacts, and with the damping of its "
                "integrator.");
    }

    // A dispatcher calls this when the functor comes into it. What must be given is refused there, because the loop is
    // parallel, where an exception would end the program.
    std::string get2DFunctorType1() const override {
        if (const auto problem = missing(className); !problem.empty()) throw std::invalid_argument(problem);
        used_ = true;
        return "MasonryMat";
    }
    std::string get2DFunctorType2() const override { return "MasonryMat"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryMat", "MasonryMat"}; }
    std::string checkOrder() const override { return "MasonryMat MasonryMat"; }
    void go(const shared_ptr<yade::Material>&, const shared_ptr<yade::Material>&,
            const shared_ptr<yade::Interaction>&) override;
    using FunctorCalls::go;

    std::vector<std::string> problems() const {
        const auto problem = used_ ? missing(className) : std::string();
        return problem.empty() ? std::vector<std::string>() : std::vector<std::string>{problem};
    }

private:
    double timeStep();

    mutable bool used_ = false; // whether it has come into a dispatcher
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Ip2_MasonryMat_MasonryMat_MasonryContactPhys, yade::IPhysFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Ip2_MasonryMat_MasonryMat_MasonryContactPhys)
