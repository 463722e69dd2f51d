#pragma once
#include "MasonryJointGeom.hpp"
#include "MasonryJointPhys.hpp"
#include "law/JointColumns.hpp"

namespace masonry {

class MasonryJointLoop : public Adapter<MasonryJointLoop, yade::GlobalEngine>, public Keeper {
public:
    static constexpr const char* className = "MasonryJointLoop";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "All masonry joints in one pass: what InteractionLoop does with the functors of this plugin, which stay as the "
        "reference, in arrays and on all threads. A run is the same, bit for bit, with any number of threads. Stands "
        "in InteractionLoop's place; new joints are made by masonry.connect(). The joints' own attributes are brought "
        "up to date when they are read.";

    shared_ptr<Ig2_Polyhedra_Polyhedra_MasonryJointGeom> geometry;
    shared_ptr<Ip2_MasonryMat_MasonryMat_MasonryJointPhys> physics;

    template <class Visit> static void attributes(Visit&& visit) {
        using L = MasonryJointLoop;
        visit("geometry", &L::geometry, "Ig2 functor with which masonry.connect() makes joints.");
        visit("physics", &L::physics, "Ip2 functor with which masonry.connect() makes joints.");
    }

    ~MasonryJointLoop() override { release(); }
    void action() override;
    void store() override;
    void release() override;

private:
    struct Group { // joints of one kind and one number of subcontacts: columns [joint] and [subcontact][joint]
        shared_ptr<MasonryJoint> joint;
        std::vector<shared_ptr<MasonryJointGeom>> geoms;
        std::vector<shared_ptr<MasonryJointPhys>> physics;
        int points = 0, stride = 0;    // subcontacts of a joint; joints in a column, padded to whole lanes
        int first = 0, firstPoint = 0; // numbers of the first joint, and of the first point of a nodal one
        bool nodal = false;            // whether a side is deformable
        JointColumns columns;
        bool alike = false; // whether the geometry of the first block of joints is that of all
        void share();
        std::vector<int> body1, body2;
        std::vector<double> frame1[4], frame2[4], span[3]; // in the plane: two numbers each, as complex numbers
        std::vector<double> area, jump[3];
        std::vector<double> offset[3];   // between rigid units
        std::vector<int> place1, place2; // of nodal joints, in the rows of MasonryZones
    };
    struct Bodies {                         // as columns
        std::vector<int> ids, momentPlaces; // of deformable units in the rows of MasonryZones, else -1
        std::vector<shared_ptr<yade::State>> states;
        std::vector<Quaternionr> reference;              // conjugate of the reference orientation
        std::vector<double> position[3], orientation[4]; // in the plane z, x, y, and the half angle's cosine and sine
    };
    struct Guest { // a point of a joint that moves with a rigid body, or between the nodes of an unmatched mesh
        int place, body;
        Vector3r reference, local;
        Attachment attachment;
    };
    struct Gather { // for every receiver the numbers of what it gets: 2 n, and 2 n + 1 with the other sign
        std::vector<int> receivers, start, items;
        void fill(const std::vector<std::vector<int>>& lists);
    };

    bool stale() const;
    void build(bool mayBePlane);
    bool inPlane() const;
    bool readBodies();
    int bodyNumber(int id, std::vector<int>& known);
    void buildPlaces(Group&, std::vector<std::vector<int>>& atPlaces);
    void advanceBlock(Group&, int from, int count);
    void moveGuests();
    void toBodies();
    void toNodes();

    std::vector<Group> groups_;
    std::vector<std::pair<int, int>> blocks_; // group, first joint
    Bodies bodies_;
    shared_ptr<MasonryZones> zones_;
    std::vector<Guest> guests_;
    Gather bodyGather_, nodeGather_;
    std::vector<double> onJoints_; // force on body 1, torque about both centres; of nodal joints the moment on both
    std::vector<double> onPoints_; // force on side 1 of nodal joints
    Vector3r *forces_ = nullptr, *torques_ = nullptr; // the host's, of the step
    bool plane_ = false;                              // whether all joints and motions lie in planes y = constant
    long seen_ = -1;
    std::size_t seenInteractions_ = 0;
    bool ahead_ = false; // whether the arrays are ahead of the joints
};

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryJointLoop)
