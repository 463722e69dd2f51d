// SPDX-License-Identifier: GPL-2.0-or-later
// Pure kinematics: damping, the energy ledger, a step of rigid bodies, frames and jumps of joints, and the largest
// eigenvalue. Expected numbers come from closed forms and from a reference that is written with Eigen's rotations.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "../dice.hpp"
#include "../within.hpp"
#include "common/Vectorised.hpp"
#include "motion/Damping.hpp"
#include "motion/EnergyLedger.hpp"
#include "motion/JointFrames.hpp"
#include "motion/LargestEigenvalue.hpp"
#include "motion/RigidMotion.hpp"
#include <algorithm>
#include <limits>

using namespace masonry;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

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
struct Bodies : RigidMotion, RigidColumns {
    explicit Bodies(int count) : count(count) {
        resize(count);
        std::fill(orientation[0].begin(), orientation[0].end(), 1.0);
        for (auto& column : earlier)
            column.assign(count, 0);
        std::fill_n(alpha, most, 0.0);
        std::fill_n(viscous, most, 0.0);
        for (int d = 0; d < 6; ++d) {
            std::fill_n(free[d], most, 1.0);
            std::fill_n(force[d], most, 0.0);
        }
    }
    void advance(const Around& around, unsigned axes = everyAxis) {
        double* last[6];
        for (int d = 0; d < 6; ++d)
            last[d] = earlier[d].data();
        RigidMotion::advance(*this, last, 0, count, around, axes);
    }
    Quaterniond turn(int i) const {
        return {orientation[0][i], orientation[1][i], orientation[2][i], orientation[3][i]};
    }
    void setTurn(int i, const Quaterniond& q) {
        orientation[0][i] = q.w();
        for (int d = 0; d < 3; ++d)
            orientation[1 + d][i] = q.vec()[d];
    }

    int count;
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
    bodies.mass[0] = 17; // any mass falls alike
    const double dt = 1e-3, g = 9.81;
    const int steps = 500;
    for (int i = 0; i < steps; ++i)
        bodies.advance({dt, {0, 0, -g}, false});
    CHECK(bodies.velocity[2][0] == within(-g * steps * dt, 1e-12));
    CHECK(bodies.position[2][0] == within(-g * dt * dt * steps * (steps + 1) / 2, 1e-12));
    CHECK(bodies.velocity[0][0] == 0);
    CHECK(bodies.position[1][0] == 0);
}

TEST_CASE("a blocked axis keeps its velocity, and what drives it does work against force and weight") {
    Bodies bodies(1);
    const double dt = 1e-2, mass = 3, velocity = 0.2, force = 40, g = 9.81;
    bodies.mass[0] = mass;
    bodies.velocity[2][0] = velocity;
    bodies.free[2][0] = 0;
    bodies.force[2][0] = force;
    bodies.alpha[0] = 0.8; // a prescribed motion is not damped
    bodies.viscous[0] = 10;
    bodies.advance({dt, {0, 0, -g}, false});
    CHECK(bodies.velocity[2][0] == velocity);
    CHECK(bodies.position[2][0] == within(velocity * dt, 1e-14));
    // The force of 40 N pushes along the motion, so what holds the velocity does negative work; half of it belongs to
    // the velocity before the step, half to the one after.
    CHECK(bodies.work[0] == within(-0.5 * dt * velocity * (force - mass * g), 1e-12));
    CHECK(bodies.kinetic[0] == 0);
    CHECK(bodies.damped[0][0] == 0);
    CHECK(bodies.damped[1][0] == 0);
}

