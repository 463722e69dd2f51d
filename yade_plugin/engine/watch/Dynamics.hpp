// SPDX-License-Identifier: GPL-2.0-or-later
// Stiffness and masses of a scene, as matrices.
#pragma once
#include "engine/bodies/BodyStep.hpp"
#include "engine/store/SceneStore.hpp"
#include "engine/units/Zones.hpp"
#include <Eigen/SparseCore>
#include <map>

namespace masonry {

// Columns are the axes about which the rotations of a rigid body count.
inline yade::Matrix3r ownAxes(const yade::State& s) {
    return rotationRestrained(s) ? yade::Matrix3r(yade::Matrix3r::Identity()) : s.ori.toRotationMatrix();
}

// Stiffness over mass of a scene: the operator S^T K S with S = sqrt(1 / M). Where masses of deformable units are
// scaled, S = sqrt(1 / M) (Q + (I - Q) / sqrt(1 + s)), in which Q projects on the rigid motions of the blocks, and a
// further part for those of cracked bricks: then S S^T is the inverse of the scaled masses (blocks/BlockLanes.hpp). The
// degrees of freedom are three of every node and six of every rigid body that has a joint; those that are blocked are
// left out. Damping divides every damped mass by 1 + alpha. The two parts of every brick that can crack move against
// each other: bricks do crack during a run, whose time step stays, and one that moves as a whole has no higher
// eigenvalues, because its masses are larger.
class Dynamics {
public:
    enum Damping { Each, AsIfAllWereDamped }; // by its own alpha, or by the largest
    // A testing machine that is not engaged yet has no force; a time step must be stable with it, too.
    enum Machines { All, Engaged };
    Dynamics(SceneStore&, Damping, Machines = All);

    // The largest eigenvalue, at most 2.1 % above it [1/s²].
    double highest() const;
    // The two bodies whose joint has most of the elastic energy of the highest mode, or twice the body of the unit that
    // has.
    std::pair<int, int> stiffest() const;
    // Of every rigid body while all others are held, by its id [1/s²].
    std::map<int, double> highestAlone() const;

    // Of a degree of freedom: sqrt(1 / mass), 0 where it is blocked.
    const std::vector<double>& scale() const { return scale_; }
    // The stiffness between degrees of freedom, multiplied by the scale of both [1/s²].
    const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix() const { return matrix_; }
    // First degree of freedom of every rigid body, about the axes that ownAxes() gives; those of nodes come before.
    const std::map<int, int>& firstOfBody() const { return firstOfBody_; }
    // Multiplies a motion, divided by the scale, by the scaled masses over those of the scale.
    void scaleMasses(Eigen::VectorXd&) const;

private:
    // A joint between rigid bodies, one subcontact of a joint with a deformable side, a connector or a testing machine.
    struct Part {
        std::vector<int> degrees; // the degrees of freedom on which it acts
        Eigen::MatrixXd stiffness;
        int body1, body2;
    };
    struct Scaled { // a block whose masses are scaled
        Zones::Block block;
        std::vector<int> degrees, rows; // degrees of freedom that can move, and their rows among those of the block
        std::vector<double> roots;      // of their masses
        // Rigid motions of the block, and of its parts if they move against each other, times the roots of the masses:
        // orthonormal columns.
        Eigen::MatrixXd whole, parts;
        Eigen::MatrixXd moving(const Eigen::MatrixXd& motions) const; // such columns of these motions
    };
    void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
    void slow(Eigen::VectorXd& x) const; // multiplies by what stands beside sqrt(1 / M)
    std::vector<bool> moves() const;
    void addDegree(double mass, double damping, bool blocked) {
        scale_.push_back(blocked ? 0 : std::sqrt(1 / mass));
        damping_.push_back(damping);
    }
    bool hasMachine(const Load&) const;
    void addBody(int id, const char* holder);
    void addBodies(const JointView&);
    void splitDamping(Damping);
    template <class F> void eachPartOf(const JointView&, F&& visit) const;
    struct Spring { // between points of two bodies, in the reference state
        int bodies[2];
        Vector3r points[2], stiffness, rotationalStiffness;
    };
    Part partOf(const Spring&) const;
    template <class F> void eachPart(F&& visit) const;
    void assemble();
    void addBlocks();

    SceneStore& store_;
    Machines machines_;
    std::vector<double> scale_, damping_; // of a degree of freedom: sqrt(1 / mass), 0 where it is blocked; and alpha
    double common_ = 1;                   // a factor 1 + alpha of all that moves, which is not in `scale_`
    std::map<int, int> firstOfBody_;      // first degree of freedom of a rigid body
    Eigen::SparseMatrix<double, Eigen::RowMajor> matrix_; // stiffness, scaled from both sides
    std::vector<Scaled> blocks_;
    double slowness_ = 1, slownessOfParts_ = 1; // 1 / sqrt(1 + s), also of parts of a brick against each other
};

} // namespace masonry
