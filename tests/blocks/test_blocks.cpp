// SPDX-License-Identifier: GPL-2.0-or-later
// Joint polygons and subcontacts of convex blocks, in any orientation.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "../within.hpp"
#include "blocks/BlockElasticity.hpp"
#include "blocks/BlockLanes.cpp" // the source, because its loops for each instruction set are local to it
#include "blocks/JointPoints.hpp"
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <doctest/doctest.h>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

using namespace masonry;

namespace {

ConvexBlock box(const Point& corner, const Point& size) {
    ConvexBlock b;
    for (int i = 0; i < 8; ++i)
        b.vertices.push_back(corner + size.cwiseProduct(Point(i & 1, (i >> 1) & 1, i >> 2)));
    b.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return b;
}

ConvexBlock moved(ConvexBlock b, const Eigen::Isometry3d& motion) {
    for (auto& v : b.vertices)
        v = motion * v;
    return b;
}

Eigen::Isometry3d randomMotion(std::mt19937& dice) {
    std::uniform_real_distribution<> u(-1, 1);
    Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
    m.rotate(Eigen::Quaterniond(u(dice), u(dice), u(dice), u(dice)).normalized());
    m.pretranslate(10 * Point(u(dice), u(dice), u(dice)));
    return m;
}

const Point brick(0.22, 0.102, 0.081);

} // namespace

TEST_CASE("a box has six faces of four corners with outward normals") {
    const auto faces = box({1, 2, 3}, brick).faces();
    REQUIRE(faces.size() == 6);
    const Point middle = Point(1, 2, 3) + 0.5 * brick;
    double surface = 0;
    for (const auto& f : faces) {
        REQUIRE(f.size() == 4);
        const Point n = (f[1] - f[0]).cross(f[2] - f[1]).normalized();
        CHECK(n.dot(f[0] - middle) > 0);
        surface += area(f, n);
    }
    CHECK(surface == within(2 * (0.22 * 0.102 + 0.22 * 0.081 + 0.102 * 0.081), 1e-9));
}

TEST_CASE("two bricks half over each other share half a bed face, in any orientation") {
    std::mt19937 dice(1);
    for (int i = 0; i < 200; ++i) {
        const auto motion = randomMotion(dice);
        const auto lower = moved(box(Point::Zero(), brick), motion);
        const auto upper = moved(box({0.11, 0, 0.081}, brick), motion);
        const auto contact = coincidentFaces(lower, upper);
        REQUIRE(contact);
        CHECK(contact->polygon.size() == 4); // round-off adds no corners
        auto corners = contact->polygon;
        const Point along = longestEdge(corners);
        CHECK(std::abs(std::abs(along.dot(motion.rotation().col(0))) - 1) < 1e-9);
        std::rotate(corners.begin(), corners.begin() + 1 + i % 3, corners.end()); // as round-off may begin elsewhere
        CHECK((longestEdge(corners) - along).norm() < 1e-9);
        CHECK((contact->normal - motion.rotation().col(2)).norm() < 1e-9);
        CHECK(area(contact->polygon, contact->normal) == within(0.11 * 0.102, 1e-9));
        CHECK((centroid(contact->polygon, contact->normal) - motion * Point(0.165, 0.051, 0.081)).norm() < 1e-9);
        const auto back = coincidentFaces(upper, lower);
        REQUIRE(back);
        CHECK((back->normal + contact->normal).norm() < 1e-9);
    }
}

TEST_CASE("turned blocks overlap in the polygon that the clipping gives") {
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
    turn.rotate(Eigen::AngleAxisd(M_PI / 4, Point::UnitZ()));
    const auto below = box({-0.5, -0.5, -1}, {1, 1, 1});
    const auto above = moved(box({-0.5, -0.5, 0}, {1, 1, 1}), turn);
    const auto contact = coincidentFaces(below, above);
    REQUIRE(contact);
    CHECK(contact->polygon.size() == 8); // a regular octagon of inradius 1/2
    CHECK(area(contact->polygon, contact->normal) == within(2 * std::sqrt(2.) - 2, 1e-9));
}

TEST_CASE("a gap or overlap within the tolerance is a joint midway, beyond it is none") {
    const double size = brick.norm();
    for (double gap : {0.9e-4 * size, -0.9e-4 * size}) {
        const auto contact = coincidentFaces(box(Point::Zero(), brick), box({0, 0, 0.081 + gap}, brick));
        REQUIRE(contact);
        CHECK(contact->polygon[0].z() == within(0.081 + 0.5 * gap, 1e-9));
    }
    for (double gap : {1.1e-4 * size, -1.1e-4 * size, 1.0})
        CHECK(!coincidentFaces(box(Point::Zero(), brick), box({0, 0, 0.081 + gap}, brick)));
}

TEST_CASE("blocks that touch along an edge, at a corner or not at all share nothing") {
    const auto one = box(Point::Zero(), brick);
    CHECK(!coincidentFaces(one, box({0.22, 0, 0.081}, brick)));
    CHECK(!coincidentFaces(one, box({0.22, 0.102, 0.081}, brick)));
    CHECK(!coincidentFaces(one, box({0, 0, 0.5}, brick)));
    CHECK(!coincidentFaces(one, one));
}

TEST_CASE("blocks that overlap or nearly share a face are told by how much, in any orientation") {
    std::mt19937 dice(7);
    const auto lower = box(Point::Zero(), brick);
    const auto bar = box({-0.05, -0.05, -0.5}, {0.1, 0.1, 1}); // two of these cross, edge over edge
    const Eigen::Isometry3d cross(Eigen::AngleAxisd(0.5 * M_PI, Point::UnitX()));
    const Eigen::Isometry3d onEdge(Eigen::AngleAxisd(0.25 * M_PI, Point::UnitZ()));
    const double edge = 0.05 * std::sqrt(2.0); // from the axis of a bar to its edge
    const auto crossed = [&](double apart) {
        return moved(moved(bar, onEdge), Eigen::Translation3d(2 * edge + apart, 0, 0) * cross);
    };
    Eigen::Isometry3d tilt = Eigen::Isometry3d::Identity();
    tilt.translate(Point(0, 0, 0.081)).rotate(Eigen::AngleAxisd(-0.02, Point::UnitY()));
    const struct {
        ConvexBlock one, two;
        double gap;
    } cases[] = {
        {lower, box({0, 0, 0.082}, brick), 1e-3},
        {lower, box({0.2, 0, 0.1}, brick), 0.019}, // a tenth of the face, a quarter of the thickness
        {lower, box({0, 0, 0.080}, brick), -1e-3},
        {lower, lower, -0.081}, // both at the same place: the shortest way to separate them is the height
        {lower, box({0.05, 0.02, 0.02}, {0.02, 0.02, 0.02}), -0.04},
        {lower, moved(lower, tilt), 0.22 * std::sin(0.02)}, // opens from an edge to the other
        {moved(bar, onEdge), crossed(-2e-3), -2e-3},
    };
    for (const auto& c : cases) {
        CAPTURE(c.gap);
        for (int i = 0; i < 20; ++i) {
            const auto motion = randomMotion(dice);
            const auto one = moved(c.one, motion), two = moved(c.two, motion);
            CHECK_FALSE(coincidentFaces(one, two));
            for (const auto& found : {misfit(one, two), misfit(two, one)}) {
                REQUIRE(found);
                CHECK(found->gap == within(c.gap, 1e-3));
            }
        }
    }
    // blocks that are far apart, or touch along an edge or at a corner, are no misfit
    for (const Point& corner :
         {Point(0, 0, 0.103), Point(0.22, 0, 0.081), Point(0.22, 0.102, 0.081), Point(0.221, 0, 0.082)})
        CHECK_FALSE(misfit(lower, box(corner, brick)));
    CHECK_FALSE(misfit(moved(bar, onEdge), crossed(1e-3)));
}