TEST_CASE("in every step of every body the kinetic energy changes by the work of its forces less what damping takes") {
    Dice dice(3);
    const int count = RigidMotion::most;
    const RigidMotion::Around around[2] = {{1e-3, {1, -2, -9.81}, false}, {1e-3, {1, -2, -9.81}, true}};
    Bodies bodies(count);
    for (int i = 0; i < count; ++i) {
        bodies.mass[i] = dice.between(0.1, 10);
        for (auto& column : bodies.inertia)
            column[i] = dice.between(0.1, 10);
        for (auto& column : bodies.velocity)
            column[i] = dice.between(-0.02, 0.02);
        bodies.alpha[i] = dice.between(0, 0.9);
        bodies.viscous[i] = dice.between(0, 50);
    }
    double taken = 0;
    for (int step = 0; step < 40; ++step) {
        for (auto& column : bodies.force)
            for (double& force : column)
                force = dice.between(-30, 30);
        const RigidColumns before = bodies;
        bodies.advance(around[step % 2]);
        for (int i = 0; i < count; ++i) {
            double gained = 0, work = 0, kinetic = 0;
            for (int d = 0; d < 6; ++d) {
                const double m = d < 3 ? before.mass[i] : before.inertia[d - 3][i];
                const double v0 = before.velocity[d][i], v1 = bodies.velocity[d][i];
                gained += 0.5 * m * (v1 * v1 - v0 * v0);
                work += 0.5e-3 * (v0 + v1) * (bodies.force[d][i] + (d < 3 ? m * around[0].gravity[d] : 0));
                kinetic += 0.5 * m * v0 * v1;
            }
            const double damped = bodies.damped[0][i] + bodies.damped[1][i];
            CHECK(gained == doctest::Approx(work - damped).epsilon(1e-12));
            CHECK(bodies.kinetic[i] == doctest::Approx(kinetic).epsilon(1e-12));
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
        bodies.mass[0] = mass;
        bodies.velocity[0][0] = velocity;
        bodies.alpha[0] = alpha;
        bodies.force[0][0] = force;
        bodies.advance({dt, {0, 0, 0}, combined});
        CHECK(bodies.velocity[0][0] == within(velocity + dt * force / mass * (combined ? 1 : 1 - alpha), 1e-14));
        CHECK(bodies.earlier[0][0] == force / mass); // what the next step compares with
        if (!combined) continue;
        const double now = bodies.velocity[0][0];
        bodies.advance({dt, {0, 0, 0}, combined}); // the force is steady: half of alpha |F|
        CHECK(bodies.velocity[0][0] == within(now + dt * force / mass * (1 - 0.5 * alpha), 1e-14));
    }
}

TEST_CASE("viscous damping takes its share of the mean velocity that local damping leaves") {
    // The step is v' = v + dt (a - alpha a - c (v + v') / 2), as v and a have the same sign.
    Bodies bodies(1);
    const double dt = 1e-2, velocity = 1, acceleration = 6, alpha = 0.25, c = 20;
    bodies.velocity[0][0] = velocity;
    bodies.alpha[0] = alpha;
    bodies.viscous[0] = c;
    bodies.force[0][0] = acceleration; // the mass is 1 kg
    bodies.advance({dt, {0, 0, 0}, false});
    const double expected = (velocity * (1 - 0.5 * c * dt) + dt * (1 - alpha) * acceleration) / (1 + 0.5 * c * dt);
    CHECK(bodies.velocity[0][0] == within(expected, 1e-14));
}

TEST_CASE("a body that spins about any axis has turned by the angle of its spin, slow or fast") {
    Dice dice(4);
    const double dt = 1e-3;
    // Half an angle of 0.001 a step is where the series end; 3000 1/s turns by 3 rad in a step.
    for (double speed : {1e-6, 1.0, 1.99, 2.01, 62.0, 3000.0}) {
        Bodies bodies(1);
        const auto start = dice.rotation();
        const Vector3d axis = dice.direction();
        bodies.setTurn(0, start);
        for (int d = 0; d < 3; ++d)
            bodies.velocity[3 + d][0] = speed * axis[d];
        const int steps = 200;
        for (int i = 0; i < steps; ++i)
            bodies.advance({dt, {0, 0, 0}, false});
        const Quaterniond expected = Quaterniond(AngleAxisd(speed * dt * steps, axis)) * start;
        const auto found = bodies.turn(0);
        CHECK(std::abs(found.norm() - 1) < 1e-15);
        CHECK((found.coeffs() - (found.dot(expected) < 0 ? -1 : 1) * expected.coeffs()).norm() < 1e-12);
    }
}

TEST_CASE("a body without spin keeps its orientation to the last bit") {
    Bodies bodies(2);
    const Quaterniond odd(0.1, -0.7, 0.3, 0.64); // not quite of length one
    bodies.setTurn(0, odd);
    bodies.velocity[4][1] = 1; // its neighbour turns
    bodies.advance({1e-3, {0, 0, -9.81}, false});
    CHECK(bodies.turn(0).coeffs() == odd.coeffs());
    CHECK(bodies.orientation[2][1] == within(std::sin(0.5e-3), 1e-12));
}

TEST_CASE("axes that are left out of a step keep their numbers") {
    Bodies bodies(3);
    for (auto& column : bodies.force)
        std::fill(column, column + 3, 1.0);
    bodies.advance({1e-3, {0, 0, -9.81}, false}, 0b010101); // x and z, and the rotation about y
    for (int d = 0; d < 6; ++d)
        CHECK((bodies.velocity[d][1] != 0) == (d % 2 == 0));
}

TEST_CASE("a body moves to the same bits alone or among sixty-four") {
    Dice dice(6);
    const int count = RigidMotion::most;
    Bodies together(count);
    for (auto* columns : {&together.velocity[0], &together.velocity[3], &together.velocity[5]})
        for (double& value : *columns)
            value = dice.between(-5, 5);
    for (int i = 0; i < count; ++i) {
        together.alpha[i] = dice.between(0, 0.9);
        together.mass[i] = dice.between(0.1, 10);
        for (auto& column : together.force)
            column[i] = dice.between(-100, 100);
    }
    const RigidColumns start = together;
    const RigidMotion::Around around{1e-3, {0, 0, -9.81}, true};
    const auto numbers = [](const Bodies& bodies, int i) {
        std::vector<double> all{bodies.kinetic[i]};
        const auto add = [&](const auto& part) {
            for (const auto& column : part)
                all.push_back(column[i]);
        };
        add(bodies.velocity), add(bodies.position), add(bodies.orientation);
        return all;
    };
    together.advance(around);
    for (int i = 0; i < count; ++i) {
        Bodies alone(1);
        alone.mass[0] = start.mass[i];
        alone.alpha[0] = together.alpha[i];
        for (int d = 0; d < 6; ++d) {
            alone.velocity[d][0] = start.velocity[d][i];
            alone.force[d][0] = together.force[d][i];
        }
        alone.advance(around);
        CHECK(numbers(alone, 0) == numbers(together, i));
    }
}

// ---- joints ---------------------------------------------------------------------------------------------------------

namespace {

using InSpace = std::false_type;
using InPlane = std::true_type; // planes y = constant

Quaterniond aboutY(double angle) { return Quaterniond(AngleAxisd(angle, Vector3d::UnitY())); }

// Axes of a bed joint, on whose block 1 block 2 stands: normal z, tangents x and y.
Matrix3d axesOfBed() { return (Matrix3d() << 0, 1, 0, 0, 0, 1, 1, 0, 0).finished(); }

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
    Vector3d arm() const { return axes.transpose() * (point - one.reference); }
};

// As many joints as a batch holds, between blocks that have turned against each other by up to an angle.
template <bool plane> std::vector<Reference> randomJoints(Dice& dice, double angle) {
    const auto vector = [&](double size) {
        const Vector3d v = dice.vector(size);
        return plane ? Vector3d(v.x(), 0, v.z()) : v;
    };
    const auto rotation = [&](double most) {
        const double by = dice.between(-most, most);
        return plane ? aboutY(by) : Quaterniond(AngleAxisd(by, dice.direction()));
    };
    std::vector<Reference> all(JointFrames::most);
    for (auto& r : all) {
        const auto common = rotation(3); // both blocks have turned with the wall
        for (Placed* block : {&r.one, &r.two}) {
            block->reference = vector(1);
            block->position = block->reference + vector(0.3);
            block->turn = common * rotation(angle);
        }
        r.axes = rotation(3) * axesOfBed();
        r.point = vector(1);
    }
    return all;
}

struct Load {
    Vector3d force, torque1, torque2; // on block 1 [N], about the centres of both blocks [N m]
};

template <std::size_t count> std::array<const double*, count> pointers(const std::vector<double> (&columns)[count]) {
    std::array<const double*, count> all;
    for (std::size_t k = 0; k < count; ++k)
        all[k] = columns[k].data();
    return all;
}

void add(std::vector<double>* columns, const Vector3d& v) {
    for (int d = 0; d < 3; ++d)
        columns[d].push_back(v[d]);
}

void add(std::vector<double>* columns, const Quaterniond& q) {
    columns[0].push_back(q.w());
    add(columns + 1, q.vec());
}

// Arguments of the functions for joints, made from references, with stresses and areas at random. In the plane the last
// columns are not read.
template <bool plane> struct Joints {
    using Arithmetic = JointArithmetic<plane>;
    static constexpr int directions = plane ? 2 : 3;

    Joints(const std::vector<Reference>& all, Dice& dice) : n(int(all.size())), onJoints(9 * n, -1) {
        for (int i = 0; i < n; ++i) {
            const auto& r = all[i];
            body1.push_back(2 * i + 1); // not in the order of the joints
            body2.push_back(2 * i);
            const Quaterniond axes(plane ? Matrix3d(r.axes * axesOfBed().transpose()) : r.axes);
            for (const Placed* block : {&r.two, &r.one}) {
                // The orientation of the body in the reference state; in the plane rotations count from there.
                const auto reference = plane ? Quaterniond::Identity() : dice.rotation();
                Quaterniond now = block->turn * reference;
                if (dice.happens(0.5)) now.coeffs() *= -1; // the same rotation
                add(orientation, inColumns(now));
                add(block == &r.one ? inBody1 : inBody2, inColumns(reference.conjugate() * axes));
                add(position, plane ? Vector3d(block->position.z(), block->position.x(), 0) : block->position);
            }
            add(span, r.axes.transpose() * (r.two.reference - r.one.reference));
            add(offset, r.arm());
            add(jump, Vector3d::Constant(0.25)); // of the step before
            add(stress, dice.vector(1e5));
            area.push_back(dice.between(0.01, 0.1));
        }
    }
    static Quaterniond inColumns(const Quaterniond& q) { return plane ? Quaterniond(q.w(), q.y(), 0, 0) : q; }

    void align() {
        Arithmetic::alignRigid(n, body1.data(), body2.data(), pointers(position).data(), pointers(orientation).data(),
                               pointers(inBody1).data(), pointers(inBody2).data(), pointers(span).data(), frames);
    }
    void findJumps() {
        Arithmetic::jumpRigid(n, offset[0].data(), offset[1].data(), offset[2].data(), jump[0].data(), jump[1].data(),
                              jump[2].data(), frames);
    }
    void pull() {
        Arithmetic::pullRigid(n, area.data(), stress[0].data(), stress[1].data(), stress[2].data(), offset[0].data(),
                              offset[1].data(), frames);
    }
    void finish() { Arithmetic::finishRigid(n, frames, onJoints.data()); }
    void checkJump(int i, const Vector3d& expected) const {
        for (int d = 0; d < directions; ++d) {
            CHECK(jump[d][i] == doctest::Approx(expected[d]).epsilon(1e-13));
            CHECK(frames.step[d][i] == doctest::Approx(expected[d] - 0.25).epsilon(1e-13));
        }
    }
    Vector3d stresses(int i) const { return {stress[0][i], stress[1][i], plane ? 0 : stress[2][i]}; }
    Vector3d force(int i, const Reference& r) const { return area[i] * (r.frame() * stresses(i)); }
    static Vector3d inSpace(const double* force) {
        return plane ? Vector3d(force[0], 0, force[1]) : Vector3d(force[0], force[1], force[2]);
    }
    Load load(int i) const {
        const double* from = &onJoints[i * Arithmetic::perJoint];
        if (plane) return {inSpace(from), from[2] * Vector3d::UnitY(), from[3] * Vector3d::UnitY()};
        return {inSpace(from), inSpace(from + 3), inSpace(from + 6)};
    }

    int n;
    std::vector<int> body1, body2;
    std::vector<double> position[3], orientation[4], inBody1[4], inBody2[4], span[3], offset[3], jump[3], stress[3];
    std::vector<double> area, onJoints;
    JointFrames frames;
};

} // namespace

