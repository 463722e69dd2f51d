#pragma once
#include "blocks/BlockElasticity.hpp"
#include "blocks/JointPoints.hpp"
#include "scene/GravityWork.hpp"
#include "scene/JointHome.hpp"
#include "scene/Ledger.hpp"
#include "scene/SceneCheck.hpp"
#include <memory>
#include <optional>

namespace masonry {

class MasonryJointGeom;
class MasonryMat;
class SceneStore;

class MasonryZones : public Adapter<MasonryZones, yade::GlobalEngine>, public EnergyLedger, public GravityWork {
public:
    static constexpr const char* className = "MasonryZones";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Deformable units: blocks divided into tetrahedral zones of linear elastic material, with their masses at the "
        "nodes (paper §2, eqs. (1)-(7)). Their joints act at points of the faces of cells, between which displacements "
        "are those of the faces' triangles: three along every face where the unit is held across the joint, else the "
        "corners and the centroid of each triangle. A unit remains one body with the shape of its block; its position "
        "and "
        "orientation follow the centre of mass and the mean rotation. Strains are taken as small in axes that turn "
        "with "
        "the unit. Stands after the loop of the joints; integrators of rigid bodies do not move these bodies. Give "
        "this "
        "engine to Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom.zones before joints are made.";

    std::vector<int> bodies;
    std::vector<int> divisions{1, 1, 1};
    std::vector<int> laidOut; // the divisions and bodies for which the nodes were numbered; set by the engine itself
    double damping = 0.8;
    std::string dampingKind = "combined";
    std::string blocked;
    Vector3r gravity = Vector3r(0, 0, -9.81);
    Vector3r moved = Vector3r::Zero(); // sum of mass times displacement of all nodes after the last step [kg m]

    template <class Visit> static void attributes(Visit&& visit) {
        using Z = MasonryZones;
        visit("bodies", &Z::bodies, described("Ids of the deformable units; their material is MasonryMat"), Given);
        visit("divisions", &Z::divisions,
              number("-", "Cells of a hexahedral unit in the directions nearest to x, y and z, each of twelve zones; "
                          "default 1, 1, 1")
                  .atLeast(1)
                  .atMost(100),
              Given);
        visit("damping", &Z::damping,
              number("-", "Damping constant alpha").atLeast(0).atMost(0.99).source("paper eq. (3): 0.8"));
        visit("dampingKind", &Z::dampingKind,
              described(
                  "'combined': alpha |F| (sgn(dF/dt) - sgn(v)) / 2, which also calms vibration about a steady motion; "
                  "'local': -alpha |F| sgn(v), paper eq. (3), which leaves that vibration and resists the motion"));
        visit("blocked", &Z::blocked,
              described("Directions in which the nodes are held: 'y' for a wall loaded in its plane, in plane stress"));
        visit("gravity", &Z::gravity,
              number("m/s²", "Gravity: that of the integrator, which this engine takes over in every step. Another "
                             "value that is set during a run is refused"));
        visit("kinetic", &Z::kinetic, number("J", "Kinetic energy of the nodes"), ReadOnly);
        visit("elastic", &Z::elastic, number("J", "Elastic energy of the zones"), ReadOnly);
        visit("gravityWork", &Z::fallen, number("J", "Work of gravity since the first step"), ReadOnly);
        visit("dampingWork", &Z::damped, number("J", "Energy taken by damping so far"), ReadOnly);
        visit("displacements", computed(&Z::displacements, &Z::setDisplacements),
              number("m", "Displacements of all nodes since the reference state"), ReadOnly);
        visit("velocities", computed(&Z::velocities, &Z::setVelocities), number("m/s", "Velocities of all nodes"),
              ReadOnly);
        visit("lastForces", computed(&Z::lastForces, &Z::setLastForces),
              number("N", "Forces on all nodes in the last step"), Hidden);
        visit("pendingDamping", &Z::pendingDamped, number("J", "Damping of the last step"), Hidden);
        GravityWork::describe<Z>(visit);
        visit("moved", &Z::moved, number("kg m", "Sum of mass times displacement of all nodes"), Hidden);
        visit("laidOut", &Z::laidOut, described("Divisions and bodies for which the nodes were numbered"), Hidden);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("nodesOf", &MasonryZones::nodesOf, py::args("body"), "Numbers (first, beyond) of a unit's nodes.")
            .def("referencePoint", &MasonryZones::referencePoint, py::args("body", "node"),
                 "Place of a node of a unit in the reference state [m].")
            .def("setVelocity", &MasonryZones::setVelocity, py::args("node", "velocity"),
                 "Set the velocity of a node [m/s] from which the next step starts.")
            .add_property("masses", &MasonryZones::masses, "Masses of all nodes [kg].");
    }

    void postLoad();
    std::vector<std::string> problems() const;
    bool isActivated() override { return standsAlone(*this); }
    void action() override;

