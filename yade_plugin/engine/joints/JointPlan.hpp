// SPDX-License-Identifier: GPL-2.0-or-later
// A step of all joints of a scene: it finds the jumps from the places of blocks and nodes, calls the law, and brings
// the forces to blocks and nodes. The state is in the columns of SceneStore. What a plan keeps itself follows from the
// scene, and is made anew when the scene has changed. See JointFrames for the arithmetic.
//
// Intact joints. The stresses of a joint between rigid blocks that has always been elastic are linear over its face.
// Its force and moment then follow from the jump at the middle of the face and the moments of area, and whether it is
// about to yield shows at the outermost points. So its points are not advanced. Just before it yields, the points take
// the jumps of the step before with the elastic stresses that belong to them, and are advanced by the law from then on.
// JointShapes::pointwise says which joints are advanced by points. That is part of the state of a joint, so that a run
// that was saved goes on in the same bits.
#pragma once
#include "SceneContents.hpp"
#include <array>
#include <map>

namespace masonry {

class JointPlan {
public:
    // Makes a step of the joints of the store's loop, and adds the energies that it takes there.
    void advance(SceneContents&);

private:
    // What a kind of joints (see JointKind) needs beside its columns in the store.
    struct Kind {
        bool alike = false;              // whether frames and spans of all joints are the same, and kept once
        int first = 0;                   // number of its first joint among those of all kinds
        int firstPoint = 0;              // number of its first subcontact among those with deformable sides
        std::vector<int> body1, body2;   // ids of every joint's bodies
        std::vector<double> frame1[4];   // quaternion of the joint's axes in body 1; in a planar run cosine and sine of
                                         // half the angle
        std::vector<double> frame2[4];   // the same in body 2
        std::vector<double> span[3];     // from centre to centre in the reference state, in the joint's axes [m]
        bool intact = false;             // whether some joints were intact when the plan was made
        std::vector<int> place1, place2; // of both sides of subcontacts with deformable sides, in Zones' rows
    };
    // Side of subcontacts that has no node of its own. It moves with a rigid body, or with the surface between nodes.
    struct PointOnBody {
        int place; // in the rows of Zones
        int body;
        Vector3r reference; // its place in the reference state, global axes [m]
        Vector3r local;     // its place in the body's axes [m]
    };
    // Sides between the same nodes of congruent units, one unit in each lane, as the nodes stand. Places are those of
    // the first lane.
    struct PointsBetweenNodes {
        int place;
        std::array<int, 3> nodes;
        std::array<double, 3> weights; // of the nodes; their sum is 1
    };
    // What points between nodes bring to the nodes of congruent units: `weights` times the forces at `points`. Every
    // node sums up its own list, in the same order with any number of threads. Places are those of the first lane.
    struct NodeShares {
        std::vector<int> nodes;
        std::vector<int> start; // of a node's list in the two columns; one more entry ends the last list
        std::vector<int> points;
        std::vector<double> weights;
    };
    // For every body or node that joints act on, the list of what acts on it. Each receiver sums up its own list, in
    // the same order with any number of threads.
    struct Receivers {
        struct Item {
            int source;  // number of a joint or of a subcontact
            bool second; // whether the receiver is at side 2, where the force has the other sign
        };
        std::vector<int> receivers; // ids of bodies or places of nodes, each with at least one item
        std::vector<int> start;     // place of a receiver's first item; one more entry ends the last list
        std::vector<Item> items;
        void fill(const std::vector<std::vector<Item>>& lists);
    };

    void build(SceneContents&, bool mayBePlane);
    bool liesInPlane(const SceneContents&) const;
    void dropStressOutOfPlane(SceneContents&);
    void buildKind(SceneContents&, const JointKind&, Kind&, std::vector<std::vector<Receivers::Item>>& atBodies);
    void buildPlaces(const JointKind&, Kind&, std::vector<std::vector<Receivers::Item>>& atPlaces,
                     std::map<std::array<double, 6>, int>& known);
    bool detectChanges(SceneContents&);
    void findIntact(const JointKind&, Kind&);
    void endIntact(const JointKind&);
    struct Run;    // joints of a batch that are advanced together
    struct Taken { // energies that a step takes [J]
        double damping = 0, impacts = 0;
    };
    Taken advanceBatch(SceneContents&, const JointKind&, const Kind&, int from, int count);
    void align(Run&) const;
    bool advanceIntact(Run&, double& taken);
    bool endsIntact(Run&, const IntactFaces&) const;
    Taken advancePoints(Run&);
    void finish(Run&);
    void shareOut();
    void orderBatches();
    void moveDependentPoints(const SceneContents&);
    void bringToBodies();
    void bringToNodes(SceneContents&);

    const SceneContents* store_ = nullptr; // the store for which the plan was made
    long revision_ = -1;                   // the store's revision for which the plan was made
    bool plane_ = false; // whether the run is planar: all joints and motions lie in planes y = constant
    std::vector<Kind> kinds_;
    struct Batch {
        int kind;  // number of the kind to which its joints belong
        int from;  // number of its first joint within that kind
        int count; // of its joints
    };
    std::vector<Batch> batches_;     // joints that a thread takes at a time
    std::vector<int> order_;         // numbers of batches in the order in which threads take them
    std::vector<double> turn_[4];    // planar runs only: cosine and sine of half the angle by which a body has turned
    std::vector<double> referenceY_; // of all bodies [m]
    std::vector<unsigned char> joined_; // whether a body has joints
    std::vector<double> jointedArea_;   // of the joints of every body [m²]
    std::vector<int> momentPlace_;      // of all bodies: place in Zones' rows of moments; -1 if it is rigid
    Zones* zones_ = nullptr;            // null if no joint has a deformable side
    std::vector<PointOnBody> onBodies_;
    std::vector<PointsBetweenNodes> betweenNodes_;
    NodeShares shares_;  // of the points between nodes
    Receivers toBodies_; // what joints bring to bodies
    Receivers toNodes_;  // what subcontacts bring to nodes and dependent points
    // Scratch of a step. Of every joint between rigid bodies the force on body 1 [N] and the torques about both centres
    // [N m]; of a joint with a deformable side only the moments on the rotations of both bodies [N m].
    std::vector<double> onJoints_;
    std::vector<Taken> taken_;     // scratch: of every batch
    std::vector<double> onPoints_; // scratch: force on side 1 of every subcontact with deformable sides [N]
    Vector3r* forces_ = nullptr;   // the host's forces of the present step [N], to which the joints add theirs
    Vector3r* torques_ = nullptr;  // the host's torques of the present step [N m]
};

} // namespace masonry