TEST_CASE_TEMPLATE("the jump is the vector between both carried points, in axes that turn with the mean of both blocks",
                   Plane, InSpace, InPlane) {
    Dice dice(7);
    for (double angle : {1e-9, 1e-3, 1.0}) {
        const auto all = randomJoints<Plane::value>(dice, angle);
        Joints<Plane::value> joints(all, dice);
        joints.align();
        joints.findJumps();
        for (int i = 0; i < joints.n; ++i)
            joints.checkJump(i, all[i].jump());
    }
}

TEST_CASE("opening is positive, sliding has the sign of block 2, and a wall that moves as one has no jump") {
    Dice dice(8);
    Reference r{{{0, 0, 0.05}, {0, 0, 0.05}, Quaterniond::Identity()},
                {{0, 0, 0.15}, {2e-3, 3e-3, 0.151}, Quaterniond::Identity()},
                axesOfBed(),
                {0.1, 0.02, 0.1}};
    const auto jumpOf = [&] {
        Joints<false> joints({r}, dice);
        joints.align();
        joints.findJumps();
        return Vector3d(joints.jump[0][0], joints.jump[1][0], joints.jump[2][0]);
    };
    CHECK((jumpOf() - Vector3d(1e-3, 2e-3, 3e-3)).norm() < 1e-15);
    for (int n = 0; n < 100; ++n) {
        const auto turn = dice.rotation();
        const Vector3d shift = dice.vector(10);
        for (Placed* block : {&r.one, &r.two}) {
            block->turn = turn;
            block->position = turn * block->reference + shift;
        }
        CHECK(jumpOf().norm() < 2e-14);
    }
}

