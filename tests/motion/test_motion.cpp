// SPDX-License-Identifier: GPL-2.0-or-later
// Pure kinematics: damping, the energy ledger, a step of rigid bodies, frames and jumps of joints, and the largest
// eigenvalue. Expected numbers come from closed forms and from a reference that is written with Eigen's rotations.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "../within.hpp"
#include "common/Vectorised.hpp"
#include "motion/Damping.hpp"
#include "motion/EnergyLedger.hpp"
#include "motion/JointFrames.hpp"
#include "motion/LargestEigenvalue.hpp"
#include "motion/RigidMotion.hpp"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

using namespace masonry;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Dice {
    std::mt19937 engine;
    explicit Dice(unsigned seed) : engine(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); }
    Vector3d vector(double size) { return size * Vector3d(between(-1, 1), between(-1, 1), between(-1, 1)); }
    Quaterniond rotation() {
        std::normal_distribution<> normal;
        return Quaterniond(normal(engine), normal(engine), normal(engine), normal(engine)).normalized();
    }
};

} // namespace

// ---- damping --------------------------------------------------------------------------------------------------------

TEST_CASE("local damping takes alpha |F| against the motion, and no more than what stops it") {
    const double reach = 0.8 * 5; // alpha |F| of a force of 5 N with alpha = 0.8
    CHECK(dampingTaken(100.0, reach, 0.0) == 4);
    CHECK(dampingTaken(-100.0, reach, 0.0) == -4);
    CHECK(dampingTaken(3.0, reach, 0.0) == 3); // 3 stops the motion in the middle of the step
    CHECK(dampingTaken(-3.0, reach, 0.0) == -3);
    CHECK(dampingTaken(0.0, reach, 0.0) == 0);
}

TEST_CASE("combined damping takes nothing of a force that grows along the motion and alpha |F| of one that falls") {
    const double reach = dampingShare(true) * 0.8 * 5;
    CHECK(dampingTaken(100.0, reach, 1.0) == 0);
    CHECK(dampingTaken(100.0, reach, 0.0) == 2); // half of alpha |F| while the force is steady
    CHECK(dampingTaken(100.0, reach, -1.0) == 4);
    CHECK(dampingTaken(-100.0, reach, 1.0) == -4); // against the motion, the force is the one that falls
    CHECK(dampingTaken(-100.0, reach, -1.0) == 0);
    CHECK(dampingTaken(1.0, reach, -1.0) == 1); // 1 stops the motion
    CHECK(dampingShare(false) == 1);
    CHECK(meanOverStep(0, 1e-3) == 0);
    CHECK(meanOverStep(4, 0.5) == 2); // viscous: 4 / (1 + 0.5 · 4 · 0.5)
}

TEST_CASE("damping never adds energy and never reverses a motion, whatever velocity, force and trend") {
    Dice dice(1);
    for (int n = 0; n < 10000; ++n) {
        const double middle = dice.between(-2, 2), reach = dice.between(0, 2);
        for (double trend : {-1.0, 0.0, 1.0}) {
            const double taken = dampingTaken(middle, reach, trend);
            CHECK(taken * middle >= 0);
            CHECK(std::abs(taken) <= std::abs(middle));
        }
    }
}

// ---- energies -------------------------------------------------------------------------------------------------------

TEST_CASE("a pending half of work is counted once, in the step after, and present energies are counted anew") {
    EnergyLedger ledger;
    ledger.beginStep();
    ledger.external += 3;
    ledger.pendingExternal += 5;
    ledger.damped += 0.5;
    ledger.pendingDamped += 0.25;
    ledger.kinetic += 7;
    ledger.fallen += 11;
    ledger.elastic += 13;
    CHECK(ledger.external == 3);
    CHECK(ledger.damped == 0.5);
    for (int step = 0; step < 2; ++step) { // the second one has nothing more to add
        ledger.beginStep();
        CHECK(ledger.external == 8);
        CHECK(ledger.damped == 0.75);
        CHECK(ledger.kinetic + ledger.fallen + ledger.elastic == 0);
        CHECK(ledger.pendingExternal + ledger.pendingDamped == 0);
    }
}

TEST_CASE("adding a ledger adds each of its entries to the same entry") {
    EnergyLedger sum{100, 200, 300, 400, 500, 600, 700};
    sum.add({1, 2, 4, 8, 16, 32, 64});
    const std::vector<double> found{sum.external, sum.damped, sum.pendingExternal, sum.pendingDamped,
                                    sum.kinetic,  sum.fallen, sum.elastic};
    CHECK(found == std::vector<double>{101, 202, 304, 408, 516, 632, 764});
}

// ---- a step of rigid bodies -----------------------------------------------------------------------------------------

namespace {

constexpr unsigned everyAxis = 0b111111;

// Bodies with their forces of the step before, which advance() wants in columns of its own.
struct Bodies {
    explicit Bodies(int count) : count(count) {
        columns.resize(count);
        std::fill(columns.orientation[0].begin(), columns.orientation[0].end(), 1.0);
        for (auto& column : earlier)
            column.assign(count, 0);
        for (int i = 0; i < RigidMotion::most; ++i) {
            motion.alpha[i] = motion.viscous[i] = 0;
            for (int d = 0; d < 6; ++d) {
                motion.free[d][i] = 1;
                motion.force[d][i] = 0;
            }
        }
    }
    void advance(const RigidMotion::Around& around, unsigned axes = everyAxis) {
        double* last[6];
        for (int d = 0; d < 6; ++d)
            last[d] = earlier[d].data();
        motion.advance(columns, last, 0, count, around, axes);
    }
    Quaterniond orientation(int i) const {
        return {columns.orientation[0][i], columns.orientation[1][i], columns.orientation[2][i],
                columns.orientation[3][i]};
    }

