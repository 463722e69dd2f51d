// What many joints do between their blocks and the law, column by column for the vector units: displacement jumps from
// the places of the blocks, and forces on the blocks from stresses. The equations are those of
// MasonryJointGeom::update; columns start at the first of `n` joints, and never overlap.
#pragma once

namespace masonry {

struct JointFrames { // of some joints, as scratch in the innermost cache
    static constexpr int most = 32;
    double axes[9][most];       // normal and tangents as columns, row by row: turned with the mean of both blocks
    double v[3][most], w[most]; // the half turn from that mean to block 2, as a quaternion
    double between[3][most];    // from centre to centre
    double common[3][most];     // of the jumps of all points
    double step[3][most];       // change of the jump, for the law
    double normalStress[most];  // from the law
    double arm[3][most];        // of a point's force, from the centre of block 1
    double force[3][most], torque[3][most]; // on block 1, sums over the points
};

// Turns of bodies from their reference orientations as rotations about y: cosine and sine of half angles, from the
// orientations `q` and the inverse reference orientations `r`. Gives how far the turns are from that, at most.
double turnsInPlane(int n, const double* const* q, const double* const* r, double* cosine, double* sine);

// Joints between rigid blocks. `turn` and `f1`, `f2`: quaternions of the blocks and of the joints' axes in each block;
// `span`: from centre to centre in the reference state, in the joints' axes; `a`: a point's offset from the centre of
// block 1 there. `onJoints`: per joint 9 numbers, force on block 1 and torques on both.
void alignRigid(int n, const int* body1, const int* body2, const double* const* position, const double* const* turn,
                const double* const* f1, const double* const* f2, const double* const* span, JointFrames&);
void jumpRigid(int n, const double* a0, const double* a1, const double* a2, double* j0, double* j1, double* j2,
               JointFrames&);
void pullRigid(int n, const double* area, const double* normal, const double* shearA, const double* shearB,
               JointFrames&);
void finishRigid(int n, const JointFrames&, double* onJoints);

// Joints with points that move by the displacements `u` at their places in the rows of MasonryZones. `onPoints`: per
// point the force on side 1; of `onJoints` the moments on the rotation of each block are filled in.
void alignNodal(int n, const int* body1, const int* body2, const double* const* turn, const double* const* f1,
                const double* const* f2, JointFrames&);
void jumpNodal(int n, const int* place1, const int* place2, const double* u, double* j0, double* j1, double* j2,
               JointFrames&);
void pullNodal(int n, const double* area, const double* normal, const double* shearA, const double* shearB,
               const double* j0, const double* j1, const double* j2, JointFrames&, double* onPoints);
void finishNodal(int n, const JointFrames&, double* onJoints);

// The same where nothing leaves planes y = constant: places and forces are complex numbers z + ix, which a rotation
// about y multiplies. `position` is z, x; `turn`, `f1`, `f2` are cosine and sine of half angles, and the joints' axes
// are turned from normal z and tangent x. Per joint `onJoints` has 4 numbers, force x, z on block 1 and the torques
// about y on both; `onPoints` has x, z.
void alignRigidInPlane(int n, const int* body1, const int* body2, const double* const* position,
                       const double* const* turn, const double* const* f1, const double* const* f2,
                       const double* const* span, JointFrames&);
void jumpRigidInPlane(int n, const double* a0, const double* a1, double* j0, double* j1, JointFrames&);
void pullRigidInPlane(int n, const double* area, const double* normal, const double* shear, const double* a0,
                      const double* a1, JointFrames&);
void finishRigidInPlane(int n, const JointFrames&, double* onJoints);
void alignNodalInPlane(int n, const int* body1, const int* body2, const double* const* turn, const double* const* f1,
                       const double* const* f2, JointFrames&);
void jumpNodalInPlane(int n, const int* place1, const int* place2, const double* u, double* j0, double* j1,
                      JointFrames&);
void pullNodalInPlane(int n, const double* area, const double* normal, const double* shear, const double* j0,
                      const double* j1, JointFrames&, double* onPoints);
void finishNodalInPlane(int n, const JointFrames&, double* onJoints);

} // namespace masonry
