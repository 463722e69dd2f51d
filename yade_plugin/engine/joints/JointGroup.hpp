// SPDX-License-Identifier: GPL-2.0-or-later
// The columns in which the state of joints lives: jumps and geometry in JointShapes, the state of the law in
// JointStates. Each of these is a group. A joint that was just made has groups of its own. When SceneStore reads a
// scene, it moves all joints of one kind into common groups, on which the engines work. JointGeometry and JointPhysics
// are views: each holds a group and the joint's number in it.
#pragma once
#include "PropertySet.hpp"
#include "blocks/FaceContact.hpp"
#include "common/StateNumbers.hpp"
#include "engine/units/Attachment.hpp"
#include "law/common/LawColumns.hpp"
#include "motion/JointFrames.hpp"
#include <boost/weak_ptr.hpp>

namespace masonry {

using boost::shared_ptr;
using yade::Quaternionr;
using yade::Vector3r;

class Zones;

// What both groups have in common: they know whether their joints still exist. A Python object may outlive its joint,
// when the scene ends or the interaction is erased.
struct JointGroup {
    boost::weak_ptr<yade::Factorable> scene; // empty before the joints belong to a scene
    bool inScene = false;                    // whether a scene has read these joints
    bool left = false; // whether all joints that are still in the scene have moved to other groups

    // Throws std::runtime_error if the joints of this group no longer exist.
    void check() const {
        if (left || (inScene && scene.expired()))
            throw std::runtime_error("this joint is gone: its scene has ended, or it was taken out of the scene");
    }
};

// A subcontact in the reference state.
struct JointPoint {
    Vector3r offset = Vector3r::Zero(); // from the centre of body 1, in the joint's axes [m]
    double area = 0;                    // that it stands for [m²]

    template <class Visit> void visitState(Visit&& visit) { visit(offset, area); }
};

// Geometry of a joint in its reference state: the state of its two blocks when it was made. Vectors without another
// remark are in global axes.
struct JointReference {
    struct Side {
        int body = -1;
        Vector3r position = Vector3r::Zero();              // of the body's centre [m]
        Quaternionr orientation = Quaternionr::Identity(); // of the body
        // Share of the body's shear compliance that this joint takes (law/README.md, Rigid units).
        double shearShare = 1;

        template <class Visit> void visitState(Visit&& visit) { visit(body, position, orientation, shearShare); }
    };
    Vector3r normal = Vector3r::UnitX();  // unit normal, from side 0 to side 1
    Vector3r tangent = Vector3r::UnitY(); // first direction in the joint's plane
    // Corners of the shared face [m]. Copies of a joint have them in common.
    std::shared_ptr<const Polygon> corners = noCorners();
    Side sides[2]; // bodies 1 and 2 of the interaction
    // How the subcontacts of a joint with a deformable side move with the nodes.
    struct Attached {
        shared_ptr<Zones> zones;
        std::vector<Attachment> sides[2]; // one for each subcontact; empty at a rigid side
    };
    std::shared_ptr<Attached> attached; // null if both sides are rigid

    const Polygon& polygon() const { return *corners; }
    static const std::shared_ptr<const Polygon>& noCorners() {
        static const auto none = std::make_shared<const Polygon>();
        return none;
    }
    // Matrix whose columns are the joint's axes: normal, tangent, normal × tangent.
    yade::Matrix3r axes() const {
        yade::Matrix3r columns;
        columns << normal, tangent, normal.cross(tangent);
        return columns;
    }
    // Rotation from the axes of the body of a side to the joint's axes.
    Quaternionr frame(int side) const { return sides[side].orientation.conjugate() * Quaternionr(axes()); }
    // Vector from the centre of body 1 to that of body 2, in the joint's axes [m].
    Vector3r span() const { return axes().transpose() * (sides[1].position - sides[0].position); }
    // Distance of a body's centre from the joint's plane [m].
    double distance(int side) const {
        return side == 0 ? (polygon()[0] - sides[0].position).dot(normal)
                         : (sides[1].position - polygon()[0]).dot(normal);
    }
    // Whether the body of a side is rigid.
    bool rigid(int side) const { return !attached || attached->sides[side].empty(); }
    void visitState(StateNumbers&);
};

// Mean of the rotations by which both bodies have carried a joint's axes along. The second becomes the nearer one of
// two quaternions that are the same rotation.
inline Quaternionr meanOf(const Quaternionr& one, Quaternionr& two) {
    if (one.dot(two) < 0) two.coeffs() *= -1;
    return Quaternionr((one.coeffs() + two.coeffs()).eval()).normalized();
}

// Numbers of points along the tangent of a joint and across it; a row has one across. 0: those that it was made with.
struct PointCounts {
    int along = 0, across = 0;