    struct Unit {
        int body;
        int firstNode;                                     // number of its first node; the others follow
        int momentPlace;                                   // in the rows of moments
        std::shared_ptr<const BlockElasticity> elasticity; // shared by congruent units
        Vector3r centre;                                   // of the body in the reference state [m]
        Quaternionr orientation;                           // of the body in the reference state
    };
    const std::vector<Unit>& units(); // divides the bodies into zones when first called
    const Unit* unitOf(int body);     // null for a rigid body
    // Whether the nodes are held in direction 0, 1 or 2.
    bool holds(int direction) const { return blocked.find("xyz"[direction]) != std::string::npos; }
    // Place of a node in the reference state, global axes [m].
    Vector3r reference(const Unit&, int node) const;
    // How the point of the unit's surface nearest to `point` moves with the nodes.
    Attachment attach(const Unit&, const Vector3r& point) const;
    // Whether the nodes on a joint polygon and the triangles between them cover it. If they do, sets the numbers of
    // these nodes, and the points where the law of a joint is followed, with their shares of the area:
    // - Where the nodes are held across the joint, as in a wall loaded in its plane: on every face of a cell the two
    // ends
    //   of the diagonal between its triangles, with 1/6 of its area each, and the middles of its two edges along the
    //   joint, with 1/3 each. Along the joint these are the points of gaussLobatto(3).
    // - Elsewhere: the corners of every triangle, with 1/12 of its area each, and its centroid, with 3/4.
    // Displacements are linear on a triangle, so both rules give a joint its true elastic rotational stiffness, and
    // under a uniform stress every node gets a third of each of its triangles, as the zones need it. Points at the
    // nodes alone would make the face of one cell three times too stiff against rotation.
    struct Covered {
        std::vector<int> nodes;
        std::vector<Subcontact> points;
    };
    std::optional<Covered> cover(const Unit&, const std::vector<Vector3r>& polygon, const Vector3r& normal,
                                 const Vector3r& along) const;

    // The rows in which the state of the nodes lives. The three components of a node are one row apart, the first at
    // the node's place: rows()[place + d * lanes]. Dependent points are subcontacts' sides without a node of their own,
    // which move with a rigid body or between nodes. JointPlan adds rows for them, which follow those of the nodes.
    int placeOf(int node) const { return places_[node]; }
    int addDependentRows(); // returns the place of the first lane
    void dropDependentRows();
    double* displacementRows() { return displacements_[0].lane; } // since the reference state [m]
    double* forceRows() { return forces_[0].lane; }               // of joints in the present step [N]
    double* momentRows() { return moments_[0].lane; }             // of joints on the rotation of the units [N m]
    Vector3r displacementOf(int node) const { return at(displacements_, places_[node]); }
    Vector3r velocityOf(int node) const { return at(velocities_, places_[node]); }
    Vector3r displacementAt(const Attachment& a) const {
        Vector3r moved = Vector3r::Zero();
        for (int i = 0; i < 3; ++i)
            if (a.weights[i] != 0) moved += a.weights[i] * displacementOf(a.nodes[i]);
        return moved;
    }

private:
    // All that decides how the nodes are numbered: divisions, then bodies.
    std::vector<int> layout() const {
        std::vector<int> all = divisions;
        all.insert(all.end(), bodies.begin(), bodies.end());
        return all;
    }
    struct Batch { // congruent units, one in each lane of the rows
        const BlockElasticity* elasticity;
        int firstRow;
        std::vector<int> units; // at most as many as there are lanes
    };
    static Vector3r at(const std::vector<Row>& rows, int place) {
        const double* v = rows[0].lane + place;
        return {v[0], v[lanes], v[2 * lanes]};
    }
    static void put(std::vector<Row>& rows, int place, const Vector3r& value) {
        for (int d = 0; d < 3; ++d)
            (rows[0].lane + place)[d * lanes] = value[d];
    }
    // Takes over the gravity of the integrator. Throws std::invalid_argument if a script has set another one
    // here during the run.
    void followGravity(const Vector3r&);
    void mesh();
    void layOut();
    void gatherFromFunctors(const SceneStore&);
    void checkAlive() const;
    std::vector<Vector3r> listed(const std::vector<Row>& rows, const std::vector<Vector3r>& loaded) const;
    std::vector<Vector3r> displacements() { return listed(displacements_, loaded_.displacements); }
    std::vector<Vector3r> velocities() { return listed(velocities_, loaded_.velocities); }
    std::vector<Vector3r> lastForces() { return listed(lastForces_, loaded_.lastForces); }
    void setDisplacements(const std::vector<Vector3r>& values) { take(values, displacements_, loaded_.displacements); }
    void setVelocities(const std::vector<Vector3r>& values) { take(values, velocities_, loaded_.velocities); }
    void setLastForces(const std::vector<Vector3r>& values) { take(values, lastForces_, loaded_.lastForces); }
    // Sets rows, or `loaded` while there are none for these values.
    void take(const std::vector<Vector3r>& values, std::vector<Row>& rows, std::vector<Vector3r>& loaded);
    py::tuple nodesOf(int body);
    Vector3r referencePoint(int body, int node);
    void setVelocity(int node, const Vector3r& velocity);
    py::list masses();

    struct { // state of the nodes while there are no rows for it: after loading, and before the bodies are divided anew
        std::vector<Vector3r> displacements, velocities, lastForces;
    } loaded_;
    std::vector<Unit> units_;
    std::vector<int> unitOfBody_; // by the id of the body; -1 if it is rigid
    std::vector<int> places_;     // of all nodes in the rows
    std::vector<Batch> batches_;
    std::vector<Row> displacements_, velocities_, forces_, lastForces_, moments_;
    boost::weak_ptr<yade::Factorable> divided_; // the scene whose bodies were divided
    boost::weak_ptr<yade::Factorable> scene_;   // the scene in which the units were last moved
    bool acted_ = false;                        // whether the units were ever moved
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryZones, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryZones)
