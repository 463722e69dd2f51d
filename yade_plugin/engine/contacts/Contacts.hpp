// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts of rigid blocks that no joint connects, wherever they meet. An engine derives from it.
#pragma once
#include "FallenBlocks.hpp"
#include "contact/BroadPhase.hpp"
#include "contact/ContactPair.hpp"
#include "contact/ContactStep.hpp"
#include "engine/joints/SceneContents.hpp"
#include <algorithm>
#include <set>

namespace masonry {

using yade::Matrix3r;
using yade::Vector3r;

class Contacts {
public:
    virtual ~Contacts() = default;

    double normalStiffness = 0;   // per area [Pa/m]
    double tangentialRatio = 0.4; // stiffness along the face over that along the normal [-]
    double friction = -1;         // coefficient [-]
    double restitution = 0.5;     // of a central impact of two faces [-]
    double skin = 0;              // by which boxes are larger than their blocks [m]; 0: chosen
    std::vector<int> bodies;      // ids of the blocks; empty: all rigid blocks

    bool takesJoints = false;    // whether joints without bond whose blocks have moved far are handed over to contact
    bool begun = false;          // whether there was a step
    double given = 0;            // elastic energy that contacts had in the first step [J]
    double conversionEnergy = 0; // elastic energy that joints got so far when they were handed over [J]
    int converted = 0;           // how many joints were handed over so far
    double lostInFriction = 0;   // so far [J]
    double lostInDamping = 0;    // so far [J]

    std::vector<std::string> problems() const;
    // Throws std::invalid_argument if a body is not there, is no block, or is a deformable unit.
    void checkBodies(const SceneContents&) const;

    // Adds the forces of all contacts to those of the present step, and counts their energies. Gravity [m/s²] is for
    // the dashpots alone.
    void act(SceneContents&, const Vector3r& gravity);
    // What a joint did to its bodies in this step, when it was handed over.
    struct Joint {
        int body1, body2;
        Vector3r normal, force;    // from body 1 to body 2; on body 1 [N]
        Vector3r torque1, torque2; // about the centres of both bodies [N m]
    };
    static constexpr int lookEvery = 10;       // steps between two looks at joints and at bodies that wake
    static constexpr int lookAtFallsEvery = 5; // and at blocks that fall
    // Whether a body is one of the blocks that can touch. It is known from the first step on.
    bool covers(int body) const { return std::binary_search(ids_.begin(), ids_.end(), body); }
    // Sizes of blocks by id; 0 where they cannot touch.
    std::vector<FallenBlocks::Size> sizes() const;
    // Goes on from the next step where these joints stood, which have no forces any more (JointConversion). To be
    // called when the scene has been read again.
    void takeOver(const SceneContents&, const std::vector<Joint>&);
    // Of all contacts on a body while its axes were blocked, so far [N s].
    Vector3r impulseOn(int body) const;
    // Elastic energy of all contacts in the last step [J].
    double elastic(const SceneContents&);
    // Finds the bounds for the present pairs, `anew` or if pairs were looked for or stiffness has changed since.
    void boundPairs(const SceneContents&, double damping, bool anew = false);
    // Bound of the largest eigenvalue of stiffness over mass [1/s²] of joints, whose own is given, and contacts: those
    // of boundPairs() if the time step follows the state, else all that may ever come. Damped masses are divided by
    // 1 + damping.
    double largestEigenvalue(const SceneContents&, double ofJoints, double damping, bool anew);
    double stepShare = 0;       // time step over its limit, if it follows the state [-]; 0: it stays
    double jointEigenvalue = 0; // that of the joints when it began to follow [1/s²]
    // Where a force acted in the last step, because blocks pressed on each other or parted in this step: two bodies,
    // and force [N] and torque about its centre [N m] on the second of them, global axes.
    struct PairForce {
        int one, other;
        Vector3r force, torque;
    };
    std::vector<PairForce> pairForces() const;
    int touching() const; // number of pairs that pressed on each other in the last step

