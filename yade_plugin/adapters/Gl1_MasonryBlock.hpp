// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "host/YadeGl.hpp"

namespace masonry {

class Gl1_MasonryBlock : public Adapter<Gl1_MasonryBlock, yade::GlShapeFunctor> {
public:
    static constexpr const char* className = "Gl1_MasonryBlock";
    static constexpr const char* baseName = "GlShapeFunctor";
    static constexpr const char* doc =
        "Draws blocks in YADE's 3-D view: faces in the colour of a value, and edges. YADE makes the functor that draws "
        "when the first view opens, so the plugin must be imported before; all objects of this class have the same "
        "values, and setting one of them changes what the view shows. A deformable unit is drawn undeformed. "
        "masonry.model.window.show() opens a view with all that is needed.";

    template <class Visit> static void attributes(Visit&& visit) {
        using G = Gl1_MasonryBlock;
        visit("colours", computed(&G::colours, &G::setColours),
              described("What the faces show: 'displacement', 'velocity', 'material', or 'own' for the colour of "
                        "each shape"));
        visit("most", computed(&G::most, &G::setMost),
              number("m or m/s", "Displacement or velocity of the last colour; 0: the largest met so far").atLeast(0));
        visit("edges", computed(&G::edges, &G::setEdges), described("Whether the edges of blocks are drawn"));
    }

    std::vector<std::string> problems() const;

    std::string get1DFunctorType1() const override { return "MasonryBlock"; }
    std::vector<std::string> getFunctorTypes() const override { return {"MasonryBlock"}; }
    std::string renders() const override { return "MasonryBlock"; }
    void initgl() override {}
    void go(const shared_ptr<yade::Shape>&, const shared_ptr<yade::State>&, bool wire,
            const yade::GLViewInfo&) override;
    using FunctorWrapper::go;

private:
    std::string colours();
    void setColours(const std::string&);
    double most();
    void setMost(const double&);
    bool edges();
    void setEdges(const bool&);
};

} // namespace masonry

extern template class masonry::Adapter<masonry::Gl1_MasonryBlock, yade::GlShapeFunctor>;
BOOST_CLASS_EXPORT_KEY(masonry::Gl1_MasonryBlock)
