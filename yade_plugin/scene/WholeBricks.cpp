// SPDX-License-Identifier: GPL-2.0-or-later
#include "WholeBricks.hpp"
#include "BodyStep.hpp"
#include "MonolithicPairs.hpp"
#include "motion/RigidParts.hpp"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>

namespace masonry {

using yade::Matrix3r;
using yade::Quaternionr;
using yade::State;
using yade::Vector3r;

namespace {

constexpr int piece = RigidMotion::most; // number of bricks that a thread takes at a time
constexpr double flatness = 1e-9;        // of a brick's length: its halves are where they were by this much at least
constexpr double slow = 1e-3;            // the same of velocities
constexpr unsigned allAxes = 63;

// Whether a body that is blocked in these axes can move as a part of a larger one that is blocked alike: a free
// rotation moves the centre along the two other axes.
bool mayBeHalf(unsigned blocked) {
    if ((blocked & allAxes) == allAxes) return true;
    for (int d = 0; d < 3; ++d)
        for (int other = 0; other < 3; ++other)
            if (!(blocked >> (3 + d) & 1) && other != d && blocked >> other & 1) return false;
    return true;
}

Matrix3r tensorOf(const Vector3r& inertia, const Quaternionr& turned) {
    const Matrix3r axes = turned.toRotationMatrix();
    return axes * inertia.asDiagonal() * axes.transpose();
}

Matrix3r tensorOf(double mass, const Vector3r& arm) {
    return mass * (arm.squaredNorm() * Matrix3r::Identity() - arm * arm.transpose());
}

// The largest number up to `most` for which a law stays elastic, as `within` says; infinite if it does up to there.
template <class F> double largest(double most, F&& within) {
    if (within(most)) return HUGE_VAL;
    double low = 0, high = most;
    while (high > 1e-6 && high - low > 1e-9 * high) {
        const double middle = low > 0 ? 0.5 * (low + high) : 0.1 * high;
        (within(middle) ? low : high) = middle;
    }
    return low;
}

// Least and largest normal stress and largest shear stress of a box within which a law stays elastic [Pa]. The stresses
// for which it does are convex, so a box is within them if its corners are.
std::array<double, 3> boxOf(const LawColumns& columns) {
    const auto within = [&](double normal, double shear) {
        const auto f = columns.yieldingUnder(normal, {shear, 0});
        return f.tension <= 0 && f.slip <= 0 && f.cap <= 0;
    };
    constexpr double most = 1e15, share = 0.9;
    const double tension = largest(most, [&](double s) { return within(s, 0); });
    const double high = std::isfinite(tension) ? share * tension : HUGE_VAL;
    const double shear = largest(most, [&](double t) { return within(std::min(high, most), t); });
    const double aside = std::isfinite(shear) ? share * shear : HUGE_VAL;
    const double size = std::min(aside, most);
    const double pressed = within(0, size) ? largest(most, [&](double s) { return within(-s, size); }) : 0;
    return {std::isfinite(pressed) ? -share * pressed : -HUGE_VAL, high, aside};
}

} // namespace

// ---- reading the scene ------------------------------------------------------------------------------------------

void WholeBricks::resize(int count) {
    own_.resize(count);
    for (auto* columns : {last_, turned_[0], turned_[1], face_, local_[0], local_[1], arm_[0], arm_[1], inertia1_,
                          middle_, bend_, box_, force_, moment_}) {
        const int width = columns == last_                                                     ? 6
                          : columns == turned_[0] || columns == turned_[1] || columns == face_ ? 4
                                                                                               : 3;
        for (int d = 0; d < width; ++d)
            columns[d].resize(count, 0);
    }
    for (auto& column : reach_)
        column.resize(count, 0);
    mass1_.resize(count, 1);
    perArea_.resize(count, 0);
    twist_.resize(count, 0);
    outside_.resize(count, 0);
}

// Visits the numbers of a brick that do not follow from others.
template <class F> void WholeBricks::eachNumber(int n, F&& visit) {
    for (auto& column : own_.position)
        visit(column[n]);
    for (auto& column : own_.orientation)
        visit(column[n]);
    for (auto& column : own_.velocity)
        visit(column[n]);
    for (auto& column : last_)
        visit(column[n]);
    for (int side = 0; side < 2; ++side) {
        for (auto& column : local_[side])
            visit(column[n]);
        for (auto& column : turned_[side])
            visit(column[n]);
    }
    for (auto* columns : {force_, moment_})
        for (int d = 0; d < 3; ++d)
            visit(columns[d][n]);
    auto& brick = bricks_[n];
    double spins = brick.spins;
    visit(spins);
    brick.spins = spins != 0;
    if (brick.spins && !brick.state) brick.state.reset(new State);
    Vector3r momentum = brick.spins ? brick.state->angMom : Vector3r::Zero();
    Vector3r spin = brick.spins ? brick.state->angVel : Vector3r::Zero();
    Vector3r speed = brick.spins ? brick.state->vel : Vector3r::Zero();
    for (auto* v : {&momentum, &spin, &speed})
        for (int d = 0; d < 3; ++d)
            visit((*v)[d]);
    if (!brick.spins) return;
    brick.state->angMom = momentum;
    brick.state->angVel = spin;
    brick.state->vel = speed;
}

std::vector<double> WholeBricks::numbers() {
    if (restore_) return restored_;
    std::vector<double> all;
    for (int n = 0; n < int(bricks_.size()); ++n) {
        if (!bricks_[n].whole) continue;
        all.push_back(bricks_[n].body[0]);
        all.push_back(bricks_[n].body[1]);
        eachNumber(n, [&](double& number) { all.push_back(number); });
    }
    return all;
}

void WholeBricks::setNumbers(const std::vector<double>& all) {
    restored_ = all;
    restore_ = true;
    revision_ = -1;
}

void WholeBricks::update(SceneContents& scene) {
    if (revision_ == scene.revision() && !restore_) return;
    std::map<std::pair<int, int>, std::vector<double>> known; // numbers of the bricks by their bodies
    const auto before = numbers();
    constexpr std::size_t width = 2 + 13 + 6 + 14 + 6 + 1 + 9;
    if (before.size() % width != 0) throw std::invalid_argument("the saved state of whole bricks is damaged");
    for (std::size_t at = 0; at < before.size(); at += width)
        known[{int(before[at]), int(before[at + 1])}].assign(before.begin() + at + 2, before.begin() + at + width);
    restored_.clear();
    restore_ = false;
    bricks_.clear();
    boxes_.clear();
    auto& bodies = scene.bodies;
    brickOf_.assign(bodies.size(), -1);
    bodies.isHalf.assign(bodies.size(), false);
    std::map<const JointShapes*, int> kindOf;
    for (int k = 0; k < int(scene.kinds.size()); ++k) {
        kindOf[scene.kinds[k].shapes.get()] = k;
        scene.kinds[k].shapes->whole.clear();
    }
    if (scene.loop)
        for (const auto& pair : monolithicPairs(scene)) {
            const auto& joint = scene.joints[pair.joint];
            if (pair.split || joint.geom->reference().attached) continue;
            Brick brick;
            brick.body[0] = pair.body1;
            brick.body[1] = pair.body2;
            brick.kind = kindOf.at(joint.geom->group.get());
            brick.joint = joint.geom->index;
            bricks_.push_back(std::move(brick));
        }
    resize(int(bricks_.size()));
    for (int n = 0; n < int(bricks_.size()); ++n) {
        auto& brick = bricks_[n];
        const auto found = known.find({brick.body[0], brick.body[1]});
        bool whole = true;
        if (found != known.end()) {
            const double* next = found->second.data();
            eachNumber(n, [&](double& number) { number = *next++; });
            complete(scene, n);
            whole = asPlaced(scene, n);
        } else
            whole = false;
        if (!whole) whole = adopt(scene, n);
        auto& kind = scene.kinds[brick.kind];
        if (!whole) { // a script has moved its halves against each other, or holds one of them
            kind.shapes->joints[brick.joint].split = true;
            continue;
        }
        brick.whole = true;
        brick.blocked = bodies.blockedAxes(brick.body[0]);
        kind.shapes->whole.resize(kind.shapes->joints.size(), 0);
        kind.shapes->whole[brick.joint] = 1;
        for (int side = 0; side < 2; ++side) {
            brickOf_[brick.body[side]] = n;
            bodies.isHalf[brick.body[side]] = true;
            brick.takes[side] = bodies.takes(brick.body[side]);
            brick.momentum[side] = bodies.state(brick.body[side]).angMom;
        }
    }
    revision_ = scene.revision();
}

// Whether both halves are held in the same axes, as halves of a brick can be.
bool WholeBricks::held(const BodyColumns& bodies, int n, unsigned& blocked) const {
    const auto& brick = bricks_[n];
    blocked = bodies.blockedAxes(brick.body[0]) & allAxes;
    return blocked == (bodies.blockedAxes(brick.body[1]) & allAxes) && mayBeHalf(blocked);
}

// Makes a brick of the present places and motions of its halves. Returns false if these are not those of one body.
bool WholeBricks::adopt(SceneContents& scene, int n) {
    auto& brick = bricks_[n];
    const auto& bodies = scene.bodies;
    unsigned blocked;
    if (!held(bodies, n, blocked)) return false;
    const State* s[2] = {&bodies.state(brick.body[0]), &bodies.state(brick.body[1])};
    const auto& r = scene.kinds[brick.kind].shapes->joints[brick.joint];
    const double mass = s[0]->mass + s[1]->mass;
    const Vector3r centre = (s[0]->mass * s[0]->pos + s[1]->mass * s[1]->pos) / mass;
    Vector3r velocity = (s[0]->mass * s[0]->vel + s[1]->mass * s[1]->vel) / mass;
    const double length = (s[1]->pos - s[0]->pos).norm();
    const Quaternionr frame1 = s[0]->ori * r.frame(0), frame2 = s[1]->ori * r.frame(1);
    const Vector3r apart = frame1.conjugate() * (s[1]->pos - s[0]->pos) - r.span();
    if (!(apart.norm() <= flatness * length) || !(frame1.angularDistance(frame2) <= flatness)) return false;

    brick.spins = (blocked >> 3) == 0;
    Quaternionr turned = Quaternionr::Identity();
    Vector3r spin = Vector3r::Zero(), momentum = Vector3r::Zero(), arms[2];
    Matrix3r tensor = Matrix3r::Zero();
    for (int side = 0; side < 2; ++side) {
        arms[side] = s[side]->pos - centre;
        const Matrix3r own =
            brick.spins ? tensorOf(s[side]->inertia, s[side]->ori) : Matrix3r(s[side]->inertia.asDiagonal());
        tensor += own + tensorOf(s[side]->mass, arms[side]);
        momentum += s[side]->mass * arms[side].cross(s[side]->vel - velocity);
        momentum += brick.spins ? s[side]->angMom : Vector3r(s[side]->inertia.cwiseProduct(s[side]->angVel));
    }
    if (brick.spins) {
        const Eigen::SelfAdjointEigenSolver<Matrix3r> principal(tensor);
        Matrix3r axes = principal.eigenvectors();
        if (axes.determinant() < 0) axes.col(2) *= -1;
        turned = Quaternionr(axes).normalized();
        spin = axes * (axes.transpose() * momentum).cwiseQuotient(principal.eigenvalues());
    } else
        for (int d = 0; d < 3; ++d)
            spin[d] = blocked >> (3 + d) & 1 ? s[0]->angVel[d] : momentum[d] / tensor(d, d);
    const double speed = s[0]->vel.norm() + s[1]->vel.norm() + length * (s[0]->angVel.norm() + s[1]->angVel.norm());
    for (int side = 0; side < 2; ++side) {
        const Vector3r off = s[side]->vel - velocity - spin.cross(arms[side]);
        if (!(off.norm() + length * (s[side]->angVel - spin).norm() <= slow * speed)) return false;
        put(local_[side], n, turned.conjugate() * arms[side]);
        put(turned_[side], n, turned.conjugate() * s[side]->ori);
    }
    put(own_.position, n, centre);
    put(own_.orientation, n, turned);
    put(own_.velocity, n, velocity);
    put(own_.velocity + 3, n, spin);
    put(force_, n, Vector3r(Vector3r::Zero()));
    put(moment_, n, Vector3r(Vector3r::Zero()));
    for (auto& column : last_)
        column[n] = 0;
    brick.state.reset();
    if (brick.spins) {
        brick.state.reset(new State);
        brick.state->vel = velocity;
        brick.state->angMom = momentum;
        brick.state->angVel = spin;
        put(own_.velocity, n, Vector3r(Vector3r::Zero()));
        put(own_.velocity + 3, n, Vector3r(Vector3r::Zero()));
    }
    complete(scene, n);
    return true;
}

// Finds what follows from the numbers of a brick, from its halves and from its joint.
void WholeBricks::complete(const SceneContents& scene, int n) {
    auto& brick = bricks_[n];
    const auto& bodies = scene.bodies;
    const auto& shapes = *scene.kinds[brick.kind].shapes;
    const auto& columns = *scene.kinds[brick.kind].states->columns;
    const auto& r = shapes.joints[brick.joint];
    const Quaternionr turned = turnOf(own_.orientation, n);
    Matrix3r tensor = Matrix3r::Zero();
    double mass = 0;
    for (int side = 0; side < 2; ++side) {
        const auto& s = bodies.state(brick.body[side]);
        const Vector3r local = vectorOf(local_[side], n);
        const Matrix3r own =
            brick.spins ? tensorOf(s.inertia, turnOf(turned_[side], n)) : Matrix3r(s.inertia.asDiagonal());
        tensor += own + tensorOf(s.mass, local);
        mass += s.mass;
        put(arm_[side], n, turned * local);
        if (side == 0) {
            mass1_[n] = s.mass;
            put(inertia1_, n, s.inertia);
        }
    }
    own_.mass[n] = mass;
    put(own_.inertia, n, Vector3r(tensor.diagonal()));
    if (brick.spins) {
        auto& s = *brick.state;
        s.mass = mass;
        s.inertia = tensor.diagonal();
        s.pos = vectorOf(own_.position, n);
        s.ori = turned;
        s.blockedDOFs = 0;
    }
    put(face_, n, turnOf(turned_[0], n) * r.frame(0));

    double area = 0;
    Vector3r middle = Vector3r::Zero();
    for (int p = 0; p < shapes.points; ++p) {
        area += shapes.areaAt(p, brick.joint);
        middle += shapes.areaAt(p, brick.joint) * shapes.offsetAt(p, brick.joint);
    }
    middle /= area;
    put(middle_, n, middle);
    perArea_[n] = 1 / area;
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero(); // of z and y
    reach_[0][n] = reach_[1][n] = 0;
    for (int p = 0; p < shapes.points; ++p) {
        const Vector3r off = shapes.offsetAt(p, brick.joint) - middle;
        const Eigen::Vector2d zy(off[2], off[1]);
        second += shapes.areaAt(p, brick.joint) * zy * zy.transpose();
        for (int d = 0; d < 2; ++d)
            reach_[d][n] = std::max(reach_[d][n], std::abs(off[1 + d]));
    }
    // Points in one row resist bending about one axis alone.
    const double all = second.trace();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(second);
    Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
    for (int d = 0; d < 2; ++d) {
        const double value = axes.eigenvalues()[d];
        const Eigen::Vector2d axis = axes.eigenvectors().col(d);
        if (value > 1e-9 * all) inverse += axis * axis.transpose() / value;
    }
    bend_[0][n] = inverse(0, 0);
    bend_[1][n] = inverse(0, 1);
    bend_[2][n] = inverse(1, 1);
    twist_[n] = all > 0 ? 1 / all : 0;

    const auto known = boxes_.find(brick.kind);
    const auto box = known != boxes_.end() ? known->second : boxes_[brick.kind] = boxOf(columns);
    for (int d = 0; d < 3; ++d)
        box_[d][n] = box[d];
}

// Whether the halves are where the brick says, and move as it says.
bool WholeBricks::asPlaced(const SceneContents& scene, int n) const {
    const auto& bodies = scene.bodies;
    const auto& brick = bricks_[n];
    unsigned blocked;
    if (!held(bodies, n, blocked) || brick.spins != ((blocked >> 3) == 0)) return false;
    const Vector3r centre = vectorOf(own_.position, n);
    const Vector3r velocity = brick.spins ? brick.state->vel : vectorOf(own_.velocity, n);
    const Vector3r spin = brick.spins ? brick.state->angVel : vectorOf(own_.velocity + 3, n);
    const Quaternionr turned = turnOf(own_.orientation, n);
    constexpr double round = 1e-12;
    double mass = 0;
    for (int side = 0; side < 2; ++side) {
        const auto& s = bodies.state(brick.body[side]);
        const Vector3r arm = turned * vectorOf(local_[side], n);
        const double length = arm.norm(), speed = velocity.norm() + length * spin.norm();
        // velocities belong to the middle of the step
        const double step = 2 * scene.scene().dt * spin.squaredNorm() * length;
        if (!((s.pos - centre - arm).norm() <= round * (length + centre.norm())) ||
            !((turned * turnOf(turned_[side], n)).angularDistance(s.ori) <= 1e-7) ||
            !((s.vel - velocity - spin.cross(arm)).norm() <= step + round * speed) ||
            !((s.angVel - spin).norm() <= round * spin.norm()))
            return false;
        const Vector3r momentum = tensorOf(s.inertia, s.ori) * s.angVel;
        if (brick.spins && !((s.angMom - momentum).norm() <= round * momentum.norm())) return false;
        mass += s.mass;
    }
    return mass == own_.mass[n] && bodies.state(brick.body[0]).mass == mass1_[n];
}

// ---- a step -----------------------------------------------------------------------------------------------------

int WholeBricks::pieces() const { return (int(bricks_.size()) + piece - 1) / piece; }

void WholeBricks::notice(SceneContents& scene, const Around& around) {
    auto& bodies = scene.bodies;
    const bool thoroughly = scene.scene().iter % 10 == 0;
    for (int n = 0; n < int(bricks_.size()); ++n) {
        auto& brick = bricks_[n];
        if (!brick.whole) continue;
        bool same = true;
        for (int side = 0; side < 2; ++side) {
            const int body = brick.body[side];
            thoroughly ? bodies.noticeAll(body) : bodies.notice(body);
            same = same && brick.takes[side] == bodies.takes(body);
            same = same && (!brick.spins || brick.momentum[side] == bodies.state(body).angMom);
            brick.momentum[side] = bodies.state(body).angMom;
            brick.takes[side] = bodies.takes(body);
        }
        if (same) continue;
        unsigned blocked;
        const bool alike = held(bodies, n, blocked);
        brick.blocked = blocked;
        if (!alike) {
            split(scene, around, n, true);
            carry(around, n);
        } else if (!asPlaced(scene, n) && !adopt(scene, n))
            split(scene, around, n, false);
    }
}

// Adds what a crack surface transferred in the last step to the forces of its blocks in this one, of which the joints
// have made their part already.
void WholeBricks::carry(const Around& around, int n) {
    const auto& brick = bricks_[n];
    const Quaternionr axes = turnOf(own_.orientation, n) * turnOf(face_, n);
    const Vector3r force = axes * vectorOf(force_, n), arm = axes * vectorOf(middle_, n);
    const Vector3r moment = axes * vectorOf(moment_, n);
    const Vector3r between = vectorOf(arm_[1], n) - vectorOf(arm_[0], n);
    around.forces[brick.body[0]] += force;
    around.forces[brick.body[1]] -= force;
    around.torques[brick.body[0]] += moment + arm.cross(force);
    around.torques[brick.body[1]] -= moment + (arm - between).cross(force);
}

EnergyLedger WholeBricks::advancePiece(SceneContents& scene, const Around& around, int number) {
    const int first = number * piece, count = std::min(piece, int(bricks_.size()) - first);
    auto& bodies = scene.bodies;
    EnergyLedger sum;
    RigidMotion motion;
    double force1[3][piece] = {}, torque1[3][piece] = {}, released[6][piece];
    std::vector<unsigned char>& outside = outside_;
    unsigned axes = 0;
    bool spinning = false;
    unsigned char moves[piece];
    Vector3r on[piece][4]; // of bricks that turn freely: force and torque of both halves
    for (int i = 0; i < count; ++i) {
        const int n = first + i;
        const auto& brick = bricks_[n];
        moves[i] = 0;
        outside[n] = 0;
        motion.alpha[i] = motion.viscous[i] = 0;
        for (int d = 0; d < 6; ++d)
            motion.force[d][i] = released[d][i] = 0;
        if (!brick.whole) continue;
        const int a = brick.body[0], b = brick.body[1];
        const auto &f1 = around.forces[a], &f2 = around.forces[b], &t1 = around.torques[a], &t2 = around.torques[b];
        const bool damped = bodies.isDamped(a) && bodies.isDamped(b);
        if (brick.spins) {
            spinning = true;
            moves[i] = 2;
            on[i][0] = f1;
            on[i][1] = t1;
            on[i][2] = f2;
            on[i][3] = t2;
            continue;
        }
        const unsigned blocked = brick.blocked;
        unsigned own = ~blocked & allAxes;
        for (int d = 0; d < 6; ++d)
            own |= unsigned(own_.velocity[d][n] != 0) << d;
        if (own == 0) continue;
        axes |= own;
        moves[i] = 1;
        motion.alpha[i] = damped ? around.damping : 0;
        motion.viscous[i] = damped ? around.massDamping : 0;
        const double r0 = arm_[0][0][n], r1 = arm_[0][1][n], r2 = arm_[0][2][n];
        const double s0 = arm_[1][0][n], s1 = arm_[1][1][n], s2 = arm_[1][2][n];
        for (int d = 0; d < 3; ++d) {
            force1[d][i] = f1[d];
            torque1[d][i] = t1[d];
            motion.force[d][i] = f1[d] + f2[d];
        }
        motion.force[3][i] = t1[0] + t2[0] + (r1 * f1[2] - r2 * f1[1]) + (s1 * f2[2] - s2 * f2[1]);
        motion.force[4][i] = t1[1] + t2[1] + (r2 * f1[0] - r0 * f1[2]) + (s2 * f2[0] - s0 * f2[2]);
        motion.force[5][i] = t1[2] + t2[2] + (r0 * f1[1] - r1 * f1[0]) + (s0 * f2[1] - s1 * f2[0]);
        for (int d = 0; d < 6; ++d)
            released[d][i] = blocked >> d & 1 ? 0.0 : 1.0;
    }
    if (axes == 0 && !spinning) return sum;

    const auto from = [&](const std::vector<double>& column) { return &column[first]; };
    const auto into = [&](std::vector<double>& column) { return &column[first]; };
    if (axes != 0) {
        HalfForces half{};
        half.mass = from(own_.mass);
        half.mass1 = from(mass1_);
        for (int d = 0; d < 3; ++d) {
            half.inertia[d] = from(own_.inertia[d]);
            half.spin[d] = from(own_.velocity[3 + d]);
            half.inertia1[d] = from(inertia1_[d]);
            half.arm1[d] = from(arm_[0][d]);
            half.force1[d] = force1[d];
            half.torque1[d] = torque1[d];
            half.middle[d] = from(middle_[d]);
            half.resultForce[d] = into(force_[d]);
            half.resultMoment[d] = into(moment_[d]);
        }
        for (int d = 0; d < 4; ++d) {
            half.orientation[d] = from(own_.orientation[d]);
            half.face[d] = from(face_[d]);
        }
        for (int d = 0; d < 6; ++d) {
            half.force[d] = motion.force[d];
            half.free[d] = released[d];
        }
        findHalfForces(count, half);
        const RigidMotion::Around with{
            around.dt, {around.gravity[0], around.gravity[1], around.gravity[2]}, around.combined};
        double unused[piece] = {}; // local damping does not use earlier forces
        double* last[6];
        for (int d = 0; d < 6; ++d) {
            last[d] = around.combined ? into(last_[d]) : unused;
            std::copy_n(released[d], count, motion.free[d]);
        }
        motion.advance(own_, last, first, count, with, axes);
        for (int i = 0; i < count; ++i) {
            if (moves[i] != 1) continue;
            sum.external += motion.work[i];
            sum.damped += motion.damped[0][i];
            sum.pendingDamped += motion.damped[1][i];
            sum.kinetic += motion.kinetic[i];
        }
        sum.pendingExternal = sum.external;
    }
    for (int i = 0; spinning && i < count; ++i)
        if (moves[i] == 2) sum.add(turnFreely(scene, around, first + i, on[i]));

    double placed[2][13][piece];
    for (int side = 0; side < 2; ++side) {
        const double *position[3], *orientation[4], *velocity[6], *local[3], *turned[4];
        double *arm[3], *to[13];
        for (int d = 0; d < 3; ++d) {
            position[d] = from(own_.position[d]);
            local[d] = from(local_[side][d]);
            arm[d] = into(arm_[side][d]);
        }
        for (int d = 0; d < 4; ++d) {
            orientation[d] = from(own_.orientation[d]);
            turned[d] = from(turned_[side][d]);
        }
        for (int d = 0; d < 6; ++d)
            velocity[d] = from(own_.velocity[d]);
        for (int d = 0; d < 13; ++d)
            to[d] = placed[side][d];
        placeParts(count, position, orientation, velocity, local, turned, arm, to);
    }
    for (int i = 0; i < count; ++i) {
        if (!moves[i]) continue;
        const int n = first + i;
        for (int side = 0; side < 2; ++side) {
            const int body = bricks_[n].body[side];
            for (int d = 0; d < 3; ++d)
                bodies.position[d][body] = placed[side][d][i];
            for (int d = 0; d < 4; ++d)
                bodies.orientation[d][body] = placed[side][3 + d][i];
            for (int d = 0; d < 6; ++d)
                bodies.velocity[d][body] = placed[side][7 + d][i];
            bodies.give(body, allAxes);
            if (moves[i] != 2) continue;
            auto& s = bodies.state(body);
            s.angMom = bricks_[n].momentum[side] = tensorOf(s.inertia, s.ori) * s.angVel;
        }
        if (moves[i] != 2) continue;
        for (auto& column : own_.velocity)
            column[n] = 0; // RigidMotion does not move the brick; its velocity is in its State
    }
    const FaceStresses stresses{{from(force_[0]), from(force_[1]), from(force_[2])},
                                {from(moment_[0]), from(moment_[1]), from(moment_[2])},
                                from(perArea_),
                                {from(bend_[0]), from(bend_[1]), from(bend_[2])},
                                from(twist_),
                                {from(reach_[0]), from(reach_[1])},
                                {from(box_[0]), from(box_[1]), from(box_[2])},
                                &outside[first]};
    compareWithBox(count, stresses);
    return sum;
}

// A step of a brick that turns freely in space; leaves its motion in the columns, for its halves.
EnergyLedger WholeBricks::turnFreely(SceneContents& scene, const Around& around, int n, const Vector3r (&on)[4]) {
    auto& brick = bricks_[n];
    auto& s = *brick.state;
    const auto& bodies = scene.bodies;
    s.isDamped = bodies.isDamped(brick.body[0]) && bodies.isDamped(brick.body[1]);
    const Vector3r arm1 = vectorOf(arm_[0], n), arm2 = vectorOf(arm_[1], n);
    const BodyForces all{on[0] + on[2], on[1] + on[3] + arm1.cross(on[0]) + arm2.cross(on[2])};

    // What half 1 lacks to move as the brick does, as in findHalfForces().
    const Matrix3r tensor = tensorOf(s.inertia, s.ori);
    const Matrix3r tensor1 = tensorOf(vectorOf(inertia1_, n), bodies.state(brick.body[0]).ori);
    const Vector3r w = s.angVel, turn = inverseInertia(s) * (all.torque - w.cross(tensor * w));
    const Vector3r lacks = mass1_[n] * (all.force / s.mass + turn.cross(arm1) + w.cross(w.cross(arm1))) - on[0];
    const Vector3r twists = tensor1 * turn + w.cross(tensor1 * w) - on[1];
    const Quaternionr axes = s.ori * turnOf(face_, n);
    const Vector3r force = axes.conjugate() * lacks;
    put(force_, n, force);
    put(moment_, n, axes.conjugate() * twists - vectorOf(middle_, n).cross(force));

    BodyForces before{vectorOf(last_, n), vectorOf(last_ + 3, n)};
    const auto step = stepOf(s, all, around.gravity, around.dt,
                             {around.damping, false, around.combined ? &before : nullptr, around.massDamping});
    put(last_, n, before.force);
    put(last_ + 3, n, before.torque);
    s.vel = step.vel;
    s.pos += around.dt * s.vel;
    turnInSpace(s, step, around.dt);
    put(own_.position, n, s.pos);
    put(own_.orientation, n, s.ori);
    put(own_.velocity, n, s.vel);
    put(own_.velocity + 3, n, s.angVel);
    return step.energies;
}

// ---- splitting --------------------------------------------------------------------------------------------------

namespace {

// Stresses that are linear over a face, by force and moment in its plane.
struct LinearStress {
    Vector3r middle;                    // stress at the middle of the face [Pa]
    double normalByY, normalByZ, twist; // growth along the tangents [Pa/m]
    Vector3r at(const Vector3r& off) const {
        return middle + Vector3r(normalByY * off[1] + normalByZ * off[2], -twist * off[2], twist * off[1]);
    }
};

LinearStress stressOf(const Vector3r& force, const Vector3r& moment, double perArea, double zz, double yz, double yy,
                      double twist) {
    return {perArea * force, yz * moment[1] - yy * moment[2], zz * moment[1] - yz * moment[2], twist * moment[0]};
}

} // namespace

bool WholeBricks::yields(const SceneContents& scene, int n) const {
    const auto& brick = bricks_[n];
    const auto& shapes = *scene.kinds[brick.kind].shapes;
    const auto& columns = *scene.kinds[brick.kind].states->columns;
    const auto stress = stressOf(vectorOf(force_, n), vectorOf(moment_, n), perArea_[n], bend_[0][n], bend_[1][n],
                                 bend_[2][n], twist_[n]);
    for (int p = 0; p < shapes.points; ++p) {
        const Vector3r s = stress.at(shapes.offsetAt(p, brick.joint) - vectorOf(middle_, n));
        const auto f = columns.yieldingUnder(s[0], {s[1], s[2]});
        if (f.tension > 0 || f.slip > 0 || f.cap > 0) return true;
    }
    return false;
}

void WholeBricks::splitYielded(SceneContents& scene, const Around& around) {
    for (int n = 0; n < int(bricks_.size()); ++n)
        if (outside_[n] && bricks_[n].whole && yields(scene, n)) split(scene, around, n, true);
}

// Makes two blocks of a brick. Where they are, the crack surface gets the jump under which its law carries force and
// moment of the last step: its reference moves, and the blocks stay. `loaded`: whether it carries them at all.
void WholeBricks::split(SceneContents& scene, const Around& around, int n, bool loaded) {
    auto& brick = bricks_[n];
    auto& bodies = scene.bodies;
    auto& shapes = *scene.kinds[brick.kind].shapes;
    auto& columns = *scene.kinds[brick.kind].states->columns;
    auto& r = shapes.joints[brick.joint];
    brick.whole = false;
    outside_[n] = 0;
    shapes.whole[brick.joint] = 0;
    r.split = true;
    ++splits;

    const Vector3r middle = vectorOf(middle_, n);
    Vector3r force = vectorOf(force_, n), moment = vectorOf(moment_, n);
    if (loaded) {
        // In a planar run nothing acts out of the plane but round-off.
        const double length = reach_[0][n] + reach_[1][n], size = length * force.norm() + moment.norm();
        for (int d = 0; d < 3; ++d) {
            if (std::abs(length * force[d]) < 1e-12 * size) force[d] = 0;
            if (std::abs(moment[d]) < 1e-12 * size) moment[d] = 0;
        }
        const auto stress = stressOf(force, moment, perArea_[n], bend_[0][n], bend_[1][n], bend_[2][n], twist_[n]);
        const auto& k = columns.stiffness();
        // The jump is that of a rigid motion: `slide` at the middle and the rotation vector `turn`.
        const Vector3r slide(stress.middle[0] / k.normal, stress.middle[1] / k.shear, stress.middle[2] / k.shear);
        const Vector3r turn(stress.twist / k.shear, stress.normalByZ / k.normal, -stress.normalByY / k.normal);
        for (int p = 0; p < shapes.points; ++p) {
            const Vector3r jump = slide + turn.cross(shapes.offsetAt(p, brick.joint) - middle);
            const double normal = columns.advanceOne(p, brick.joint, {jump[0], {jump[1], jump[2]}});
            const auto s = columns.state(p, brick.joint);
            shapes.setJump(p, brick.joint, jump);
            energy += 0.5 * shapes.areaAt(p, brick.joint) *
                      (normal * jump[0] + s.shearStress.a * jump[1] + s.shearStress.b * jump[2]);
        }
        // Jumps are 4 w v × a + common with the quaternion (w, v) of half the relative rotation: see JointFrames.
        const double angle = turn.norm(), half = 0.5 * std::asin(0.5 * angle);
        Quaternionr by = Quaternionr::Identity();
        if (angle > 0) {
            by.w() = std::cos(half);
            by.vec() = std::sin(half) / angle * turn;
        }
        const Quaternionr axes(r.axes());
        const Vector3r common = slide - turn.cross(middle);
        const Vector3r span = by.conjugate() * (r.span() - common);
        r.sides[0].orientation = axes * by * axes.conjugate() * r.sides[0].orientation;
        r.sides[1].orientation = axes * by.conjugate() * axes.conjugate() * r.sides[1].orientation;
        r.sides[1].position = r.sides[0].position + r.axes() * span;
    }
    scene.splits.push_back({brick.kind, brick.joint});

    // The halves go on as they moved, and damping remembers what they were accelerated by.
    const Vector3r lastTurn = vectorOf(last_ + 3, n);
    const Vector3r whole = brick.spins ? brick.state->angMom : Vector3r(Vector3r::Zero());
    Vector3r missing = whole;
    for (int side = 0; side < 2; ++side) {
        const int body = brick.body[side];
        auto& s = bodies.state(body);
        const Vector3r arm = vectorOf(arm_[side], n);
        bodies.isHalf[body] = false;
        brickOf_[body] = -1;
        if (around.combined) {
            const Vector3r turn =
                brick.spins ? Vector3r(inverseInertia(*brick.state) * brick.state->inertia.cwiseProduct(lastTurn))
                            : lastTurn;
            const Vector3r push = vectorOf(last_, n) + turn.cross(arm);
            const Vector3r torque =
                brick.spins ? Vector3r(tensorOf(s.inertia, s.ori) * turn).cwiseQuotient(s.inertia) : turn;
            for (int d = 0; d < 3; ++d) {
                around.last[d][body] = push[d];
                around.last[3 + d][body] = torque[d];
            }
        }
        if (brick.spins) {
            s.angMom = tensorOf(s.inertia, s.ori) * brick.state->angVel;
            missing -= s.angMom + s.mass * arm.cross(s.vel - brick.state->vel);
        }
        bodies.take(body);
    }
    for (int side = 0; brick.spins && side < 2; ++side) // round-off of the step, so that the spin stays as it was
        bodies.state(brick.body[side]).angMom += 0.5 * missing;
    for (auto& column : own_.velocity)
        column[n] = 0;
}

// ---- for others -------------------------------------------------------------------------------------------------

const WholeBricks::Carrier* WholeBricks::carrierOf(int body, Carrier& carrier) const {
    if (body >= int(brickOf_.size()) || brickOf_[body] < 0) return nullptr;
    const int n = brickOf_[body];
    const auto& brick = bricks_[n];
    carrier.body1 = brick.body[0];
    carrier.body2 = brick.body[1];
    carrier.centre = vectorOf(own_.position, n);
    if (brick.spins) {
        carrier.velocity = brick.state->vel;
        carrier.spin = brick.state->angVel;
        carrier.inverseMass = inverseMass(*brick.state);
        carrier.inverseInertia = inverseInertia(*brick.state);
        return &carrier;
    }
    carrier.velocity = vectorOf(own_.velocity, n);
    carrier.spin = vectorOf(own_.velocity + 3, n);
    Vector3r perInertia;
    for (int d = 0; d < 3; ++d) {
        carrier.inverseMass[d] = brick.blocked >> d & 1 ? 0 : 1 / own_.mass[n];
        perInertia[d] = brick.blocked >> (3 + d) & 1 ? 0 : 1 / own_.inertia[d][n];
    }
    carrier.inverseInertia = perInertia.asDiagonal();
    return &carrier;
}

std::vector<WholeBricks::Section> WholeBricks::sections() const {
    std::vector<Section> all;
    for (int n = 0; n < int(bricks_.size()); ++n)
        if (bricks_[n].whole)
            all.push_back({bricks_[n].body[0], bricks_[n].body[1], vectorOf(force_, n), vectorOf(moment_, n)});
    return all;
}

const WholeBricks::Section* WholeBricks::sectionOf(int body1, int body2, Section& section) const {
    if (body1 >= int(brickOf_.size()) || brickOf_[body1] < 0) return nullptr;
    const int n = brickOf_[body1];
    if (bricks_[n].body[0] != body1 || bricks_[n].body[1] != body2) return nullptr;
    section = {body1, body2, vectorOf(force_, n), vectorOf(moment_, n)};
    return &section;
}

} // namespace masonry
