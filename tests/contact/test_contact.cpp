// SPDX-License-Identifier: GPL-2.0-or-later
// The contact of convex blocks: a force that is the gradient of a potential, friction and damping that only take
// energy.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "../dice.hpp"
#include "../within.hpp"
#include "blocks/BlockShape.hpp"
#include "contact/BroadPhase.hpp"
#include "contact/ContactDamping.hpp"
#include "contact/ContactEnds.hpp"
#include "contact/ContactFriction.hpp"
#include "contact/ContactStep.hpp"
#include "contact/Overlap.hpp"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <functional>

using namespace masonry;
using boost::math::quadrature::gauss_kronrod;

namespace {

using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;
using Turn = Eigen::Quaterniond;
ContactBlock blockOf(const std::vector<Vector>& points) {
    const auto shape = blockAround(points);
    std::vector<Vector> corners;
    for (const auto& v : shape.vertices)
        corners.push_back(shape.orientation * v);
    return contactBlock(corners, shape.triangles);
}

ContactBlock box(const Vector& size) {
    std::vector<Vector> points;
    for (int i = 0; i < 8; ++i)
        points.push_back(size.cwiseProduct(Vector((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, (i >> 2) - 0.5)));
    return blockOf(points);
}

ContactBlock hull(Dice& dice, int points) {
    std::vector<Vector> all;
    while (int(all.size()) < points) {
        const Vector v = dice.vector();
        if (v.norm() < 1 && v.norm() > 0.1) all.push_back(dice.between(0.08, 0.12) * v.normalized());
    }
    try {
        return blockOf(all);
    } catch (const std::invalid_argument&) { // four points that are nearly in one plane
        return hull(dice, points);
    }
}

const Vector brick(0.22, 0.102, 0.081);

ContactBlock anyBlock(Dice& dice, int mostPoints = 20) {
    const std::size_t kind = dice.oneOf(4);
    if (kind == 0) return box(brick);
    if (kind == 1) return box(Vector(0.5 * brick[0], brick[1], brick[2]));
    return hull(dice, int(4 + dice.oneOf(mostPoints - 3)));
}

struct Pair {
    ContactBlock one, other;
    OverlapFinder finder;
    Pair(ContactBlock a, ContactBlock b) : one(std::move(a)), other(std::move(b)) {
        finder.provideFor(one);
        finder.provideFor(other);
    }
    explicit Pair(Dice& dice, int mostPoints = 20) : Pair(anyBlock(dice, mostPoints), anyBlock(dice, mostPoints)) {}
    double size() const { return std::min(one.radius, other.radius); }
    // Forces of blocks that do not touch are zero.
    Overlap at(const RelativePose& pose) {
        int axis = 0;
        Overlap found;
        const Vector none = Vector::Zero();
        if (!finder.find(one, other, pose, axis, found))
            found = {none, none, 0, 0, none, 0, none, 0, none, Matrix::Zero()};
        return found;
    }
    double potential(const RelativePose& pose) { return finder.potential(one, other, pose); }
    // A scale for forces: no overlap of such a depth has more.
    double force(double depth) const { return size() * size() * depth; }
};

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 wrench(const Overlap& o) { return (Vector6() << o.force, o.moment).finished(); }

RelativePose moved(const RelativePose& pose, const Vector& shift, const Vector& turn) {
    const double angle = turn.norm();
    const Matrix r = angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix(Matrix::Identity());
    return {r * pose.turn, r * pose.place + shift};
}

// Derivative of a function at 0, to the fourth order.
double slope(const std::function<double(double)>& f, double h) {
    return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

// Compares force and moment on the other block with those that the potential gives.
void checkDescent(Pair& pair, const RelativePose& pose, double tolerance = 1e-6, double step = 1e-5) {
    const auto o = pair.at(pose);
    const double size = pair.size(), scale = std::max(o.pressing, 1e-6 * pair.force(size)); // beyond round-off
    for (int d = 0; d < 3; ++d) {
        const Vector axis = Vector::Unit(d), none = Vector::Zero();
        const double force = -slope([&](double h) { return pair.potential(moved(pose, h * axis, none)); }, step * size);
        const double moment = -slope([&](double h) { return pair.potential(moved(pose, none, h * axis)); }, step);
        CHECK(std::abs(o.force[d] - force) <= tolerance * scale);
        CHECK(std::abs(o.moment[d] - moment) <= tolerance * scale * size);
    }
}

// A pose in which the other block has been brought from afar until it overlaps the one by a depth, along a direction.
RelativePose pressed(Pair& pair, const Turn& turn, const Vector& direction, const Vector& aside, double depth) {
    RelativePose pose{turn.toRotationMatrix(), Vector::Zero()};
    double outside = 2 * (pair.one.radius + pair.other.radius), inside = 0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inside + outside);
        pose.place = aside + middle * direction;
        (pair.at(pose).pressing > 0 ? inside : outside) = middle;
    }
    pose.place = aside + (inside - depth) * direction;
    return pose;
}

// The same with any turn and direction.
RelativePose pressed(Pair& pair, Dice& dice, double depth) {
    return pressed(pair, dice.rotation(), dice.direction(), Vector::Zero(), depth);
}

Turn along(const Vector& from, const Vector& to) { return Turn::FromTwoVectors(from, to); }
Turn about(double angle, const Vector& axis) { return Turn(Eigen::AngleAxisd(angle, axis.normalized())); }

} // namespace

