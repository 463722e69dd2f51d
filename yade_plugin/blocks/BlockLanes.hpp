// SPDX-License-Identifier: GPL-2.0-or-later
// Forces and motion of the nodes of several congruent blocks at a time (paper §2). A Row holds one number for each of
// `lanes` blocks, so that the vector units of the processor compute them together. Displacements, velocities and forces
// have three rows a node, row 3 n + d for node n and direction d.
#pragma once
#include "common/Vectorised.hpp"

namespace masonry {

// What congruent blocks have in common, as plain arrays: the stiffness matrix and the properties of the nodes. Nodes of
// plane units move in two directions only, `across` + 1 and `across` + 2 (modulo 3). Their rows of the third direction
// are neither read nor written, and their matrix stands in a second form, too: for every node i its neighbours j,
// itself included, with four numbers, the force at i in both directions under a displacement of j in the first of them,
// and so on: ff, fs, sf, ss with the first letter for the force.
struct BlockMatrix {
    // A row of the stiffness matrix: its degree of freedom, which is 3 n + d, and where its entries begin and end.
    struct Entries {
        int degree, first, beyond;
    };
    const double* nodes;     // places of the nodes [m], three numbers a node
    const double* gradients; // mean gradients of the shape functions [1/m], three numbers a node
    const double* masses;    // of the nodes [kg]
    const double* values;    // entries of the stiffness matrix [N/m]
    const Entries* rows;
    const int* columns; // degree of freedom of the column of each entry
    int nodeCount, rowCount;
    int across = -1;                // the direction in which nodes of plane units are held; -1 of blocks in space
    const int* pairStart = nullptr; // where the neighbours of each node begin; one more entry ends the last list
    const int* pairNode = nullptr;
    const double* pairValues = nullptr; // four for each neighbour [N/m]
};

// What the motion of all nodes depends on in a step.
struct NodeMotion {
    double dt;              // time step [s]
    double damping;         // coefficient of damping, 0 to 1
    double gravity[3];      // [m/s²]
    bool combined;          // combined damping instead of the paper's local damping
    bool held[3];           // directions in which nodes do not move
    double massDamping = 0; // viscous [1/s]
};

// Sums over the nodes of each block, for the energy balance and the motion of the block. Forces belong to the middle of
// the step from the old to the new velocities, and the energy balance refers to that time: half of the work of damping
// has been done by then, with the old velocities, and the other half is pending.
struct NodeSums {
    Row kinetic;     // kinetic energy at the time of the forces [J]
    Row gravityWork; // work of the weight since the reference state, up to the time of the forces [J]
    Row damping;     // energy lost to damping with the old velocities [J]
    Row pending;     // energy lost to damping with the new velocities, which the next balance counts [J]
    Row moved[3];    // sum of mass times displacement in each direction [kg m]
};

// Adds two kinds of nodal forces [N] to `forces`: the elastic forces of the zones, and the forces that stand for a
// moment on each block (`moments`, three rows [N m]), which do the same work as the moment does on the rotation of the
// block. Also gives the rotation of each block (nine rows, the matrix row by row) and its elastic energy (one row [J]).
// `scratch` is working memory of six rows a node.
void addBlockForces(const BlockMatrix&, const Row* displacements, const Row* moments, Row* forces, Row* rotation,
                    Row* energy, Row* scratch);

// Advances velocities [m/s] and displacements [m] of the nodes by one step, paper eqs. (1) to (3), and sets the forces
// to zero for the next one. `lastForces` keeps the forces for combined damping. `present` is one for a block and zero
// for a lane that is not in use.
void moveBlocks(const BlockMatrix&, const NodeMotion&, const Row& present, Row* displacements, Row* velocities,
                Row* forces, Row* lastForces, NodeSums&);

} // namespace masonry
