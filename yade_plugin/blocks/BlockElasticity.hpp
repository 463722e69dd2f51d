// SPDX-License-Identifier: GPL-2.0-or-later
// Linear elasticity of a meshed block (paper §2): zones of constant strain and masses lumped at the nodes. Strains are
// small, in axes that turn with the block. Congruent blocks share one object, and the forces of several of them are
// computed at a time (BlockLanes.hpp).
#pragma once
#include "BlockLanes.hpp"
#include "BlockMesh.hpp"

namespace masonry {

using Matrix3 = Eigen::Matrix3d;

class BlockElasticity {
public:
    // Throws std::invalid_argument unless E > 0, -1 < nu < 0.5 and density > 0. `held` is the direction (0, 1 or 2) in
    // which no node can move, or -1. Normal stress in this direction is zero (plane stress), although the nodes are
    // held, and the block turns about it only. For a mesh of a plane unit it is the direction across its plane; its
    // zones are its triangles, as thick as the unit.
    BlockElasticity(BlockMesh mesh, double youngModulus, double poissonRatio, double density, int held = -1);

    const BlockMesh& mesh() const { return mesh_; }
    const std::vector<double>& masses() const { return masses_; } // of the nodes [kg]
    double mass() const { return mass_; }                         // of the block [kg]

    // Rotation of the block: the rotation in the polar decomposition of its mean deformation gradient. `displacements`
    // [m] has one entry a node.
    Matrix3 rotation(const Point* displacements) const;

    // Stress of a zone [Pa], in axes that turn with the block: along x, y and z before the block has turned.
    Matrix3 stress(int zone, const Point* displacements, const Matrix3& rotation) const;

    // Stiffness matrix of a zone in a block that has not turned [N/m]; row and column 3 i + j belong to node i of the
    // zone and direction j. A triangle has three nodes: what belongs to the fourth is zero.
    Eigen::Matrix<double, 12, 12> stiffness(int zone) const;

    // The same for the functions of BlockLanes.hpp. It points into this object.
    BlockMatrix matrix() const;

private:
    void addZone(const std::array<int, 4>& nodes, int corners, const std::array<Point, 4>& gradients, double volume,
                 double density);
    struct Zone {
        std::array<int, 4> nodes;       // of a triangle the fourth is the first again, with a gradient of zero
        std::array<Point, 4> gradients; // of the shape functions of its nodes [1/m]
        double volume;                  // [m³]
    };
    // Displacement of a node relative to the turned block, in axes that turn with the block [m]. The symmetric part of
    // its gradient is the strain.
    Point turnedBack(int node, const Point* displacements, const Matrix3& rotation) const {
        return rotation.transpose() * (mesh_.nodes[node] + displacements[node]) - mesh_.nodes[node];
    }
    Matrix3 stressOf(const Matrix3& gradient) const { // Hooke's law, paper §2
        return lambda_ * gradient.trace() * Matrix3::Identity() + shear_ * (gradient + gradient.transpose());
    }
    void assemble();
    void pair();

    BlockMesh mesh_;
    int held_; // direction in which no node can move, or -1
    std::vector<Zone> zones_;
    std::vector<double> masses_;
    std::vector<Point> meanGradients_; // of the shape function of each node, averaged over the block [1/m]
    double mass_ = 0;
    double lambda_ = 0, shear_ = 0;          // Lamé's constants [Pa]; lambda_ is reduced for plane stress
    std::vector<BlockMatrix::Entries> rows_; // of the stiffness matrix, without those of held directions
    std::vector<int> columns_;               // of the entries of the stiffness matrix that are not zero, row by row
    std::vector<double> values_;             // of these entries [N/m]
    // Of plane units: the same matrix in blocks of four for every pair of nodes, see BlockMatrix.
    std::vector<int> pairStart_, pairNode_;
    std::vector<double> pairValues_;
};

} // namespace masonry