TEST_CASE("blocks that are not convex, or wind the wrong way, are refused") {
    auto inward = box(Point::Zero(), brick);
    for (auto& t : inward.triangles)
        std::swap(t[1], t[2]);
    auto dented = box(Point::Zero(), brick);
    dented.vertices[7] = Point(0.05, 0.03, 0.02);
    for (const auto& wrong : {inward, dented}) {
        CHECK_THROWS_WITH(coincidentFaces(box({0, 0, 0.081}, brick), wrong),
                          "block is not convex, or the corners of its faces wind the wrong way");
        CHECK_THROWS_AS(misfit(wrong, wrong), std::invalid_argument);
    }
    ConvexBlock tetrahedron{{Point::Zero(), Point::UnitX(), Point::UnitY(), Point::UnitZ()},
                            {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
    CHECK_THROWS_WITH(divide(tetrahedron, {1, 1, 1}), "block has an inverted zone: not convex, or without volume");
}

TEST_CASE("the rule of Gauss and Lobatto has the ends, and is exact to degree 2n - 3 and no further") {
    const auto three = gaussLobatto(3), four = gaussLobatto(4);
    CHECK(three.weights[0] == within(1. / 6, 1e-15));
    CHECK(three.weights[1] == within(2. / 3, 1e-15));
    CHECK(four.weights[0] == within(1. / 12, 1e-15));
    CHECK(four.weights[1] == within(5. / 12, 1e-15));
    CHECK(four.places[1] == within(0.5 - 0.5 / std::sqrt(5.), 1e-15));
    for (int n : {2, 3, 4, 5, 6, 7, 8, 11, 16, 33, 100, 1000}) {
        CAPTURE(n);
        const auto rule = gaussLobatto(n);
        REQUIRE(int(rule.places.size()) == n);
        CHECK(rule.places.front() == 0);
        CHECK(rule.places.back() == 1);
        for (int i = 0; i < n; ++i) {
            CHECK(rule.weights[i] > 0);
            if (i > 0) CHECK(rule.places[i] > rule.places[i - 1]);
        }
        const auto error = [&](int degree) { // of the integral of (2x - 1) to the power of the degree
            double sum = 0;
            for (int i = 0; i < n; ++i)
                sum += rule.weights[i] * std::pow(2 * rule.places[i] - 1, degree);
            return std::abs(sum - (degree % 2 ? 0.0 : 1.0 / (degree + 1)));
        };
        for (int degree = 0; degree <= 2 * n - 3; ++degree)
            CHECK(error(degree) < 1e-12);
        if (n < 8) CHECK(error(2 * n - 2) > 1e-5); // beyond, the error at this degree drowns in round-off
    }
}

TEST_CASE("subcontacts keep the area and the moments of any convex polygon, and lie on it") {
    std::mt19937 dice(2);
    std::uniform_real_distribution<> u(0, 1);
    for (int trial = 0; trial < 300; ++trial) {
        const auto motion = randomMotion(dice);
        std::vector<double> angles;
        for (int i = 0, n = 3 + trial % 6; i < n; ++i)
            angles.push_back(2 * M_PI * (i + 0.8 * u(dice)) / n);
        Polygon polygon;
        for (double a : angles)
            polygon.push_back(motion * Point(0.3 * std::cos(a), 0.1 * std::sin(a), 0));
        const Point normal = motion.rotation().col(2), direction = longestEdge(polygon);
        const Point middle = centroid(polygon, normal);
        const double whole = area(polygon, normal);
        Matrix3 second = Matrix3::Zero(); // moments about the centroid, exact by the middles of the edges of triangles
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point a = polygon[i] - middle, b = polygon[(i + 1) % polygon.size()] - middle;
            const double third = a.cross(b).dot(normal) / 6;
            for (const Point& p : {Point(a / 2), Point(b / 2), Point((a + b) / 2)})
                second += third * p * p.transpose();
        }
        for (int along : {1, 2, 3, 5, 6})
            for (int across : {1, 2, 3, 4}) {
                CAPTURE(polygon.size());
                CAPTURE(along);
                CAPTURE(across);
                double sum = 0;
                Point moment = Point::Zero();
                Matrix3 moments = Matrix3::Zero();
                const auto points = subdivide(polygon, normal, direction, along, across);
                for (std::size_t n = 0; n < points.size(); ++n) {
                    const auto& [centre, part] = points[n];
                    CHECK(part > 0);
                    sum += part;
                    moment += part * centre;
                    moments += part * (centre - middle) * (centre - middle).transpose();
                    for (std::size_t i = 0; i < polygon.size(); ++i) {
                        const Point edge = polygon[(i + 1) % polygon.size()] - polygon[i];
                        CHECK(edge.normalized().cross(centre - polygon[i]).dot(normal) > -1e-9);
                    }
                    for (std::size_t other = 0; other < n; ++other)
                        CHECK((points[other].centre - centre).norm() > 1e-6); // no point stands twice
                }
                CHECK(sum == within(whole, 1e-9));
                CHECK((moment / sum - middle).norm() < 1e-9);
                if (along >= 3 && across == 1)
                    CHECK(direction.dot(moments * direction) == within(direction.dot(second * direction), 1e-8));
                const bool least = along >= 2 && across >= 2; // a polygon that is no parallelogram has more points then
                if (least) CHECK((moments - second).norm() < 1e-9 * second.norm());
                for (const auto& corner : polygon)
                    if (least)
                        CHECK(std::any_of(points.begin(), points.end(),
                                          [&](const auto& s) { return (s.centre - corner).norm() < 1e-9; }));
            }
    }
}

TEST_CASE("a face has three points along and three across at its edges and middles, in the order of a grid") {
    std::mt19937 dice(3);
    for (int trial = 0; trial < 50; ++trial) {
        const auto motion = randomMotion(dice);
        const auto contact =
            coincidentFaces(moved(box(Point::Zero(), brick), motion), moved(box({0, 0, 0.081}, brick), motion));
        REQUIRE(contact);
        const auto share = [](int i, int of) { return of == 1 ? 1 : i == 1 ? 2. / 3 : 1. / 6; };
        const auto place = [](int i, int of) { return of == 1 ? 0.5 : 0.5 * i; };
        for (const auto& [along, across] : {std::pair(3, 3), std::pair(3, 1), std::pair(1, 3)}) {
            const auto found = subdivide(contact->polygon, contact->normal, motion.rotation().col(0), along, across);
            REQUIRE(int(found.size()) == along * across);
            for (int n = 0; n < along * across; ++n) {
                const int i = n / across, j = n % across;
                const Point there(0.22 * place(i, along), 0.102 * place(j, across), 0.081);
                CHECK((found[n].centre - motion * there).norm() < 1e-9);
                CHECK(found[n].area == within(0.22 * 0.102 * share(i, along) * share(j, across), 1e-9));
            }
        }
    }
}

TEST_CASE("polygons without four corners have the corners and centroids of small triangles, half as many as points") {
    for (int corners : {3, 5, 6}) {
        Polygon polygon;
        for (int i = 0; i < corners; ++i)
            polygon.push_back({std::cos(2 * M_PI * i / corners), std::sin(2 * M_PI * i / corners), 0});
        for (int along = 2; along < 9; ++along)
            for (int across = 2; across < 9; ++across) {
                const int m = std::max(along, across) / 2; // parts of the line from the centroid to a corner
                const int inner = corners * m * m, shared = 1 + corners * m * (m + 1) / 2;
                const auto points = subdivide(polygon, Point::UnitZ(), Point::UnitX(), along, across);
                CHECK(int(points.size()) == inner + shared);
            }
    }
}

TEST_CASE("a parallelogram may have two points along, other quadrilaterals have at least three each way") {
    const Polygon sheared{{0, 0, 0}, {0.2, 0, 0}, {0.25, 0.1, 0}, {0.05, 0.1, 0}};
    const Polygon trapezoid{{0, 0, 0}, {0.2, 0, 0}, {0.15, 0.1, 0}, {0.05, 0.1, 0}};
    CHECK(subdivide(sheared, Point::UnitZ(), Point::UnitX(), 2, 2).size() == 4);
    CHECK(subdivide(trapezoid, Point::UnitZ(), Point::UnitX(), 2, 2).size() == 9);
    CHECK(subdivide(trapezoid, Point::UnitZ(), Point::UnitX(), 4, 2).size() == 12);
}

TEST_CASE("cells nearest to the subcontacts of a face cover it, and each holds its point") {
    std::mt19937 dice(4);
    std::uniform_real_distribution<> u(0, 1);
    for (int corners = 3; corners < 8; ++corners) {
        Polygon polygon;
        for (int i = 0; i < corners; ++i) {
            const double angle = 2 * M_PI * (i + 0.8 * u(dice)) / corners;
            polygon.push_back({0.3 * std::cos(angle), 0.1 * std::sin(angle), 0});
        }
        for (int across : {1, 3}) {
            std::vector<Point> points;
            for (const auto& s : subdivide(polygon, Point::UnitZ(), Point::UnitX(), 4, across))
                points.push_back(s.centre);
            double sum = 0;
            const auto cells = nearestCells(polygon, points);
            for (std::size_t n = 0; n < cells.size(); ++n) {
                REQUIRE(cells[n].size() > 2);
                const double part = area(cells[n], Point::UnitZ());
                CHECK(part > 0);
                sum += part;
                for (std::size_t i = 0; i < cells[n].size(); ++i) {
                    const Point edge = cells[n][(i + 1) % cells[n].size()] - cells[n][i];
                    CHECK(edge.cross(points[n] - cells[n][i]).z() > -1e-12);
                }
            }
            CHECK(sum == within(area(polygon, Point::UnitZ()), 1e-9));
        }
    }
}

Row everyLane() {
    Row present;
    std::fill_n(present.lane, lanes, 1.0);
    return present;
}

struct Forces {
    std::vector<Point> forces;
    Matrix3 rotation;
    double energy;
};

// Forces, rotation and energy of one block in a batch, beside others that are at rest or moved in another way.
Forces forcesOf(const BlockElasticity& e, const std::vector<Point>& u, const Point& moment = Point::Zero()) {
    constexpr int mine = 3;
    std::vector<Row> all(3 * u.size()), f(all.size(), Row{}), scratch(2 * all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        for (int lane = 0; lane < lanes; ++lane)
            all[i].lane[lane] = lane ? (lane - mine) * 1e-6 * double(i % 7) + u[i / 3][i % 3] : 0;
    Row rotation[9], energy, moments[3]{};
    for (int d = 0; d < 3; ++d)
        moments[d].lane[mine] = moment[d];
    addBlockForces(e.matrix(), all.data(), moments, f.data(), rotation, &energy, scratch.data());
    Forces result{std::vector<Point>(u.size()), {}, energy.lane[mine]};
    for (std::size_t n = 0; n < u.size(); ++n)
        for (int d = 0; d < 3; ++d)
            result.forces[n][d] = f[3 * n + d].lane[mine];
    for (int i = 0; i < 9; ++i)
        result.rotation(i / 3, i % 3) = rotation[i].lane[mine];
    return result;
}

// ---- zones -------------------------------------------------------------------------------------------------------

namespace {

BlockElasticity elastic(const ConvexBlock& block, std::array<int, 3> divisions) {
    return BlockElasticity(divide(block, divisions), 4.8e9, 0.16, 1800);
}

ConvexBlock prism() { // five faces: no hexahedron
    ConvexBlock b;
    b.vertices = {{0, 0, 0}, {0.2, 0, 0}, {0.05, 0.1, 0}, {0, 0, 0.1}, {0.2, 0, 0.1}, {0.05, 0.1, 0.1}};
    b.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    return b;
}

} // namespace

TEST_CASE("zones fill a block, their surface closes, and the masses add up") {
    for (const auto& divisions : {std::array<int, 3>{1, 1, 1}, {2, 1, 2}, {3, 2, 4}}) {
        const auto e = elastic(box({0.3, 0.1, 0.2}, brick), divisions);
        const auto& mesh = e.mesh();
        CHECK(mesh.zones.size() == 12u * divisions[0] * divisions[1] * divisions[2]);
        double inside = 0, mass = 0;
        for (const auto& z : mesh.zones)
            inside += volume({mesh.nodes[z[0]], mesh.nodes[z[1]], mesh.nodes[z[2]], mesh.nodes[z[3]]});
        for (double m : e.masses())
            mass += m;
        CHECK(inside == within(brick.prod(), 1e-9));
        CHECK(mass == within(1800 * brick.prod(), 1e-9));
        Point closed = Point::Zero();
        double flux = 0; // of x through the surface: three times the volume
        for (const auto& t : mesh.triangles) {
            const Point &a = mesh.nodes[t[0]], &b = mesh.nodes[t[1]], &c = mesh.nodes[t[2]];
            const Point n = 0.5 * (b - a).cross(c - a);
            closed += n;
            flux += n.dot(a + b + c) / 3;
        }
        CHECK(closed.norm() < 1e-15);
        CHECK(flux == within(3 * brick.prod(), 1e-9));
        REQUIRE(mesh.triangles.size() == 2 * mesh.cellFaces.size());
        for (std::size_t n = 0; n < mesh.triangles.size(); ++n) { // two triangles are the halves of a cell's face
            const auto &t = mesh.triangles[n], &other = mesh.triangles[n ^ 1];
            const auto& face = mesh.cellFaces[n / 2];
            for (int node : face)
                CHECK(std::count(t.begin(), t.end(), node) + std::count(other.begin(), other.end(), node) > 0);
            const auto outward = [&](const auto& corners) {
                return Point((mesh.nodes[corners[1]] - mesh.nodes[corners[0]])
                                 .cross(mesh.nodes[corners[2]] - mesh.nodes[corners[1]])
                                 .normalized());
            };
            CHECK((outward(t) - outward(face)).norm() < 1e-9);
        }
    }
    CHECK(elastic(prism(), {1, 1, 1}).mesh().cellFaces.empty());
    const auto e = elastic(prism(), {1, 1, 1});
    CHECK(e.mass() == within(1800 * 0.5 * 0.2 * 0.1 * 0.1, 1e-9));
}

TEST_CASE("neighbouring cells conform: every inner face belongs to two zones") {
    const auto mesh = divide(box(Point::Zero(), brick), {3, 2, 2});
    std::map<std::array<int, 3>, int> faces;
    for (const auto& z : mesh.zones)
        for (int i = 0; i < 4; ++i) {
            std::array<int, 3> f{z[(i + 1) % 4], z[(i + 2) % 4], z[(i + 3) % 4]};
            std::sort(f.begin(), f.end());
            ++faces[f];
        }
    std::size_t once = 0;
    for (const auto& [face, count] : faces) {
        CHECK(count <= 2);
        once += count == 1;
    }
    CHECK(once == mesh.triangles.size());
}

TEST_CASE("rigid motions of any size give no force and show their rotation") {
    std::mt19937 dice(4);
    for (const auto& block : {box(Point::Zero(), brick), prism()}) {
        const auto e = elastic(block, {2, 1, 1});
        const auto n = e.mesh().nodes.size();
        for (int trial = 0; trial < 50; ++trial) {
            const auto motion = randomMotion(dice);
            std::vector<Point> u(n);
            for (std::size_t i = 0; i < n; ++i)
                u[i] = motion * e.mesh().nodes[i] - e.mesh().nodes[i];
            // After a large rotation Newton's iteration starts far from its solution; at a pure rotation the result is
            // exact.
            const Matrix3 r = e.rotation(u.data());
            CHECK((r - motion.rotation()).norm() < 1e-11);
            const auto result = forcesOf(e, u);
            CHECK((result.rotation - r).norm() < 1e-11);
            for (const auto& force : result.forces)
                CHECK(force.norm() < 1e-3); // N, of a block whose zones carry 1e8 N at unit strain
            CHECK(result.energy < 1e-9);
        }
    }
}

TEST_CASE("patch test: a linear displacement field is a constant stress on any mesh") {
    std::mt19937 dice(5);
    std::uniform_real_distribution<> u01(-1, 1);
    Matrix3 g;
    for (int i = 0; i < 9; ++i)
        g(i) = 1e-7 * u01(dice);
    const Matrix3 strain = 0.5 * (g + g.transpose());
    const double E = 4.8e9, nu = 0.16, lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
    const Matrix3 exact = lambda * strain.trace() * Matrix3::Identity() + 2 * mu * strain;
    for (const auto& block : {box(Point::Zero(), brick), prism()}) {
        const auto e = elastic(block, {2, 2, 3});
        const auto& mesh = e.mesh();
        std::vector<Point> u;
        for (const auto& x : mesh.nodes)
            u.push_back(g * x);
        const Matrix3 r = e.rotation(u.data());
        const auto f = forcesOf(e, u).forces;
        for (std::size_t z = 0; z < mesh.zones.size(); ++z)
            CHECK((e.stress(int(z), u.data(), r) - exact).norm() < 1e-5 * exact.norm());
        std::vector<char> surface(mesh.nodes.size(), 0);
        for (const auto& t : mesh.triangles)
            for (int i : t)
                surface[i] = 1;
        for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
            if (!surface[i]) CHECK(f[i].norm() < 1e-6 * exact.norm() * 0.01);
    }
}

TEST_CASE("the forces of a block are those of its zones' stresses on their faces") {
    std::mt19937 dice(9);
    std::uniform_real_distribution<> u01(-1, 1);
    for (int held : {-1, 1}) {
        const auto block = box(Point::Zero(), brick);
        const BlockElasticity e(divide(block, {2, 1, 3}), 4.8e9, 0.16, 1800, held);
        const auto& mesh = e.mesh();
        std::vector<Point> u, f(mesh.nodes.size(), Point::Zero());
        for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
            u.push_back(1e-5 * Point(u01(dice), u01(dice), u01(dice)) + Point(0.01, 0.02, -0.03));
            if (held >= 0) u[i][held] = 0;
        }
        const auto result = forcesOf(e, u);
        double energy = 0;
        for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
            const auto& nodes = mesh.zones[z];
            const Matrix3 stress = e.stress(int(z), u.data(), result.rotation);
            for (int i = 0; i < 4; ++i) { // a third of the traction on the face opposite to a node
                const Point a = mesh.nodes[nodes[(i + 1) % 4]], b = mesh.nodes[nodes[(i + 2) % 4]],
                            c = mesh.nodes[nodes[(i + 3) % 4]];
                Point face = 0.5 * (b - a).cross(c - a);
                if (face.dot(mesh.nodes[nodes[i]] - a) > 0) face = -face;
                const Point force = stress * face / 3;
                f[nodes[i]] += result.rotation * force;
                energy -= 0.5 * force.dot(result.rotation.transpose() * (mesh.nodes[nodes[i]] + u[nodes[i]]) -
                                          mesh.nodes[nodes[i]]);
            }
        }
        double size = 0;
        for (const auto& force : f)
            size = std::max(size, force.norm());
        for (std::size_t i = 0; i < f.size(); ++i)
            for (int d = 0; d < 3; ++d)
                if (d != held) CHECK(std::abs(f[i][d] - result.forces[i][d]) < 1e-9 * size);
        CHECK(result.energy == within(energy, 1e-6));
    }
}

