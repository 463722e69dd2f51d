#pragma once
#include "Adapter.hpp"
#include "blocks/FaceContact.hpp"

namespace masonry {

class MasonryJointGeom : public Adapter<MasonryJointGeom, yade::IGeom> {
    MASONRY_DISPATCHED(MasonryJointGeom, yade::IGeom)
    static constexpr const char* className = "MasonryJointGeom";
    static constexpr const char* baseName = "IGeom";
    static constexpr const char* doc =
        "Joint between two blocks: the polygon that their faces share in the reference state, divided into "
        "subcontacts, and the displacement jumps across it. Small displacements: the joint lives to the end of the run "
        "and turns with the mean rotation of its two blocks.";

    Vector3r normal = Vector3r::UnitX(), tangent = Vector3r::UnitY(); // reference, global axes; normal from 1 to 2
    std::vector<Vector3r> polygon, centres;                           // reference, global axes
    std::vector<double> areas;
    int along = 1, across = 1;
    double distance1 = 0, distance2 = 0;
    Vector3r position1 = Vector3r::Zero(), position2 = Vector3r::Zero();
    Quaternionr orientation1 = Quaternionr::Identity(), orientation2 = Quaternionr::Identity();
    std::vector<Vector3r> jumps; // (opening, slide along tangent, slide across)

    template <class Visit> static void attributes(Visit&& visit) {
        using G = MasonryJointGeom;
        visit("normal", &G::normal, "Unit normal in the reference state, from body 1 to body 2.", ReadOnly);
        visit("tangent", &G::tangent,
              "First in-plane direction in the reference state; the second is normal × tangent.", ReadOnly);
        visit("polygon", &G::polygon, "Corners of the joint polygon in the reference state [m].", ReadOnly);
        visit("centres", &G::centres, "Centres of the subcontacts in the reference state [m].", ReadOnly);
        visit("areas", &G::areas, "Areas of the subcontacts [m²]; they add up to the polygon's.", ReadOnly);
        visit("along", &G::along, "Divisions of the polygon along the tangent [-].", ReadOnly);
        visit("across", &G::across, "Divisions across the tangent [-].", ReadOnly);
        visit("distance1", &G::distance1, "Distance of body 1's centre from the joint plane [m].", ReadOnly);
        visit("distance2", &G::distance2, "Distance of body 2's centre from the joint plane [m].", ReadOnly);
        visit("jumps", &G::jumps,
              "Displacement jump at each subcontact since the reference state: opening, slide along the tangent, slide "
              "across it [m].",
              ReadOnly);
        visit("position1", &G::position1, "", Hidden);
        visit("position2", &G::position2, "", Hidden);
        visit("orientation1", &G::orientation1, "", Hidden);
        visit("orientation2", &G::orientation2, "", Hidden);
    }

    struct Scratch { // of one step, per subcontact
        Jump increment;
        Vector3r arm; // from the centre of body 1 to the middle of the jump
    };
    std::vector<Scratch> scratch;
    yade::Matrix3r axes; // columns: normal and tangents, turned with the mean rotation of the two blocks
    Vector3r between;    // from the centre of body 1 to that of body 2

    MasonryJointGeom() { createIndex(); }

    // Joint in the reference state, from the polygon that two blocks share.
    void define(const FaceContact&, const Vector3r& along, int rows, int columns, const yade::State&,
                const yade::State&);
    // Jumps, their increments and the arms of the current step.
    void update(const yade::State& state1, const yade::State& state2);
    // The subcontact cells as polygons in the reference state, for pictures.
    std::vector<Subcontact> cells() const;
};

class Ig2_Polyhedra_Polyhedra_MasonryJointGeom
    : public Adapter<Ig2_Polyhedra_Polyhedra_MasonryJointGeom, yade::IGeomFunctor> {
public:
    static constexpr const char* className = "Ig2_Polyhedra_Polyhedra_MasonryJointGeom";
    static constexpr const char* baseName = "IGeomFunctor";
    static constexpr const char* doc =
        "Creates a MasonryJointGeom from the faces that two convex Polyhedra share in the reference state, and updates "
        "its jumps. A pair without a shared face gets no joint; asked for one (utils.createInteraction), it is an "
        "error.";

    int subcontacts = 4;
    int rows = 1;
    Vector3r rowDirection = Vector3r::Zero();
    double tolerance = 1e-4;

    template <class Visit> static void attributes(Visit&& visit) {
        using F = Ig2_Polyhedra_Polyhedra_MasonryJointGeom;
        visit("subcontacts", &F::subcontacts, "Subcontacts along a joint [-], 1 to 1000.");
        visit("rows", &F::rows,
              "Rows of subcontacts across a joint [-], 1 to 1000; 1 is enough for walls loaded in their plane.");
        visit("rowDirection", &F::rowDirection,
              "Direction across which rows are counted (the thickness of a wall); zero: across the longest edge of the "
              "joint.");
        visit("tolerance", &F::tolerance,
              "Largest gap or overlap of coincident faces, relative to the size of the smaller block [-], above 0, at "
              "most 0.01.");
    }

    std::string get2DFunctorType1() const override { return "Polyhedra"; }
    std::string get2DFunctorType2() const override { return "Polyhedra"; }
    std::vector<std::string> getFunctorTypes() const override { return {"Polyhedra", "Polyhedra"}; }
    std::string checkOrder() const override { return "Polyhedra Polyhedra"; }
    bool go(const shared_ptr<yade::Shape>&, const shared_ptr<yade::Shape>&, const yade::State&, const yade::State&,
            const Vector3r& shift, const bool& force, const shared_ptr<yade::Interaction>&) override;
    using FunctorCalls::go;

    void postLoad();
};

// The block that a body's Polyhedra stands for, in global axes.
ConvexBlock blockOf(yade::Polyhedra&, const yade::State&);

// Pairs of bodies whose Polyhedra share a face, each with the lower id first.
py::list touchingPairs(double tolerance);

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryJointGeom)
BOOST_CLASS_EXPORT_KEY(masonry::Ig2_Polyhedra_Polyhedra_MasonryJointGeom)
