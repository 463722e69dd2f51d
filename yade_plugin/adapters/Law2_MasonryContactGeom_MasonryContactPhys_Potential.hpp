// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "MasonryContactGeom.hpp"
#include "MasonryContactPhys.hpp"

namespace masonry {

class Law2_MasonryContactGeom_MasonryContactPhys_Potential
    : public Adapter<Law2_MasonryContactGeom_MasonryContactPhys_Potential, yade::LawFunctor>,
      public ContactStepper {
public:
    static constexpr const char* className = "Law2_MasonryContactGeom_MasonryContactPhys_Potential";
    static constexpr const char* baseName = "LawFunctor";
    static constexpr const char* doc = "The force between two blocks from the potential of their overlap, with Coulomb "
                                       "friction and viscous damping in "
                                       "compression, one contact at a time; MasonryContacts is the quick path through "
                                       "the same law. A contact ends when "
                                       "its blocks part. YADE adds up the forces on a body thread by thread, so their "
                                       "last digits depend on the number "
                                       "of threads.";

    template <class Visit> static void attributes(Visit&& visit) {
        using L = Law2_MasonryContactGeom_MasonryContactPhys_Potential;
        visit("lostInFriction", computed<ContactStepper, double>(&L::lostInFriction, &L::setLostInFriction),
              number("J", "Energy that friction took so far"), ReadOnly);
        visit("lostInDamping", computed<ContactStepper, double>(&L::lostInDamping, &L::setLostInDamping),
              number("J", "Energy that damping took so far"), ReadOnly);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("stored", &Law2_MasonryContactGeom_MasonryContactPhys_Potential::storedInScene,
                "Elastic energy of all contacts of the scene in the last step [J].");
    }

    std::string get2DFunctorType1() const override { return "MasonryContactGeom"; }
    std::string get2DFunctorType2() const override { return "MasonryContactPhys"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryContactGeom", "MasonryContactPhys"}; }
    std::string checkOrder() const override { return "MasonryContactGeom MasonryContactPhys"; }
    bool go(shared_ptr<yade::IGeom>&, shared_ptr<yade::IPhys>&, yade::Interaction*) override;
    using FunctorCalls::go;

    const yade::Scene* givenScene() const override { return scene; }

private:
    double storedInScene();
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Law2_MasonryContactGeom_MasonryContactPhys_Potential, yade::LawFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Law2_MasonryContactGeom_MasonryContactPhys_Potential)