TEST_CASE("combined damping of a node takes nothing of a growing force, half of a steady one, all of one that falls") {
    const auto e = elastic(box(Point::Zero(), brick), {1, 1, 1});
    const auto matrix = e.matrix();
    const std::size_t rows = 3 * e.mesh().nodes.size();
    const double dt = 1e-6, alpha = 0.3, velocity = 5;
    for (bool combined : {true, false})
        for (const auto& [before, force, share] :
             {std::tuple(1., 2., 0.), std::tuple(2., 2., 0.5), std::tuple(3., 2., 1.), std::tuple(-3., -2., 0.)}) {
            std::vector<Row> u(rows, Row{}), v(rows, Row{}), f(rows, Row{}), last(rows, Row{});
            for (std::size_t row = 0; row < rows; ++row)
                for (int lane = 0; lane < lanes; ++lane)
                    v[row].lane[lane] = velocity, f[row].lane[lane] = force, last[row].lane[lane] = before;
            LaneUnits units{matrix, everyLane(), u.data(), v.data(), f.data(), last.data(), {}, {}};
            moveBlocks({dt, alpha, {0, 0, 0}, combined, {false, false, false}}, units);
            const double taken = alpha * std::abs(force) * (combined ? share : 1);
            double first = 0, second = 0; // energy taken with the velocities before and after the step [J]
            for (std::size_t row = 0; row < rows; ++row)
                for (double now : v[row].lane)
                    CHECK((now - velocity) * matrix.masses[row / 3] / dt == within(force - taken, 1e-6));
            for (std::size_t row = 0; row < rows; ++row) {
                first += 0.5 * dt * taken * velocity;
                second += 0.5 * dt * taken * v[row].lane[0];
            }
            CHECK(units.sums.damping.lane[0] == within(first, 1e-9));
            CHECK(units.sums.pending.lane[0] == within(second, 1e-9));
        }
}