    int count;
    RigidColumns columns;
    RigidMotion motion;
    std::vector<double> earlier[6];
};

} // namespace

TEST_CASE("new rows of bodies stand still at the origin with mass and inertia of one") {
    RigidColumns columns;
    columns.resize(2);
    columns.mass[0] = 5;
    columns.resize(3);
    CHECK(columns.mass == std::vector<double>{5, 1, 1});
    const auto all = [](const auto& part, double value) {
        for (const auto& column : part)
            CHECK(column == std::vector<double>(3, value));
    };
    all(columns.inertia, 1), all(columns.position, 0), all(columns.velocity, 0);
}

TEST_CASE("after n steps of free fall the velocity is g n dt and the height g dt² n (n + 1) / 2") {
    Bodies bodies(1);
    bodies.columns.mass[0] = 17; // any mass falls alike
    const double dt = 1e-3, g = 9.81;
    const int steps = 500;
    for (int i = 0; i < steps; ++i)
        bodies.advance({dt, {0, 0, -g}, false});
    CHECK(bodies.columns.velocity[2][0] == within(-g * steps * dt, 1e-12));
    CHECK(bodies.columns.position[2][0] == within(-g * dt * dt * steps * (steps + 1) / 2, 1e-12));
    CHECK(bodies.columns.velocity[0][0] == 0);
    CHECK(bodies.columns.position[1][0] == 0);
}

TEST_CASE("a blocked axis keeps its velocity, and what drives it does work against force and weight") {
    Bodies bodies(1);
    const double dt = 1e-2, mass = 3, velocity = 0.2, force = 40, g = 9.81;
    bodies.columns.mass[0] = mass;
    bodies.columns.velocity[2][0] = velocity;
    bodies.motion.free[2][0] = 0;
    bodies.motion.force[2][0] = force;
    bodies.motion.alpha[0] = 0.8; // a prescribed motion is not damped
    bodies.motion.viscous[0] = 10;
    bodies.advance({dt, {0, 0, -g}, false});
    CHECK(bodies.columns.velocity[2][0] == velocity);
    CHECK(bodies.columns.position[2][0] == within(velocity * dt, 1e-14));
    // The force of 40 N pushes along the motion, so what holds the velocity does negative work; half of it belongs to
    // the velocity before the step, half to the one after.
    CHECK(bodies.motion.work[0] == within(-0.5 * dt * velocity * (force - mass * g), 1e-12));
    CHECK(bodies.motion.kinetic[0] == 0);
    CHECK(bodies.motion.damped[0][0] == 0);
    CHECK(bodies.motion.damped[1][0] == 0);
}

TEST_CASE("in every step of every body the kinetic energy changes by the work of its forces less what damping takes") {
    Dice dice(3);
    const int count = RigidMotion::most;
    const double dt = 1e-3, gravity[3] = {1, -2, -9.81};
    Bodies bodies(count);
    for (int i = 0; i < count; ++i) {
        bodies.columns.mass[i] = dice.between(0.1, 10);
        for (auto& column : bodies.columns.inertia)
            column[i] = dice.between(0.1, 10);
        for (auto& column : bodies.columns.velocity)
            column[i] = dice.between(-0.02, 0.02);
        bodies.motion.alpha[i] = dice.between(0, 0.9);
        bodies.motion.viscous[i] = dice.between(0, 50);
    }
    double taken = 0;
    for (int step = 0; step < 40; ++step) {
        for (auto& column : bodies.motion.force)
            for (double& force : column)
                force = dice.between(-30, 30);
        const auto before = bodies.columns;
        bodies.advance({dt, {gravity[0], gravity[1], gravity[2]}, step % 2 == 1});
        for (int i = 0; i < count; ++i) {
            double gained = 0, work = 0, kinetic = 0;
            for (int d = 0; d < 6; ++d) {
                const double m = d < 3 ? before.mass[i] : before.inertia[d - 3][i];
                const double v0 = before.velocity[d][i], v1 = bodies.columns.velocity[d][i];
                gained += 0.5 * m * (v1 * v1 - v0 * v0);
                work += 0.5 * dt * (v0 + v1) * (bodies.motion.force[d][i] + (d < 3 ? m * gravity[d] : 0));
                kinetic += 0.5 * m * v0 * v1;
            }
            const double damped = bodies.motion.damped[0][i] + bodies.motion.damped[1][i];
            CHECK(gained == doctest::Approx(work - damped).epsilon(1e-12));
            CHECK(bodies.motion.kinetic[i] == doctest::Approx(kinetic).epsilon(1e-12));
            CHECK(damped >= 0);
            taken += damped;
        }
    }
    CHECK(taken > 0.01); // damping was not idle
}

