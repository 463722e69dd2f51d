// SPDX-License-Identifier: GPL-2.0-or-later
// Deformable units: their nodes, how joints hang on them, and a step of their motion. The state of the nodes lives
// here, in rows. An engine derives from it.
#pragma once
#include "Attachment.hpp"
#include "blocks/BlockElasticity.hpp"
#include "blocks/JointPoints.hpp"
#include "common/Pack.hpp"
#include "engine/bodies/BodyColumns.hpp"
#include "engine/bodies/GravityWork.hpp"
#include "motion/EnergyLedger.hpp"
#include <Eigen/Core>
#include <memory>
#include <optional>

namespace masonry {

class Zones : public EnergyLedger, public GravityWork {
public:
    std::vector<int> bodies; // ids of the deformable units
    std::vector<int> divisions{1, 1, 1};
    double massScaling = 0;               // of the masses in all but rigid motions of a block, see moveScaled() [-]
    double scaledBy = 0;                  // massScaling in the last step [-]
    std::vector<int> splitBricks;         // first bodies of bricks in two units that have split, in the order of that
    std::vector<int> laidOut;             // what decided how the nodes were numbered; set by mesh()
    double damping = 0.8;                 // damping constant alpha [-]
    std::string dampingKind = "combined"; // or "local"
    std::string blocked;                  // directions in which the nodes are held: some of x, y and z
    Vector3r gravity = Vector3r(0, 0, -9.81); // [m/s²]
    Vector3r moved = Vector3r::Zero();        // sum of mass times displacement of all nodes after the last step [kg m]

    // What is wrong with these values, one sentence for each problem; empty if nothing is.
    std::vector<std::string> problems() const;
    // To be called when one of these values has changed: the next call of units() divides the bodies anew, and the
    // state of the nodes is kept.
    void divideAnew();

    // Makes a step of all units. Forces and moments of the joints are in the rows. `ofIntegrator` is the gravity of the
    // integrator [m/s²], which the units follow; `massDamping` [1/s] is its mass-proportional damping.
    void advance(yade::Scene&, BodyColumns&, const Vector3r& ofIntegrator, double massDamping);

    struct Unit {
        int body;
        int firstNode;                                     // number of its first node; the others follow
        int momentPlace;                                   // in the rows of moments
        std::shared_ptr<const BlockElasticity> elasticity; // shared by congruent units
        Vector3r centre;                                   // of the body in the reference state [m]
        Quaternionr orientation;                           // of the body in the reference state
    };
    // Bricks in two units that move as one, as far as masses are scaled, until their crack surface yields.
    struct Brick {
        int body1, body2;
        bool split;
    };
    // Takes over the bricks in two units, all of them with split = false. To be called when joints have changed.
    void takeBricks(std::vector<Brick>);
    // Whether this body is the first of a brick that moves as one.
    bool isWholeBrick(int body) const {
        return body < int(brickOfBody_.size()) && brickOfBody_[body] >= 0 && !bricks_[brickOfBody_[body]].split;
    }
    // Splits the bricks that newlyCracked() has found, and books the kinetic energy that a change of the scaled masses
    // makes or takes. To be called in every step before advance(), when the joints have been advanced.
    void followMasses(const std::vector<int>& cracked);
    // Kinetic energy of the present velocities with the masses of this scaling [J].
    double kineticEnergy(double scaling);
    // A unit, or the two units of a brick, whose masses are scaled together.
    struct Block {
        std::vector<const Unit*> units;
        bool split;
    };
    std::vector<Block> blocks();
    // Rigid motions about the present centre of mass of some units together, in directions in which nodes are not held:
    // columns of displacements of their nodes, three rows a node, that are orthonormal under the masses.
    Eigen::MatrixXd rigidMotions(const std::vector<const Unit*>&) const;
    // The same of the units of a block each for itself: columns that are zero at the nodes of the other.
    Eigen::MatrixXd motionsOfParts(const Block&) const;

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
    //   ends of the diagonal between its triangles, with 1/6 of its area each, and the middles of its two edges along
    //   the joint, with 1/3 each. Along the joint these are the points of gaussLobatto(3).
    // - Where the unit is a plane unit, which is held in the same way: on every edge of a cell its two ends, with 1/6
    //   of the area that belongs to it each, and its middle, with 4/6. The points lie in the middle plane. A joint
    //   across the plane has no such points.
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