// ---- plane units ---------------------------------------------------------------------------------------------------

namespace {

BlockElasticity planeUnit(const ConvexBlock& block, std::array<int, 3> divisions, int across = 1) {
    auto mesh = divideInPlane(block, divisions, across);
    REQUIRE(mesh.has_value());
    return BlockElasticity(std::move(*mesh), 4.8e9, 0.16, 1800, across);
}

// A trapezium: a right prism along y over a quadrilateral that is no rectangle.
ConvexBlock voussoir() {
    auto b = box(Point::Zero(), brick);
    for (auto& v : b.vertices)
        if (v.z() > 0.01) v.x() = 0.03 + 0.7 * v.x();
    return b;
}

} // namespace

TEST_CASE("a plane unit has nodes in its middle plane alone, and the mass and the rim of its block") {
    for (const auto& [block, across, volume, nodes, triangles, edges] :
         {std::tuple(box({0.3, 0.1, 0.2}, brick), 1, brick.prod(), 13, 16, 8),
          std::tuple(voussoir(), 1, 0.85 * brick.prod(), 13, 16, 8), std::tuple(prism(), 2, 0.001, 4, 3, 3),
          std::tuple(box({0.3, 0.1, 0.2}, brick), 0, brick.prod(), 13, 16, 8)}) {
        const auto e = planeUnit(block, {2, 2, 2}, across);
        const auto& mesh = e.mesh();
        CHECK(mesh.nodes.size() == std::size_t(nodes));
        CHECK(mesh.triangles.size() == std::size_t(triangles));
        CHECK(mesh.rim.size() == std::size_t(edges));
        CHECK(mesh.zones.empty());
        double mass = 0, low = HUGE_VAL, high = -HUGE_VAL;
        for (double m : e.masses())
            mass += m;
        CHECK(mass == within(1800 * volume, 1e-9));
        CHECK(e.mass() == within(mass, 1e-12));
        for (const auto& v : block.vertices)
            low = std::min(low, v[across]), high = std::max(high, v[across]);
        CHECK(mesh.thickness == within(high - low, 1e-12));
        for (const auto& node : mesh.nodes)
            CHECK(node[across] == within(0.5 * (low + high), 1e-12));
        Point centre = Point::Zero(), outward = Point::Zero();
        for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
            centre += e.masses()[n] / mass * mesh.nodes[n];
        for (const auto& [from, to] : mesh.rim)
            outward += (mesh.nodes[to] - mesh.nodes[from]).cross(Point::Unit(across));
        CHECK(outward.norm() < 1e-12); // the rim closes
        if (across == 0) CHECK((centre - Point(0.3, 0.1, 0.2) - 0.5 * brick).norm() < 1e-12);
    }
    CHECK(!divideInPlane(prism(), {1, 1, 1}, 1).has_value()); // a prism along z alone
    auto leaning = box(Point::Zero(), brick);
    for (auto& v : leaning.vertices)
        v.x() += 0.05 * v.y();
    CHECK(!divideInPlane(leaning, {1, 1, 1}, 1).has_value()); // no right prism
}

