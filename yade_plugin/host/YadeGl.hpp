// SPDX-License-Identifier: GPL-2.0-or-later
// YADE's classes that draw in its 3-D view, declared as those in Yade.hpp are.
#pragma once
#include "Yade.hpp"

namespace yade {

// What the view tells about itself. Nothing of it is used here, so its members are not declared.
struct GLViewInfo;

template <class Kind, class R, class Arguments> class Functor1D : public Functor, public FunctorWrapper<R, Arguments> {
public:
    std::vector<std::string> getFunctorTypes() const override;
    virtual std::string get1DFunctorType1() const;
};

// Draws shapes of one class. The view has moved the axes to those of the body when it calls `go`.
class GlShapeFunctor
    : public Functor1D<
          Shape, void,
          boost::mpl::vector<const shared_ptr<Shape>&, const shared_ptr<State>&, bool, const GLViewInfo&>> {
    MASONRY_HOST_CLASS(GlShapeFunctor)
    virtual std::string renders() const;
    virtual void initgl();
    GlShapeFunctor() = default;
};

// Draws the physics of interactions of one class, in global axes.
class GlIPhysFunctor : public Functor1D<IPhys, void,
                                        boost::mpl::vector<const shared_ptr<IPhys>&, const shared_ptr<Interaction>&,
                                                           const shared_ptr<Body>&, const shared_ptr<Body>&, bool>> {
    MASONRY_HOST_CLASS(GlIPhysFunctor)
    virtual std::string renders() const;
    virtual void initgl();
    GlIPhysFunctor() = default;
};

// Draws something else in every picture, after all bodies and interactions.
class GlExtraDrawer : public Serializable {
    MASONRY_HOST_CLASS(GlExtraDrawer)
    virtual void render();
    Scene* scene = nullptr;
    bool dead = false;
    GlExtraDrawer() = default;
};

// Makes a functor for every class that it finds, before its first picture: with the graphical interface before a script
// can register its classes. Whoever registers some later sets `initDone` to false, and the next picture begins anew. A
// shape without a functor made then ends YADE with a failed assertion.
class OpenGLRenderer {
public:
    static bool initDone;
};

} // namespace yade