TEST_CASE("a brick has six faces with outward normals, and its area") {
    const auto block = box(brick);
    REQUIRE(block.faceCount() == 6);
    CHECK(block.edges.size() == 3);
    for (const auto& face : block.faces) {
        CHECK(face.beyond - face.first == 4);
        CHECK(face.offset > 0);
    }
    CHECK(block.surface == within(2 * (0.22 * 0.102 + 0.22 * 0.081 + 0.102 * 0.081), 1e-12));
    CHECK(block.largestFace == within(0.22 * 0.102, 1e-12));
    CHECK(block.thickness == within(0.081, 1e-12));
    CHECK_THROWS_AS(contactBlock({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}), std::invalid_argument);
    auto shape = blockAround({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    for (auto& t : shape.triangles)
        std::swap(t[0], t[1]); // they wind the wrong way round
    CHECK_THROWS_AS(contactBlock(shape.vertices, shape.triangles), std::invalid_argument);
}

TEST_CASE("face on face is stiffness times area times depth, up to the first order of depth over size") {
    Pair pair(box(Vector(1, 1, 0.5)), box(brick)); // the brick lies inside a face of the slab
    for (double depth : {1e-3, 1e-5, 1e-7}) {
        const RelativePose pose{Matrix::Identity(), {0.05, 0.02, 0.25 + 0.5 * brick[2] - depth}};
        const auto o = pair.at(pose);
        const double plain = brick[0] * brick[1] * depth, part = depth / brick[1];
        CHECK(o.force[2] == within(plain, part + 1e-9));
        CHECK(pair.potential(pose) == within(0.5 * plain * depth, part + 1e-9));
        CHECK(o.force.head<2>().norm() < 1e-12 * plain);
        CHECK(o.area == within(brick[0] * brick[1], 1e-9));
        CHECK((o.centre.head<2>() - Eigen::Vector2d(0.05, 0.02)).norm() < 1e-9);
        const double meanSquare = (brick[0] * brick[0] + brick[1] * brick[1]) / 12;
        CHECK(o.meanSquare == within(meanSquare, 3 * part + 1e-9));
        CHECK(o.normal[2] == within(1, 1e-9));
        CHECK(o.firstMoment[0] == within(0.05 * o.area, 1e-9));
        const double second = o.area * (brick[0] * brick[0] / 12 + 0.05 * 0.05);
        CHECK(o.secondMoment(0, 0) == within(second, 1e-9));
        CHECK(std::abs(o.secondMoment(0, 1) - 0.05 * 0.02 * o.area) < 1e-9 * second);
    }
    // The error falls with the first power of the depth: a strip beside the rim has the next face as the nearest one.
    const auto error = [&](double depth) {
        const auto o = pair.at({Matrix::Identity(), {0, 0, 0.25 + 0.5 * brick[2] - depth}});
        return std::abs(o.force[2] / (brick[0] * brick[1] * depth) - 1);
    };
    CHECK(error(2e-3) / error(1e-3) == within(2, 0.05));
}

TEST_CASE("a cube in the middle of a large one, and a cube in itself") {
    // The integral of the depth of a cube of side a is a⁴ / 8: pyramids of volume a³/6 with mean depth a/2/4 each.
    Pair same(box(Vector::Ones()), box(Vector::Ones()));
    const RelativePose here{Matrix::Identity(), Vector::Zero()};
    CHECK(same.potential(here) == within(0.125, 1e-12));
    CHECK(same.at(here).force.norm() < 1e-14);
    Pair nested(box(Vector::Ones()), box(0.5 * Vector::Ones()));
    // Of the large one: 1/4 below the surface of the small one and more inside; of the small one 1/128.
    const double expected = 0.5 * (0.125 * 0.25 + 0.0625 * 0.125 + 0.0625 * 0.125);
    CHECK(nested.potential(here) == within(expected, 1e-12));
    // Off the middle towards a face: the force pushes out of it, and is the gradient of the potential.
    for (const Vector& off : {Vector(0.1, 0, 0), Vector(0.1, 0.1, 0), Vector(0.05, 0.1, -0.2)})
        checkDescent(nested, {Matrix::Identity(), off});
}

TEST_CASE("the potential is the integral of both depths over the overlap") {
    Dice dice(11);
    for (int n = 0; n < 6; ++n) {
        Pair pair(dice);
        const RelativePose pose{dice.rotation().toRotationMatrix(), 0.4 * pair.size() * dice.vector()};
        const auto depthOf = [](const ContactBlock& block, const Vector& p) {
            double depth = HUGE_VAL;
            for (const auto& face : block.faces)
                depth = std::min(depth, face.offset - face.normal.dot(p));
            return depth;
        };
        double sum = 0, square = 0;
        const int points = 200000;
        for (int i = 0; i < points; ++i) {
            const Vector p = pair.one.radius * dice.vector();
            const double one = depthOf(pair.one, p),
                         other = depthOf(pair.other, pose.turn.transpose() * (p - pose.place));
            const double value = one > 0 && other > 0 ? 0.5 * (one + other) : 0;
            sum += value;
            square += value * value;
        }
        const double volume = std::pow(2 * pair.one.radius, 3), mean = sum / points;
        const double error = std::sqrt((square / points - mean * mean) / points);
        CHECK(std::abs(pair.potential(pose) - volume * mean) < 5 * volume * error);
    }
}

TEST_CASE("the force is the gradient of the potential, in thousands of positions of all kinds") {
    Dice dice(1);
    int touching = 0;
    for (int n = 0; n < 1500; ++n) {
        Pair pair(dice);
        const Turn turn = n % 5 == 0 ? about(0.02 * dice.between(-1, 1), dice.vector()) : dice.rotation();
        const double depth = pair.size() * std::pow(10, dice.between(-2.5, -0.3));
        const auto pose = pressed(pair, turn, dice.direction(), 0.3 * pair.size() * dice.vector(), depth);
        if (pair.at(pose).pressing == 0) continue;
        ++touching;
        checkDescent(pair, pose);
    }
    CHECK(touching > 1400);
}

TEST_CASE("faces, edges and corners against each other follow the gradient, exactly aligned ones too") {
    Dice dice(2);
    Pair pair(box(brick), box(brick));
    const Vector x = Vector::UnitX(), y = Vector::UnitY(), z = Vector::UnitZ();
    std::vector<std::pair<Turn, Vector>> classes = {
        {Turn::Identity(), {0.11, 0, 0}},                 // face on face, half over
        {Turn::Identity(), {0, 0, 0}},                    // all sides in one plane
        {about(M_PI / 2, z), {0, 0, 0}},                  // header on stretcher
        {about(0.3, z), {0.01, 0.02, 0}},                 // turned about the normal
        {about(0.4, y), {0, 0, 0}},                       // edge on face, parallel to two faces
        {about(0.4, y), {0.0, 0.051, 0}},                 // likewise, over the rim
        {about(M_PI / 4, x) * about(0.2, z), {0, 0, 0}},  // edge on face, turned
        {along(brick.normalized(), -z), {0.01, 0.01, 0}}, // corner on face
        {along(brick.normalized(), -z), {0.11, 0.051, 0}} // corner on corner
    };
    for (const auto& [turn, aside] : classes)
        for (double depth : {1e-2, 1e-3, 1e-4})
            checkDescent(pair, pressed(pair, turn, z, aside, depth), 1e-5, 1e-2 * depth);
    // Edge on edge: both stand on an edge, crossed at any angle, also at a right one and parallel.
    for (double angle : {0.0, 0.3, M_PI / 2}) {
        const Turn stand = about(M_PI / 4, x);
        const Turn relative = stand.conjugate() * about(angle, z) * stand;
        for (double depth : {1e-2, 1e-3})
            checkDescent(pair, pressed(pair, relative, stand.conjugate() * z, Vector::Zero(), depth), 1e-5,
                         1e-7 / depth);
    }
}

TEST_CASE("closed paths in six dimensions give back their work") {
    Dice dice(3);
    double worst = 0;
    int kept = 0;
    for (int path = 0; path < 200; ++path) {
        const int mostPoints = path % 10 ? 9 : 20; // corners of a hull: most have few, which is quicker
        Pair pair(dice, mostPoints);
        // Two harmonics of place and of the quaternion. The path goes in and out of the block.
        Vector place[5];
        Eigen::Vector4d turn[5];
        const double reach = 0.35 * (pair.one.radius + pair.other.radius);
        for (int h = 0; h < 5; ++h) {
            place[h] = reach * (h > 2 ? 0.2 : 1) * dice.vector();
            turn[h] = (h > 2 ? 0.1 : 0.3) * Eigen::Vector4d(dice.between(-1, 1), dice.between(-1, 1),
                                                            dice.between(-1, 1), dice.between(-1, 1));
        }
        turn[0].normalize();
        const auto waves = [](double s, const auto& of) { // and their rate
            const double a = 2 * M_PI * s, c1 = std::cos(a), s1 = std::sin(a), c2 = std::cos(2 * a),
                         s2 = std::sin(2 * a);
            return std::pair((of[0] + of[1] * c1 + of[2] * s1 + of[3] * c2 + of[4] * s2).eval(),
                             (2 * M_PI * (of[2] * c1 - of[1] * s1) + 4 * M_PI * (of[4] * c2 - of[3] * s2)).eval());
        };
        const auto poseAt = [&](double s, Vector& velocity, Vector& spin) {
            const auto [x, v] = waves(s, place);
            const auto [q, dq] = waves(s, turn);
            const double norm = q.norm();
            const Eigen::Vector4d unit = q / norm, rate = (dq - unit.dot(dq) * unit) / norm;
            const Turn now(unit[0], unit[1], unit[2], unit[3]), change(rate[0], rate[1], rate[2], rate[3]);
            velocity = v;
            spin = 2 * (change * now.conjugate()).vec();
            return RelativePose{now.toRotationMatrix(), x};
        };
        const auto power = [&](double s) {
            Vector velocity, spin;
            const auto pose = poseAt(s, velocity, spin);
            const auto o = pair.at(pose);
            // The spin turns the other block about its own origin.
            return o.force.dot(velocity) + (o.moment - pose.place.cross(o.force)).dot(spin);
        };
        double most = 0, work = 0; // the largest energy and the work
        Vector velocity, spin;
        for (int i = 0; i < 32; ++i)
            most = std::max(most, pair.potential(poseAt(i / 32.0, velocity, spin)));
        if (!(most > 0)) continue;
        ++kept;
        // A short touch can be between the points of few pieces: then the path is walked again in more pieces.
        for (int pieces = 16; pieces <= 1024; pieces *= 4) {
            work = 0;
            for (int i = 0; i < pieces; ++i)
                work += gauss_kronrod<double, 15>::integrate(power, double(i) / pieces, (i + 1.0) / pieces, 12, 1e-6);
            if (std::abs(work) < 3e-7 * most) break;
        }
        worst = std::max(worst, std::abs(work) / most);
    }
    MESSAGE("largest work of a closed path over the largest energy on it: " << worst);
    CHECK(kept > 180);
    CHECK(worst < 1e-6);
}

TEST_CASE("the order of the two blocks, and where the pair is, change nothing") {
    Dice dice(4);
    for (int n = 0; n < 500; ++n) {
        Pair pair(dice), swapped(pair.other, pair.one);
        const auto pose = pressed(pair, dice, 0.1 * pair.size());
        const RelativePose back{pose.turn.transpose(), -(pose.turn.transpose() * pose.place)};
        const auto o = pair.at(pose), b = swapped.at(back);
        const double scale = o.pressing + 1e-12 * pair.force(pair.size());
        CHECK((o.force + pose.turn * b.force).norm() < 1e-10 * scale);
        // The moment of the opposite force about the origin of the one block.
        const Vector moment = pose.turn * b.moment + pose.place.cross(pose.turn * b.force);
        CHECK((o.moment + moment).norm() < 1e-10 * scale * pair.size());
        CHECK(std::abs(o.area - b.area) < 1e-10 * pair.size() * pair.size());
        CHECK(std::abs(o.meanSquare - b.meanSquare) < 1e-9 * pair.size() * pair.size());
        CHECK(swapped.potential(back) == within(pair.potential(pose), 1e-10));
        // A turn of the one block's axes turns all that is found.
        const Matrix r = dice.rotation().toRotationMatrix();
        std::vector<Vector> corners;
        for (int i = 0; i < pair.one.cornerCount(); ++i)
            corners.push_back(r * Vector(pair.one.corners[0][i], pair.one.corners[1][i], pair.one.corners[2][i]));
        Pair turned(blockOf(corners), pair.other);
        // blockOf() moves the origin to the centroid, which is where it was.
        const auto t = turned.at({r * pose.turn, r * pose.place});
        CHECK((t.force - r * o.force).norm() < 1e-9 * scale);
    }
}

TEST_CASE("a face in the plane between two cells is counted once") {
    // A face of the other cube stands in the plane between the cells of two faces of the one.
    Pair pair(box(Vector::Ones()), box(Vector(0.6, 0.4, 0.3)));
    const Turn turn = about(M_PI / 4, Vector::UnitZ());
    for (double sign : {-1.0, 1.0}) {
        const Vector outward = sign * (turn * Vector::UnitX());
        const auto at = [&](double off) {
            const Vector along = turn * Vector::UnitY();
            return RelativePose{turn.toRotationMatrix(), 0.25 * along - (0.3 + off) * outward};
        };
        const auto here = pair.at(at(0)), before = pair.at(at(-1e-9)), after = pair.at(at(1e-9));
        REQUIRE(here.pressing > 0);
        CHECK((here.force - before.force).norm() < 1e-8);
        CHECK((here.force - after.force).norm() < 1e-8);
        CHECK(std::abs(pair.potential(at(0)) - pair.potential(at(1e-9))) < 1e-8);
        checkDescent(pair, at(0), 1e-5);
    }
}

TEST_CASE("a small motion changes the force by no more than the stated stiffness") {
    Dice dice(5);
    double most = 0;
    for (int n = 0; n < 1000; ++n) {
        Pair pair(dice);
        const double depth = pair.size() * std::pow(10, dice.between(-4, -0.5));
        auto pose = pressed(pair, n % 3 ? dice.rotation() : Turn::Identity(), dice.direction(), Vector::Zero(), depth);
        const double step = 1e-3 * depth;
        auto before = pair.at(pose);
        for (int i = 0; i < 5; ++i) {
            const Vector shift = step * dice.direction();
            pose.place += shift;
            const auto after = pair.at(pose);
            // The surface inside the other block changes during the motion, by less than a strip along it.
            const double touched = std::max(before.touched, after.touched) * 1.02 + 20 * step * pair.size();
            CHECK((after.force - before.force).norm() <= touched * step);
            most = std::max(most, (after.force - before.force).norm() / (touched * step));
            before = after;
        }
    }
    CHECK(most > 0.8); // the bound is not far off
}

TEST_CASE("the bound of the eigenvalue holds for the stiffness by differences") {
    Dice dice(6);
    double closest = 0, nearest = 0;
    for (int n = 0; n < 300; ++n) {
        Pair pair(dice);
        const auto pose = pressed(pair, n % 2 ? dice.rotation() : about(0.001, dice.vector()), dice.direction(),
                                  Vector::Zero(), 0.003 * pair.size());
        const auto o = pair.at(pose);
        if (o.pressing == 0) continue;
        // Masses with the moments of inertia of an ellipsoid of the block's size; any would do.
        const double mass[2] = {1, dice.between(0.2, 5)};
        const Vector inertia[2] = {mass[0] * pair.one.radius * pair.one.radius * Vector(0.2, 0.3, 0.4),
                                   mass[1] * pair.other.radius * pair.other.radius * Vector(0.2, 0.3, 0.4)};
        // Relative motion: columns of translation and rotation of the other block about its origin, in axes of the one.
        // Of the force and moment on it the derivative is symmetric but for the moment of the force itself.
        Eigen::Matrix<double, 6, 6> stiffness;
        for (int d = 0; d < 6; ++d) {
            const double h = 1e-6 * (d < 3 ? pair.size() : 1);
            const auto at = [&](double s) {
                RelativePose p = pose;
                if (d < 3)
                    p.place += s * Vector::Unit(d);
                else
                    p.turn = Eigen::AngleAxisd(s, Vector::Unit(d - 3)) * pose.turn;
                auto w = wrench(pair.at(p));
                w.tail<3>() -= p.place.cross(Vector(w.head<3>()));
                return w;
            };
            stiffness.col(d) = (at(-h) - at(h)) / (2 * h);
        }
        const Eigen::Matrix<double, 6, 6> symmetric = 0.5 * (stiffness + stiffness.transpose());
        // The same motion by both blocks: velocity of the other relative to the one, in its place.
        Eigen::Matrix<double, 6, 12> relative = Eigen::Matrix<double, 6, 12>::Zero();
        Matrix arm;
        arm << 0, -pose.place[2], pose.place[1], pose.place[2], 0, -pose.place[0], -pose.place[1], pose.place[0], 0;
        const Matrix roots[2] = {inertia[0].cwiseInverse().cwiseSqrt().asDiagonal(),
                                 inertia[1].cwiseInverse().cwiseSqrt().asDiagonal()};
        relative.block<3, 3>(0, 0) = -Matrix::Identity() / std::sqrt(mass[0]);
        relative.block<3, 3>(0, 3) = arm * roots[0];
        relative.block<3, 3>(3, 3) = -roots[0];
        relative.block<3, 3>(0, 6) = Matrix::Identity() / std::sqrt(mass[1]);
        relative.block<3, 3>(3, 9) = pose.turn * roots[1];
        const Eigen::Matrix<double, 12, 12> scaled = relative.transpose() * symmetric * relative;
        const double found = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>>(scaled).eigenvalues()[11];
        const double bound = 2 * std::max(embeddedEigenvalue(pair.one, mass[0], inertia[0], 1, 0),
                                          embeddedEigenvalue(pair.other, mass[1], inertia[1], 1, 0));
        CHECK(found <= 1.02 * bound); // the force itself, which turns, adds a part of depth over size
        closest = std::max(closest, found / bound);
        // The parts of both surfaces that lie near the other block, with the skin of the search, are enough.
        const RelativePose back{pose.turn.transpose(), -(pose.turn.transpose() * pose.place)};
        double near = 0;
        for (int side = 0; side < 2; ++side) {
            const auto &own = side ? pair.other : pair.one, &other = side ? pair.one : pair.other;
            BlockStiffness surface = BlockStiffness::Zero();
            addNearSurface(own, other, side ? back : pose, 0.1 * std::min(own.thickness, other.thickness), 2, 0,
                           surface);
            near = std::max(near, largestEigenvalueOf(surface, {Matrix::Identity(), Vector::Zero(), Vector::Zero(),
                                                                Vector::Zero(), mass[side], inertia[side], 0}));
        }
        CHECK(found <= 1.02 * near);
        CHECK(near <= (1 + 1e-9) * bound);
        nearest = std::max(nearest, found / near);
    }
    MESSAGE("largest eigenvalue over its bound: " << closest << ", over that of near surfaces: " << nearest);
    CHECK(closest > 0.1);
    // A cube that rests on all sides: two faces along the normal and four along the face for each translation.
    const double found = embeddedEigenvalue(box(Vector::Ones()), 3, Vector::Constant(1e9), 2, 0.5);
    CHECK(found == within((2 * 2 + 4 * 0.5) / 3, 1e-12));
}

TEST_CASE("a pair that moves has the answer of a pair that is looked at for the first time, and no overlap is missed") {
    Dice dice(14);
    int separated = 0, touching = 0;
    for (int n = 0; n < 300; ++n) {
        Pair pair(anyBlock(dice), n % 2 ? anyBlock(dice) : box(brick));
        // They begin just apart or just in each other, some with faces or edges that are parallel.
        const Turn turn = n % 3 ? dice.rotation() : about(M_PI / 2, Vector::Unit(n % 9 / 3));
        auto pose = pressed(pair, turn, dice.direction(), Vector::Zero(), 1e-4 * dice.between(-1, 1));
        int axis = 0; // that separated them last
        for (int i = 0; i < 100; ++i) {
            const double step = n % 4 ? dice.logarithmic(1e-16, 1e-4) : 0.1;
            pose = moved(pose, step * pair.size() * dice.vector(), step * dice.vector());
            if (pose.place.norm() > pair.one.radius + pair.other.radius) pose.place *= 0.5;
            Overlap kept;
            const bool touches = pair.finder.find(pair.one, pair.other, pose, axis, kept);
            const auto fresh = pair.at(pose);
            (touches ? touching : separated) += 1;
            REQUIRE(touches == (fresh.pressing > 0));
            if (!touches) {
                CHECK(pair.potential(pose) <= 1e-12 * std::pow(pair.size(), 4));
                continue;
            }
            CHECK((wrench(kept) - wrench(fresh)).isZero(0));
            CHECK(kept.area == fresh.area);
            CHECK(kept.meanSquare == fresh.meanSquare);
        }
    }
    CHECK(separated > 5000);
    CHECK(touching > 5000);
}

namespace {

// Friction on a brick that lies in a face of a large slab with a normal force, moved by hand.
struct Slider {
    Pair pair{box(Vector(2, 2, 0.5)), box(brick)};
    RelativePose pose{Matrix::Identity(), {0.1, 0, 0.25 + 0.5 * brick[2] - 1e-5}};
    double normalStiffness = 1e9, ratio = 0.4, friction = 0.6;
    FrictionState state{};
    FrictionStep last{Vector::Zero(), 0, 0, 0};
    double lost = 0, work = 0;
    double normalForce = 0, tangential = 0;
    Vector middle = Vector::Zero();

    void act(double forceFactor = 1) {
        const auto o = pair.at(pose);
        normalForce = forceFactor * normalStiffness * o.force.norm();
        tangential = ratio * normalStiffness * o.area;
        middle = o.centre;
        last = advanceFriction(state, o, pose, normalForce, tangential, friction);
        lost += last.lost;
    }
    void go(const Vector& shift, double turn, double forceFactor = 1) {
        const auto before = last;
        pose.turn = Eigen::AngleAxisd(turn, Vector::UnitZ()) * pose.turn;
        pose.place += shift;
        act(forceFactor);
        // What the body that is held gets: the opposite of the work of friction on it.
        const Vector slip = shift + turn * Vector::UnitZ().cross(middle - pose.place);
        work -= 0.5 * (before.force + last.force).dot(slip) + 0.5 * (before.moment + last.moment) * turn;
    }
};

} // namespace

TEST_CASE("friction is elastic up to the limit, then slides with friction times normal force") {
    Slider s;
    s.act();
    const double limit = s.friction * s.normalForce;
    s.go({1e-7, 0, 0}, 0);
    CHECK(s.last.force[0] == within(-s.tangential * 1e-7, 1e-8));
    CHECK(s.lost == 0);
    for (int i = 0; i < 1000; ++i)
        s.go({1e-6, 0, 0}, 0);
    CHECK(s.last.force[0] == within(-limit, 1e-9));
    CHECK(std::abs(s.last.force[2]) < 1e-9 * limit);
    CHECK(s.work == within(s.lost + s.last.stored, 1e-9));
    // Back by twice the elastic slip: the force has the opposite direction.
    for (int i = 0; i < 100; ++i)
        s.go({-0.02 * limit / s.tangential, 0, 0}, 0);
    CHECK(s.last.force[0] == within(limit, 1e-6));
    CHECK(s.work == within(s.lost + s.last.stored, 1e-9));
}

TEST_CASE("a twist alone slides at friction times normal force times lever, and shear takes its share") {
    Slider s;
    s.act();
    for (int i = 0; i < 2000; ++i)
        s.go(Vector::Zero(), 1e-6);
    const double lever = leverOfFriction(s.pair.at(s.pose));
    CHECK(s.last.moment == within(-s.friction * s.normalForce * lever, 1e-6));
    for (int i = 0; i < 2000; ++i) {
        s.go({1e-6, 0, 0}, 1e-6);
        const double t = s.last.force.norm() / (s.friction * s.normalForce);
        const double m = s.last.moment / (s.friction * s.normalForce * lever);
        CHECK(t * t + m * m <= within(1, 1e-6));
    }
    CHECK(s.last.force.norm() > 0.5 * s.friction * s.normalForce);
    // The lever is the mean distance of an even pressure, which is 0.0644 m for this brick.
    CHECK(lever == within(0.0644, 0.03));
}

TEST_CASE("friction takes energy in every step under an even normal force, and all of what goes in under any") {
    Dice dice(8);
    for (int n = 0; n < 50; ++n) {
        Slider s;
        s.act();
        double previous = s.last.stored;
        for (int i = 0; i < 500; ++i) {
            const double lostBefore = s.lost, workBefore = s.work;
            const double factor = n % 2 ? 1 : dice.between(0, 1);
            Vector shift = 1e-6 * dice.vector().cwiseProduct(Vector(1, 1, n % 2 ? 0 : 1));
            if (s.pose.place[2] + shift[2] >= 0.25 + 0.5 * brick[2]) shift[2] *= -1; // what parts has no friction
            s.go(shift, 1e-5 * dice.between(-1, 1), factor);
            if (n % 2) CHECK(s.lost >= lostBefore - 1e-12 * s.last.stored); // round-off
            // The balance is exact to the second order of the motion, also where the normal force falls.
            const double unaccounted = s.work - workBefore - (s.lost - lostBefore) - (s.last.stored - previous);
            CHECK(std::abs(unaccounted) < 1e-4 * s.friction * s.normalStiffness * 1e-5 * 0.02244 * 1e-6);
            previous = s.last.stored;
        }
        CHECK(s.lost > 0);
    }
}

TEST_CASE("a pair at rest, and one that moves as a rigid whole, keeps its friction to the last digits") {
    Dice dice(9);
    Slider s;
    s.act();
    s.go({1e-7, 5e-8, 0}, 1e-7);
    const auto first = s.last;
    for (int i = 0; i < 100000; ++i)
        s.act();
    CHECK((s.last.force - first.force).norm() < 1e-9 * first.force.norm());
    // The relative pose of two bodies that fly together, as it comes from their places.
    const RelativePose pose = s.pose;
    Turn turn = Turn::Identity();
    Vector place = Vector::Zero();
    for (int i = 0; i < 10000; ++i) {
        turn = (about(0.01, dice.vector()) * turn).normalized();
        place += 0.1 * dice.vector();
        const Turn other = (turn * Turn(pose.turn)).normalized();
        const Vector centre = place + turn * pose.place;
        s.pose = {(turn.conjugate() * other).toRotationMatrix(), turn.conjugate() * (centre - place)};
        s.act();
    }
    CHECK((s.last.force - first.force).norm() < 1e-6 * first.force.norm());
    CHECK(std::abs(s.last.moment - first.moment) < 1e-6 * std::abs(first.moment));
    CHECK(s.lost < 1e-6 * s.last.stored);
}

TEST_CASE("the shear force turns by half of what one block turns against the other") {
    Slider s;
    s.friction = 1e6; // nothing slides
    s.act();
    s.go({1e-7, 0, 0}, 0);
    for (int i = 0; i < 200; ++i)
        s.go(Vector::Zero(), 1e-3);
    CHECK(std::atan2(-s.last.force[1], -s.last.force[0]) == within(0.1, 0.01));
}

TEST_CASE("when the normal force falls slip and twist are cut, and they are lost when the pair parts") {
    Slider s;
    s.act();
    s.go({3e-6, 0, 0}, 3e-5);
    const double lever = leverOfFriction(s.pair.at(s.pose));
    const auto carried = [&] { return std::hypot(s.last.force.norm(), s.last.moment / lever); };
    const double stored = s.last.stored, before = carried();
    CHECK(std::abs(s.last.moment / lever) > 0.3 * s.last.force.norm());
    s.act(0.1);
    CHECK(carried() == within(s.friction * s.normalForce, 1e-9));
    CHECK(carried() < before);
    CHECK(s.lost + s.last.stored == within(stored, 1e-12));
    const double rest = s.last.stored;
    CHECK(endFriction(s.state) == within(rest, 1e-12));
    CHECK(s.state.stiffness == 0);
    CHECK(endFriction(s.state) == 0);
}

TEST_CASE("where the normal flips the contact is another one: what was stored is lost, and friction begins anew") {
    Slider s;
    s.act();
    s.go({1e-7, 0, 0}, 0);
    const double stored = s.last.stored;
    REQUIRE(stored > 0);
    s.state.normal = -s.state.normal;
    s.act();
    CHECK(s.last.lost == within(stored, 1e-12));
    CHECK(s.last.force.norm() == 0);
    CHECK(s.last.stored == 0);
}

TEST_CASE("a ratio of damping gives its restitution, and none makes a contact pull") {
    for (double restitution : {0.1, 0.13, 0.14, 0.3, 0.5, 0.8, 0.99, 1.0}) {
        const double ratio = dampingRatio(restitution);
        CHECK(restitutionOf(ratio) == within(restitution, 1e-10));
        // A mass on a spring and a dashpot, in small steps.
        double x = 0, v = 1;
        const double dt = 1e-5;
        double force = 1;
        for (int i = 0; i < 3000000 && (i < 10 || force > 0); ++i) {
            v -= 0.5 * dt * (2 * ratio * v + x);
            x += dt * v;
            v -= 0.5 * dt * (2 * ratio * v + x);
            force = 2 * ratio * v + x;
        }
        CHECK(-v == within(restitution, 1e-3));
    }
    CHECK(dampingRatio(1) == 0);
    Dice dice(10);
    for (int n = 0; n < 500; ++n) {
        Pair pair(dice);
        const auto pose = pressed(pair, dice, 0.05 * pair.size());
        const auto o = pair.at(pose);
        if (!(o.area > 0)) continue;
        const RelativeMotion motion{dice.vector(), 10 * dice.vector()};
        const double normalForce = o.force.norm(), coefficient = 0.01 * dice.between(0, 10);
        const auto d = dampContact(o, motion, coefficient, normalForce);
        CHECK(d.power >= 0);
        CHECK(normalForce + d.force >= -1e-15 * normalForce);
        // The power of force and moment is that which is said.
        const double power = -(d.force * o.normal.dot(motion.velocity) + d.moment.dot(motion.spin));
        CHECK(std::abs(power - d.power) <= 1e-9 * (d.power + std::abs(d.force)));
    }
}

TEST_CASE("a share of a force takes as much energy as it should, or as it can") {
    Dice dice(13);
    int found = 0;
    for (int n = 0; n < 2000; ++n) {
        const AddedForce force{dice.between(-1, 1), dice.between(0, 2), dice.between(-0.3, 0.3)};
        const double energy = dice.between(-0.5, 0.5);
        const double share = shareThatTakes(force, energy);
        const auto given = [&](double x) {
            return x * (force.work + 0.5 * force.others) + 0.5 * x * x * force.response;
        };
        CHECK(std::abs(share) <= 1);
        if (std::abs(share) < 1 && std::abs(given(share) + energy) < 1e-12) {
            ++found;
            for (double x : {0.5 * share, -0.5 * share, 0.0}) // none of less size does
                CHECK((given(x) + energy) * energy > 0);
        } else if (std::abs(share) < 1) { // none does: this one takes most
            CHECK(energy > 0);
            CHECK(given(share) <= given(share + 1e-3));
            CHECK(given(share) <= given(share - 1e-3));
        }
    }
    CHECK(found > 500);
    CHECK(shareThatTakes({1, 1, 0}, 0) == 0);
    CHECK(shareThatTakes({1, 0, 0}, 1) == 0);
}

TEST_CASE("a mass that meets a spring keeps its energy, wherever in the step it does") {
    for (double frequency : {0.05, 0.3, 0.7, 1.0, 1.3}) // times the time step
        for (double phase = 0.01; phase < 1; phase += 0.07) {
            const double k = frequency * frequency; // mass and time step are 1
            double x = -phase, v = 1, given = 0, push = 0, most = 0;
            bool touched = false;
            for (int n = 0; n < 200; ++n, x += v) {
                given -= 0.5 * push * v;
                const bool touches = x > 0;
                const double plain = touches ? -k * x : 0;
                const double last = push, w = touches ? 0.5 * k * x * x : 0;
                push = plain;
                if (touches && !touched)
                    push += plain * shareThatTakes({plain * v, plain * plain, plain * plain}, w + 0.5 * plain * v);
                if (!touches && touched && last * v > 0)
                    push = last * shareThatTakes({last * v, last * last, 0}, -given);
                given -= 0.5 * push * v;
                if (!touches) given = 0;
                touched = touches;
                v += push;
                if (!touches) push = 0;
                most = std::max(most, x);
            }
            CHECK(v == within(-1, 1e-12));
            CHECK(most > 0);
        }
}

TEST_CASE("sweep and prune finds all pairs of boxes that overlap, in order") {
    Dice dice(12);
    for (int n = 0; n < 300; ++n) {
        const std::size_t count = dice.oneOf(61);
        std::vector<Box> boxes;
        std::vector<unsigned char> awake;
        for (std::size_t b = 0; b < count; ++b) {
            // Some share their boundaries, and some are as large as a ground.
            Box box;
            for (int d = 0; d < 3; ++d) {
                const double middle = n % 2 ? dice.between(-1, 1) : 0.1 * (double(dice.oneOf(19)) - 9);
                const double half = b % 13 == 5 ? 3 : n % 2 ? dice.between(0, 0.3) : 0.1;
                box.low[d] = middle - half;
                box.high[d] = middle + half;
            }
            boxes.push_back(box);
            awake.push_back(n % 3 == 0 || dice.happens(0.5));
        }
        std::vector<std::pair<int, int>> expected;
        for (std::size_t a = 0; a < count; ++a)
            for (std::size_t b = a + 1; b < count; ++b) {
                bool overlap = awake[a] || awake[b];
                for (int d = 0; d < 3; ++d)
                    overlap &= boxes[a].low[d] <= boxes[b].high[d] && boxes[b].low[d] <= boxes[a].high[d];
                if (overlap) expected.emplace_back(a, b);
            }
        CHECK(overlappingBoxes(boxes, awake) == expected);
    }
}
