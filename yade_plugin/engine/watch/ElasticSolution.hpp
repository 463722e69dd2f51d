// SPDX-License-Identifier: GPL-2.0-or-later
// The equilibrium of a scene whose joints, connectors and units are as elastic as in the beginning.
#pragma once
#include "Dynamics.hpp"
#include <Eigen/SparseCholesky>

namespace masonry {

// The Cholesky factors of the stiffness matrix of the present scene.
class ElasticSolution {
public:
    // Throws std::invalid_argument if something can move without resistance.
    ElasticSolution();

    // Moves all bodies and nodes to where the forces of the last step would be in equilibrium, while drives hold. That
    // step must have been so short that nothing has moved since. Returns the square root of what the forces that were
    // not in equilibrium do in this motion [J^(1/2)]. A second move corrects what was not linear in the first.
    //
    // The mean of these forces before and after a move does work that counts as taken by damping; the forces after it
    // are known in the next move. In the first move loads grow, and do half of their work only.
    double move();

    // Finds the first mode along a direction, while drives hold: that which a sudden uniform acceleration gives most
    // momentum. Its modal mass is 1. Returns the square of its angular frequency [1/s²], 0 if there is none.
    double findMode(const Vector3r& direction);
    // Momentum of the mode along that direction per its velocity [kg^(1/2)].
    double participation() const { return participation_; }
    // Moves all along the mode [m kg^(1/2)], without work.
    void displace(double amount);
    // Force of the last step along the mode, in whose direction it does work [N/kg^(1/2)].
    double force() const;

private:
    using Vector = Eigen::VectorXd;
    Vector displacements(const Vector& moved) const;
    void moveBy(const Vector& displacements);
    Vector ordered(const Vector& all) const;
    Vector spread(const Vector& ordered) const;
    Vector imbalance() const;
    Vector alongDrive(const Load&) const;
    Vector motionUnder(const Vector& forces) const;
    Vector inertia(const Vector& motion) const;

    SceneStore& scene_;
    Dynamics dynamics_;
    Eigen::Map<const Vector> scale_;
    std::vector<int> places_; // of every degree of freedom in the factors; -1 where it is blocked
    int count_ = 0;           // of those that can move
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> factors_;
    bool first_ = true;
    Vector moved_; // the last move
    Vector mode_;  // displacements divided by the scale
    double participation_ = 0;
};

} // namespace masonry