TEST_CASE("patch test of plane units: a linear displacement is a uniform plane stress with its forces on the rim") {
    std::mt19937 dice(31);
    std::uniform_real_distribution<> u01(-1, 1);
    const double E = 4.8e9, nu = 0.16;
    for (const auto& [block, across] :
         {std::pair(box(Point::Zero(), brick), 1), std::pair(voussoir(), 1), std::pair(prism(), 2)}) {
        const int a = (across + 1) % 3, b = (across + 2) % 3;
        Matrix3 g = Matrix3::Zero();
        for (int i : {a, b})
            for (int j : {a, b})
                g(i, j) = 1e-7 * u01(dice);
        const Matrix3 strain = 0.5 * (g + g.transpose());
        Matrix3 exact = Matrix3::Zero();
        exact(a, a) = E / (1 - nu * nu) * (strain(a, a) + nu * strain(b, b));
        exact(b, b) = E / (1 - nu * nu) * (strain(b, b) + nu * strain(a, a));
        exact(a, b) = exact(b, a) = E / (1 + nu) * strain(a, b);
        const auto e = planeUnit(block, {3, 2, 2}, across);
        const auto& mesh = e.mesh();
        std::vector<Point> u, expected(mesh.nodes.size(), Point::Zero());
        for (const auto& x : mesh.nodes)
            u.push_back(g * x);
        const Matrix3 r = e.rotation(u.data());
        for (std::size_t z = 0; z < mesh.triangles.size(); ++z)
            CHECK((e.stress(int(z), u.data(), r) - exact).norm() < 1e-5 * exact.norm());
        for (const auto& [from, to] : mesh.rim) {
            const Point outward = (mesh.nodes[to] - mesh.nodes[from]).cross(Point::Unit(across)) * mesh.thickness;
            for (int node : {from, to})
                expected[node] -= 0.5 * exact * outward; // the unit pulls its nodes back
        }
        const auto f = forcesOf(e, u).forces;
        for (std::size_t n = 0; n < f.size(); ++n)
            CHECK((f[n] - expected[n]).norm() < 1e-5 * exact.norm() * mesh.thickness * 0.1);
        double energy = 0.5 * (exact.cwiseProduct(strain)).sum() * e.mass() / 1800;
        CHECK(forcesOf(e, u).energy == within(energy, 1e-4));
    }
}

