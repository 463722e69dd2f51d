// SPDX-License-Identifier: GPL-2.0-or-later
// Forces and motion of the nodes of several congruent blocks at a time (paper §2). A Row holds one number for each of
// `lanes` blocks. Displacements, velocities and forces have three rows a node, row 3 n + d for node n and direction d.
#pragma once
#include "common/Vectorised.hpp"

namespace masonry {

// What congruent blocks have in common: the stiffness matrix and the properties of the nodes. Nodes of plane units move
// in two directions only, `across` + 1 and `across` + 2 (modulo 3). Their rows of the third direction are neither read
// nor written, and their matrix stands in a second form, too: for every node i and its neighbours j, itself included,
// the force at i in both directions under a displacement of j in either: ff, fs, sf, ss with the first letter for the
// force.
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

// Sums over the nodes of each block. Forces belong to the middle of the step from the old to the new velocities, and so
// does the energy balance: half of the work of damping has been done by then, with the old velocities, and the other
// half is pending.
struct NodeSums {
    Row kinetic;     // kinetic energy at the time of the forces [J]
    Row gravityWork; // work of the weight since the reference state, up to the time of the forces [J]
    Row damping;     // energy lost to damping with the old velocities [J]
    Row pending;     // energy lost to damping with the new velocities, which the next balance counts [J]
    Row moved[3];    // sum of mass times displacement in each direction [kg m]
};

// Adds nodal forces [N] to `forces`: the elastic ones of the zones, and those that do the same work as a moment on each
// block (`moments`, three rows [N m]) does on the rotation of the block. Also gives the rotation of each block (nine
// rows, the matrix row by row) and its elastic energy (one row [J]). `scratch` has six rows a node.
void addBlockForces(const BlockMatrix&, const Row* displacements, const Row* moments, Row* forces, Row* rotation,
                    Row* energy, Row* scratch);

// Units of one kind, one in each lane, and what a step does to them.
struct LaneUnits {
    BlockMatrix matrix;
    Row present; // one for a unit, zero for a lane that is not in use
    Row *displacements, *velocities, *forces;
    Row* lastForces; // for combined damping
    Row offset[3];   // from the centre of the first unit of a block to that of this one in the reference state [m]
    NodeSums sums;
};

// Advances velocities [m/s] and displacements [m] of the nodes by one step, paper eqs. (1) to (3), and sets the forces
// to zero for the next one.
void moveBlocks(const NodeMotion&, LaneUnits&);

// Share of the scaling that the rigid motion of the two parts of a cracked brick against each other has. Crack surfaces
// that are ten times as stiff as mortar do not set the time step then, whatever the scaling.
constexpr double sharedScaling = 0.2;

// As moveBlocks(), with masses that are scaled selectively: M* = M + s (M - M R (R^T M R)^-1 R^T M) in place of the
// lumped masses M, where R are the rigid motions of a block about its present centre of mass and s is `scaling`. So a
// rigid motion of a block has its true inertia, and deformation is slower. With the accelerations a = M^-1 f and their
// rigid part P a, which has the same momentum and spin, those with M* are P a + (a - P a) / (1 + s). (After L.
// Olovsson, K. Simonsson, M. Unosson, Selective mass scaling for explicit finite element analyses, International
// Journal for Numerical Methods in Engineering 63, 2005, doi 10.1002/nme.1293; rigid motions of a whole block, not of
// an element, are a choice of this plugin.)
//
// A block is one unit, or the two units of a brick that may crack: `count` units side by side in a lane. Two units are
// one block where `whole` is one. Where it is zero they have cracked apart: the motion of one rigid unit against the
// other then has 1 + sharedScaling s times its inertia, while the brick as a whole keeps its own. Otherwise the springs
// between its parts, which are stiffer than mortar, would set the time step.
//
// Damping acts on the rigid motion of blocks and on the rest, each for itself: as moveBlocks() would on masses M under
// the rigid part of the forces, and on masses (1 + s) M under the rest. What it takes at a node is then projected on
// its part. The parts are orthogonal under both masses, and a projection makes nothing larger, so damping takes energy
// in every step and reverses no part of the motion. On the forces of the nodes as they are it would make of the slow
// vibration of blocks a friction on their rigid motion. Viscous damping is in proportion to M*. The kinetic energy is
// that of M*; what belongs to two units stands in the sums of the first. `scratch` has nine rows a node of all units.
void moveScaled(const NodeMotion&, double scaling, LaneUnits* units, int count, const Row& whole, Row* scratch);

} // namespace masonry