TEST_CASE("local damping takes alpha |F| of a moving body, combined damping nothing while the force grows") {
    for (bool combined : {false, true}) {
        Bodies bodies(1);
        const double dt = 1e-4, mass = 2, force = 6, alpha = 0.25, velocity = 1;
        bodies.columns.mass[0] = mass;
        bodies.columns.velocity[0][0] = velocity;
        bodies.motion.alpha[0] = alpha;
        bodies.motion.force[0][0] = force;
        bodies.advance({dt, {0, 0, 0}, combined});
        CHECK(bodies.columns.velocity[0][0] ==
              within(velocity + dt * force / mass * (combined ? 1 : 1 - alpha), 1e-14));
        CHECK(bodies.earlier[0][0] == force / mass); // what the next step compares with
        if (!combined) continue;
        const double now = bodies.columns.velocity[0][0];
        bodies.advance({dt, {0, 0, 0}, combined}); // the force is steady: half of alpha |F|
        CHECK(bodies.columns.velocity[0][0] == within(now + dt * force / mass * (1 - 0.5 * alpha), 1e-14));
    }
}

TEST_CASE("viscous damping takes its share of the mean velocity that local damping leaves") {
    // The step is v' = v + dt (a - alpha a - c (v + v') / 2), as v and a have the same sign.
    Bodies bodies(1);
    const double dt = 1e-2, velocity = 1, acceleration = 6, alpha = 0.25, c = 20;
    bodies.columns.velocity[0][0] = velocity;
    bodies.motion.alpha[0] = alpha;
    bodies.motion.viscous[0] = c;
    bodies.motion.force[0][0] = acceleration; // the mass is 1 kg
    bodies.advance({dt, {0, 0, 0}, false});
    const double expected = (velocity * (1 - 0.5 * c * dt) + dt * (1 - alpha) * acceleration) / (1 + 0.5 * c * dt);
    CHECK(bodies.columns.velocity[0][0] == within(expected, 1e-14));
}

TEST_CASE("a body that spins about any axis has turned by the angle of its spin, slow or fast") {
    Dice dice(4);
    const double dt = 1e-3;
    // Half an angle of 0.001 a step is where the series end; 3000 1/s turns by 3 rad in a step.
    for (double speed : {1e-6, 1.0, 1.99, 2.01, 62.0, 3000.0}) {
        Bodies bodies(1);
        const auto start = dice.rotation();
        const Vector3d axis = dice.vector(1).normalized();
        const double parts[4] = {start.w(), start.x(), start.y(), start.z()};
        for (int k = 0; k < 4; ++k)
            bodies.columns.orientation[k][0] = parts[k];
        for (int d = 0; d < 3; ++d)
            bodies.columns.velocity[3 + d][0] = speed * axis[d];
        const int steps = 200;
        for (int i = 0; i < steps; ++i)
            bodies.advance({dt, {0, 0, 0}, false});
        const Quaterniond expected = Quaterniond(AngleAxisd(speed * dt * steps, axis)) * start;
        const auto found = bodies.orientation(0);
        CHECK(std::abs(found.norm() - 1) < 1e-15);
        CHECK((found.coeffs() - (found.dot(expected) < 0 ? -1 : 1) * expected.coeffs()).norm() < 1e-12);
    }
}

TEST_CASE("a body without spin keeps its orientation to the last bit") {
    Dice dice(5);
    Bodies bodies(2);
    const double odd[4] = {0.1, -0.7, 0.3, 0.64}; // not quite of length one
    for (int k = 0; k < 4; ++k)
        bodies.columns.orientation[k][0] = odd[k];
    bodies.columns.velocity[4][1] = 1; // its neighbour turns
    bodies.advance({1e-3, {0, 0, -9.81}, false});
    for (int k = 0; k < 4; ++k)
        CHECK(bodies.columns.orientation[k][0] == odd[k]);
    CHECK(bodies.columns.orientation[2][1] == within(std::sin(0.5e-3), 1e-12));
}

TEST_CASE("axes that are left out of a step keep their numbers") {
    Bodies bodies(3);
    for (auto& column : bodies.motion.force)
        std::fill(column, column + 3, 1.0);
    bodies.advance({1e-3, {0, 0, -9.81}, false}, 0b010101); // x and z, and the rotation about y
    for (int d = 0; d < 6; ++d)
        CHECK((bodies.columns.velocity[d][1] != 0) == (d % 2 == 0));
}

TEST_CASE("a body moves to the same bits alone or among sixty-four") {
    Dice dice(6);
    const int count = RigidMotion::most;
    Bodies together(count);
    for (auto* columns : {&together.columns.velocity[0], &together.columns.velocity[3], &together.columns.velocity[5]})
        for (double& value : *columns)
            value = dice.between(-5, 5);
    for (int i = 0; i < count; ++i) {
        together.motion.alpha[i] = dice.between(0, 0.9);
        together.columns.mass[i] = dice.between(0.1, 10);
        for (auto& column : together.motion.force)
            column[i] = dice.between(-100, 100);
    }
    const RigidColumns start = together.columns;
    const RigidMotion::Around around{1e-3, {0, 0, -9.81}, true};
    const auto numbers = [](const Bodies& bodies, int i) {
        std::vector<double> all{bodies.motion.kinetic[i]};
        const auto add = [&](const auto& part) {
            for (const auto& column : part)
                all.push_back(column[i]);
        };
        add(bodies.columns.velocity), add(bodies.columns.position), add(bodies.columns.orientation);
        return all;
    };
    together.advance(around);
    for (int i = 0; i < count; ++i) {
        Bodies alone(1);
        alone.columns.mass[0] = start.mass[i];
        alone.motion.alpha[0] = together.motion.alpha[i];
        for (int d = 0; d < 6; ++d) {
            alone.columns.velocity[d][0] = start.velocity[d][i];
            alone.motion.force[d][0] = together.motion.force[d][i];
        }
        alone.advance(around);
        CHECK(numbers(alone, 0) == numbers(together, i));
    }
}

