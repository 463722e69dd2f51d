// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "host/YadeGl.hpp"

namespace masonry {

class Gl1_MasonryJointPhys : public Adapter<Gl1_MasonryJointPhys, yade::GlIPhysFunctor> {
    MASONRY_CLASS(Gl1_MasonryJointPhys, GlIPhysFunctor)
    static constexpr const char* doc =
        "Draws joints in YADE's 3-D view, where Renderer().intrPhys is set: around every subcontact the part of the "
        "joint that is nearest to it, in the colour of a value, where the joint has moved to. All objects of this "
        "class have the same values, and setting one of them changes what the view shows. "
        "masonry.model.window.show() opens "
        "a view with all that is needed.";

    static inline std::string colours = "damage";
    static inline double most = 0;
    static inline double scale = 1;

    template <class Visit> static void attributes(Visit&& visit) {
        using G = Gl1_MasonryJointPhys;
        visit("colours", &G::colours,
              described("What the joints show: 'damage' (the largest of tension, shear and compression), 'opening' or "
                        "'regime'"));
        visit("most", &G::most, number("m", "Opening of the last colour; 0: the largest met so far").atLeast(0));
        visit("scale", &G::scale,
              number("-", "Factor of displacements, as Renderer().dispScale is for blocks").above(0));
    }

    std::vector<std::string> problems() const;
    void postLoad();

    MASONRY_DRAWS(MasonryJointPhys)
    void go(const shared_ptr<yade::IPhys>&, const shared_ptr<yade::Interaction>&, const shared_ptr<yade::Body>&,
            const shared_ptr<yade::Body>&, bool wire) override;
    using FunctorWrapper::go;
};

} // namespace masonry

MASONRY_DECLARE(Gl1_MasonryJointPhys)
