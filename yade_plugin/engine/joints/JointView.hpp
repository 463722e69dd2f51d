// SPDX-License-Identifier: GPL-2.0-or-later
// A joint as the engines see it: its geometry and its state, each a view of the columns in which they live.
#pragma once
#include "JointGroup.hpp"

namespace masonry {

// The geometry of a joint and its jumps. The host's IGeom of a joint derives from it.
class JointGeometry {
public:
    // Makes the joint in its reference state, with `columns` of subcontacts along the direction `along` by `rows`
    // across it on the shared polygon (see subdivide()).
    void define(const FaceContact&, const Vector3r& along, int columns, int rows, int body1, int body2,
                const yade::State&, const yade::State&);
    // For a joint with a deformable side, whose subcontacts move with the surface between nodes. If the nodes of a
    // deformable side cover the polygon and, where both sides are deformable, match, the subcontacts are the points of
    // the cells' faces (see Zones::cover); else they remain those of define().
    void attach(const shared_ptr<Zones>&);

    // Whether the joint was made by define() or loaded from a file.
    bool made() const { return group != nullptr; }
    const JointReference& reference() const { return group->joints[index]; }
    int points() const { return group ? group->points : 0; }
    double area(int point) const { return group->areaAt(point, index); }
    const RefinedJoint& refined() const { return group->refined[index]; }
    bool converted() const { return group->converted[index]; } // to a contact: the joint has no forces any more
    Vector3r jump(int point) const { return group->jumpAt(point, index); }
    Vector3r offset(int point) const { return group->offsetAt(point, index); }
    // Point of a subcontact in the reference state, global axes [m].
    Vector3r centre(int point) const { return reference().sides[0].position + reference().axes() * offset(point); }
    // A polygon around every subcontact in the reference state, for pictures: the part of the joint that is nearest to
    // its point. Its area is not that of the subcontact.
    std::vector<Polygon> cells() const;

    shared_ptr<JointShapes> group; // null until define() or loading; SceneStore replaces it
    int index = 0;                 // number of the joint in its group

    // Scratch of one step of this joint alone, for the functors. follow() fills it from the places of the blocks; the
    // law's functor reads it, and adds moment and forces for the zones.
    struct Step {
        yade::Matrix3r axes;                 // columns normal and tangents, turned with the mean of both blocks
        Vector3r between = Vector3r::Zero(); // from the centre of body 1 to that of body 2, global axes [m]
        Vector3r moment = Vector3r::Zero();  // on the rotation of each deformable block, global axes [N m]
        std::vector<Vector3r> increments;    // change of the jumps in this step, in the joint's axes [m]
        std::vector<Vector3r> arms;          // of the forces, from the centre of a rigid body, in the joint's axes [m]:
                                             // of body 1, or of body 2 if body 1 is deformable
        std::vector<Vector3r> forces;        // on side 1 of a joint with a deformable side, global axes [N]
    };
    std::unique_ptr<Step> step; // null before the first step with functors
    void follow(const yade::State& state1, const yade::State& state2);

private:
    void followDeformable(const yade::State& state1, const yade::State& state2);
};

// The state of a joint. The host's IPhys of a joint derives from it.
class JointPhysics {
public:
    // Gives the joint a group of its own, in which nothing has happened.
    void define(const shared_ptr<PropertySet>& kind, const ElasticStiffness& k, int points) {
        group.reset(new JointStates(kind, k, 1, points));
        index = 0;
    }

    bool made() const { return group != nullptr; }
    int points() const { return group ? group->columns.unsynchronised()->points() : 0; }
    const Law& law() const { return group->columns.unsynchronised()->law(); }
    const ElasticStiffness& stiffness() const { return group->columns.unsynchronised()->stiffness(); }
    // What every law knows of a subcontact; `shown` gives what files show of it beside that, zero if its law does not.
    JointState state(int point) const { return group->columns->state(point, index); }
    double shown(int point, const JointField& field) const { return group->columns->shown(point, index, field); }
    // Energies dissipated so far by mode [J/m²].
    Energies lost(int point) const { return group->columns->dissipated(point, index); }

    // The property set, which the joint shares with others of its kind.
    const shared_ptr<PropertySet>& propertySet() const { return group->joints[index]; }

    shared_ptr<JointStates> group; // null until define() or loading; SceneStore replaces it
    int index = 0;                 // number of the joint in its group
};

// A joint of a scene, with the objects by which the host holds it.
struct JointView {
    const yade::Interaction* interaction;
    shared_ptr<JointGeometry> geom;
    shared_ptr<JointPhysics> phys;
};

} // namespace masonry