// ---- joints ---------------------------------------------------------------------------------------------------------

namespace {

struct Placed {
    Vector3d reference, position; // of the centre [m]
    Quaterniond turn;             // since the reference state
};

// A joint with one subcontact between blocks 0 and 1, and its jump and forces by Eigen. `axes` has the normal and the
// tangents as columns; `point` is the subcontact. Both are those of the reference state.
struct Reference {
    Placed one, two;
    Matrix3d axes;
    Vector3d point;

    // Places of the subcontact as both blocks have carried it along.
    Vector3d carried(const Placed& block) const { return block.position + block.turn * (point - block.reference); }
    Vector3d middle() const { return 0.5 * (carried(one) + carried(two)); }
    Matrix3d frame() const {
        const double sign = one.turn.dot(two.turn) < 0 ? -1 : 1;
        Quaterniond mean;
        mean.coeffs() = one.turn.coeffs() + sign * two.turn.coeffs();
        return mean.normalized() * axes;
    }
    Vector3d jump() const { return frame().transpose() * (carried(two) - carried(one)); }
};

// Arguments of the functions for joints in space, made from references with the same two blocks.
struct Joints {
    explicit Joints(const std::vector<Reference>& all, Dice& dice) : n(int(all.size())) {
        for (int i = 0; i < n; ++i) {
            const auto& r = all[i];
            body1.push_back(2 * i + 1); // not in the order of the joints
            body2.push_back(2 * i);
            const Quaterniond axes(r.axes);
            for (const Placed* block : {&r.two, &r.one}) {
                const auto reference = dice.rotation(); // the orientation of the body in the reference state
                Quaterniond now = block->turn * reference;
                if (dice.between(-1, 1) < 0) now.coeffs() *= -1; // the same rotation
                add(orientation, now);
                add(block == &r.one ? inBody1 : inBody2, reference.conjugate() * axes);
                for (int d = 0; d < 3; ++d)
                    position[d].push_back(block->position[d]);
            }
            const Vector3d between = r.axes.transpose() * (r.two.reference - r.one.reference);
            const Vector3d arm = r.axes.transpose() * (r.point - r.one.reference);
            for (int d = 0; d < 3; ++d) {
                span[d].push_back(between[d]);
                offset[d].push_back(arm[d]);
                jump[d].push_back(0);
            }
        }
    }
    static void add(std::vector<double>* columns, const Quaterniond& q) {
        const double parts[4] = {q.w(), q.x(), q.y(), q.z()};
        for (int k = 0; k < 4; ++k)
            columns[k].push_back(parts[k]);
    }
    template <int count> struct Pointers {
        const double* column[count];
        explicit Pointers(const std::vector<double>* columns) {
            for (int k = 0; k < count; ++k)
                column[k] = columns[k].data();
        }
    };
    void align() {
        const Pointers<3> p(position), s(span);
        const Pointers<4> q(orientation), f1(inBody1), f2(inBody2);
        JointArithmetic<false>::alignRigid(n, body1.data(), body2.data(), p.column, q.column, f1.column, f2.column,
                                           s.column, frames);
    }
    void findJumps() {
        JointArithmetic<false>::jumpRigid(n, offset[0].data(), offset[1].data(), offset[2].data(), jump[0].data(),
                                          jump[1].data(), jump[2].data(), frames);
    }

    int n;
    std::vector<int> body1, body2;
    std::vector<double> position[3], orientation[4], inBody1[4], inBody2[4], span[3], offset[3], jump[3];
    JointFrames frames;
};

Reference randomJoint(Dice& dice, double angle) {
    Reference r;
    r.one.reference = dice.vector(1);
    r.two.reference = dice.vector(1);
    const auto common = dice.rotation(); // both blocks have turned with the wall
    for (Placed* block : {&r.one, &r.two}) {
        block->position = block->reference + dice.vector(0.3);
        block->turn = common * Quaterniond(AngleAxisd(dice.between(-angle, angle), dice.vector(1).normalized()));
    }
    r.axes = dice.rotation().toRotationMatrix();
    r.point = dice.vector(1);
    return r;
}

std::vector<Reference> randomJoints(Dice& dice, double angle) {
    std::vector<Reference> all;
    for (int i = 0; i < JointFrames::most; ++i)
        all.push_back(randomJoint(dice, angle));
    return all;
}

} // namespace

TEST_CASE("the jump is the vector between both carried points, in axes that turn with the mean of both blocks") {
    Dice dice(7);
    for (double angle : {1e-9, 1e-3, 1.0}) {
        const auto all = randomJoints(dice, angle);
        Joints joints(all, dice);
        for (auto& column : joints.jump)
            for (double& value : column)
                value = 0.25; // of the step before
        joints.align();
        joints.findJumps();
        for (int i = 0; i < joints.n; ++i) {
            const Vector3d expected = all[i].jump();
            for (int d = 0; d < 3; ++d) {
                CHECK(joints.jump[d][i] == doctest::Approx(expected[d]).epsilon(1e-13));
                CHECK(joints.frames.step[d][i] == doctest::Approx(expected[d] - 0.25).epsilon(1e-13));
            }
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 3; ++column)
                    CHECK(joints.frames.axes[3 * row + column][i] ==
                          doctest::Approx(all[i].frame()(row, column)).epsilon(1e-13));
        }
    }
}

