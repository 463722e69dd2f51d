// Linear elasticity of a meshed block, paper §2: constant-strain zones, lumped masses, small strains in axes that turn
// with the block. Congruent blocks share one, and their forces are computed several blocks at a time.
#pragma once
#include "BlockLanes.hpp"
#include "BlockMesh.hpp"

namespace masonry {

using Matrix3 = Eigen::Matrix3d;

class BlockElasticity {
public:
    // Throws std::invalid_argument with what is wrong with the constants (E > 0, -1 < nu < 0.5, density > 0).
    // `held` is the one direction in which all nodes are held, or -1: it is kept free of stress, not of strain (plane
    // stress), and the block turns about it only.
    BlockElasticity(BlockMesh mesh, double youngModulus, double poissonRatio, double density, int held = -1);

    const BlockMesh& mesh() const { return mesh_; }
    const std::vector<double>& masses() const { return masses_; } // [kg] of the nodes
    double mass() const { return mass_; }

    // Rotation of the block: the polar part of its mean deformation gradient, from displacements of all nodes.
    Matrix3 rotation(const Point* displacements) const;

    // Stress of a zone [Pa], in the axes turned back by the rotation.
    Matrix3 stress(int zone, const Point* displacements, const Matrix3& rotation) const;

    // Stiffness matrix of a zone without rotation, nodes x 3 [N/m].
    Eigen::Matrix<double, 12, 12> stiffness(int zone) const;

    // For the loops over blocks side by side; lives as long as this.
    BlockMatrix matrix() const;

private:
    struct Zone {
        std::array<int, 4> nodes;
        std::array<Point, 4> gradients; // of the shape functions [1/m]
        double volume;
    };
    // Displacement of a node in axes that turn with the block; its symmetric gradient is the strain.
    Point turnedBack(int node, const Point* displacements, const Matrix3& rotation) const {
        return rotation.transpose() * (mesh_.nodes[node] + displacements[node]) - mesh_.nodes[node];
    }
    Matrix3 stressOf(const Matrix3& gradient) const { // Hooke's law, paper §2
        return lambda_ * gradient.trace() * Matrix3::Identity() + shear_ * (gradient + gradient.transpose());
    }
    void assemble(int held);

    BlockMesh mesh_;
    std::vector<Zone> zones_;
    std::vector<double> masses_;
    std::vector<Point> meanGradients_; // volume-averaged, per node
    double mass_ = 0, lambda_ = 0, shear_ = 0;
    std::vector<BlockMatrix::Entries> rows_; // of the degrees that are not held
    std::vector<int> columns_;
    std::vector<double> values_;
};

} // namespace masonry
