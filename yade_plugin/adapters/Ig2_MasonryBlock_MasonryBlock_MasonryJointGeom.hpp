// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "MasonryJointGeom.hpp"
#include "engine/bodies/Fixed.hpp"

namespace masonry {

class Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom
    : public Adapter<Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom, yade::IGeomFunctor> {
    MASONRY_CLASS(Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom, IGeomFunctor)
    static constexpr const char* doc =
        "Creates a MasonryJointGeom from the faces that two blocks share in the reference state, and updates "
        "its jumps. A pair without a shared face gets no joint; utils.createInteraction() for such a pair raises an "
        "error.";

    int subcontacts = 3;
    int rows = 0;
    Vector3r rowDirection = Vector3r::Zero();
    double tolerance = 1e-4;
    shared_ptr<MasonryZones> zones;

    template <class Visit> static void attributes(Visit&& visit) {
        using F = Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom;
        visit("subcontacts", &F::subcontacts,
              number("-", "Subcontacts along a joint, at right angles to its rows (see rowDirection), at the points of "
                          "Gauss and Lobatto. With three or more, rocking "
                          "about an edge and the elastic rotational stiffness are exact; with two, that stiffness is "
                          "three times too large; with one, there is none. The cost of a step grows with their number")
                  .atLeast(1)
                  .atMost(1000));
        visit("rows", &F::rows,
              number("-",
                     "Rows of subcontacts across a joint, at the points of Gauss and Lobatto; 0: one if both blocks "
                     "are held so that they can only turn about one axis that lies in the joint, as in a wall "
                     "loaded in its plane, else three. A joint with one row does not resist a rotation of its "
                     "blocks out of the plane, and it takes the cost of a third of three rows. More than three follow "
                     "a crack across the joint more finely. A joint with two rows or more that has not four corners "
                     "has the points of triangles about its middle, which half of the larger of subcontacts and rows "
                     "divides; one that the nodes of deformable units cover has the points of their cells")
                  .atLeast(0)
                  .atMost(1000));
        visit("rowDirection", &F::rowDirection,
              described("Direction in which rows follow each other (the thickness of a wall); zero: the axis about "
                        "which the blocks can turn, if rows is 0 and there is one, else across the longest edge of the "
                        "joint"));
        visit("tolerance", &F::tolerance,
              number("-", "Largest gap or overlap of coincident faces, relative to the size of the smaller block")
                  .above(0)
                  .atMost(0.01));
        visit("zones", &F::zones, described("MasonryZones of the deformable units; None: all units are rigid"));
    }

    std::vector<std::string> problems() const {
        return fixed_.problems({"subcontacts", "rows"}, {double(subcontacts), double(rows)});
    }

    MASONRY_FOR_PAIRS(MasonryBlock, MasonryBlock)
    void preStep() override;
    bool go(const shared_ptr<yade::Shape>&, const shared_ptr<yade::Shape>&, const yade::State&, const yade::State&,
            const Vector3r& shift, const bool& force, const shared_ptr<yade::Interaction>&) override;
    using FunctorWrapper::go;

private:
    struct Grid {
        Vector3r along; // direction of `subcontacts`, a unit vector in the joint's plane
        int rows;
    };
    Fixed fixed_;
    Grid gridOf(const FaceContact&, const yade::Interaction&, const yade::State&, const yade::State&) const;
};

} // namespace masonry

MASONRY_DECLARE(Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom)
