// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "MasonryZones.hpp"
#include "engine/joints/JointView.hpp"

namespace masonry {

class MasonryJointGeom : public Adapter<MasonryJointGeom, yade::IGeom>, public JointGeometry {
    MASONRY_DISPATCHED(MasonryJointGeom, IGeom)
    static constexpr const char* doc =
        "Joint between two blocks: the polygon that their faces share in the reference state, divided into "
        "subcontacts, and the displacement jumps across it. Displacements are taken as small: a joint stays to the end "
        "of the run, no new ones are found, and it turns with the mean rotation of its two blocks.";

    template <class Visit> static void attributes(Visit&& visit) {
        using G = MasonryJointGeom;
        visit("normal", computed(&G::normal), described("Unit normal in the reference state, from body 1 to body 2"),
              Shown);
        visit("tangent", computed(&G::tangent),
              described("First direction in the joint's plane in the reference state; the second is normal × tangent"),
              Shown);
        visit("polygon", computed(&G::polygon), number("m", "Corners of the joint polygon in the reference state"),
              Shown);
        visit("distance1", computed(&G::distance1), number("m", "Distance of body 1's centre from the joint's plane"),
              Shown);
        visit("distance2", computed(&G::distance2), number("m", "Distance of body 2's centre from the joint's plane"),
              Shown);
        visit("zones", computed(&G::zones, &G::setZones), described("MasonryZones of the deformable sides"), Hidden);
        visit("record", &G::visitRecord, described("All numbers of the joint"));
    }

    MasonryJointGeom() {
        createIndex();
        ++changes;
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.add_property("centres", &MasonryJointGeom::centres,
                         "Points of the subcontacts in the reference state [m]; those at the rim of a joint lie on its "
                         "edges.")
            .add_property("areas", &MasonryJointGeom::areas,
                          "Areas of the subcontacts [m²], the weights of their points in sums; they add up to the "
                          "polygon's.")
            .add_property("jumps", &MasonryJointGeom::jumps,
                          "Displacement jump at each subcontact since the reference state: opening, slide along the "
                          "tangent, slide across it [m].");
    }

private:
    const JointShapes& shapes() const; // throws std::runtime_error if the joint no longer exists or was never made
    Vector3r normal();
    Vector3r tangent();
    std::vector<Vector3r> polygon();
    double distance1();
    double distance2();
    shared_ptr<MasonryZones> zones();
    void setZones(const shared_ptr<MasonryZones>&);
    void visitRecord(StateNumbers&);
    py::list centres();
    py::list areas();
    py::list jumps();
};

} // namespace masonry

MASONRY_DECLARE(MasonryJointGeom)