    bool operator==(const PointCounts& other) const { return along == other.along && across == other.across; }
    template <class Visit> void visitState(Visit&& visit) { visit(along, across); }
};

// What Refinement has made of a joint: its numbers of points, and the points that it was made with, which copies of a
// joint have in common. Null if it was not refined.
struct RefinedJoint {
    PointCounts points;
    std::shared_ptr<const std::vector<JointPoint>> coarse;

    void visitState(StateNumbers&);
};

// A vector field that is linear over the faces of joints, in columns: the value at the middle of a face, and the vector
// whose cross product with the way from there is the change.
struct LinearField {
    std::vector<double> middle[3], turn[3];

    bool empty() const { return middle[0].empty(); }
    void resize(std::size_t count);
    Vector3r at(int joint, double b1, double b2) const { // at the way (0, b1, b2) from the middle
        const double t0 = turn[0][joint], t1 = turn[1][joint], t2 = turn[2][joint];
        return {middle[0][joint] + (t1 * b2 - t2 * b1), middle[1][joint] - t0 * b2, middle[2][joint] + t0 * b1};
    }
    std::array<double, 6> numbersOf(int joint) const; // zero if the columns are empty
    void setNumbers(int joint, const std::array<double, 6>&);
    void clear();
};

// Geometry and jumps of joints that have the same number of subcontacts. The columns hold first the values of
// subcontact 0 of all joints, then those of subcontact 1, and so on. Vectors are in the joints' axes.
struct JointShapes : JointGroup {
    JointShapes(int joints, int pointCount);

    int points;         // number of subcontacts of a joint
    int stride;         // number of joints, rounded up to whole lanes; one joint alone is not rounded up
    bool alike = false; // see shareShapes()
    // Whether a scene or a file has had areas and offsets of these joints, which then stay to the bit. A run that is
    // resumed, and has other joints beside them, goes on with the same numbers.
    bool settled = false;
    std::vector<JointReference> joints;
    std::vector<double> jump[3]; // displacement jump since the reference state: opening and the two slides [m]
    // Stress of JointDamping in the last step [Pa], normal and the two shears; empty while there was no such damping.
    std::vector<double> viscous[3];
    // Stress of impacts (JointImpact) in the last step [Pa], normal and the two shears. Empty, as `closing`, while
    // impacts take no energy.
    std::vector<double> impact[3];
    // Largest closing speed since the corner opened [m/s]; 0: it is open; `notAnImpact`: it closed again, was never
    // open, or is no corner (`rim`).
    std::vector<double> closing;
    static constexpr double notAnImpact = -1;
    std::vector<double> area;      // of a subcontact [m²]
    std::vector<double> offset[3]; // from the centre of body 1 to the subcontact in the reference state [m]

    // What becomes of joints in a run.
    std::vector<RefinedJoint> refined; // set by Refinement
    // Whether the contact of its blocks has taken the place of a joint, set by JointConversion: a step leaves its state
    // as it is, and it has no forces any more. Such a joint keeps its place in the columns. 1 when it has been set, 2
    // after one more step without a jump: from then on a step would change nothing.
    std::vector<unsigned char> converted;