TEST_CASE_TEMPLATE("stress times area acts at the middle of the jump, on both blocks against each other", Plane,
                   InSpace, InPlane) {
    Dice dice(9);
    auto all = randomJoints<Plane::value>(dice, 0.5);
    Joints<Plane::value> joints(all, dice);
    const int n = joints.n;
    joints.align();
    std::vector<Load> expected(n, {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()});
    for (int subcontact = 0; subcontact < 3; ++subcontact) {
        for (int i = 0; i < n; ++i) {
            auto& r = all[i];
            r.point = randomJoints<Plane::value>(dice, 0)[0].point;
            const Vector3d arm = r.arm(), pull = joints.force(i, r); // tension pulls block 1 along the normal
            for (int d = 0; d < 3; ++d)
                joints.offset[d][i] = arm[d];
            expected[i].force += pull;
            expected[i].torque1 += (r.middle() - r.one.position).cross(pull);
            expected[i].torque2 -= (r.middle() - r.two.position).cross(pull);
        }
        joints.findJumps();
        joints.pull();
    }
    joints.finish();
    for (int i = 0; i < n; ++i) { // forces of some 10 kN
        CHECK((joints.load(i).force - expected[i].force).norm() < 1e-8);
        CHECK((joints.load(i).torque1 - expected[i].torque1).norm() < 1e-8);
        CHECK((joints.load(i).torque2 - expected[i].torque2).norm() < 1e-8);
    }
}

