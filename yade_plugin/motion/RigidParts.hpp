// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies that are the two halves of other, rigid bodies, in columns for the vector units: their places and velocities,
// and what the halves transfer to each other.
#pragma once

namespace masonry {

// For each of `n` parts, from the body that it is a part of:
// - `position`, `orientation`, `velocity`: of the body, after a step, as in RigidColumns
// - `local` [m] and `turned`: centre and orientation of the part in the axes of the body
// - `arm`: from the centre of the body to that of the part, global axes [m]: that before the step comes in, that after
//   it goes out
// - `to`: receives position, orientation and velocity of the part: 3, 4 and 6 columns
// A part has the mean velocity of its centre in the step, that at the middle of the turn. The momenta of all parts then
// add up to that of the body.
void placeParts(int n, const double* const* position, const double* const* orientation, const double* const* velocity,
                const double* const* local, const double* const* turned, double* const* arm, double* const* to);

// Force and moment that half 2 of a body exerts on half 1, where rotations about some of the global axes are blocked:
// what half 1 lacks to move as the body does, without damping and gravity, which are in proportion to mass. In axes
// that are blocked half 1 is held by itself, and the halves transfer nothing.
struct HalfForces {
    const double *mass, *inertia[3], *spin[3], *orientation[4]; // of the body; inertia about the global axes
    const double *force[6], *free[6]; // on the body: force [N] and torque [N m]; 1 where it is free, 0 where blocked
    const double *mass1, *inertia1[3], *arm1[3]; // of half 1, with the vector from the body's centre to its own [m]
    const double *force1[3], *torque1[3];        // on half 1, without what is found here, about its centre
    const double* face[4];                       // the axes in which the results are, in the axes of the body
    const double* middle[3];                     // from the centre of half 1 to the point of the moment, in these axes
    double *resultForce[3], *resultMoment[3];    // receive force [N] and moment [N m] on half 1
};
void findHalfForces(int n, const HalfForces&);

// Turns a vector into axes that a unit quaternion has turned.
void turnInto(double w, double x, double y, double z, double (&vector)[3]);

// Whether stresses that are linear over a face may lie outside a box. Axes are the normal of the face and two tangents.
struct FaceStresses {
    const double *force[3], *moment[3]; // on the face, the moment about its middle
    const double* perArea;              // 1 over its area [1/m²]
    const double *bend[3], *twist; // inverse second moments of area: zz, yz, yy of bending, and of torsion [1/m⁴]
    const double* reach[2];        // largest distances |y|, |z| from the middle along the tangents [m]
    const double* box[3];          // least and largest normal stress, and largest shear stress [Pa]
    unsigned char* outside;        // receives the answer
};
void compareWithBox(int n, const FaceStresses&);

} // namespace masonry