    // Intact joints (see BatchStep), of which a step only brings `linear` up to date. What stands in the columns of
    // jumps, stresses of damping, openings and stresses of the law is then of an earlier step, until somebody reads
    // them: synchronise() is called before that. All else that the law remembers of the points is always up to date.
    std::vector<unsigned char> pointwise; // of every joint, whether it is not intact; never becomes so again
    LinearField linear;                   // jumps of intact joints [m]
    LinearField damped; // of the stress of JointDamping, what is to be multiplied by the stiffnesses [m]; empty like
                        // `viscous`
    bool stale = false; // whether the columns of intact joints are of an earlier step
    std::shared_ptr<LawColumns> law;          // of the same joints; null before they belong to a scene
    std::vector<double> middle[3];            // middle of the face, as `offset` [m]; empty before findMiddles()
    std::vector<double> faceArea, inertia[3]; // area [m²] and its second moments about the middle, along the first
                                              // tangent, along the second, and mixed [m⁴]
    std::vector<int> rim; // numbers of the points that are corners of their hull in one of the joints

    // Writes what intact joints have in their linear fields to their points, if that is of an earlier step.
    void synchronise() {
        if (stale) writePoints();
    }
    void synchronise(int joint); // the same for one joint, always
    // From now on the joints of a vector register, of which this is one, are advanced by their points.
    void endIntact(int joint);
    void findMiddles(); // fills `middle` to `rim` from areas and offsets
    // Place of a joint in the columns `middle` to `inertia`.
    std::size_t face(int joint) const { return alike ? std::size_t(joint % JointFrames::most) : std::size_t(joint); }
    // Jump of a subcontact of an intact joint [m].
    Vector3r intactJumpAt(int point, int joint) const {
        if (!stale) return vectorAt(jump, at(point, joint)); // the same bits
        const std::size_t s = shape(point, joint), f = face(joint);
        return linear.at(joint, offset[1][s] - middle[1][f], offset[2][s] - middle[2][f]);
    }
    // Whether what stands at the points of a joint is that of an intact one with these linear fields.
    bool isIntact(int joint) const;

    // Place of a subcontact in the columns of jumps.
    std::size_t at(int point, int joint) const { return std::size_t(point) * stride + joint; }
    // Place of a subcontact in the columns of areas and offsets.
    std::size_t shape(int point, int joint) const {
        return alike ? std::size_t(point) * JointFrames::most : at(point, joint);
    }
    Vector3r jumpAt(int point, int joint) {
        synchronise();
        return vectorAt(jump, at(point, joint));
    }
    Vector3r offsetAt(int point, int joint) const { return vectorAt(offset, shape(point, joint)); }
    double areaAt(int point, int joint) const { return area[shape(point, joint)]; }
    Vector3r viscousAt(int point, int joint) {
        synchronise();
        return viscous[0].empty() ? Vector3r(Vector3r::Zero()) : vectorAt(viscous, at(point, joint));
    }
    void setViscous(int point, int joint, const Vector3r& value) {
        if (viscous[0].empty() && value.isZero(0)) return;
        makeViscous();
        setVector(viscous, at(point, joint), value);
    }
    void dropViscous() {
        for (auto& column : viscous)
            column.clear();
        damped.clear();
    }
    void makeViscous() {
        for (auto& column : viscous)
            column.resize(jump[0].size(), 0);
        damped.resize(pointwise.size());
    }
    struct Impact {
        Vector3r stress = Vector3r::Zero();
        double closing = notAnImpact;

