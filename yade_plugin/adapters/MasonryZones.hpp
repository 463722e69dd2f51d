#pragma once
#include "Adapter.hpp"
#include "blocks/BlockElasticity.hpp"
#include "law/JointLaw.hpp"
#include <memory>

namespace masonry {

class MasonryJointGeom;
class MasonryMat;

// Where a subcontact hangs on the surface of a deformable unit.
struct Attachment {
    std::array<int, 3> nodes{0, 0, 0}; // numbers in the arrays of MasonryZones
    std::array<double, 3> weights{1, 0, 0};
};
template <> struct IsNumbers<Attachment> : std::true_type {};
template <class F> void numbers(Attachment& a, F&& each) {
    for (int i = 0; i < 3; ++i) {
        double node = a.nodes[i];
        each(node), each(a.weights[i]);
        a.nodes[i] = int(node);
    }
}

class MasonryZones : public Adapter<MasonryZones, yade::GlobalEngine> {
public:
    static constexpr const char* className = "MasonryZones";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Deformable units: blocks divided into tetrahedral zones of linear elastic material, masses at the nodes, "
        "joints "
        "between nodes (paper §2, eqs. (1)-(7)). A unit stays one body with a Polyhedra shape, whose position and "
        "orientation follow the centre of mass and the mean rotation; strains are small in axes that turn with the "
        "unit. "
        "Stands after the interaction loop; the host's integrator leaves these bodies alone. Give it to "
        "Ig2_Polyhedra_Polyhedra_MasonryJointGeom.zones before joints are made.";

    std::vector<int> bodies, divisions{1, 1, 1}, laidOut; // the last: what the nodes were numbered for
    double damping = 0.8;
    std::string dampingKind = "combined", blocked;
    Vector3r gravity = Vector3r(0, 0, -9.81);
    double kinetic = 0, elastic = 0, gravityWork = 0, dampingWork = 0, pendingDamping = 0;
    std::vector<Vector3r> displacements, velocities, lastForces;

    template <class Visit> static void attributes(Visit&& visit) {
        using Z = MasonryZones;
        visit("bodies", &Z::bodies, "Ids of the deformable units; their material is MasonryMat.", Given);
        visit("divisions", &Z::divisions,
              "Cells of a hexahedral unit in the directions nearest to x, y and z [-], 1 to 100; each is twelve zones. "
              "Default: 1, 1, 1.",
              Given);
        visit("damping", &Z::damping, "Damping constant alpha [-], 0 to 0.99 (paper eq. (3): 0.8).");
        visit("dampingKind", &Z::dampingKind,
              "'combined': alpha |F| (sgn(dF/dt) - sgn(v)) / 2, calms what swings about a steady motion, too; "
              "'local': -alpha |F| sgn(v), paper eq. (3), lets it swing and turns it into a drag.");
        visit("blocked", &Z::blocked,
              "Directions in which the nodes are held, as 'y': a wall in its plane, in plane stress.");
        visit("gravity", &Z::gravity, "Gravity [m/s²].");
        visit("kinetic", &Z::kinetic, "Kinetic energy of the nodes [J].", ReadOnly);
        visit("elastic", &Z::elastic, "Elastic energy of the zones [J].", ReadOnly);
        visit("gravityWork", &Z::gravityWork, "Work of gravity since the reference state [J].", ReadOnly);
        visit("dampingWork", &Z::dampingWork, "Energy taken by damping so far [J].", ReadOnly);
        visit("displacements", &Z::displacements, "Displacements of all nodes since the reference state [m].",
              ReadOnly);
        visit("velocities", &Z::velocities, "Velocities of all nodes [m/s].", ReadOnly);
        visit("lastForces", &Z::lastForces, "", Hidden);
        visit("pendingDamping", &Z::pendingDamping, "", Hidden);
        visit("laidOut", &Z::laidOut, "", Hidden);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("nodesOf", &MasonryZones::nodesOf, py::args("body"), "Numbers (first, beyond) of a unit's nodes.")
            .def("referencePoint", &MasonryZones::referencePoint, py::args("body", "node"),
                 "Place of a node of a unit in the reference state [m].")
            .def("setVelocity", &MasonryZones::setVelocity, py::args("node", "velocity"),
                 "Give a node a velocity [m/s], as a start.")
            .add_property("masses", &MasonryZones::masses, "Masses of all nodes [kg].");
    }

    void postLoad();
    void refresh(); // displacements, velocities and forces from the rows
    void action() override;

    struct Unit {
        int body, firstNode, momentPlace;
        std::shared_ptr<const BlockElasticity> elasticity;
        Vector3r centre; // reference
        Quaternionr orientation;
    };
    const std::vector<Unit>& units(); // meshes the bodies when first asked
    const Unit* unitOf(int body);     // null for a rigid body
    bool holds(int direction) const { return blocked.find("xyz"[direction]) != std::string::npos; }
    Vector3r reference(const Unit&, int node) const;
    Attachment attach(const Unit&, const Vector3r& point) const;
    // Nodes of a unit on a joint polygon with a third of the areas of the surface triangles around them; empty if those
    // triangles do not make up the polygon.
    std::vector<std::pair<int, double>> nodesOn(const Unit&, const std::vector<Vector3r>& polygon,
                                                const Vector3r& normal) const;

    // The rows of numbers behind the nodes, for engines that work on them directly: a node's three numbers stand at
    // its place, one row apart. Guests are places at the end for what moves with something else.
    int placeOf(int node) const { return places_[node]; }
    int addGuest();
    void dropGuests();
    bool looped = false; // a MasonryJointLoop brings the joints' forces
    double* displacementRows() { return displacements_[0].lane; }
    double* forceRows() { return forces_[0].lane; }
    double* momentRows() { return moments_[0].lane; } // of joints on the rotation of the units
    Vector3r displacementAt(const Attachment& a) const {
        Vector3r moved = Vector3r::Zero();
        for (int i = 0; i < 3 && a.weights[i] != 0; ++i)
            moved += a.weights[i] * at(displacements_, places_[a.nodes[i]]);
        return moved;
    }

private:
    std::vector<int> layout() const { // all that the numbers of the nodes hang on
        std::vector<int> all = divisions;
        all.insert(all.end(), bodies.begin(), bodies.end());
        return all;
    }
    struct Batch { // of congruent units side by side
        const BlockElasticity* elasticity;
        int firstRow;
        std::vector<int> units;
    };
    static Vector3r at(const std::vector<Row>& rows, int place) {
        const double* v = rows[0].lane + place;
        return {v[0], v[lanes], v[2 * lanes]};
    }
    static void put(std::vector<Row>& rows, int place, const Vector3r& value) {
        for (int d = 0; d < 3; ++d)
            (rows[0].lane + place)[d * lanes] = value[d];
    }
    void gatherFromFunctors();
    py::tuple nodesOf(int body);
    Vector3r referencePoint(int body, int node);
    void setVelocity(int node, const Vector3r& velocity);
    py::list masses();

    std::vector<Unit> units_;
    std::vector<int> unitOfBody_, places_; // of all nodes
    std::vector<Batch> batches_;
    std::vector<Row> displacements_, velocities_, forces_, lastForces_, moments_;
    int guests_ = 0;
    bool ahead_ = false;                        // whether the rows are ahead of the attributes
    std::vector<shared_ptr<yade::IGeom>> seen_; // of all interactions, to know when joints_ are others
    std::vector<const MasonryJointGeom*> joints_;
};

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryZones)
