// Inner loops over congruent blocks that stand side by side in rows [node][direction], paper §2.
#pragma once
#include "common/Vectorised.hpp"

namespace masonry {

struct BlockMatrix { // of a block, as plain arrays
    struct Entries { // of a row of the stiffness matrix
        int degree, first, beyond;
    };
    const double *nodes, *gradients, *masses, *values;
    const Entries* rows;
    const int* columns;
    int nodeCount, rowCount;
};

struct NodeMotion { // what moves the nodes in a step
    double dt, damping, gravity[3];
    bool combined, held[3];
};

struct NodeSums { // over the nodes of each block
    Row kinetic, gravityWork, damping, pending, moved[3];
};

// Adds the zones' forces [N], and those that do the work of a moment [N m] (three rows) on the block's rotation. Gives
// each block's rotation, row by row, and elastic energy [J]. `scratch` has six rows a node.
void addBlockForces(const BlockMatrix&, const Row* displacements, const Row* moments, Row* forces, Row* rotation,
                    Row* energy, Row* scratch);

// Eqs. (1)-(3): takes velocities and displacements on by a step and uses up the forces. `present` is one for a block
// and zero for an empty place.
void moveBlocks(const BlockMatrix&, const NodeMotion&, const Row& present, Row* displacements, Row* velocities,
                Row* forces, Row* lastForces, NodeSums&);

} // namespace masonry