TEST_CASE("opening is positive, sliding has the sign of block 2, and a wall that moves as one has no jump") {
    Dice dice(8);
    Reference r;
    r.axes.col(0) = Vector3d::UnitZ(); // a bed joint: block 2 stands on block 1
    r.axes.col(1) = Vector3d::UnitX();
    r.axes.col(2) = Vector3d::UnitY();
    r.one.reference = Vector3d(0, 0, 0.05);
    r.two.reference = Vector3d(0, 0, 0.15);
    r.point = Vector3d(0.1, 0.02, 0.1);
    r.one.turn = r.two.turn = Quaterniond::Identity();
    r.one.position = r.one.reference;
    r.two.position = r.two.reference + Vector3d(2e-3, 3e-3, 1e-3);
    Joints moved({r}, dice);
    moved.align();
    moved.findJumps();
    CHECK(moved.jump[0][0] == within(1e-3, 1e-12));
    CHECK(moved.jump[1][0] == within(2e-3, 1e-12));
    CHECK(moved.jump[2][0] == within(3e-3, 1e-12));

    for (int n = 0; n < 100; ++n) {
        const auto turn = dice.rotation();
        const Vector3d shift = dice.vector(10);
        for (Placed* block : {&r.one, &r.two}) {
            block->turn = turn;
            block->position = turn * block->reference + shift;
        }
        Joints asOne({r}, dice);
        asOne.align();
        asOne.findJumps();
        for (const auto& column : asOne.jump)
            CHECK(std::abs(column[0]) < 1e-14);
    }
}

TEST_CASE("stress times area acts at the middle of the jump, on both blocks against each other") {
    Dice dice(9);
    const auto all = randomJoints(dice, 0.5);
    Joints joints(all, dice);
    joints.align();
    const int n = joints.n;
    Vector3d force[JointFrames::most], torque1[JointFrames::most], torque2[JointFrames::most];
    for (int i = 0; i < n; ++i)
        force[i] = torque1[i] = torque2[i] = Vector3d::Zero();
    for (int subcontact = 0; subcontact < 3; ++subcontact) {
        std::vector<Reference> here = all;
        std::vector<double> area(n), stress[3];
        for (int i = 0; i < n; ++i) {
            here[i].point = dice.vector(1);
            const Vector3d arm = here[i].axes.transpose() * (here[i].point - here[i].one.reference);
            area[i] = dice.between(0.01, 0.1);
            const Vector3d stresses = dice.vector(1e5);
            for (int d = 0; d < 3; ++d) {
                joints.offset[d][i] = arm[d];
                stress[d].push_back(stresses[d]);
            }
            const Vector3d pull = area[i] * (here[i].frame() * stresses); // tension pulls block 1 along the normal
            force[i] += pull;
            torque1[i] += (here[i].middle() - here[i].one.position).cross(pull);
            torque2[i] -= (here[i].middle() - here[i].two.position).cross(pull);
        }
        joints.findJumps();
        JointArithmetic<false>::pullRigid(n, area.data(), stress[0].data(), stress[1].data(), stress[2].data(), nullptr,
                                          nullptr, joints.frames);
    }
    std::vector<double> found(9 * n);
    JointArithmetic<false>::finishRigid(n, joints.frames, found.data());
    for (int i = 0; i < n; ++i)
        for (int d = 0; d < 3; ++d) { // forces of some 10 kN
            CHECK(std::abs(found[9 * i + d] - force[i][d]) < 1e-8);
            CHECK(std::abs(found[9 * i + 3 + d] - torque1[i][d]) < 1e-8);
            CHECK(std::abs(found[9 * i + 6 + d] - torque2[i][d]) < 1e-8);
        }
}

TEST_CASE("the work of the forces on both blocks is that of the stresses on the jump") {
    // The frame turns with the mean of both rotations only as long as the blocks are nearly parallel: the error is the
    // angle between them, here some 1e-3, times the jump, here some 1e-3 m.
    Dice dice(10);
    const double small = 1e-7;
    auto all = randomJoints(dice, 1e-3);
    for (auto& r : all)
        for (Placed* block : {&r.one, &r.two})
            block->position = r.one.turn * block->reference + dice.vector(1e-3);
    auto later = all;
    std::vector<Vector3d> shift, turn; // of both blocks
    for (auto& r : later)
        for (Placed* block : {&r.one, &r.two}) {
            shift.push_back(dice.vector(small));
            turn.push_back(dice.vector(small));
            block->position += shift.back();
            block->turn = Quaterniond(AngleAxisd(turn.back().norm(), turn.back().normalized())) * block->turn;
        }
    Joints joints(all, dice);
    joints.align();
    joints.findJumps();
    const int n = joints.n;
    const std::vector<double> area(n, 0.02), normal(n, 1e5), shearA(n, -4e4), shearB(n, 7e4);
    JointArithmetic<false>::pullRigid(n, area.data(), normal.data(), shearA.data(), shearB.data(), nullptr, nullptr,
                                      joints.frames);
    std::vector<double> onJoints(9 * n);
    JointArithmetic<false>::finishRigid(n, joints.frames, onJoints.data());
    for (int i = 0; i < n; ++i) {
        const Eigen::Map<const Vector3d> force(&onJoints[9 * i]), torque1(&onJoints[9 * i + 3]),
            torque2(&onJoints[9 * i + 6]);
        const double work =
            force.dot(shift[2 * i] - shift[2 * i + 1]) + torque1.dot(turn[2 * i]) + torque2.dot(turn[2 * i + 1]);
        const Vector3d change = later[i].jump() - all[i].jump();
        const double stored = area[i] * Vector3d(normal[i], shearA[i], shearB[i]).dot(change);
        CHECK(std::abs(work + stored) < 1e-5 * small * 2e3); // a force of 2 kN
    }
}