TEST_CASE("the work of the forces on both blocks is that of the stresses on the jump") {
    // The frame turns with the mean of both rotations only as long as the blocks are nearly parallel: the error is the
    // angle between them, here some 1e-3, times the jump, here some 1e-3 m.
    Dice dice(10);
    const double small = 1e-7;
    auto all = randomJoints<false>(dice, 1e-3);
    for (auto& r : all)
        for (Placed* block : {&r.one, &r.two})
            block->position = r.one.turn * block->reference + dice.vector(1e-3);
    Joints<false> joints(all, dice);
    joints.align();
    joints.findJumps();
    joints.pull();
    joints.finish();
    for (int i = 0; i < joints.n; ++i) {
        const auto load = joints.load(i);
        const Vector3d shift1 = dice.vector(small), shift2 = dice.vector(small);
        const Vector3d turn1 = dice.vector(small), turn2 = dice.vector(small);
        Reference later = all[i];
        later.one.position += shift1;
        later.two.position += shift2;
        later.one.turn = AngleAxisd(turn1.norm(), turn1.normalized()) * later.one.turn;
        later.two.turn = AngleAxisd(turn2.norm(), turn2.normalized()) * later.two.turn;
        const double work = load.force.dot(shift1 - shift2) + load.torque1.dot(turn1) + load.torque2.dot(turn2);
        const double stored = joints.area[i] * joints.stresses(i).dot(later.jump() - all[i].jump());
        CHECK(std::abs(work + stored) < 1e-5 * small * 2e3); // a force of some 2 kN
    }
}

