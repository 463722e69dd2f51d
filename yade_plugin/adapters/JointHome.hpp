// Where the state of joints lives, in columns: jumps and places in JointShapes, what the law remembers in JointStates.
// A joint begins with a home of its own; when a scene is read (SceneStore), all joints of one kind move into one home,
// which the engines work on. MasonryJointGeom and MasonryJointPhys are views of a home and the joint's number in it.
#pragma once
#include "MasonryJoint.hpp"
#include "blocks/FaceContact.hpp"
#include "law/piecewise_softening/JointColumns.hpp"
#include "motion/JointFrames.hpp"
#include <boost/weak_ptr.hpp>

namespace masonry {

class MasonryZones;

// Tells a view that its joint has gone: its scene has ended, or the joint was taken out of it.
struct Home {
    boost::weak_ptr<yade::Factorable> scene; // empty before the joints belong to one
    bool inScene = false;
    bool left = false; // all joints that are still in the scene have moved on

    // Throws std::runtime_error where the joint has gone.
    void check() const {
        if (left || (inScene && scene.expired()))
            throw std::runtime_error("this joint is gone: its scene has ended, or it was taken out of the scene");
    }
};

// Where a subcontact hangs on the surface of a deformable unit.
struct Attachment {
    std::array<int, 3> nodes{0, 0, 0}; // numbers in the lists of MasonryZones
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

// What a joint is in the reference state, in which its blocks were when it was made.
struct JointReference {
    struct Side {
        int body = -1;
        Vector3r position = Vector3r::Zero(); // of the body's centre [m]
        Quaternionr orientation = Quaternionr::Identity();
    };
    Vector3r normal = Vector3r::UnitX();  // from side 0 to side 1
    Vector3r tangent = Vector3r::UnitY(); // first direction in the joint's plane
    Polygon polygon;                      // corners of the shared face [m]
    Side sides[2];
    // Of a joint with a deformable side: where every subcontact hangs on each side; empty at a rigid side.
    struct Hung {
        shared_ptr<MasonryZones> zones;
        std::vector<Attachment> sides[2];
    };
    std::shared_ptr<Hung> hung;

    // The joint's axes as columns: normal, tangent, normal × tangent.
    yade::Matrix3r axes() const {
        yade::Matrix3r columns;
        columns << normal, tangent, normal.cross(tangent);
        return columns;
    }
    // The joint's axes seen from the body of a side.
    Quaternionr frame(int side) const { return sides[side].orientation.conjugate() * Quaternionr(axes()); }
    // From the centre of body 1 to that of body 2, in the joint's axes [m].
    Vector3r span() const { return axes().transpose() * (sides[1].position - sides[0].position); }
    // Distance of a body's centre from the joint's plane [m].
    double distance(int side) const {
        return side == 0 ? (polygon[0] - sides[0].position).dot(normal) : (sides[1].position - polygon[0]).dot(normal);
    }
    bool rigid(int side) const { return !hung || hung->sides[side].empty(); }
};

// Subcontacts of joints with one number of them: columns [point][joint]. Vectors are in the joints' axes.
struct JointShapes : Home {
    JointShapes(int joints, int pointCount);

    int points;         // subcontacts of a joint
    int stride;         // joints in a column, padded to whole lanes; one joint alone has no padding
    bool alike = false; // all joints have the same areas and offsets: one value stands `JointFrames::most` times
    std::vector<JointReference> joints;
    std::vector<double> jump[3];   // since the reference state [m]
    std::vector<double> area;      // [m²]
    std::vector<double> offset[3]; // from the centre of body 1 [m]

    std::size_t at(int point, int joint) const { return std::size_t(point) * stride + joint; }
    std::size_t shape(int point, int joint) const { // of areas and offsets
        return alike ? std::size_t(point) * JointFrames::most : at(point, joint);
    }
    Vector3r jumpAt(int point, int joint) const { return vectorAt(jump, at(point, joint)); }
    Vector3r offsetAt(int point, int joint) const { return vectorAt(offset, shape(point, joint)); }
    double areaAt(int point, int joint) const { return area[shape(point, joint)]; }
    void setJump(int point, int joint, const Vector3r& value) { setVector(jump, at(point, joint), value); }
    // Area and offset of a home whose joints are not alike.
    void setShape(int point, int joint, const Vector3r& offsetOfPoint, double areaOfPoint) {
        setVector(offset, at(point, joint), offsetOfPoint);
        area[at(point, joint)] = areaOfPoint;
    }
    // Takes a joint over from another home with the same number of points.
    void take(int joint, const JointShapes& from, int other);
    // Keeps one value for all joints where areas and offsets are the same but for round-off: they then stay in the
    // innermost cache.
    void shareShapes();

private:
    static Vector3r vectorAt(const std::vector<double>* columns, std::size_t i) {
        return {columns[0][i], columns[1][i], columns[2][i]};
    }
    static void setVector(std::vector<double>* columns, std::size_t i, const Vector3r& value) {
        for (int d = 0; d < 3; ++d)
            columns[d][i] = value[d];
    }
};

// Whether numbers are the same but for round-off: stiffnesses, lengths and areas calculated in many places.
inline bool sameButRoundOff(double a, double b, double scale) { return std::abs(a - b) <= 1e-12 * scale; }

// What the law remembers of joints that share properties and stiffness.
struct JointStates : Home {
    JointStates(const shared_ptr<MasonryJoint>& kind, const ElasticStiffness& k, int joints, int points)
        : joint(kind), columns(kind->law(), k, joints, points) {}

    shared_ptr<MasonryJoint> joint;
    JointColumns columns;
    shared_ptr<JointShapes> shapes; // of the same joints in the same order; null before they belong to a scene

    void take(int number, const JointStates& from, int other) {
        for (int p = 0; p < columns.points(); ++p) {
            columns.set(p, number, from.columns.get(p, other));
            columns.setDissipated(p, number, from.columns.dissipated(p, other));
        }
    }
};

} // namespace masonry
