#pragma once
#include "MasonryZones.hpp"

namespace masonry {

class MasonryJointGeom : public Adapter<MasonryJointGeom, yade::IGeom> {
    MASONRY_DISPATCHED(MasonryJointGeom, yade::IGeom)
    static constexpr const char* className = "MasonryJointGeom";
    static constexpr const char* baseName = "IGeom";
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
        visit("record", computed(&G::record, &G::setRecord), described("All numbers of the joint"), Hidden);
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

    // Makes the joint in its reference state, with `columns` of subcontacts along the direction `along` by `rows`
    // across it on the shared polygon (see subdivide()).
    void define(const FaceContact&, const Vector3r& along, int columns, int rows, int body1, int body2,
                const yade::State&, const yade::State&);
    // For a joint with a deformable side, whose subcontacts move with the surface between nodes. If the nodes of a
    // deformable side cover the polygon and, where both sides are deformable, match, the subcontacts are the points of
    // the cells' faces (see MasonryZones::cover); else they remain those of define().
    void attach(const shared_ptr<MasonryZones>&);

    // Whether the joint was made by define() or loaded from a file.
    bool made() const { return home != nullptr; }
    const JointReference& reference() const { return home->joints[index]; }
    int points() const { return home ? home->points : 0; }
    double area(int point) const { return home->areaAt(point, index); }
    Vector3r jump(int point) const { return home->jumpAt(point, index); }
    Vector3r offset(int point) const { return home->offsetAt(point, index); }
    // Point of a subcontact in the reference state, global axes [m].
    Vector3r centre(int point) const { return reference().sides[0].position + reference().axes() * offset(point); }
    // A polygon around every subcontact in the reference state, for pictures: the part of the joint that is nearest to
    // its point. Its area is not that of the subcontact.
    std::vector<Polygon> cells() const;

    shared_ptr<JointShapes> home; // null until define() or loading; SceneStore replaces it
    int index = 0;                // number of the joint in its home

    // Scratch of one step of this joint alone, for the functors. follow() fills it from the places of the blocks; the
    // law's functor reads it, and adds moment and forces for MasonryZones.
    struct Step {
        yade::Matrix3r axes;                 // columns normal and tangents, turned with the mean of both blocks
        Vector3r between = Vector3r::Zero(); // from the centre of body 1 to that of body 2, global axes [m]
        Vector3r moment = Vector3r::Zero();  // on the rotation of each deformable block, global axes [N m]
        std::vector<Vector3r> increments;    // change of the jumps in this step, in the joint's axes [m]
        std::vector<Vector3r> arms;          // of the forces, from the centre of a rigid body, in the joint's axes [m]:
                                             // of body 1, or of body 2 if body 1 is deformable
        std::vector<Vector3r> forces;        // on side 1 of a joint with a deformable side, global axes [N]
    };
    std::unique_ptr<Step> step; // null before the first step with functors
    void follow(const yade::State& state1, const yade::State& state2);

private:
    const JointShapes& shapes() const; // throws std::runtime_error if the joint no longer exists or was never made
    Vector3r normal();
    Vector3r tangent();
    std::vector<Vector3r> polygon();
    double distance1();
    double distance2();
    shared_ptr<MasonryZones> zones();
    void setZones(const shared_ptr<MasonryZones>&);
    std::vector<double> record();
    void setRecord(const std::vector<double>&);
    py::list centres();
    py::list areas();
    py::list jumps();
    void followDeformable(const yade::State& state1, const yade::State& state2);
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryJointGeom, yade::IGeom>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryJointGeom)