TEST_CASE("joints with a deformable side follow their nodes, and two forces that are apart have no resulting moment") {
    Dice dice(11);
    const auto all = randomJoints(dice, 0.5);
    Joints joints(all, dice);
    const int n = joints.n;
    const Joints::Pointers<4> q(joints.orientation), f1(joints.inBody1), f2(joints.inBody2);
    JointArithmetic<false>::alignNodal(n, joints.body1.data(), joints.body2.data(), q.column, f1.column, f2.column,
                                       joints.frames);
    std::vector<double> u(6 * lanes * n); // two nodes for each joint, three components, `lanes` numbers apart
    for (double& value : u)
        value = dice.between(-1, 1);
    std::vector<int> place1, place2;
    std::vector<double> area(n), stress[3], onPoints(3 * n), onJoints(9 * n, -1);
    std::vector<Vector3d> apart;
    for (int i = 0; i < n; ++i) {
        place1.push_back(3 * lanes * (2 * i) + i % lanes);
        place2.push_back(3 * lanes * (2 * i + 1) + (i + 3) % lanes);
        apart.emplace_back();
        for (int d = 0; d < 3; ++d)
            apart[i][d] = u[place2[i] + d * lanes] - u[place1[i] + d * lanes];
        area[i] = dice.between(0.01, 0.1);
        for (auto& column : stress)
            column.push_back(dice.between(-1e5, 1e5));
    }
    auto& jump = joints.jump;
    JointArithmetic<false>::jumpNodal(n, place1.data(), place2.data(), u.data(), jump[0].data(), jump[1].data(),
                                      jump[2].data(), joints.frames);
    JointArithmetic<false>::pullNodal(n, area.data(), stress[0].data(), stress[1].data(), stress[2].data(),
                                      jump[0].data(), jump[1].data(), jump[2].data(), joints.frames, onPoints.data());
    JointArithmetic<false>::finishNodal(n, joints.frames, onJoints.data());
    for (int i = 0; i < n; ++i) {
        const Matrix3d frame = all[i].frame();
        const Vector3d expected = frame.transpose() * apart[i];
        const Vector3d force = area[i] * (frame * Vector3d(stress[0][i], stress[1][i], stress[2][i]));
        const Eigen::Map<const Vector3d> torque1(&onJoints[9 * i + 3]), torque2(&onJoints[9 * i + 6]);
        for (int d = 0; d < 3; ++d) {
            CHECK(jump[d][i] == doctest::Approx(expected[d]).epsilon(1e-13));
            CHECK(joints.frames.step[d][i] == jump[d][i]); // the jump before was zero
            CHECK(onPoints[3 * i + d] == within(force[d], 1e-9));
        }
        // `force` on side 1 and its opposite on side 2 have the moment -apart × force.
        CHECK((torque1 + torque2 - apart[i].cross(force)).norm() < 1e-8);
        CHECK(torque1 == torque2);
        CHECK(onJoints[9 * i] == -1); // forces go to the nodes
    }
}

// ---- in the plane ---------------------------------------------------------------------------------------------------

namespace {

Quaterniond aboutY(double angle) { return Quaterniond(AngleAxisd(angle, Vector3d::UnitY())); }

// Joints in planes y = constant, with the same numbers for the functions in space and in the plane.
struct PlanarJoints {
    explicit PlanarJoints(Dice& dice, int n = JointFrames::most) : n(n) {
        Matrix3d bed; // normal z, tangents x and y
        bed << 0, 1, 0, 0, 0, 1, 1, 0, 0;
        for (int i = 0; i < n; ++i) {
            Reference r;
            const double turned = dice.between(-3, 3), axes = dice.between(-3, 3);
            const double angles[2] = {turned + dice.between(-0.5, 0.5), turned + dice.between(-0.5, 0.5)};
            Placed* const blocks[2] = {&r.one, &r.two};
            for (int side = 0; side < 2; ++side) {
                Placed& block = *blocks[side];
                block.reference = dice.vector(1);
                block.reference.y() = 0;
                block.position = dice.vector(1);
                block.position.y() = 0;
                block.turn = aboutY(angles[side]);
                half[0].push_back(std::cos(0.5 * angles[side])); // bodies 2i and 2i + 1
                half[1].push_back(std::sin(0.5 * angles[side]));
                position[0].push_back(block.position.z());
                position[1].push_back(block.position.x());
            }
            frame[0].push_back(std::cos(0.5 * axes));
            frame[1].push_back(std::sin(0.5 * axes));
            body1.push_back(2 * i);
            body2.push_back(2 * i + 1);
            r.axes = aboutY(axes) * bed;
            r.point = dice.vector(1);
            r.point.y() = 0;
            const Vector3d between = r.axes.transpose() * (r.two.reference - r.one.reference);
            const Vector3d arm = r.axes.transpose() * (r.point - r.one.reference);
            for (int d = 0; d < 2; ++d) {
                span[d].push_back(between[d]);
                offset[d].push_back(arm[d]);
                jump[d].push_back(0);
                stress[d].push_back(dice.between(-1e5, 1e5));
            }
            area.push_back(dice.between(0.01, 0.1));
            all.push_back(r);
        }
    }
    int n;
    std::vector<Reference> all;
    std::vector<int> body1, body2;
    std::vector<double> half[2], frame[2], position[2], span[2], offset[2], jump[2], stress[2], area;
    JointFrames frames;
};

} // namespace