TEST_CASE("forces are the gradient of the energy, keep momentum, and do the work of moments, in space and in a plane") {
    std::mt19937 dice(32);
    std::uniform_real_distribution<> u01(-1, 1);
    for (int across : {-1, 0, 1, 2}) { // -1: in space
        const auto block = box(Point::Zero(), brick);
        const auto e = across < 0 ? elastic(block, {2, 1, 1}) : planeUnit(block, {2, 1, 2}, across);
        const auto n = e.mesh().nodes.size();
        const Point axis = across < 0 ? Point(1, 2, 3).normalized() : Point::Unit(across);
        const Point moment = across < 0 ? Point(3, -2, 5) : Point(7 * axis);
        const auto inPlane = [&](double size) { // without a component across the plane
            Point p = size * Point(u01(dice), u01(dice), u01(dice));
            if (across >= 0) p[across] = 0;
            return p;
        };
        Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
        turn.rotate(Eigen::AngleAxisd(0.3, axis));
        std::vector<Point> u(n), rigid(n);
        for (std::size_t i = 0; i < n; ++i) {
            rigid[i] = turn * e.mesh().nodes[i] - e.mesh().nodes[i] + Point::Unit((across + 1) % 3);
            u[i] = rigid[i] + inPlane(1e-6);
        }
        for (const auto& force : forcesOf(e, rigid).forces)
            CHECK(force.norm() < 1e-3); // N, of a block whose zones carry 1e8 N at unit strain
        CHECK((forcesOf(e, rigid).rotation - turn.rotation()).norm() < 1e-11);
        CHECK((forcesOf(e, u).rotation - e.rotation(u.data())).norm() < 1e-11);
        const auto f = forcesOf(e, u).forces, withMoment = forcesOf(e, u, moment).forces;
        Point sum = Point::Zero(), about = Point::Zero(), added = Point::Zero(), turned = Point::Zero();
        double size = 0, work = 0;
        auto after = u, before = u; // half of a small motion on, and back
        for (std::size_t i = 0; i < n; ++i) {
            const Point place = e.mesh().nodes[i] + u[i], force = withMoment[i] - f[i], du = inPlane(1e-6);
            sum += f[i], about += place.cross(f[i]), size += f[i].norm();
            added += force, turned += place.cross(force), work += force.dot(du);
            after[i] += 0.5 * du, before[i] -= 0.5 * du;
        }
        CHECK(sum.norm() < 1e-9 * size);
        CHECK(about.norm() < 1e-5 * size);
        CHECK(added.norm() < 1e-8);
        CHECK((turned - moment).norm() < 1e-3);
        const Eigen::AngleAxisd by(Matrix3(e.rotation(after.data()) * e.rotation(before.data()).transpose()));
        CHECK(work == within(moment.dot(by.angle() * by.axis()), 1e-3));
        for (std::size_t i = 0; i < n; ++i)
            for (int d = 0; d < 3; ++d) {
                if (d == across) continue;
                auto plus = u, minus = u;
                plus[i][d] += 1e-8, minus[i][d] -= 1e-8;
                CHECK(-(forcesOf(e, plus).energy - forcesOf(e, minus).energy) / 2e-8 ==
                      doctest::Approx(f[i][d]).epsilon(1e-4).scale(size));
            }
    }
}

TEST_CASE("a beam of plane units bends as the theory of beams says, and less stiffly with finer cells") {
    // A beam of 8:1 under opposite moments at its ends: pairs of forces along it, linear over the height.
    const double length = 0.8, height = 0.1, thickness = 0.1, E = 4.8e9;
    const auto stiffness = [&](int cells) {
        const auto e = planeUnit(box(Point::Zero(), {length, thickness, height}), {8 * cells, 1, cells});
        const auto m = e.matrix();
        const int n = 3 * m.nodeCount;
        Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
        for (int r = 0; r < m.rowCount; ++r)
            for (int i = m.rows[r].first; i < m.rows[r].beyond; ++i)
                k(m.rows[r].degree, m.columns[i]) = m.values[i];
        // bending strains that the theory gives, as displacements: their energy is at least that of the theory
        Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
        for (int i = 0; i < m.nodeCount; ++i) {
            const double x = m.nodes[3 * i] - length / 2, z = m.nodes[3 * i + 2] - height / 2;
            u[3 * i] = x * z;
            u[3 * i + 2] = -0.5 * x * x - 0.5 * 0.16 * z * z;
        }
        const double exact = E * thickness * std::pow(height, 3) / 12 * length; // u K u under unit curvature
        return u.dot(k * u) / exact;
    };
    const double coarse = stiffness(2), fine = stiffness(4);
    CHECK(coarse > 1);
    CHECK(fine > 1);
    CHECK((coarse - 1) / (fine - 1) == within(4, 0.1)); // second order
    CHECK(fine < 1.1);
}

TEST_CASE("every instruction set moves blocks and plane units to the same bits") {
    std::mt19937 dice(13);
    std::uniform_real_distribution<> u01(-1, 1);
    const auto space = elastic(box(Point::Zero(), brick), {2, 1, 2});
    const auto plane = planeUnit(box(Point::Zero(), brick), {2, 1, 2});
    for (const auto& [e, combined] : {std::pair(&space, false), std::pair(&space, true), std::pair(&plane, true)}) {
        const bool held = e == &plane;
        const auto matrix = e->matrix();
        const std::size_t rows = 3 * e->mesh().nodes.size();
        std::vector<Row> start(3 * rows);
        for (std::size_t i = 0; i < start.size(); ++i)
            for (double& value : start[i].lane)
                value = held && i % 3 == 1 ? 0 : u01(dice) * (i < rows ? 1e-5 : i < 2 * rows ? 1e-3 : 10);
        const NodeMotion motion{1e-6, 0.8, {0, 0, -9.81}, combined, {false, held, false}};
        const auto run = [&](auto addForces, auto move) {
            auto u = std::vector<Row>(start.begin(), start.begin() + rows);
            auto v = std::vector<Row>(start.begin() + rows, start.begin() + 2 * rows);
            auto last = std::vector<Row>(start.begin() + 2 * rows, start.end());
            std::vector<Row> f(rows, Row{}), scratch(2 * rows);
            Row moments[3]{}, rotation[9], energy;
            LaneUnits units{matrix, everyLane(), u.data(), v.data(), f.data(), last.data(), {}, {}};
            const auto& sums = units.sums;
            for (int step = 0; step < 20; ++step) {
                moments[1].lane[2] = step;
                addForces(matrix, u.data(), moments, f.data(), rotation, &energy, scratch.data());
                move(motion, units);
            }
            std::vector<double> all;
            for (const auto* part : {&u, &v, &last})
                for (const auto& row : *part)
                    all.insert(all.end(), row.lane, row.lane + lanes);
            for (const Row& row : {energy, sums.kinetic, sums.gravityWork, sums.damping, sums.pending, sums.moved[2]})
                all.insert(all.end(), row.lane, row.lane + lanes);
            return all;
        };
        const auto reference = run(plain::addForces, plain::move);
        CHECK(std::abs(reference[5] - start[0].lane[5]) > 1e-9); // it moved
#if defined(__x86_64__)
        if (__builtin_cpu_supports("avx2")) CHECK(run(avx2::addForces, avx2::move) == reference);
        if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
            CHECK(run(avx512::addForces, avx512::move) == reference);
#endif
    }
}

