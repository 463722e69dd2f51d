// SPDX-License-Identifier: GPL-2.0-or-later
// The arithmetic of many joints between their blocks and the law, in columns: displacement jumps from the places of the
// blocks, and forces on the blocks from the stresses. The functions are called in the order align, then for each
// subcontact jump, the law and pull, then finish. Columns begin at the first of `n` joints and never overlap, except
// that orientations, positions and displacements are those of all bodies or nodes.
//
// Each body carries the joint's axes along with it. The mean of the two rotations is the frame of the joint; the
// rotation `half` leads from that frame to the axes carried by body 2, and its inverse to those carried by body 1. With
// d from centre to centre and a from the centre of body 1 to the subcontact, both in the reference state, and `between`
// the present vector from centre to centre, the jump in the joint's frame is
//     between - half d + (half - half^T) a,
// where half - half^T = 4 w [v ×] for the unit quaternion (w, v). Forces act at the middle of the jump.
#pragma once

namespace masonry {

// Scratch of a batch of joints, small enough for the innermost cache. A column has one number for each joint. Vectors
// without another remark are in the joint's frame.
struct alignas(64) JointFrames {
    static constexpr int most = 32; // largest number of joints in a batch
    double axes[9][most];           // matrix whose columns are the frame's normal and tangents, row by row;
                                    // in a planar run 0 and 1 hold cosine and sine of the frame's angle
    double v[3][most];              // vector part of the unit quaternion `half`; in a planar run only 2 is used
    double w[most];                 // its scalar part
    double between[3][most];        // from centre to centre, global axes [m]
    double common[3][most];         // part of the jump that is the same at all subcontacts [m]
    double middle[3][most];         // of intact joints the jump at the middle of the face [m],
    double turn[3][most];           // and its change over the face [-]: the cross product with the way from the middle
    double step[3][most];           // change of the present subcontact's jump in this step, for the law [m]
    double normalStress[most];      // at the present subcontact, from the law [Pa]
    double arm[3][most];            // of the present subcontact's force, from the centre of block 1 [m]
    double force[3][most];          // on block 1, sum over the subcontacts [N]
    double torque[3][most];         // about the centre of block 1, sum over the subcontacts; of joints with deformable
                                    // sides the moment of jumps and forces [N m]
};

// For planar runs: cosine and sine of half the angle by which each of `n` bodies has turned about y, from the
// orientations `q` and the inverse reference orientations `r`. Returns the largest part of a rotation that is not about
// y: the sum of the sizes of the quaternion's x and z.
double turnsInPlane(int n, const double* const* q, const double* const* r, double* cosine, double* sine);

// Intact joints between rigid blocks, whose stresses are the stiffness times the jumps (see BatchStep).
struct IntactFaces {          // columns that begin at the first joint
    const double* middle[3];  // of a face, from the centre of block 1 in the reference state [m]
    const double* area;       // [m²]
    const double* inertia[3]; // second moments about the middle: along the first tangent, the second, and mixed [m⁴]
    double normal, shear;     // stiffnesses [Pa/m]
};
// The openings at a subcontact with the offsets a1 and a2; in `step`.
void openIntact(int n, const IntactFaces&, const double* a1, const double* a2, JointFrames&);
// Keeps `middle` and `turn` in six columns.
void keepIntact(int n, const JointFrames&, double* const* jumps);
// The same, and adds `times` the change of the jumps in this step to `middle` and `turn`, so that the stresses of
// damping come to those of the law. `damped` are the columns of what was added in the step before, which is replaced.
// Returns the energy taken [J].
double dampIntact(int n, const IntactFaces&, double times, double* const* jumps, double* const* damped, JointFrames&);

// How many numbers what a joint and a subcontact bring has: in space force on block 1 [N] and torques about the centres
// of both blocks [N m], and a force; in a planar run force x and z and the torques about y, and a force x and z.
constexpr int numbersOfJoint(bool plane) { return plane ? 4 : 9; }
constexpr int numbersOfPoint(bool plane) { return plane ? 2 : 3; }

// The arithmetic in space, and that of planar runs, in which nothing leaves planes y = constant. There a place or force
// is the complex number z + ix, and a rotation about y is a multiplication by a complex number: `position` holds z and
// x, and quaternions are cosine and sine of half angles. The angle of a joint's frame is counted from normal z and
// tangent x. What points out of the plane is not read.
//
// The arguments are:
// - `turn`: quaternions of the blocks; `f1`, `f2`: quaternions of the joints' axes in each block
// - `span`: vector d from centre to centre in the reference state, in the joints' axes [m]
// - `a0`, `a1`, `a2`: offset a of the present subcontact [m]; `j0`, `j1`, `j2`: its jump [m], which is brought up to
//   date
// - `area` [m²] and the stresses of the present subcontact [Pa]
template <bool plane> struct JointArithmetic {
    static constexpr int perJoint = numbersOfJoint(plane), perPoint = numbersOfPoint(plane);

    // Joints between rigid blocks.
    static void alignRigid(int n, const int* body1, const int* body2, const double* const* position,
                           const double* const* turn, const double* const* f1, const double* const* f2,
                           const double* const* span, JointFrames&);
    static void jumpRigid(int n, const double* a0, const double* a1, const double* a2, double* j0, double* j1,
                          double* j2, JointFrames&);
    static void pullRigid(int n, const double* area, const double* normal, const double* shearA, const double* shearB,
                          const double* a0, const double* a1, JointFrames&);
    static void finishRigid(int n, const JointFrames&, double* onJoints);

    // Intact ones, in the order align, spreadIntact, then for some subcontacts jumpIntact or openIntact, then
    // dampIntact and pullIntact, then finish. spreadIntact fills `middle` and `turn`, jumpIntact the jumps at a
    // subcontact in `step`, and pullIntact force and torque on block 1.
    static void spreadIntact(int n, const IntactFaces&, JointFrames&);
    static void jumpIntact(int n, const IntactFaces&, const double* a1, const double* a2, JointFrames&);
    static void pullIntact(int n, const IntactFaces&, JointFrames&);

    // Joints with a deformable side, whose subcontacts move by displacements `u` [m]. `place1` and `place2` say where
    // in `u` the two sides of the present subcontact stand, with components `lanes` numbers apart. `onPoints` receives
    // the force on side 1, global axes [N]; of `onJoints` only the moments on the rotations of both blocks are set.
    static void alignNodal(int n, const int* body1, const int* body2, const double* const* turn,
                           const double* const* f1, const double* const* f2, JointFrames&);
    static void jumpNodal(int n, const int* place1, const int* place2, const double* u, double* j0, double* j1,
                          double* j2, JointFrames&);
    static void pullNodal(int n, const double* area, const double* normal, const double* shearA, const double* shearB,
                          const double* j0, const double* j1, const double* j2, JointFrames&, double* onPoints);
    static void finishNodal(int n, const JointFrames&, double* onJoints);
};

} // namespace masonry