TEST_CASE("in the plane jumps, forces and moments are those in space") {
    Dice dice(12);
    PlanarJoints planar(dice);
    const int n = planar.n;
    const Joints::Pointers<2> p(planar.position), q(planar.half), f(planar.frame), s(planar.span);
    JointArithmetic<true>::alignRigid(n, planar.body1.data(), planar.body2.data(), p.column, q.column, f.column,
                                      f.column, s.column, planar.frames);
    JointArithmetic<true>::jumpRigid(n, planar.offset[0].data(), planar.offset[1].data(), nullptr,
                                     planar.jump[0].data(), planar.jump[1].data(), nullptr, planar.frames);
    JointArithmetic<true>::pullRigid(n, planar.area.data(), planar.stress[0].data(), planar.stress[1].data(), nullptr,
                                     planar.offset[0].data(), planar.offset[1].data(), planar.frames);
    std::vector<double> found(4 * n);
    JointArithmetic<true>::finishRigid(n, planar.frames, found.data());
    for (int i = 0; i < n; ++i) {
        const auto& r = planar.all[i];
        const Vector3d expected = r.jump();
        const Vector3d force = planar.area[i] * (r.frame() * Vector3d(planar.stress[0][i], planar.stress[1][i], 0));
        for (int d = 0; d < 2; ++d) {
            CHECK(planar.jump[d][i] == doctest::Approx(expected[d]).epsilon(1e-13));
            CHECK(planar.frames.step[d][i] == planar.jump[d][i]);
        }
        CHECK(std::abs(expected[2]) < 1e-14);
        CHECK(std::abs(found[4 * i] - force.x()) < 1e-9);
        CHECK(std::abs(found[4 * i + 1] - force.z()) < 1e-9);
        CHECK(std::abs(found[4 * i + 2] - (r.middle() - r.one.position).cross(force).y()) < 1e-9);
        CHECK(std::abs(found[4 * i + 3] + (r.middle() - r.two.position).cross(force).y()) < 1e-9);
    }
}

TEST_CASE("in the plane joints with a deformable side follow their nodes, too") {
    Dice dice(13);
    PlanarJoints planar(dice);
    const int n = planar.n;
    const Joints::Pointers<2> q(planar.half), f(planar.frame);
    JointArithmetic<true>::alignNodal(n, planar.body1.data(), planar.body2.data(), q.column, f.column, f.column,
                                      planar.frames);
    std::vector<double> u(6 * lanes * n), onPoints(2 * n), onJoints(4 * n);
    for (double& value : u)
        value = dice.between(-1, 1);
    std::vector<int> place1, place2;
    for (int i = 0; i < n; ++i) {
        place1.push_back(3 * lanes * (2 * i) + i % lanes);
        place2.push_back(3 * lanes * (2 * i + 1) + i % lanes);
    }
    JointArithmetic<true>::jumpNodal(n, place1.data(), place2.data(), u.data(), planar.jump[0].data(),
                                     planar.jump[1].data(), nullptr, planar.frames);
    JointArithmetic<true>::pullNodal(n, planar.area.data(), planar.stress[0].data(), planar.stress[1].data(), nullptr,
                                     planar.jump[0].data(), planar.jump[1].data(), nullptr, planar.frames,
                                     onPoints.data());
    JointArithmetic<true>::finishNodal(n, planar.frames, onJoints.data());
    for (int i = 0; i < n; ++i) {
        const Matrix3d frame = planar.all[i].frame();
        const Vector3d apart(u[place2[i]] - u[place1[i]], 0, u[place2[i] + 2 * lanes] - u[place1[i] + 2 * lanes]);
        const Vector3d expected = frame.transpose() * apart;
        const Vector3d force = planar.area[i] * (frame * Vector3d(planar.stress[0][i], planar.stress[1][i], 0));
        for (int d = 0; d < 2; ++d) {
            CHECK(planar.jump[d][i] == doctest::Approx(expected[d]).epsilon(1e-13));
            CHECK(planar.frames.step[d][i] == planar.jump[d][i]);
        }
        CHECK(onPoints[2 * i] == within(force.x(), 1e-9));
        CHECK(onPoints[2 * i + 1] == within(force.z(), 1e-9));
        CHECK(onJoints[4 * i + 2] == within(0.5 * apart.cross(force).y(), 1e-9));
        CHECK(onJoints[4 * i + 3] == onJoints[4 * i + 2]);
    }
}