// ---- masses that are scaled selectively -----------------------------------------------------------------------------

namespace {

// One or two units side by side in every lane, with random states, and their scaled mass matrix in lane `mine`.
struct Scaling {
    static constexpr int mine = 5;
    double scaling;
    std::vector<const BlockElasticity*> units;
    bool whole, plane;
    Point apart = Point(0.12, 0, 0.01); // from unit to unit [m]
    std::vector<std::vector<Row>> u, v, f, last;
    std::vector<Row> scratch;
    std::vector<LaneUnits> members;

    Scaling(double s, std::vector<const BlockElasticity*> all, bool isWhole, std::mt19937& dice)
        : scaling(s), units(all), whole(isWhole), plane(all[0]->mesh().across >= 0) {
        std::uniform_real_distribution<> u01(-1, 1);
        for (const auto* unit : units) {
            const std::size_t rows = 3 * unit->mesh().nodes.size();
            std::vector<Row> made[4];
            for (int i = 0; i < 4; ++i) {
                made[i].resize(rows);
                const double size = i == 0 ? 1e-4 : i == 1 ? 1e-3 : 10;
                for (std::size_t row = 0; row < rows; ++row)
                    for (double& value : made[i][row].lane)
                        value = plane && row % 3 == 1 ? 0 : size * u01(dice);
            }
            u.push_back(made[0]), v.push_back(made[1]), f.push_back(made[2]), last.push_back(made[3]);
            scratch.resize(scratch.size() + 3 * rows);
        }
    }
    int degrees() const {
        int count = 0;
        for (const auto* unit : units)
            count += int(3 * unit->mesh().nodes.size());
        return count;
    }
    Eigen::VectorXd listed(const std::vector<std::vector<Row>>& rows, int lane = mine) const {
        Eigen::VectorXd all(degrees());
        int i = 0;
        for (const auto& part : rows)
            for (const auto& row : part)
                all[i++] = row.lane[lane];
        return all;
    }
    Eigen::VectorXd masses() const {
        Eigen::VectorXd all(degrees());
        int i = 0;
        for (const auto* unit : units)
            for (double m : unit->masses())
                for (int d = 0; d < 3; ++d)
                    all[i++] = m;
        return all;
    }
    Eigen::VectorXd places() const {
        Eigen::VectorXd all = listed(u);
        int i = 0;
        for (std::size_t k = 0; k < units.size(); ++k)
            for (const auto& node : units[k]->mesh().nodes)
                for (int d = 0; d < 3; ++d)
                    all[i++] += node[d] + double(k) * apart[d];
        return all;
    }
    // Rigid motions in the columns, of all units together or each for itself.
    Eigen::MatrixXd rigid(bool together) const {
        const auto x = places();
        const int parts = together ? 1 : int(units.size());
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(degrees(), 6 * parts);
        int row = 0;
        for (std::size_t k = 0; k < units.size(); ++k)
            for (std::size_t n = 0; n < units[k]->mesh().nodes.size(); ++n, row += 3)
                for (int motion = 0; motion < 6; ++motion) {
                    const Point p = x.segment<3>(row), axis = Point::Unit(motion % 3);
                    Point moved = motion < 3 ? axis : Point(axis.cross(p));
                    if (plane && (motion < 3 ? motion == 1 : motion != 4)) moved.setZero();
                    all.block<3, 1>(row, 6 * (together ? 0 : int(k)) + motion) = moved;
                }
        Eigen::MatrixXd kept(degrees(), plane ? 3 * parts : 6 * parts);
        int column = 0;
        for (int c = 0; c < all.cols(); ++c)
            if (all.col(c).norm() > 0) kept.col(column++) = all.col(c);
        return kept;
    }
    Eigen::MatrixXd massMatrix() const {
        const Eigen::MatrixXd m = masses().asDiagonal();
        const auto projected = [&](const Eigen::MatrixXd& r) {
            const Eigen::MatrixXd p = m * r;
            return Eigen::MatrixXd(p * (r.transpose() * p).inverse() * p.transpose());
        };
        const Eigen::MatrixXd w = projected(rigid(true));
        if (whole || units.size() == 1) return m + scaling * (m - w);
        const Eigen::MatrixXd h = projected(rigid(false));
        return m + scaling * (m - h) + sharedScaling * scaling * (h - w);
    }
    template <class Move> void step(Move&& move, const NodeMotion& motion) {
        members.clear();
        for (std::size_t k = 0; k < units.size(); ++k) {
            members.push_back({units[k]->matrix(), {}, u[k].data(), v[k].data(), f[k].data(), last[k].data(), {}, {}});
            for (int lane = 0; lane < lanes; ++lane) {
                members[k].present.lane[lane] = 1;
                for (int d = 0; d < 3; ++d)
                    members[k].offset[d].lane[lane] = double(k) * apart[d];
            }
        }
        Row isWhole{};
        isWhole.lane[mine] = whole;
        move(motion, scaling, members.data(), int(units.size()), isWhole, scratch.data());
    }
    double sum(Row NodeSums::*which) const {
        double all = 0;
        for (const auto& member : members)
            all += (member.sums.*which).lane[mine];
        return all;
    }
};

// What every case of scaled masses is made of: units in the plane or in space, one or two, whole or split.
template <class F> void eachScaling(std::mt19937& dice, F&& visit) {
    const auto plane = planeUnit(box(Point::Zero(), {0.11, 0.102, 0.081}), {2, 1, 2});
    const auto small = planeUnit(box(Point::Zero(), {0.08, 0.102, 0.081}), {1, 1, 1});
    const BlockElasticity space(divide(box(Point::Zero(), {0.11, 0.102, 0.081}), {1, 1, 1}), 4.8e9, 0.16, 1800);
    for (double scaling : {1.0, 20.0}) {
        visit(Scaling(scaling, {&plane}, false, dice));
        visit(Scaling(scaling, {&space}, false, dice));
        for (bool whole : {true, false}) {
            visit(Scaling(scaling, {&plane, &small}, whole, dice));
            visit(Scaling(scaling, {&space, &space}, whole, dice));
        }
    }
}

} // namespace