    // The bodies that are looked for where joints are handed over, by their ids.
    const std::set<int>& awake() const { return awake_; }
    void visitState(StateNumbers&);

protected:
    // Force on the second body of a pair in the last step [N], global axes.
    Vector3r forceOf(int id1, int id2) const;

private:
    struct Pair {
        int one = 0, other = 0;
        int axis = 0; // number of the axis that separated them when it was last looked for
        // Way by which the contact sees the other body farther away than it stands, in the axes of the first [m]: what
        // crushing and dilatancy left of a joint that became this contact, so that its force goes on.
        Vector3r gap = Vector3r::Zero();
        PairMemory memory = {};

        template <class Visit> void visitState(Visit&& visit) { visit(one, other, axis, gap, memory); }
    };
    using Effect = ContactEffect; // of a pair in the present step
    struct Placed {               // a body when the pairs were last looked for
        Vector3r position;
        double orientation[4];

        template <class Visit> void visitState(Visit&& visit) {
            visit(position, orientation[0], orientation[1], orientation[2], orientation[3]);
        }
    };
    struct JointShare { // what a joint between rigid bodies does to both
        JointView joint;
        int bodies[2];
        BlockStiffness stiffness[2];
    };
    struct Change { // of what acts on a body, where its joint was handed over in the last step and a contact goes on
        int body;
        Vector3r force, torque; // [N], [N m]

        template <class Visit> void visitState(Visit&& visit) { visit(body, force, torque); }
    };
    std::vector<int> idsOf(const SceneContents&) const;
    void turnBlocks(const SceneContents&);
    bool isAwake(const SceneContents&, int body) const;
    void wake(const SceneContents&);
    void findPairsOfWoken(const SceneContents&);
    void countChanges(const SceneContents&);
    Pair* pairOf(int one, int other);
    double settle(const SceneContents&, Pair&, const Vector3r& normal, const Vector3r& onOther);
    void prepare(const SceneContents&);
    bool moved(const SceneContents&) const;
    void findPairs(const SceneContents&);
    RelativePose poseOf(const SceneContents&, const Pair&) const;
    ContactBody bodyOf(const SceneContents&, int body) const;
    ContactProperties law() const { return {normalStiffness, tangentialRatio, friction, dampingRatio_}; }
    void actOn(const SceneContents&, OverlapFinder&, Pair&, Effect&) const;
    template <class Strike> void damp(const SceneContents&, const Vector3r& gravity, Strike&& strike);
    void measureJoints(const SceneContents&);

    static constexpr int piece = 16; // pairs that a thread takes at a time

    std::vector<ContactBlock> blocks_; // of a body, by its id; without faces where it is none of `ids_`
    std::vector<int> ids_;             // of all blocks that can touch
    std::vector<Matrix3r> turns_;      // from the axes of a body to the global ones, by its id
    std::vector<Pair> pairs_;
    std::vector<Effect> effects_;    // of `pairs_`
    std::vector<Vector3r> impulses_; // of contacts on every body while it was held, so far, by id [N s]
    std::vector<OverlapFinder> finders_;
    std::vector<Placed> placed_;              // of `ids_`
    std::vector<std::pair<int, int>> joined_; // bodies that have a joint, sorted
    std::set<int> awake_;                     // where joints are handed over: bodies that may come near others
    std::vector<Change> changes_;
    double usedSkin_ = 0;
    double dampingRatio_ = 0, ratioOf_ = -1; // dampingRatio(restitution), and for which restitution
    // Bound for any contacts that may come, and what it was found for.
    double embedded_ = 0, boundStiffness_ = -1, boundRatio_ = -1;
    long boundRevision_ = -1;
    // Bounds for the present pairs, of contacts alone and with all joints that were not handed over; and for which
    // numerical damping and stiffnesses.
    double ofPairs_ = 0, ofAll_ = 0;
    std::array<double, 3> boundFor_ = {};
    bool unbounded_ = true;              // whether these must be found
    long measuredRevision_ = -1;         // SceneContents::stiffnessRevision() of `shares_`
    std::vector<JointShare> shares_;     // of all joints between rigid bodies
    std::vector<ContactBody> middle_;    // scratch of damp(): bodies in the middle of the step, by id
    std::vector<unsigned char> isKnown_; // whether a body is there
    bool restored_ = false;              // whether pairs and places are those of a checkpoint
    bool stale_ = true;                  // whether the pairs must be looked for
    long revision_ = -1;                 // SceneContents::revision() of all that
};

} // namespace masonry
