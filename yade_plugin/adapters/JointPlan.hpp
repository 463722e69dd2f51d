// A step of all joints of a scene: jumps from the places of blocks and nodes, the law, forces on blocks and nodes. It
// works on the columns of SceneStore; what it keeps itself follows from the scene and is made anew when that changes.
#pragma once
#include "SceneStore.hpp"

namespace masonry {

class JointPlan {
public:
    void advance(SceneStore&);

private:
    struct Kind {                      // of joints, beside their columns in the store
        bool alike = false;            // the joints' axes in their blocks are the same, too: one value stands for all
        int first = 0;                 // number of its first joint among those of all kinds
        int firstPoint = 0;            // number of its first subcontact among those with deformable sides
        std::vector<int> body1, body2; // of every joint
        std::vector<double> frame1[4]; // the joints' axes in each block; in the plane cosine and sine of half angles
        std::vector<double> frame2[4];
        std::vector<double> span[3];     // from centre to centre in the reference state
        std::vector<int> place1, place2; // of subcontacts with deformable sides, in the rows of MasonryZones
    };
    // A subcontact's side that has no node of its own: it moves with a rigid body, or between the nodes of a surface.
    struct DependentPoint {
        int place;
        int body; // -1 between nodes
        Vector3r reference, local;
        Attachment attachment;
    };
    // Who receives what: for every receiver the numbers of what acts on it.
    struct Receivers {
        struct Item {
            int source;
            bool second; // it acts on side 2, with the other sign
        };
        std::vector<int> receivers;
        std::vector<int> start; // of a receiver's items
        std::vector<Item> items;
        void fill(const std::vector<std::vector<Item>>& lists);
    };

    void build(SceneStore&, bool mayBePlane);
    bool liesInPlane(const SceneStore&) const;
    void dropStressOutOfPlane(SceneStore&);
    void buildKind(SceneStore&, const JointKind&, Kind&, std::vector<std::vector<Receivers::Item>>& atBodies);
    void buildPlaces(const JointKind&, Kind&, std::vector<std::vector<Receivers::Item>>& atPlaces);
    bool noticeBodies(SceneStore&);
    void advanceBlock(SceneStore&, const JointKind&, const Kind&, int from, int count);
    void moveDependentPoints(const SceneStore&);
    void bringToBodies();
    void bringToNodes(SceneStore&);

    const SceneStore* store_ = nullptr; // for which the plan was made
    long revision_ = -1;
    bool plane_ = false; // all joints and motions lie in planes y = constant
    std::vector<Kind> kinds_;
    struct Block { // joints that a thread takes at a time
        int kind, from;
    };
    std::vector<Block> blocks_;
    std::vector<double> turn_[4];       // of all bodies: orientation; in the plane the half angle's cosine and sine
    std::vector<double> referenceY_;    // of all bodies
    std::vector<unsigned char> joined_; // whether a body has joints, and whether it is deformable
    std::vector<int> momentPlace_;      // of deformable units in the rows of MasonryZones, else -1
    MasonryZones* zones_ = nullptr;
    std::vector<DependentPoint> dependentPoints_;
    Receivers toBodies_, toNodes_;
    std::vector<double> onJoints_; // force on body 1, torques about both centres; deformable: moment on each rotation
    std::vector<double> onPoints_; // force on side 1 of subcontacts with deformable sides
    Vector3r* forces_ = nullptr;   // the host's, of the present step
    Vector3r* torques_ = nullptr;
};

} // namespace masonry