TEST_CASE("scaled masses are those of the matrix, and leave momentum and spin of every block as they are") {
    std::mt19937 dice(41);
    eachScaling(dice, [&](Scaling s) {
        const bool held = s.plane;
        const Eigen::VectorXd force = s.listed(s.f), before = s.listed(s.v);
        const Eigen::MatrixXd m = s.massMatrix(), w = s.rigid(true), h = s.rigid(false);
        const double dt = 1e-5;
        s.step(moveScaled, {dt, 0, {0, 0, 0}, true, {false, held, false}});
        const Eigen::VectorXd after = s.listed(s.v), change = (after - before) / dt;
        CHECK((m * change - force).norm() < 1e-10 * force.norm());
        const Eigen::VectorXd impulse = s.masses().cwiseProduct(change);
        CHECK((w.transpose() * (impulse - force)).norm() < 1e-12 * force.norm());
        if (!s.whole && s.units.size() == 1) CHECK((h.transpose() * (impulse - force)).norm() < 1e-12 * force.norm());
        CHECK(s.sum(&NodeSums::kinetic) == within(0.5 * before.dot(m * after), 1e-9));
        CHECK(s.sum(&NodeSums::damping) == 0);
    });
}

TEST_CASE("a block falls as it would with true masses") {
    std::mt19937 dice(42);
    eachScaling(dice, [&](Scaling s) {
        for (auto* rows : {&s.v, &s.f})
            for (auto& part : *rows)
                part.assign(part.size(), Row{});
        s.step(moveScaled, {1e-5, 0, {0, 0, -9.81}, true, {false, s.plane, false}});
        const auto v = s.listed(s.v);
        for (int i = 0; i < v.size(); ++i)
            CHECK(std::abs(v[i] - (i % 3 == 2 ? -9.81e-5 : 0)) < 1e-15);
    });
}

TEST_CASE("damping of scaled masses takes what the energies say, and never gives any") {
    std::mt19937 dice(43);
    for (int trial = 0; trial < 20; ++trial)
        eachScaling(dice, [&](Scaling s) {
            const double viscous = trial % 3 == 0 ? 500 : 0;
            const Eigen::VectorXd force = s.listed(s.f), before = s.listed(s.v);
            const Eigen::MatrixXd m = s.massMatrix();
            const double dt = trial % 2 ? 1e-5 : 1e-7;
            s.step(moveScaled, {dt, 0.8, {0, 0, 0}, trial % 4 < 2, {false, s.plane, false}, viscous});
            const Eigen::VectorXd after = s.listed(s.v), lost = force - m * (after - before) / dt;
            const double damping = s.sum(&NodeSums::damping), pending = s.sum(&NodeSums::pending);
            CHECK(damping + pending >= 0);
            const double size = 1e-9 * force.norm() * before.norm() * dt;
            CHECK(std::abs(damping - 0.5 * dt * lost.dot(before)) < size);
            CHECK(std::abs(pending - 0.5 * dt * lost.dot(after)) < 10 * size);
            CHECK(s.sum(&NodeSums::kinetic) == doctest::Approx(0.5 * before.dot(m * after)).epsilon(1e-8).scale(1e-9));
        });
}

TEST_CASE("every instruction set moves scaled masses to the same bits") {
    std::mt19937 dice(44);
    eachScaling(dice, [&](const Scaling& start) {
        const auto run = [&](auto move) {
            Scaling s = start;
            for (int step = 0; step < 5; ++step) {
                s.step(move, {1e-6, 0.8, {0, 0, -9.81}, true, {false, s.plane, false}, 3});
                s.f = start.f;
            }
            std::vector<double> all;
            for (int lane = 0; lane < lanes; ++lane)
                for (const auto* rows : {&s.u, &s.v, &s.last}) {
                    const auto one = s.listed(*rows, lane);
                    all.insert(all.end(), one.data(), one.data() + one.size());
                }
            for (auto which : {&NodeSums::kinetic, &NodeSums::damping, &NodeSums::pending, &NodeSums::gravityWork})
                all.push_back(s.sum(which));
            return all;
        };
        const auto reference = run(plain::moveScaledUnits);
#if defined(__x86_64__)
        if (__builtin_cpu_supports("avx2")) CHECK(run(avx2::moveScaledUnits) == reference);
        if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
            CHECK(run(avx512::moveScaledUnits) == reference);
#endif
        CHECK(reference[0] != start.u[0][0].lane[0]);
    });
}

TEST_CASE("a surface point is found with weights that return it") {
    const auto mesh = divide(box(Point::Zero(), brick), {2, 1, 3});
    std::mt19937 dice(8);
    std::uniform_real_distribution<> u01(0, 1);
    for (int i = 0; i < 100; ++i) {
        const Point p(0.22 * u01(dice), 0.102 * u01(dice), i % 2 ? 0.081 : 0);
        const auto s = nearestOnSurface(mesh, p);
        Point back = Point::Zero();
        double sum = 0;
        for (int k = 0; k < 3; ++k)
            back += s.weights[k] * mesh.nodes[s.nodes[k]], sum += s.weights[k];
        CHECK((back - p).norm() < 1e-12);
        CHECK(sum == within(1, 1e-9));
    }
}

TEST_CASE("blocks and constants that cannot be meshed are refused") {
    const auto refused = [](auto&& make) {
        try {
            make();
        } catch (const std::invalid_argument& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    const auto good = box(Point::Zero(), brick);
    CHECK(refused([&] { divide(good, {1, 1, 1}); }) == "accepted");
    CHECK(refused([&] { divide(good, {0, 1, 1}); }) == "divisions 0 must be 1 to 100");
    CHECK(refused([&] {
              divide(box(Point::Zero(), {0.22, 0.102, 1e-5}), {1, 1, 1});
          }).find("sliver") != std::string::npos);
    auto dented = good;
    dented.vertices[7] = {0.05, 0.02, 0.02};
    CHECK(refused([&] { divide(dented, {1, 1, 1}); }).find("inverted zone") != std::string::npos);
    CHECK(refused([&] { BlockElasticity(divide(good, {1, 1, 1}), 0, 0.2, 1); }).find("Young") != std::string::npos);
    CHECK(refused([&] { BlockElasticity(divide(good, {1, 1, 1}), 1, 0.5, 1); }).find("Poisson") != std::string::npos);
    CHECK(refused([&] { BlockElasticity(divide(good, {1, 1, 1}), 1, -1, 1); }).find("Poisson") != std::string::npos);
    CHECK(refused([&] { BlockElasticity(divide(good, {1, 1, 1}), 1, 0, 0); }).find("density") != std::string::npos);
}