TEST_CASE_TEMPLATE("joints with a deformable side follow their nodes, and two forces apart have no resulting moment",
                   Plane, InSpace, InPlane) {
    Dice dice(11);
    const auto all = randomJoints<Plane::value>(dice, 0.5);
    Joints<Plane::value> joints(all, dice);
    using Arithmetic = typename Joints<Plane::value>::Arithmetic;
    const int n = joints.n;
    Arithmetic::alignNodal(n, joints.body1.data(), joints.body2.data(), pointers(joints.orientation).data(),
                           pointers(joints.inBody1).data(), pointers(joints.inBody2).data(), joints.frames);
    std::vector<double> u(6 * lanes * n); // two nodes for each joint, three components, `lanes` numbers apart
    for (double& value : u)
        value = dice.between(-1, 1);
    std::vector<int> place1, place2;
    for (int i = 0; i < n; ++i) {
        place1.push_back(3 * lanes * (2 * i) + i % lanes);
        place2.push_back(3 * lanes * (2 * i + 1) + (i + 3) % lanes);
    }
    std::vector<double> onPoints(3 * n);
    auto& [x, y, z] = joints.jump;
    auto& [normal, shearA, shearB] = joints.stress;
    Arithmetic::jumpNodal(n, place1.data(), place2.data(), u.data(), x.data(), y.data(), z.data(), joints.frames);
    Arithmetic::pullNodal(n, joints.area.data(), normal.data(), shearA.data(), shearB.data(), x.data(), y.data(),
                          z.data(), joints.frames, onPoints.data());
    Arithmetic::finishNodal(n, joints.frames, joints.onJoints.data());
    for (int i = 0; i < n; ++i) {
        Vector3d apart;
        for (int d = 0; d < 3; ++d)
            apart[d] = Plane::value && d == 1 ? 0 : u[place2[i] + d * lanes] - u[place1[i] + d * lanes];
        joints.checkJump(i, all[i].frame().transpose() * apart);
        const Vector3d force = joints.force(i, all[i]);
        CHECK((joints.inSpace(&onPoints[i * Arithmetic::perPoint]) - force).norm() < 1e-9 * force.norm());
        // `force` on side 1 and its opposite on side 2 have the moment -apart × force.
        const auto load = joints.load(i);
        CHECK((load.torque1 + load.torque2 - apart.cross(force)).norm() < 1e-8);
        CHECK(load.torque1 == load.torque2);
        CHECK(load.force[0] == -1); // forces go to the nodes
    }
}

TEST_CASE("rotations in the plane are read with their half angle, and any other rotation and NaN is found") {
    Dice dice(14);
    const int n = 11;
    std::vector<double> now[4], inverse[4], cosine(n), sine(n), angles;
    for (int i = 0; i < n; ++i) {
        const auto reference = dice.rotation();
        angles.push_back(dice.between(-3, 3));
        add(now, aboutY(angles[i]) * reference);
        add(inverse, reference.conjugate());
    }
    const auto read = [&] {
        return turnsInPlane(n, pointers(now).data(), pointers(inverse).data(), cosine.data(), sine.data());
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
    const double largest = 2 - 2 * std::cos(n * M_PI / (n + 1));
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
