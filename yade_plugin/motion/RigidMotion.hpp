// A step of many rigid blocks with restrained rotation, column by column for the vector units: the equations of paper
// eqs. (1)-(3), and of the energies that belong to them, as the host's integrator has them.
#pragma once

namespace masonry {

struct RigidMotion { // of some blocks, as scratch in the innermost cache
    static constexpr int most = 64;
    struct Around {
        double dt, gravity[3];
        bool combined; // kind of damping
    };
    double mass[most], inertia[3][most]; // inertia about the global axes
    double alpha[most];                  // damping constant
    double free[6][most];                // 0 where a translation or rotation is blocked
    double force[6][most];               // force and torque
    double velocity[6][most];            // and angular velocity; brought to the end of the step
    double orientation[4][most];         // w, x, y, z; brought to the end of the step
    double last[6][most];                // force per mass of the step before, for combined damping
    double kinetic[most];                // out [J]
    double work[most], damped[2][most];  // out [J]: of prescribed motions; of damping, by the velocity before and after

    // `axes`: bits of the translations and rotations in which anything is free or moves.
    void advance(int n, const Around&, unsigned axes);

private:
    static void push(int n, const Around&, double gravity, const double* inert, const double* alpha, const double* free,
                     const double* force, double* velocity, double* last, double* kinetic, double* work,
                     double* damped0, double* damped1);
    static void turn(int n, double dt, const double* x, const double* y, const double* z, double* q0, double* q1,
                     double* q2, double* q3);
};

} // namespace masonry