TEST_CASE("rotations in the plane are read with their half angle, and any other rotation and NaN is found") {
    Dice dice(14);
    const int n = 11;
    std::vector<double> now[4], inverse[4], cosine(n), sine(n), angles;
    for (int i = 0; i < n; ++i) {
        const auto reference = dice.rotation();
        angles.push_back(dice.between(-3, 3));
        Joints::add(now, aboutY(angles[i]) * reference);
        Joints::add(inverse, reference.conjugate());
    }
    const auto read = [&] {
        const Joints::Pointers<4> q(now), r(inverse);
        return turnsInPlane(n, q.column, r.column, cosine.data(), sine.data());
    };
    CHECK(read() < 1e-15);
    for (int i = 0; i < n; ++i) {
        CHECK(cosine[i] == doctest::Approx(std::cos(0.5 * angles[i])).epsilon(1e-14));
        CHECK(sine[i] == doctest::Approx(std::sin(0.5 * angles[i])).epsilon(1e-14));
    }
    // Body 7 also turns by 2e-6 about x: half of that stands in its quaternion.
    Quaterniond body(now[0][7], now[1][7], now[2][7], now[3][7]);
    body = Quaterniond(AngleAxisd(2e-6, Vector3d::UnitX())) * body;
    const double parts[4] = {body.w(), body.x(), body.y(), body.z()};
    for (int k = 0; k < 4; ++k)
        now[k][7] = parts[k];
    // |x| + |z| of a rotation about x after one about y by the angle b is (|cos b/2| + |sin b/2|) times its half angle.
    const double b = 0.5 * angles[7];
    CHECK(read() == within(1e-6 * (std::abs(std::cos(b)) + std::abs(std::sin(b))), 1e-6));
    now[3][2] = std::numeric_limits<double>::quiet_NaN();
    CHECK(!(read() < 1e9)); // a comparison with NaN is false
}

// ---- the largest eigenvalue -----------------------------------------------------------------------------------------

TEST_CASE("the bound of the largest eigenvalue lies within 2.1 % above it, for any spectrum and size") {
    std::mt19937 dice(19);
    std::normal_distribution<> normal;
    for (int n : {1, 2, 5, 40, 118, 300}) {
        // from eigenvalues that crowd below the largest to some that are far apart
        for (double power : {0.0, 0.1, 1.0, 8.0, 100.0}) {
            const double largest = 7 * std::pow(1e3, std::min(power, 5.0));
            Eigen::MatrixXd random(n, n);
            for (double& value : random.reshaped())
                value = normal(dice);
            const Eigen::MatrixXd q = random.householderQr().householderQ();
            Eigen::VectorXd values(n);
            for (int i = 0; i < n; ++i)
                values[i] = largest * std::pow((i + 1.0) / n, power);
            const Eigen::MatrixXd matrix = q * values.asDiagonal() * q.transpose();
            std::vector<bool> moves(n + 3, true); // three components do not move
            moves[0] = moves[n / 2 + 1] = moves[n + 2] = false;
            const auto multiply = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
                Eigen::VectorXd inner(n);
                for (int i = 0, k = 0; i < n + 3; ++i)
                    if (moves[i]) inner[k++] = x[i];
                const Eigen::VectorXd image = matrix * inner;
                y.setZero();
                for (int i = 0, k = 0; i < n + 3; ++i)
                    if (moves[i]) y[i] = image[k++];
            };
            const double bound = largestEigenvalue(moves, multiply);
            const Eigen::VectorXd mode = highMode(moves, multiply);
            Eigen::VectorXd image(n + 3);
            multiply(mode, image);
            CHECK(mode.dot(image) >= 0.97 * largest * mode.squaredNorm());
            CHECK(bound >= largest * (1 - 1e-12));
            CHECK(bound <= largest * 1.021);
        }
    }
    const auto nothing = [](const Eigen::VectorXd&, Eigen::VectorXd& y) { y.setZero(); };
    CHECK(largestEigenvalue({false}, nothing) == 0);
    CHECK_THROWS_AS(largestEigenvalue({true}, nothing), std::invalid_argument);
}

TEST_CASE("the stiffest part of a chain is found, and its bound is the same in every run") {
    // Masses of 1 kg between springs of 1 N/m and fixed ends: the largest eigenvalue is 2 - 2 cos(n pi / (n + 1)).
    const int n = 60;
    const auto chain = [&](double spring, int at) {
        return [=](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
            for (int i = 0; i < n; ++i)
                y[i] = 2 * x[i] - (i > 0 ? x[i - 1] : 0) - (i + 1 < n ? x[i + 1] : 0);
            const double force = spring * (x[at] - x[at + 1]);
            y[at] += force;
            y[at + 1] -= force;
        };
    };
    const std::vector<bool> moves(n, true);
    const double largest = 2 - 2 * std::cos(n * pi / (n + 1));
    const double even = largestEigenvalue(moves, chain(0, 0));
    CHECK(even >= largest * (1 - 1e-12));
    CHECK(even <= largest * 1.021);
    CHECK(largestEigenvalue(moves, chain(0, 0)) == even);
    // A spring of 100 N/m between masses 20 and 21 moves these two against each other.
    CHECK(largestEigenvalue(moves, chain(100, 20)) > 200);
    const auto uneven = highMode(moves, chain(100, 20));
    CHECK(uneven.norm() == within(1, 1e-12));
    CHECK(std::abs(uneven[20]) == within(std::sqrt(0.5), 0.01));
    CHECK(uneven[21] == within(-uneven[20], 0.01));
}

TEST_CASE("an operator that is not finite is refused") {
    const auto broken = [](const Eigen::VectorXd&, Eigen::VectorXd& y) {
        y.setConstant(std::numeric_limits<double>::quiet_NaN());
    };
    CHECK_THROWS_AS(largestEigenvalue({true, true}, broken), std::invalid_argument);
}
