#pragma once
#include "Adapter.hpp"
#include "MasonryZones.hpp"
#include "blocks/FaceContact.hpp"

namespace masonry {

// One subcontact of a joint, all that a step touches in one place. Vectors are in the axes of the joint: normal,
// tangent, normal × tangent.
struct JointPoint {
    Vector3r offset = Vector3r::Zero(); // from the centre of body 1, reference
    double area = 0;
    Vector3r jump = Vector3r::Zero();  // since the reference state
    Jump increment;                    // scratch of a step
    Vector3r arm = Vector3r::Zero();   // scratch: from the centre of body 1 to the middle of the jump
    Vector3r force = Vector3r::Zero(); // scratch: on side 1, global axes; kept for deformable units only
};
template <> struct IsNumbers<JointPoint> : std::true_type {};
template <class F> void numbers(JointPoint& p, F&& each) {
    numbers(p.offset, each), each(p.area), numbers(p.jump, each);
}

class MasonryJointGeom : public Adapter<MasonryJointGeom, yade::IGeom> {
    MASONRY_DISPATCHED(MasonryJointGeom, yade::IGeom)
    static constexpr const char* className = "MasonryJointGeom";
    static constexpr const char* baseName = "IGeom";
    static constexpr const char* doc =
        "Joint between two blocks: the polygon that their faces share in the reference state, divided into "
        "subcontacts, and the displacement jumps across it. Small displacements: the joint lives to the end of the run "
        "and turns with the mean rotation of its two blocks.";

    Vector3r normal = Vector3r::UnitX(), tangent = Vector3r::UnitY(); // reference, global axes; normal from 1 to 2
    std::vector<Vector3r> polygon;                                    // reference, global axes
    std::vector<JointPoint> points;
    shared_ptr<MasonryZones> zones;                     // where a side is deformable
    std::vector<Attachment> attachments1, attachments2; // of the points; empty at a rigid side
    double distance1 = 0, distance2 = 0;
    Vector3r position1 = Vector3r::Zero(), position2 = Vector3r::Zero();
    Quaternionr orientation1 = Quaternionr::Identity(), orientation2 = Quaternionr::Identity();
    Vector3r centreToCentre = Vector3r::Zero();                                     // reference, in the joint's axes
    Quaternionr frame1 = Quaternionr::Identity(), frame2 = Quaternionr::Identity(); // the joint's axes in each body's

    template <class Visit> static void attributes(Visit&& visit) {
        using G = MasonryJointGeom;
        visit("normal", &G::normal, "Unit normal in the reference state, from body 1 to body 2.", ReadOnly);
        visit("tangent", &G::tangent,
              "First in-plane direction in the reference state; the second is normal × tangent.", ReadOnly);
        visit("polygon", &G::polygon, "Corners of the joint polygon in the reference state [m].", ReadOnly);
        visit("distance1", &G::distance1, "Distance of body 1's centre from the joint plane [m].", ReadOnly);
        visit("distance2", &G::distance2, "Distance of body 2's centre from the joint plane [m].", ReadOnly);
        visit("points", &G::points, "", Hidden);
        visit("position1", &G::position1, "", Hidden);
        visit("position2", &G::position2, "", Hidden);
        visit("orientation1", &G::orientation1, "", Hidden);
        visit("orientation2", &G::orientation2, "", Hidden);
        visit("centreToCentre", &G::centreToCentre, "", Hidden);
        visit("zones", &G::zones, "", Hidden);
        visit("body1", &G::body1, "", Hidden);
        visit("body2", &G::body2, "", Hidden);
        visit("attachments1", &G::attachments1, "", Hidden);
        visit("attachments2", &G::attachments2, "", Hidden);
        visit("frame1", &G::frame1, "", Hidden);
        visit("frame2", &G::frame2, "", Hidden);
    }

    yade::Matrix3r axes; // scratch: columns normal and tangents, turned with the mean rotation of the two blocks
    Vector3r between;    // scratch: from the centre of body 1 to that of body 2
    // Of a joint with a deformable side: its bodies, and as scratch the moment on the rotation of each.
    int body1 = -1, body2 = -1;
    Vector3r moment = Vector3r::Zero();

    Keeper* keeper = nullptr; // the engine that has the jumps in its arrays, if one has

    MasonryJointGeom() {
        createIndex();
        ++changes;
    }
    void refresh() {
        if (keeper) keeper->store();
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.add_property("centres", &MasonryJointGeom::centres,
                         "Centres of the subcontacts in the reference state [m].")
            .add_property("areas", &MasonryJointGeom::areas,
                          "Areas of the subcontacts [m²]; they add up to the polygon's.")
            .add_property("jumps", &MasonryJointGeom::jumps,
                          "Displacement jump at each subcontact since the reference state: opening, slide along the "
                          "tangent, slide across it [m].");
    }

    // Joint in the reference state, from the polygon that two blocks share.
    void define(const FaceContact&, const Vector3r& along, int rows, int columns, const yade::State&,
                const yade::State&);
    // Points at the nodes of deformable sides where they match, else the grid's points hung on their surfaces.
    void attach(const shared_ptr<MasonryZones>&, int body1, int body2);
    // Jumps, their increments and the arms of the current step.
    void update(const yade::State& state1, const yade::State& state2);
    // Reference axes of the joint as columns, and the centre of a subcontact, in global axes.
    yade::Matrix3r referenceAxes() const {
        yade::Matrix3r columns;
        columns << normal, tangent, normal.cross(tangent);
        return columns;
    }
    Vector3r centre(const JointPoint& point) const { return position1 + referenceAxes() * point.offset; }
    // A polygon around every subcontact in the reference state, for pictures.
    std::vector<Polygon> cells() const;

private:
    void updateDeformable(const yade::State& state1, const yade::State& state2);
    template <class F> py::list perPoint(F&& value) const {
        py::list all;
        for (const auto& point : points)
            all.append(value(point));
        return all;
    }
    py::list centres() const {
        return perPoint([&](const JointPoint& p) { return centre(p); });
    }
    py::list areas() const {
        return perPoint([](const JointPoint& p) { return p.area; });
    }
    py::list jumps() {
        refresh();
        return perPoint([](const JointPoint& p) { return p.jump; });
    }
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
    shared_ptr<MasonryZones> zones;

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
        visit("zones", &F::zones, "MasonryZones of the deformable units; None: all units are rigid.");
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

// The block that a body's Polyhedra stands for at a place, in global axes.
ConvexBlock blockOf(yade::Polyhedra&, const Vector3r& position, const Quaternionr& orientation);

// Of the blocks of the scene: pairs (id1, id2) that share a face, the lower id first; pairs (id1, id2, gap, bound)
// that nearly do, or overlap (gap below 0), and the gap that would be accepted [m]; the thinnest (id, thickness) and
// the largest (id, diagonal) [m].
py::tuple neighbours(double tolerance);
py::list touchingPairs(double tolerance); // the first of these

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryJointGeom)
BOOST_CLASS_EXPORT_KEY(masonry::Ig2_Polyhedra_Polyhedra_MasonryJointGeom)
