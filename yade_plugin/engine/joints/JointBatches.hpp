// SPDX-License-Identifier: GPL-2.0-or-later
// What a step of the joints needs that follows from the scene, and its scratch. It is made anew when the scene has
// changed; the state is in the columns of SceneStore.
#pragma once
#include "SceneContents.hpp"
#include <array>
#include <map>

namespace masonry {

// For every body or node that joints act on, the list of what acts on it. Each receiver sums up its own list, in the
// same order with any number of threads.
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

// What a kind of joints (see JointKind) needs beside its columns in the store.
struct KindInStep {
    bool alike = false;              // whether frames and spans of all joints are the same, and kept once
    int first = 0;                   // number of its first joint among those of all kinds
    int firstPoint = 0;              // number of its first subcontact among those with deformable sides
    std::vector<int> body1, body2;   // ids of every joint's bodies
    std::vector<double> frame1[4];   // quaternion of the joint's axes in body 1; in a planar run cosine and sine of
                                     // half the angle
    std::vector<double> frame2[4];   // the same in body 2
    std::vector<double> span[3];     // from centre to centre in the reference state, in the joint's axes [m]
    bool intact = false;             // whether some joints were intact when the batches were made
    std::vector<int> place1, place2; // of both sides of subcontacts with deformable sides, in Zones' rows
};

struct JointBatches {
    void build(SceneContents&, bool mayBePlane);

    bool plane = false;            // whether the run is planar: all joints and motions lie in planes y = constant
    std::vector<KindInStep> kinds; // those of the store
    struct Batch {
        int kind;  // number of the kind to which its joints belong
        int from;  // number of its first joint within that kind
        int count; // of its joints
    };
    std::vector<Batch> batches;        // joints that a thread takes at a time
    std::vector<int> order;            // numbers of batches in the order in which threads take them
    std::vector<double> referenceY;    // of all bodies [m]
    std::vector<unsigned char> joined; // whether a body has joints
    std::vector<double> jointedArea;   // of the joints of every body [m²]
    std::vector<int> momentPlace;      // of all bodies: place in Zones' rows of moments; -1 if it is rigid
    Zones* zones = nullptr;            // null if no joint has a deformable side
    Receivers toBodies;                // what joints bring to bodies
    Receivers toNodes;                 // what subcontacts bring to nodes and dependent points

    // Side of subcontacts that has no node of its own. It moves with a rigid body, or with the surface between nodes.
    struct PointOnBody {
        int place; // in the rows of Zones
        int body;
        Vector3r reference; // its place in the reference state, global axes [m]
        Vector3r local;     // its place in the body's axes [m]
    };
    std::vector<PointOnBody> onBodies;
    // Sides between the same nodes of congruent units, one unit in each lane, as the nodes stand. Places are those of
    // the first lane.
    struct PointsBetweenNodes {
        int place;
        std::array<int, 3> nodes;
        std::array<double, 3> weights; // of the nodes; their sum is 1
    };
    std::vector<PointsBetweenNodes> betweenNodes;
    // What points between nodes bring to the nodes of congruent units: `weights` times the forces at `points`. Every
    // node sums up its own list, in the same order with any number of threads. Places are those of the first lane.
    struct NodeShares {
        std::vector<int> nodes;
        std::vector<int> start; // of a node's list in the two columns; one more entry ends the last list
        std::vector<int> points;
        std::vector<double> weights;
    };
    NodeShares shares;

    // Scratch of a step. Of every joint between rigid bodies the force on body 1 [N] and the torques about both centres
    // [N m]; of a joint with a deformable side only the moments on the rotations of both bodies [N m].
    std::vector<double> onJoints;
    std::vector<double> onPoints; // force on side 1 of every subcontact with deformable sides [N]
    std::vector<double> turn[2];  // planar runs only: cosine and sine of half the angle by which a body has turned

private:
    using Lists = std::vector<std::vector<Receivers::Item>>;
    bool liesInPlane(const SceneContents&) const;
    void buildKind(SceneContents&, const JointKind&, KindInStep&, Lists& atBodies);
    void buildPlaces(const JointKind&, KindInStep&, Lists& atPlaces, std::map<std::array<double, 6>, int>& known);
    void findIntact(const JointKind&, KindInStep&);
    void listShares();
    void orderBatches();
};

constexpr int bodiesAtOnce = 64; // how many bodies a thread takes at a time
// Distances [m], angles [rad] and directions out of the plane below this count as none.
constexpr double outOfPlaneTolerance = 1e-9;
// Whether a body can only move and turn in a plane y = constant.
inline bool isHeldInPlane(const BodyColumns& bodies, int body) {
    return bodies.isBlocked(body, 1) && bodies.isBlocked(body, 3) && bodies.isBlocked(body, 5);
}

} // namespace masonry
