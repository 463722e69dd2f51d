// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "host/YadeGl.hpp"

namespace masonry {

class Gl1_MasonryJointPhys : public Adapter<Gl1_MasonryJointPhys, yade::GlIPhysFunctor> {
public:
    static constexpr const char* className = "Gl1_MasonryJointPhys";
    static constexpr const char* baseName = "GlIPhysFunctor";
    static constexpr const char* doc =
        "Draws joints in YADE's 3-D view, where Renderer().intrPhys is set: around every subcontact the part of the "
        "joint that is nearest to it, in the colour of a value, where the joint has moved to. All objects of this "
        "class have the same values, and setting one of them changes what the view shows. "
        "masonry.model.window.show() opens "
        "a view with all that is needed.";

    template <class Visit> static void attributes(Visit&& visit) {
        using G = Gl1_MasonryJointPhys;
        visit("colours", computed(&G::colours, &G::setColours),
              described("What the joints show: 'damage' (the largest of tension, shear and compression), 'opening' or "
                        "'regime'"));
        visit("most", computed(&G::most, &G::setMost),
              number("m", "Opening of the last colour; 0: the largest met so far").atLeast(0));
        visit("scale", computed(&G::scale, &G::setScale),
              number("-", "Factor of displacements, as Renderer().dispScale is for blocks").above(0));
    }

    std::vector<std::string> problems() const;

    std::string get1DFunctorType1() const override { return "MasonryJointPhys"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryJointPhys"}; }
    std::string renders() const override { return "MasonryJointPhys"; }
    void initgl() override {}
    void go(const shared_ptr<yade::IPhys>&, const shared_ptr<yade::Interaction>&, const shared_ptr<yade::Body>&,
            const shared_ptr<yade::Body>&, bool wire) override;
    using FunctorWrapper::go;

private:
    std::string colours();
    void setColours(const std::string&);
    double most();
    void setMost(const double&);
    double scale();
    void setScale(const double&);
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Gl1_MasonryJointPhys, yade::GlIPhysFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Gl1_MasonryJointPhys)
