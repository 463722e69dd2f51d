// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid bricks of two blocks that move as one until their crack surface yields (JointProperties::monolithic). The
// integrator owns them. README.md, Whole bricks, says how a brick splits.
#pragma once
#include "BodyColumns.hpp"
#include "SceneContents.hpp"
#include "motion/EnergyLedger.hpp"
#include <array>
#include <map>
#include <memory>

namespace masonry {

class WholeBricks {
public:
    // What the step of a brick needs of the integrator.
    struct Around {
        double dt;                        // time step [s]
        yade::Vector3r gravity;           // [m/s²]
        double damping;                   // damping constant of damped bodies [-]
        double massDamping;               // of damped bodies [1/s]
        bool combined;                    // whether damping is combined or local
        std::vector<double>* last;        // the integrator's six columns of forces of the last step of all bodies
        yade::Vector3r *forces, *torques; // of all bodies in this step [N], [N m]
    };
    // The brick that a body is a half of, for those that prescribe a motion.
    struct Carrier {
        int body1, body2;
        yade::Vector3r centre, velocity, spin, inverseMass;
        yade::Matrix3r inverseInertia;
    };
    // Force and moment in the plane of a crack surface that a whole brick transferred in the last step, as the brick
    // acts on body 1, in the joint's axes; the moment about the middle of the surface.
    struct Section {
        int body1, body2;
        yade::Vector3r force, moment; // [N], [N m]
    };

    // Reads the bricks of a scene that has changed, and tells the columns of joints which of them are whole. A brick is
    // whole if the scene has a MasonryJointLoop, both blocks are rigid and are held in the same axes.
    void update(SceneContents&);
    int pieces() const; // of advancePiece()
    // Looks at what scripts have done to the bricks since the last step. A brick whose halves were moved against each
    // other, or of which one half is held otherwise than the other, splits.
    void notice(SceneContents&, const Around&);
    // Makes a step of the bricks of a piece. Threads may take different pieces.
    EnergyLedger advancePiece(SceneContents&, const Around&, int piece);
    // Splits the bricks whose crack surface has yielded in this step.
    void splitYielded(SceneContents&, const Around&);

    const Carrier* carrierOf(int body, Carrier&) const; // null if the body is no half of a whole brick
    std::vector<Section> sections() const;
    const Section* sectionOf(int body1, int body2, Section&) const; // null if there is no such whole brick

    double energy = 0; // elastic energy that crack surfaces had when their bricks split, so far [J]
    int splits = 0;    // number of bricks that have split so far

    // In saved files and checkpoints: the numbers of all whole bricks.
    std::vector<double> numbers();
    void setNumbers(const std::vector<double>&);

private:
    struct Brick {
        int body[2];
        int kind, joint; // place of the joint in SceneContents::kinds
        bool whole = false;
        bool spins = false;         // whether it turns freely in space
        unsigned blocked = 0;       // axes in which both halves are held, as in State.blockedDOFs
        unsigned takes[2] = {0, 0}; // BodyColumns::takes() of the halves when they were last looked at
        yade::Vector3r momentum[2] = {
            yade::Vector3r::Zero(),
            yade::Vector3r::Zero()};        // State.angMom of the halves of a brick that turns freely, as it was set
        std::unique_ptr<yade::State> state; // of a brick that turns freely
    };
    void resize(int count);
    bool adopt(SceneContents&, int brick);
    void complete(const SceneContents&, int brick);
    bool asPlaced(const SceneContents&, int brick) const;
    void carry(const Around&, int brick);
    bool held(const BodyColumns&, int brick, unsigned& blocked) const;
    EnergyLedger turnFreely(SceneContents&, const Around&, int brick, const yade::Vector3r (&on)[4]);
    bool yields(const SceneContents&, int brick) const;
    void split(SceneContents&, const Around&, int brick, bool loaded);
    template <class F> void eachNumber(int brick, F&& visit);
    yade::Vector3r vectorOf(const std::vector<double>* columns, int brick) const {
        return {columns[0][brick], columns[1][brick], columns[2][brick]};
    }
    static void put(std::vector<double>* columns, int brick, const yade::Vector3r& value) {
        for (int d = 0; d < 3; ++d)
            columns[d][brick] = value[d];
    }
    static yade::Quaternionr turnOf(const std::vector<double>* columns, int brick) {
        return {columns[0][brick], columns[1][brick], columns[2][brick], columns[3][brick]};
    }
    static void put(std::vector<double>* columns, int brick, const yade::Quaternionr& q) {
        columns[0][brick] = q.w();
        for (int d = 0; d < 3; ++d)
            columns[1 + d][brick] = q.vec()[d];
    }

    long revision_ = -1; // SceneStore::revision() for which the bricks were read
    std::vector<Brick> bricks_;
    std::vector<int> brickOf_; // of every body; -1 if it is no half of a whole brick
    RigidColumns own_;
    std::vector<double> last_[6];      // as Integrator::last_, of whole bricks
    std::vector<double> local_[2][3];  // centres of the halves in the axes of the brick [m]
    std::vector<double> turned_[2][4]; // orientations of the halves in the axes of the brick
    std::vector<double> arm_[2][3];    // from the centre of the brick to those of the halves, global axes [m]
    std::vector<double> mass1_;        // of half 1 [kg]
    std::vector<double> inertia1_[3];  // of half 1, as State.inertia [kg m²]
    std::vector<double> face_[4];      // the joint's axes in the axes of the brick
    std::vector<double> middle_[3];    // of the crack surface, from the centre of half 1, in the joint's axes [m]
    std::vector<double> perArea_;      // 1 over the area [1/m²]
    // Inverse second moments of area of the points about their middle [1/m⁴]: in bending zz, yz and yy, where y and z
    // are along the two tangents, and in torsion.
    std::vector<double> bend_[3], twist_;
    std::vector<double> reach_[2]; // largest |y| and |z| of the points [m]
    // Stresses that are within the strength of the law: from `box_[0]` to `box_[1]` in the normal direction together
    // with shear stresses up to `box_[2]` [Pa].
    std::vector<double> box_[3];
    std::vector<double> force_[3], moment_[3];   // see Section
    std::map<int, std::array<double, 3>> boxes_; // the same by the number of the kind of joint
    std::vector<unsigned char> outside_;         // whether stresses of this step may be beyond the strength
    std::vector<double> restored_;               // numbers that were set, until update() takes them
    bool restore_ = false;
};

} // namespace masonry
