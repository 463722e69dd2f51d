// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "host/YadeGl.hpp"

namespace masonry {

class Gl1_MasonryBlock : public Adapter<Gl1_MasonryBlock, yade::GlShapeFunctor> {
    MASONRY_CLASS(Gl1_MasonryBlock, GlShapeFunctor)
    static constexpr const char* doc =
        "Draws blocks in YADE's 3-D view: faces in the colour of a value, and edges. YADE makes the functor that draws "
        "when the first view opens, so the plugin must be imported before; all objects of this class have the same "
        "values, and setting one of them changes what the view shows. A deformable unit is drawn undeformed. "
        "masonry.model.window.show() opens a view with all that is needed.";

    static inline std::string colours = "displacement";
    static inline double most = 0;
    static inline bool edges = true;

    template <class Visit> static void attributes(Visit&& visit) {
        using G = Gl1_MasonryBlock;
        visit("colours", &G::colours,
              described("What the faces show: 'displacement', 'velocity', 'material', or 'own' for the colour of "
                        "each shape"));
        visit("most", &G::most,
              number("m or m/s", "Displacement or velocity of the last colour; 0: the largest met so far").atLeast(0));
        visit("edges", &G::edges, described("Whether the edges of blocks are drawn"));
    }

    std::vector<std::string> problems() const;
    void postLoad();

    MASONRY_DRAWS(MasonryBlock)
    void go(const shared_ptr<yade::Shape>&, const shared_ptr<yade::State>&, bool wire,
            const yade::GLViewInfo&) override;
    using FunctorWrapper::go;
};

} // namespace masonry

MASONRY_DECLARE(Gl1_MasonryBlock)
