// SPDX-License-Identifier: GPL-2.0-or-later
// A step of many rigid blocks in columns for the vector units: paper eqs. (1) to (3), and the energies that belong to
// them. A block with a blocked rotation turns about the global axes. A block that turns in space has none.
#pragma once
#include <vector>

namespace masonry {

// State of all bodies of a scene. The row of a body is its id.
struct RigidColumns {
    std::vector<double> position[3];    // [m]
    std::vector<double> orientation[4]; // w, x, y, z
    std::vector<double> velocity[6];    // velocity [m/s], then angular velocity [1/s]
    std::vector<double> mass;           // [kg]
    std::vector<double> inertia[3];     // about the global axes, of a body that turns in space about its own [kg m²]

    void resize(int count);
};

// Input, output and scratch of a step of bodies with neighbouring ids, small enough for the innermost cache.
struct RigidMotion {
    static constexpr int most = 64; // largest number of bodies
    struct Around {
        double dt;         // time step [s]
        double gravity[3]; // [m/s²]
        bool combined;     // whether damping is combined or local
    };
    double alpha[most];       // input: damping constant of each body [-]
    double viscous[most];     // input: mass-proportional damping of each body [1/s]
    double free[6][most];     // input: 0 in blocked axes and for bodies that are not moved here, else 1
    double force[6][most];    // input: force [N] and torque [N m]; no torque on bodies that turn in space
    double inSpace[most]{};   // input: 1 for bodies that turn in space, else 0
    double torque[3][most];   // input: torque on bodies that turn in space [N m]
    double momentum[3][most]; // input and output: angular momentum of these bodies [kg m²/s]
    double kinetic[most];     // output: kinetic energy [J]
    double work[most];        // output: half of the work of prescribed motions in the step [J]
    double damped[2][most];   // output: energy taken by damping with the velocity before and after the step [J]

    // Makes a step of bodies `first` to `first + n - 1`. `last` holds their force per mass [m/s²] and torque per
    // inertia [1/s²] of the step before, and receives those of this step; local damping does not use them. `axes` has
    // one bit for each translation and rotation in which any of the bodies is free or has a velocity; the others are
    // left out.
    void advance(RigidColumns&, double* const* last, int first, int n, const Around&, unsigned axes);

private:
    struct Axis { // columns of one translation or rotation; `inert` is the mass or the inertia
        const double *inert, *free, *force;
        double *velocity, *last;
    };
    double steady_[most]; // scratch: see meanOverStep()

    void push(int n, const Axis&, const Around&, double gravity);
    static void move(int n, double dt, const double* velocity, double* position);
    void turn(int n, double dt, const double* const* spin, double* const* orientation) const;
    struct InSpace { // columns of the bodies that turn in space; `last` are torques per inertia
        const double* inertia[3];
        double *orientation[4], *spin[3], *last[3];
    };
    void pushInSpace(int n, const InSpace&, const Around&);
    void turnInSpace(int n, const InSpace&, double dt);
};

} // namespace masonry