        template <class Visit> void visitState(Visit&& visit) { visit(stress, closing); }
    };
    Impact impactAt(int point, int joint) const {
        const std::size_t i = at(point, joint);
        return closing.empty() ? Impact() : Impact{vectorAt(impact, i), closing[i]};
    }
    void setImpact(int point, int joint, const Impact& value) {
        if (closing.empty() && value.closing == notAnImpact && value.stress.isZero(0)) return;
        makeImpacts();
        setVector(impact, at(point, joint), value.stress);
        closing[at(point, joint)] = value.closing;
    }
    void makeImpacts() {
        for (auto& column : impact)
            column.resize(jump[0].size(), 0);
        closing.resize(jump[0].size(), notAnImpact);
    }
    void dropImpacts() {
        for (auto* column : {&impact[0], &impact[1], &impact[2], &closing})
            column->clear();
    }
    // The stress that a subcontact has beside that of the law [Pa].
    Vector3r stressBesideLaw(int point, int joint) { return viscousAt(point, joint) + impactAt(point, joint).stress; }
    void setJump(int point, int joint, const Vector3r& value) {
        synchronise();
        setVector(jump, at(point, joint), value);
    }
    void visitState(int joint, StateNumbers&); // what changes in a step
    void visitShape(int joint, StateNumbers&); // what it was made as, and its points
    // Sets area and offset of a subcontact. Only for groups whose joints do not share them.
    void setShape(int point, int joint, const Vector3r& offsetOfPoint, double areaOfPoint) {
        setVector(offset, at(point, joint), offsetOfPoint);
        area[at(point, joint)] = areaOfPoint;
    }
    // Copies joint number `other` of another group with the same number of points into place `joint` of this one.
    void take(int joint, JointShapes& from, int other);
    // If areas and offsets of all joints are the same, to the bit if they are `settled` and but for round-off
    // otherwise, keeps those of the first joint alone and sets `alike`. Each value then stands `JointFrames::most`
    // times, so that a batch of joints reads them as it reads others, and they stay in the innermost cache. Settles
    // them.
    void shareShapes();

private:
    void writePoints();
    static Vector3r vectorAt(const std::vector<double>* columns, std::size_t i) {
        return {columns[0][i], columns[1][i], columns[2][i]};
    }
    static void setVector(std::vector<double>* columns, std::size_t i, const Vector3r& value) {
        for (int d = 0; d < 3; ++d)
            columns[d][i] = value[d];
    }
};

// Whether two numbers of about this size differ by round-off only. Equal stiffnesses, lengths and areas differ by that
// much when they are calculated at different places of a wall.
inline bool sameButRoundOff(double a, double b, double scale) { return std::abs(a - b) <= 1e-12 * scale; }

// State of the law in joints whose properties have equal values, and which share stiffness.
struct JointStates : JointGroup {
    JointStates(const shared_ptr<PropertySet>& kind, const ElasticStiffness& k, int count, int points)
        : joints(count, kind), columns(*this, kind->ownLaw()->columns(k, count, points)) {}

    // The columns of the law. Whoever reads them finds those of intact joints up to date.
    class Current {
    public:
        Current(const JointStates& of, std::unique_ptr<LawColumns> all) : of_(of), all_(std::move(all)) {}
        LawColumns* operator->() const { return &**this; }
        LawColumns& operator*() const {
            if (of_.shapes) of_.shapes->synchronise();
            return *all_;
        }
        // For what does not depend on the present state.
        const std::shared_ptr<LawColumns>& unsynchronised() const { return all_; }

    private:
        const JointStates& of_;
        std::shared_ptr<LawColumns> all_;
    };

    std::vector<shared_ptr<PropertySet>> joints; // the property set of each; different objects have equal values
    Current columns;
    shared_ptr<JointShapes> shapes; // of the same joints in the same order; null before they belong to a scene

    // Copies joint number `other` of another group into place `number` of this one.
    void take(int number, const JointStates& from, int other) {
        joints[number] = from.joints[other];
        auto& own = *columns;
        const auto& others = *from.columns;
        for (int p = 0; p < own.points(); ++p)
            own.take(p, number, others, p, other);
    }
    void visitState(int number, StateNumbers& n) {
        for (int p = 0; p < columns->points(); ++p)
            columns->visitState(p, number, n);
    }

    JointStates(const JointStates&) = delete;
    JointStates& operator=(const JointStates&) = delete;
};

// Joints whose properties have equal values, and which share stiffness and number of subcontacts.
struct JointKind {
    shared_ptr<JointShapes> shapes;
    shared_ptr<JointStates> states;
    bool attached; // whether a side of these joints is deformable
};

} // namespace masonry