    // The rows in which the state of the nodes lives. The three components of a node are one row apart: rows()[place +
    // d * lanes]. Dependent points are subcontacts' sides without a node of their own, which move with a rigid body or
    // between nodes. JointBatches adds rows for them behind those of the nodes.
    int placeOf(int node) const { return places_[node]; }
    int addDependentRows(); // returns the place of the first lane
    void dropDependentRows();
    double* displacementRows() { return displacements_[0].lane; } // since the reference state [m]
    double* forceRows() { return forces_[0].lane; }               // of joints in the present step [N]
    double* momentRows() { return moments_[0].lane; }             // of joints on the rotation of the units [N m]
    void clearForces(); // sets forces and moments of all nodes to zero; divides the bodies if that is still to be done
    Vector3r displacementOf(int node) const { return at(displacements_, places_[node]); }
    Vector3r velocityOf(int node) const { return at(velocities_, places_[node]); }
    Vector3r displacementAt(const Attachment& a) const {
        Vector3r moved = Vector3r::Zero();
        for (int i = 0; i < 3; ++i)
            if (a.weights[i] != 0) moved += a.weights[i] * displacementOf(a.nodes[i]);
        return moved;
    }

    // All nodes, in the order of their numbers.
    std::vector<Vector3r> displacements() { return listed(displacements_, loaded_.displacements); }
    std::vector<Vector3r> velocities() { return listed(velocities_, loaded_.velocities); }
    std::vector<Vector3r> lastForces() { return listed(lastForces_, loaded_.lastForces); }
    void setDisplacements(const std::vector<Vector3r>& values) { take(values, displacements_, loaded_.displacements); }
    void setVelocities(const std::vector<Vector3r>& values) { take(values, velocities_, loaded_.velocities); }
    void setLastForces(const std::vector<Vector3r>& values) { take(values, lastForces_, loaded_.lastForces); }
    // Sets the velocity of a node [m/s] from which the next step starts.
    void setVelocity(int node, const Vector3r& velocity);
    // Throws std::runtime_error if the scene in which the units moved has ended.
    void checkAlive() const;

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
    // Batches that are moved together: one, or two with the units of the same bricks in the same lanes.
    struct LaneGroup {
        int first, second;       // numbers of batches; the second is -1 if there is none
        std::vector<int> bricks; // number of the brick in every lane
    };
    void addUnit(int unit, int batch);
    bool isPair(const Brick&);
    void pairUp();
    void advanceGroup(const LaneGroup&, const NodeMotion&, BodyColumns&, std::vector<NodeSums>&,
                      std::vector<Row>& energies);
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
    std::vector<Vector3r> listed(const std::vector<Row>& rows, const std::vector<Vector3r>& loaded) const;
    // Sets rows, or `loaded` while there are none for these values.
    void take(const std::vector<Vector3r>& values, std::vector<Row>& rows, std::vector<Vector3r>& loaded);

    struct { // state of the nodes while there are no rows for it: after loading, and before the bodies are divided anew
        std::vector<Vector3r> displacements, velocities, lastForces;
    } loaded_;
    std::vector<Unit> units_;
    std::vector<int> unitOfBody_; // by the id of the body; -1 if it is rigid
    std::vector<int> places_;     // of all nodes in the rows
    std::vector<Batch> batches_;
    std::vector<LaneGroup> groups_;
    int rows_ = 0; // how many rows the nodes take
    std::vector<Brick> bricks_;
    std::vector<int> brickOfBody_; // number of the brick by its first body; -1 for all others
    std::vector<Row> displacements_, velocities_, forces_, lastForces_, moments_;
    boost::weak_ptr<yade::Factorable> divided_; // the scene whose bodies were divided
    boost::weak_ptr<yade::Factorable> scene_;   // the scene in which the units were last moved
    bool acted_ = false;                        // whether the units were ever moved
};

} // namespace masonry
