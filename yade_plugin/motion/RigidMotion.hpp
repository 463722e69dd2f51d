// A step of many rigid blocks with restrained rotation, column by column for the vector units: paper eqs. (1) to (3),
// and the energies that belong to them.
#pragma once
#include <vector>

namespace masonry {

struct RigidColumns {                   // of all bodies
    std::vector<double> position[3];    // [m]
    std::vector<double> orientation[4]; // w, x, y, z
    std::vector<double> velocity[6];    // velocity [m/s] and angular velocity [1/s]
    std::vector<double> mass;           // [kg]
    std::vector<double> inertia[3];     // about the global axes [kg m²]

    void resize(int count);
};

struct RigidMotion { // of some bodies that stand beside each other, with what a step needs in the innermost cache
    static constexpr int most = 64;
    struct Around {
        double dt;
        double gravity[3];
        bool combined; // kind of damping
    };
    double alpha[most];     // damping constant
    double free[6][most];   // 0 where a translation or rotation is blocked, or the body is moved elsewhere
    double force[6][most];  // force and torque
    double kinetic[most];   // out [J]
    double work[most];      // out: half the work of prescribed motions in the step [J]
    double damped[2][most]; // out: taken by damping, by the velocity before and after [J]

    // Takes bodies first..first+n on by a step. `last`: of these bodies, force per mass and torque per inertia in the
    // step before, for combined damping. `axes`: bits of the translations and rotations in which anything is free or
    // moves.
    void advance(RigidColumns&, double* const* last, int first, int n, const Around&, unsigned axes);

private:
    struct Axis { // one degree of freedom of the bodies
        const double *inert, *alpha, *free, *force;
        double *velocity, *last;
    };
    void push(int n, const Axis&, const Around&, double gravity);
    static void move(int n, double dt, const double* velocity, double* position);
    static void turn(int n, double dt, const double* const* spin, double* const* orientation);
};

} // namespace masonry
