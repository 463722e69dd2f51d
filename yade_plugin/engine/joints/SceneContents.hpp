// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies and joints of a scene, as far as the parts of engines need them that do not know the engines themselves.
#pragma once
#include "JointView.hpp"
#include "engine/bodies/BodyColumns.hpp"

namespace masonry {

class Connectors;
class Contacts;
class Load;

// What others use of the engine that makes the step of the joints.
struct JointLoop {
    double stiffnessDamping = 0; // stiffness-proportional viscous damping of joints [s]
    double dampingWork = 0;      // energy that it has taken so far [J]
    bool impacts = false;        // whether impacts of joints take energy (JointImpact)
    double impactWork = 0;       // energy that they have taken so far [J]
    int points = 0;              // along a side of a joint from when it is about to yield; 0: see Refinement
    double refiningEnergy = 0;   // elastic energy that joints got when they were refined, so far [J]
    double overestimate = 0;     // of a load by dry joints that have opened at three points [-]
};

class SceneContents {
public:
    explicit SceneContents(yade::Scene& scene) : scene_(scene) {}
    SceneContents(const SceneContents&) = delete;
    SceneContents& operator=(const SceneContents&) = delete;

    yade::Scene& scene() const { return scene_; }
    // A number that changes whenever bodies or joints were read again. No two readings of any scenes have the same.
    long revision() const { return revision_; }
    // The same, but for readings between which only joints were refined: their stiffness stays what it is.
    long stiffnessRevision() const { return stiffnessRevision_; }

    JointLoop* loop = nullptr;           // null if no engine of the scene makes the step of the joints
    std::vector<Load*> loads;            // those that are not dead
    std::vector<Connectors*> connectors; // those that are not dead
    std::vector<Contacts*> contacts;     // those that are not dead
    BodyColumns bodies;
    std::vector<JointKind> kinds;
    std::vector<JointView> joints; // of all kinds, in the host's order

    // Calls `each` with every joint whose place no contact has taken.
    template <class F> void eachJoint(F&& each) const {
        for (const auto& joint : joints)
            if (!joint.geom->converted()) each(joint);
    }

protected:
    yade::Scene& scene_;
    long revision_ = 0, stiffnessRevision_ = 0;
};

} // namespace masonry
