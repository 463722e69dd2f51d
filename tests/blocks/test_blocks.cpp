// SPDX-License-Identifier: GPL-2.0-or-later
// Joint polygons and subcontacts of convex blocks in any orientation; forces and steps of deformable blocks.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "../dice.hpp"
#include "../within.hpp"
#include "blocks/BlockElasticity.hpp"
#include "blocks/BlockLanes.cpp" // the source, because its loops for each instruction set are local to it
#include "blocks/JointPoints.hpp"
#include <Eigen/LU>
#include <algorithm>
#include <map>

using namespace masonry;
using Eigen::AngleAxisd;
using Eigen::Isometry3d;

namespace {

const Point size(0.22, 0.102, 0.081); // of a brick [m]
const double volumeOfBrick = size.prod();
const Point up = Point::UnitZ();

ConvexBlock box(const Point& corner, const Point& size) {
    ConvexBlock b;
    for (int i = 0; i < 8; ++i)
        b.vertices.push_back(corner + size.cwiseProduct(Point(i & 1, (i >> 1) & 1, i >> 2)));
    b.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return b;
}

ConvexBlock brick(const Point& corner = Point::Zero()) { return box(corner, size); }

ConvexBlock dentedBrick() {
    auto b = brick();
    b.vertices[7] = {0.05, 0.02, 0.02};
    return b;
}

ConvexBlock prism() { // five faces: no hexahedron
    return {{{0, 0, 0}, {0.2, 0, 0}, {0.05, 0.1, 0}, {0, 0, 0.1}, {0.2, 0, 0.1}, {0.05, 0.1, 0.1}},
            {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}};
}

ConvexBlock moved(ConvexBlock b, const Isometry3d& motion) {
    for (auto& v : b.vertices)
        v = motion * v;
    return b;
}

Isometry3d anyMotion(Dice& dice) { return Eigen::Translation3d(dice.vector(10)) * dice.rotation(); }

// A convex polygon with its corners on an ellipse.
Polygon inEllipse(Dice& dice, int corners) {
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * M_PI * (i + dice.between(0, 0.8)) / corners;
        polygon.push_back({0.3 * std::cos(angle), 0.1 * std::sin(angle), 0});
    }
    return polygon;
}

} // namespace

// ---- faces ----------------------------------------------------------------------------------------------------------

TEST_CASE("a box has six faces of four corners with outward normals") {
    const auto faces = brick({1, 2, 3}).faces();
    REQUIRE(faces.size() == 6);
    double surface = 0;
    for (const auto& f : faces) {
        REQUIRE(f.size() == 4);
        const Point n = (f[1] - f[0]).cross(f[2] - f[1]).normalized();
        CHECK(n.dot(f[0] - Point(1, 2, 3) - 0.5 * size) > 0);
        surface += area(f, n);
    }
    CHECK(surface == within(2 * (0.22 * 0.102 + 0.22 * 0.081 + 0.102 * 0.081), 1e-9));
}

TEST_CASE("two bricks half over each other share half a bed face, in any orientation") {
    Dice dice(1);
    for (int i = 0; i < 200; ++i) {
        const auto motion = anyMotion(dice);
        const auto lower = moved(brick(), motion), upper = moved(brick({0.11, 0, 0.081}), motion);
        const auto contact = coincidentFaces(lower, upper), back = coincidentFaces(upper, lower);
        REQUIRE(contact);
        REQUIRE(back);
        CHECK((contact->normal - motion.rotation().col(2)).norm() < 1e-9);
        CHECK((back->normal + contact->normal).norm() < 1e-9);
        CHECK(area(contact->polygon, contact->normal) == within(0.11 * 0.102, 1e-9));
        CHECK((centroid(contact->polygon, contact->normal) - motion * Point(0.165, 0.051, 0.081)).norm() < 1e-9);
        auto corners = contact->polygon;
        CHECK(corners.size() == 4); // round-off adds no corners
        const Point along = longestEdge(corners);
        CHECK(std::abs(along.dot(motion.rotation().col(0))) == within(1, 1e-9));
        std::rotate(corners.begin(), corners.begin() + 1 + i % 3, corners.end()); // as round-off may begin elsewhere
        CHECK((longestEdge(corners) - along).norm() < 1e-9);
    }
}

TEST_CASE("turned blocks overlap in the polygon that the clipping gives") {
    const auto above = moved(box({-0.5, -0.5, 0}, {1, 1, 1}), Isometry3d(AngleAxisd(M_PI / 4, up)));
    const auto contact = coincidentFaces(box({-0.5, -0.5, -1}, {1, 1, 1}), above);
    REQUIRE(contact);
    CHECK(contact->polygon.size() == 8); // a regular octagon of inradius 1/2
    CHECK(area(contact->polygon, contact->normal) == within(2 * std::sqrt(2.) - 2, 1e-9));
}

TEST_CASE("a gap or overlap within the tolerance is a joint midway, beyond it is none") {
    for (double share : {0.9, -0.9, 1.1, -1.1, 1e4}) { // of the tolerance
        const double gap = share * 1e-4 * size.norm();
        const auto contact = coincidentFaces(brick(), brick({0, 0, 0.081 + gap}));
        REQUIRE(contact.has_value() == (std::abs(share) < 1));
        if (contact) CHECK(contact->polygon[0].z() == within(0.081 + 0.5 * gap, 1e-9));
    }
}

TEST_CASE("blocks that overlap or nearly share a face are told by how much, in any orientation") {
    Dice dice(7);
    // two bars that stand on an edge and cross, edge over edge
    const Isometry3d onEdge(AngleAxisd(0.25 * M_PI, up)), cross(AngleAxisd(0.5 * M_PI, Point::UnitX()));
    const auto bar = moved(box({-0.05, -0.05, -0.5}, {0.1, 0.1, 1}), onEdge);
    const auto crossed = [&](double apart) {
        return moved(bar, Eigen::Translation3d(0.1 * std::sqrt(2.) + apart, 0, 0) * cross);
    };
    const Isometry3d tilt = Eigen::Translation3d(0, 0, 0.081) * AngleAxisd(-0.02, Point::UnitY());
    const struct {
        ConvexBlock one, two;
        double gap;
    } cases[] = {
        {brick(), brick({0, 0, 0.082}), 1e-3},
        {brick(), brick({0.2, 0, 0.1}), 0.019}, // a tenth of the face, a quarter of the thickness
        {brick(), brick({0, 0, 0.080}), -1e-3},
        {brick(), brick(), -0.081}, // both at the same place: the shortest way to separate them is the height
        {brick(), box({0.05, 0.02, 0.02}, {0.02, 0.02, 0.02}), -0.04},
        {brick(), moved(brick(), tilt), 0.22 * std::sin(0.02)}, // opens from an edge to the other
        {bar, crossed(-2e-3), -2e-3},
    };
    for (const auto& c : cases) {
        CAPTURE(c.gap);
        for (int i = 0; i < 20; ++i) {
            const auto motion = anyMotion(dice);
            const auto one = moved(c.one, motion), two = moved(c.two, motion);
            CHECK_FALSE(coincidentFaces(one, two));
            for (const auto& found : {misfit(one, two), misfit(two, one)}) {
                REQUIRE(found);
                CHECK(found->gap == within(c.gap, 1e-3));
            }
        }
    }
    CHECK_FALSE(misfit(bar, crossed(1e-3)));
}

TEST_CASE("blocks that are far apart, or touch along an edge or at a corner, share nothing and are no misfit") {
    for (const Point& corner : {Point(0, 0, 0.5), Point(0, 0, 0.103), Point(0.22, 0, 0.081), Point(0.22, 0.102, 0.081),
                                Point(0.221, 0, 0.082)}) {
        CHECK_FALSE(coincidentFaces(brick(), brick(corner)));
        CHECK_FALSE(misfit(brick(), brick(corner)));
    }
}

TEST_CASE("blocks and constants that cannot be used are refused") {
    auto inward = brick();
    for (auto& t : inward.triangles)
        std::swap(t[1], t[2]);
    for (const auto& wrong : {inward, dentedBrick()}) {
        CHECK_THROWS_WITH(coincidentFaces(brick({0, 0, 0.081}), wrong),
                          "block is not convex, or the corners of its faces wind the wrong way");
        CHECK_THROWS_AS(misfit(wrong, wrong), std::invalid_argument);
    }
    const ConvexBlock tetrahedron{{Point::Zero(), Point::UnitX(), Point::UnitY(), up},
                                  {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
    for (const auto& inverted : {tetrahedron, dentedBrick()})
        CHECK_THROWS_WITH(divide(inverted, {1, 1, 1}), "block has an inverted zone: not convex, or without volume");
    CHECK_THROWS_WITH(divide(brick(), {0, 1, 1}), "divisions 0 must be 1 to 100");
    CHECK_THROWS_WITH(divide(box(Point::Zero(), {0.22, 0.102, 1e-5}), {1, 1, 1}), doctest::Contains("sliver"));
    const auto mesh = divide(brick(), {1, 1, 1});
    CHECK_THROWS_WITH(BlockElasticity(mesh, 0, 0.2, 1), doctest::Contains("Young"));
    for (double poisson : {0.5, -1.0})
        CHECK_THROWS_WITH(BlockElasticity(mesh, 1, poisson, 1), doctest::Contains("Poisson"));
    CHECK_THROWS_WITH(BlockElasticity(mesh, 1, 0, 0), doctest::Contains("density"));
}

// ---- subcontacts ----------------------------------------------------------------------------------------------------

TEST_CASE("the rule of Gauss and Lobatto has the ends, and is exact to degree 2n - 3 and no further") {
    for (int n : {2, 3, 4, 5, 6, 7, 8, 11, 16, 33, 100, 1000}) {
        CAPTURE(n);
        const auto [places, weights] = gaussLobatto(n);
        REQUIRE(int(places.size()) == n);
        CHECK(places.front() == 0);
        CHECK(places.back() == 1);
        for (int i = 0; i < n; ++i) {
            CHECK(weights[i] > 0);
            if (i > 0) CHECK(places[i] > places[i - 1]);
        }
        for (int degree = 0; degree < 2 * n - 1; ++degree) {
            double error = degree % 2 ? 0 : -1.0 / (degree + 1); // of the integral of (2x - 1) to the power of it
            for (int i = 0; i < n; ++i)
                error += weights[i] * std::pow(2 * places[i] - 1, degree);
            if (degree < 2 * n - 2)
                CHECK(std::abs(error) < 1e-12);
            else if (n < 8) // later the error drowns in round-off
                CHECK(std::abs(error) > 1e-5);
        }
    }
}

TEST_CASE("subcontacts keep the area and the moments of any convex polygon, and lie on it") {
    Dice dice(2);
    for (int trial = 0; trial < 300; ++trial) {
        const auto motion = anyMotion(dice);
        Polygon polygon = inEllipse(dice, 3 + trial % 6);
        for (auto& corner : polygon)
            corner = motion * corner;
        const Point normal = motion.rotation().col(2), direction = longestEdge(polygon);
        const Point middle = centroid(polygon, normal);
        Matrix3 second = Matrix3::Zero(); // moments about the centroid, exact by the middles of the edges of triangles
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point a = polygon[i] - middle, b = polygon[(i + 1) % polygon.size()] - middle;
            for (const Point& p : {Point(a / 2), Point(b / 2), Point((a + b) / 2)})
                second += a.cross(b).dot(normal) / 6 * p * p.transpose();
        }
        for (int along : {1, 2, 3, 5, 6})
            for (int across : {1, 2, 3, 4}) {
                CAPTURE(along);
                CAPTURE(across);
                double sum = 0;
                Point moment = Point::Zero();
                Matrix3 moments = Matrix3::Zero();
                const auto points = subdivide(polygon, normal, direction, along, across);
                const auto pointsAt = [&](const Point& place, double distance) {
                    return std::count_if(points.begin(), points.end(),
                                         [&](const auto& s) { return (s.centre - place).norm() < distance; });
                };
                for (const auto& [centre, part] : points) {
                    CHECK(part > 0);
                    sum += part;
                    moment += part * centre;
                    moments += part * (centre - middle) * (centre - middle).transpose();
                    for (std::size_t i = 0; i < polygon.size(); ++i) {
                        const Point edge = polygon[(i + 1) % polygon.size()] - polygon[i];
                        CHECK(edge.normalized().cross(centre - polygon[i]).dot(normal) > -1e-9);
                    }
                    CHECK(pointsAt(centre, 1e-6) == 1);
                }
                CHECK(sum == within(area(polygon, normal), 1e-9));
                CHECK((moment / sum - middle).norm() < 1e-9);
                if (along >= 3 && across == 1)
                    CHECK(direction.dot(moments * direction) == within(direction.dot(second * direction), 1e-8));
                if (along == 1 || across == 1) continue;
                CHECK((moments - second).norm() < 1e-9 * second.norm()); // no parallelogram, and so points enough
                for (const auto& corner : polygon)
                    CHECK(pointsAt(corner, 1e-9) == 1);
            }
    }
}

TEST_CASE("a face has three points along and three across at its edges and middles, in the order of a grid") {
    Dice dice(3);
    const auto share = [](int i, int of) { return of == 1 ? 1 : i == 1 ? 2. / 3 : 1. / 6; };
    const auto place = [](int i, int of) { return of == 1 ? 0.5 : 0.5 * i; };
    for (int trial = 0; trial < 50; ++trial) {
        const auto motion = anyMotion(dice);
        const auto contact = coincidentFaces(moved(brick(), motion), moved(brick({0, 0, 0.081}), motion));
        REQUIRE(contact);
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
    Dice dice(4);
    for (int corners : {3, 5, 6})
        for (int along = 2; along < 9; ++along)
            for (int across = 2; across < 9; ++across) {
                const int m = std::max(along, across) / 2; // parts of the line from the centroid to a corner
                const int inner = corners * m * m, shared = 1 + corners * m * (m + 1) / 2;
                const auto points = subdivide(inEllipse(dice, corners), up, Point::UnitX(), along, across);
                CHECK(int(points.size()) == inner + shared);
            }
}

TEST_CASE("a parallelogram may have two points along, other quadrilaterals have at least three each way") {
    const auto pointsOf = [](double top, int along) { // of a quadrilateral with this upper edge [m]
        return subdivide({{0, 0, 0}, {0.2, 0, 0}, {0.05 + top, 0.1, 0}, {0.05, 0.1, 0}}, up, Point::UnitX(), along, 2)
            .size();
    };
    CHECK(pointsOf(0.2, 2) == 4);
    CHECK(pointsOf(0.1, 2) == 9);
    CHECK(pointsOf(0.1, 4) == 12);
}

TEST_CASE("cells nearest to the subcontacts of a face cover it, and each holds its point") {
    Dice dice(4);
    for (int corners = 3; corners < 8; ++corners)
        for (int across : {1, 3}) {
            const auto polygon = inEllipse(dice, corners);
            std::vector<Point> points;
            for (const auto& s : subdivide(polygon, up, Point::UnitX(), 4, across))
                points.push_back(s.centre);
            double sum = 0;
            const auto cells = nearestCells(polygon, points);
            for (std::size_t n = 0; n < cells.size(); ++n) {
                const auto& cell = cells[n];
                REQUIRE(cell.size() > 2);
                CHECK(area(cell, up) > 0);
                sum += area(cell, up);
                for (std::size_t i = 0; i < cell.size(); ++i)
                    CHECK((cell[(i + 1) % cell.size()] - cell[i]).cross(points[n] - cell[i]).z() > -1e-12);
            }
            CHECK(sum == within(area(polygon, up), 1e-9));
        }
}

// ---- deformable blocks ----------------------------------------------------------------------------------------------

namespace {

const double young = 4.8e9, poisson = 0.16, density = 1800; // [Pa], [-], [kg/m³]

// A block in space, or a plane unit with a direction across.
BlockElasticity elastic(const ConvexBlock& block, std::array<int, 3> divisions, int across = -1) {
    return {across < 0 ? divide(block, divisions) : divideInPlane(block, divisions, across).value(), young, poisson,
            density, across};
}

// A trapezium: a right prism along y over a quadrilateral that is no rectangle.
ConvexBlock voussoir() {
    auto b = brick();
    for (auto& v : b.vertices)
        if (v.z() > 0.01) v.x() = 0.03 + 0.7 * v.x();
    return b;
}

// A vector without a component across the plane of a plane unit.
Point inPlane(Dice& dice, int across, double size) {
    Point p = dice.vector(size);
    if (across >= 0) p[across] = 0;
    return p;
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
    for (std::size_t i = 0; i < all.size(); ++i)
        result.forces[i / 3][i % 3] = f[i].lane[mine];
    for (int i = 0; i < 9; ++i)
        result.rotation(i / 3, i % 3) = rotation[i].lane[mine];
    return result;
}

} // namespace

TEST_CASE("zones fill a block, their surface closes, and the masses add up") {
    for (const auto& divisions : {std::array<int, 3>{1, 1, 1}, {2, 1, 2}, {3, 2, 4}}) {
        const auto e = elastic(brick({0.3, 0.1, 0.2}), divisions);
        const auto& mesh = e.mesh();
        CHECK(mesh.zones.size() == 12u * divisions[0] * divisions[1] * divisions[2]);
        double inside = 0, mass = 0;
        for (const auto& z : mesh.zones)
            inside += volume({mesh.nodes[z[0]], mesh.nodes[z[1]], mesh.nodes[z[2]], mesh.nodes[z[3]]});
        for (double m : e.masses())
            mass += m;
        CHECK(inside == within(volumeOfBrick, 1e-9));
        CHECK(mass == within(density * volumeOfBrick, 1e-9));
        const auto areaVector = [&](const auto& corners) { // twice, by the first two edges
            const Point& middle = mesh.nodes[corners[1]];
            return Point((middle - mesh.nodes[corners[0]]).cross(mesh.nodes[corners[2]] - middle));
        };
        Point closed = Point::Zero();
        double flux = 0; // of x through the surface: three times the volume
        for (const auto& t : mesh.triangles) {
            closed += areaVector(t);
            flux += areaVector(t).dot(mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 6;
        }
        CHECK(closed.norm() < 1e-15);
        CHECK(flux == within(3 * volumeOfBrick, 1e-9));
        REQUIRE(mesh.triangles.size() == 2 * mesh.cellFaces.size());
        for (std::size_t n = 0; n < mesh.triangles.size(); ++n) { // two triangles are the halves of a cell's face
            const auto &t = mesh.triangles[n], &other = mesh.triangles[n ^ 1];
            const auto& face = mesh.cellFaces[n / 2];
            for (int node : face)
                CHECK(std::count(t.begin(), t.end(), node) + std::count(other.begin(), other.end(), node) > 0);
            CHECK((areaVector(t).normalized() - areaVector(face).normalized()).norm() < 1e-9);
        }
    }
    const auto e = elastic(prism(), {1, 1, 1});
    CHECK(e.mesh().cellFaces.empty());
    CHECK(e.mass() == within(density * 0.5 * 0.2 * 0.1 * 0.1, 1e-9));
}

TEST_CASE("neighbouring cells conform: every inner face belongs to two zones") {
    const auto mesh = divide(brick(), {3, 2, 2});
    std::map<std::array<int, 3>, int> zonesOfFace;
    for (const auto& z : mesh.zones)
        for (int i = 0; i < 4; ++i) {
            std::array<int, 3> face{z[(i + 1) % 4], z[(i + 2) % 4], z[(i + 3) % 4]};
            std::sort(face.begin(), face.end());
            ++zonesOfFace[face];
        }
    std::size_t once = 0;
    for (const auto& [face, count] : zonesOfFace) {
        CHECK(count <= 2);
        once += count == 1;
    }
    CHECK(once == mesh.triangles.size());
}

TEST_CASE("a plane unit has nodes in its middle plane alone, and the mass and the rim of its block") {
    const auto whole = brick({0.3, 0.1, 0.2});
    const struct {
        ConvexBlock block;
        int across;
        double volume;
        std::size_t nodes, triangles, edges;
    } cases[] = {{whole, 0, volumeOfBrick, 13, 16, 8},
                 {whole, 1, volumeOfBrick, 13, 16, 8},
                 {voussoir(), 1, 0.85 * volumeOfBrick, 13, 16, 8},
                 {prism(), 2, 0.001, 4, 3, 3}};
    for (const auto& c : cases) {
        const auto e = elastic(c.block, {2, 2, 2}, c.across);
        const auto& mesh = e.mesh();
        CHECK(mesh.nodes.size() == c.nodes);
        CHECK(mesh.triangles.size() == c.triangles);
        CHECK(mesh.rim.size() == c.edges);
        CHECK(mesh.zones.empty());
        double mass = 0, low = HUGE_VAL, high = -HUGE_VAL;
        for (double m : e.masses())
            mass += m;
        CHECK(mass == within(density * c.volume, 1e-9));
        CHECK(e.mass() == within(mass, 1e-12));
        for (const auto& v : c.block.vertices)
            low = std::min(low, v[c.across]), high = std::max(high, v[c.across]);
        CHECK(mesh.thickness == within(high - low, 1e-12));
        Point centre = Point::Zero(), outward = Point::Zero();
        for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
            CHECK(mesh.nodes[n][c.across] == within(0.5 * (low + high), 1e-12));
            centre += e.masses()[n] / mass * mesh.nodes[n];
        }
        for (const auto& [from, to] : mesh.rim)
            outward += (mesh.nodes[to] - mesh.nodes[from]).cross(Point::Unit(c.across));
        CHECK(outward.norm() < 1e-12); // the rim closes
        if (c.across == 0) CHECK((centre - Point(0.3, 0.1, 0.2) - 0.5 * size).norm() < 1e-12);
    }
    CHECK(!divideInPlane(prism(), {1, 1, 1}, 1)); // a prism along z alone
    auto leaning = brick();
    for (auto& v : leaning.vertices)
        v.x() += 0.05 * v.y();
    CHECK(!divideInPlane(leaning, {1, 1, 1}, 1)); // no right prism
}

TEST_CASE("rigid motions of any size give no force and show their rotation") {
    Dice dice(4);
    for (const auto& e : {elastic(brick(), {2, 1, 1}), elastic(prism(), {2, 1, 1}), elastic(brick(), {2, 1, 2}, 0),
                          elastic(brick(), {2, 1, 2}, 1), elastic(brick(), {2, 1, 2}, 2)})
        for (int trial = 0; trial < 50; ++trial) {
            const int across = e.mesh().across;
            auto motion = anyMotion(dice);
            if (across >= 0)
                motion = Eigen::Translation3d(inPlane(dice, across, 10)) *
                         AngleAxisd(dice.between(-M_PI, M_PI), Point::Unit(across));
            std::vector<Point> u;
            for (const auto& node : e.mesh().nodes)
                u.push_back(motion * node - node);
            // After a large rotation Newton's iteration starts far from its solution; at a pure rotation the result is
            // exact.
            CHECK((e.rotation(u.data()) - motion.rotation()).norm() < 1e-11);
            const auto result = forcesOf(e, u);
            CHECK((result.rotation - motion.rotation()).norm() < 1e-11);
            for (const auto& force : result.forces)
                CHECK(force.norm() < 1e-3); // N, of a block whose zones carry 1e8 N at unit strain
            CHECK(result.energy < 1e-9);
        }
}

TEST_CASE("patch test: a linear displacement is a uniform stress on any mesh, in plane units a plane stress") {
    Dice dice(5);
    const double lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), mu = young / (2 * (1 + poisson));
    for (const auto& [block, across] : {std::pair(brick(), -1), std::pair(prism(), -1), std::pair(brick(), 1),
                                        std::pair(voussoir(), 1), std::pair(prism(), 2)}) {
        const auto e = elastic(block, {3, 2, 2}, across);
        const auto& mesh = e.mesh();
        Matrix3 g;
        for (int i = 0; i < 3; ++i)
            g.col(i) = i == across ? Point(Point::Zero()) : inPlane(dice, across, 1e-7);
        Matrix3 strain = 0.5 * (g + g.transpose());
        if (across >= 0) strain(across, across) = -poisson / (1 - poisson) * strain.trace();
        const Matrix3 exact = lambda * strain.trace() * Matrix3::Identity() + 2 * mu * strain;
        std::vector<Point> u;
        for (const auto& x : mesh.nodes)
            u.push_back(g * x);
        const Matrix3 r = e.rotation(u.data());
        for (std::size_t z = 0; z < std::max(mesh.zones.size(), across < 0 ? 0 : mesh.triangles.size()); ++z)
            CHECK((e.stress(int(z), u.data(), r) - exact).norm() < 1e-5 * exact.norm());
        const double energy = 0.5 * exact.cwiseProduct(strain).sum() * e.mass() / density;
        CHECK(forcesOf(e, u).energy == within(energy, 1e-4));
    }
}

TEST_CASE("the forces of a block are those of its zones' stresses on their faces") {
    Dice dice(9);
    const BlockElasticity blocks[] = {elastic(brick(), {2, 1, 3}),
                                      elastic(voussoir(), {2, 1, 3}, 1),
                                      {divide(brick(), {2, 1, 3}), young, poisson, density, 1}};
    for (const auto& e : blocks) {
        const auto& mesh = e.mesh();
        const bool plane = mesh.across >= 0;
        const int held = &e == blocks ? -1 : 1;
        std::vector<Point> u, f(mesh.nodes.size(), Point::Zero());
        for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
            u.push_back(inPlane(dice, held, 1e-5) + Point(0.01, held < 0 ? 0.02 : 0, -0.03));
        const auto result = forcesOf(e, u);
        const std::size_t zones = plane ? mesh.triangles.size() : mesh.zones.size();
        const int corners = plane ? 3 : 4;
        for (std::size_t z = 0; z < zones; ++z) {
            const int* nodes = plane ? mesh.triangles[z].data() : mesh.zones[z].data();
            const Matrix3 stress = e.stress(int(z), u.data(), result.rotation);
            for (int i = 0; i < corners; ++i) { // its share of the traction on the opposite face
                const auto at = [&](int k) { return mesh.nodes[nodes[(i + k) % corners]]; };
                Point share = plane ? Point(mesh.thickness / 2 * (at(2) - at(1)).cross(Point::Unit(1)))
                                    : Point((at(2) - at(1)).cross(at(3) - at(1)) / 6);
                if (share.dot(at(0) - at(1)) > 0) share = -share;
                f[nodes[i]] += result.rotation * stress * share;
            }
        }
        double largest = 0;
        for (const auto& force : f)
            largest = std::max(largest, force.norm());
        for (std::size_t i = 0; i < f.size(); ++i)
            for (int d = 0; d < 3; ++d)
                if (d != held) CHECK(std::abs(f[i][d] - result.forces[i][d]) < 1e-9 * largest);
    }
}

TEST_CASE("forces are the gradient of the energy, keep momentum, and do the work of moments, in space and in a plane") {
    Dice dice(32);
    for (int across : {-1, 0, 1, 2}) { // -1: in space
        const auto e = elastic(brick(), {2, 1, 2}, across);
        const auto n = e.mesh().nodes.size();
        const Point axis = across < 0 ? Point(1, 2, 3).normalized() : Point::Unit(across);
        const Point moment = across < 0 ? Point(3, -2, 5) : Point(7 * axis);
        std::vector<Point> u;
        for (const auto& node : e.mesh().nodes)
            u.push_back(AngleAxisd(0.3, axis) * node - node + Point::Unit((across + 1) % 3) +
                        inPlane(dice, across, 1e-6));
        CHECK((forcesOf(e, u).rotation - e.rotation(u.data())).norm() < 1e-11);
        const auto f = forcesOf(e, u).forces, withMoment = forcesOf(e, u, moment).forces;
        Point sum = Point::Zero(), about = sum, added = sum, turned = sum;
        double total = 0, work = 0;
        auto after = u, before = u; // half of a small motion on, and back
        for (std::size_t i = 0; i < n; ++i) {
            const Point place = e.mesh().nodes[i] + u[i], force = withMoment[i] - f[i];
            const Point du = inPlane(dice, across, 1e-6);
            sum += f[i], about += place.cross(f[i]), total += f[i].norm();
            added += force, turned += place.cross(force), work += force.dot(du);
            after[i] += 0.5 * du, before[i] -= 0.5 * du;
        }
        CHECK(sum.norm() < 1e-9 * total);
        CHECK(about.norm() < 1e-5 * total);
        CHECK(added.norm() < 1e-8);
        CHECK((turned - moment).norm() < 1e-3);
        const AngleAxisd by(Matrix3(e.rotation(after.data()) * e.rotation(before.data()).transpose()));
        CHECK(work == within(moment.dot(by.angle() * by.axis()), 1e-3));
        for (std::size_t i = 0; i < n; ++i)
            for (int d = 0; d < 3; ++d) {
                if (d == across) continue;
                auto plus = u, minus = u;
                plus[i][d] += 1e-8, minus[i][d] -= 1e-8;
                const double slope = (forcesOf(e, plus).energy - forcesOf(e, minus).energy) / 2e-8;
                CHECK(-slope == doctest::Approx(f[i][d]).epsilon(1e-4).scale(total));
            }
    }
}

TEST_CASE("a beam of plane units bends as the theory of beams says, and less stiffly with finer cells") {
    // A beam of 8:1 under opposite moments at its ends: pairs of forces along it, linear over the height.
    const double length = 0.8, height = 0.1, thickness = 0.1;
    const auto stiffness = [&](int cells) { // over that of the theory
        const auto e = elastic(box(Point::Zero(), {length, thickness, height}), {8 * cells, 1, cells}, 1);
        std::vector<Point> u; // bending strains that the theory gives, of unit curvature: the energy is at least its
        const double curvature = 1e-6;
        for (const auto& node : e.mesh().nodes) {
            const double x = node.x() - length / 2, z = node.z() - height / 2;
            u.push_back(curvature * Point(x * z, 0, -0.5 * x * x - 0.5 * poisson * z * z));
        }
        const double exact = young * thickness * std::pow(height, 3) / 12 * length * curvature * curvature;
        return 2 * forcesOf(e, u).energy / exact;
    };
    const double coarse = stiffness(2), fine = stiffness(4);
    CHECK(fine > 1);
    CHECK((coarse - 1) / (fine - 1) == within(4, 0.1)); // second order
    CHECK(fine < 1.1);
}

TEST_CASE("a surface point is found with weights that return it") {
    const auto mesh = divide(brick(), {2, 1, 3});
    Dice dice(8);
    for (int i = 0; i < 100; ++i) {
        const Point p(dice.between(0, 0.22), dice.between(0, 0.102), i % 2 ? 0.081 : 0);
        const auto [nodes, weights] = nearestOnSurface(mesh, p);
        Point back = Point::Zero();
        for (int k = 0; k < 3; ++k)
            back += weights[k] * mesh.nodes[nodes[k]];
        CHECK((back - p).norm() < 1e-12);
        CHECK(weights[0] + weights[1] + weights[2] == within(1, 1e-9));
    }
}

// ---- steps ----------------------------------------------------------------------------------------------------------

TEST_CASE("combined damping of a node takes nothing of a growing force, half of a steady one, all of one that falls") {
    const auto e = elastic(brick(), {1, 1, 1});
    const auto matrix = e.matrix();
    const std::size_t rows = 3 * e.mesh().nodes.size();
    const double dt = 1e-6, alpha = 0.3, velocity = 5;
    const struct { double before, force, share; } cases[] = {{1, 2, 0}, {2, 2, 0.5}, {3, 2, 1}, {-3, -2, 0}};
    for (bool combined : {true, false})
        for (const auto& [before, force, share] : cases) {
            const auto all = [&](double number) {
                Row row;
                std::fill_n(row.lane, lanes, number);
                return std::vector<Row>(rows, row);
            };
            auto u = all(0), v = all(velocity), f = all(force), last = all(before);
            LaneUnits units{matrix, everyLane(), u.data(), v.data(), f.data(), last.data(), {}, {}};
            moveBlocks({dt, alpha, {0, 0, 0}, combined, {false, false, false}}, units);
            const auto& sums = units.sums;
            const double taken = alpha * std::abs(force) * (combined ? share : 1);
            double after = 0; // energy taken with the velocities after the step [J]
            for (std::size_t row = 0; row < rows; ++row) {
                after += 0.5 * dt * taken * v[row].lane[0];
                for (double now : v[row].lane)
                    CHECK((now - velocity) * matrix.masses[row / 3] / dt == within(force - taken, 1e-6));
            }
            CHECK(sums.damping.lane[0] == within(0.5 * dt * taken * velocity * double(rows), 1e-9));
            CHECK(sums.pending.lane[0] == within(after, 1e-9));
        }
}

namespace {

struct Functions {
    decltype(&plain::addForces) addForces;
    decltype(&plain::move) move;
    decltype(&plain::moveScaledUnits) moveScaled;
};

// Of every instruction set that this processor has.
std::vector<Functions> instructionSets() {
    std::vector<Functions> all{{plain::addForces, plain::move, plain::moveScaledUnits}};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) all.push_back({avx2::addForces, avx2::move, avx2::moveScaledUnits});
    if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
        all.push_back({avx512::addForces, avx512::move, avx512::moveScaledUnits});
#endif
    return all;
}

void append(std::vector<double>& numbers, const Row& row) { numbers.insert(numbers.end(), row.lane, row.lane + lanes); }

// Random numbers of up to a size; none across the plane of plane units.
std::vector<Row> randomRows(Dice& dice, std::size_t count, bool plane, double size) {
    std::vector<Row> rows(count);
    for (std::size_t i = 0; i < count; ++i)
        for (double& value : rows[i].lane)
            value = plane && i % 3 == 1 ? 0 : dice.between(-size, size);
    return rows;
}

} // namespace

TEST_CASE("every instruction set moves blocks and plane units to the same bits") {
    Dice dice(13);
    const auto space = elastic(brick(), {2, 1, 2}), plane = elastic(brick(), {2, 1, 2}, 1);
    for (const auto& [e, combined] : {std::pair(&space, false), std::pair(&space, true), std::pair(&plane, true)}) {
        const bool held = e == &plane;
        const auto matrix = e->matrix();
        const std::size_t rows = 3 * e->mesh().nodes.size();
        const auto u0 = randomRows(dice, rows, held, 1e-5), v0 = randomRows(dice, rows, held, 1e-3),
                   last0 = randomRows(dice, rows, held, 10);
        const NodeMotion motion{1e-6, 0.8, {0, 0, -9.81}, combined, {false, held, false}};
        const auto run = [&](const Functions& functions) {
            auto u = u0, v = v0, last = last0;
            std::vector<Row> f(rows, Row{}), scratch(2 * rows);
            Row moments[3]{}, rotation[9], energy;
            LaneUnits units{matrix, everyLane(), u.data(), v.data(), f.data(), last.data(), {}, {}};
            const auto& sums = units.sums;
            for (int step = 0; step < 20; ++step) {
                moments[1].lane[2] = step;
                functions.addForces(matrix, u.data(), moments, f.data(), rotation, &energy, scratch.data());
                functions.move(motion, units);
            }
            std::vector<double> all;
            for (const auto* part : {&u, &v, &last})
                for (const auto& row : *part)
                    append(all, row);
            for (const Row& row : {energy, sums.kinetic, sums.gravityWork, sums.damping, sums.pending, sums.moved[2]})
                append(all, row);
            return all;
        };
        const auto sets = instructionSets();
        const auto reference = run(sets[0]);
        CHECK(std::abs(reference[5] - u0[0].lane[5]) > 1e-9); // it moved
        for (const auto& set : sets)
            CHECK(run(set) == reference);
    }
}

// ---- masses that are scaled selectively -----------------------------------------------------------------------------

namespace {

// One or two units side by side in every lane, with random states, and their scaled mass matrix in lane `mine`. Vectors
// have the three directions of all nodes, those of the second unit after those of the first.
struct Scaling {
    static constexpr int mine = 5;
    double scaling;
    std::vector<const BlockElasticity*> units;
    bool whole, plane;
    Point apart = Point(0.12, 0, 0.01); // from unit to unit [m]
    int first, degrees;                 // degrees of freedom of the first unit, and of all
    Eigen::VectorXd masses, places;     // [kg], [m] in the reference state
    std::vector<Row> u, v, f, last, scratch;
    std::vector<LaneUnits> members;

    Scaling(double s, std::vector<const BlockElasticity*> all, bool isWhole, Dice& dice)
        : scaling(s), units(all), whole(isWhole), plane(all[0]->mesh().across >= 0) {
        first = int(3 * units[0]->mesh().nodes.size());
        degrees = units.size() == 1 ? first : first + int(3 * units[1]->mesh().nodes.size());
        masses.resize(degrees), places.resize(degrees);
        for (int i = 0; i < degrees; ++i) {
            const int unit = unitOf(i), node = (i - unit * first) / 3;
            masses[i] = units[unit]->masses()[node];
            places[i] = units[unit]->mesh().nodes[node][i % 3] + unit * apart[i % 3];
        }
        u = randomRows(dice, degrees, plane, 1e-4), v = randomRows(dice, degrees, plane, 1e-3);
        f = randomRows(dice, degrees, plane, 10), last = randomRows(dice, degrees, plane, 10);
        scratch.resize(3 * degrees);
    }
    int unitOf(int degree) const { return degree >= first; }
    static Eigen::VectorXd listed(const std::vector<Row>& rows, int lane = mine) {
        return Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<lanes>>(rows[0].lane + lane, rows.size());
    }
    // Rigid motions in the columns, of all units together or each for itself.
    Eigen::MatrixXd rigid(bool together) const {
        const Eigen::VectorXd x = places + listed(u);
        const std::vector<int> motions = plane ? std::vector{0, 2, 4} : std::vector{0, 1, 2, 3, 4, 5};
        const int kinds = int(motions.size());
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(degrees, together ? kinds : kinds * int(units.size()));
        for (int row = 0; row < degrees; row += 3)
            for (int k = 0; k < kinds; ++k) {
                const Point axis = Point::Unit(motions[k] % 3), turned = axis.cross(Point(x.segment<3>(row)));
                all.block<3, 1>(row, k + (together ? 0 : kinds * unitOf(row))) = motions[k] < 3 ? axis : turned;
            }
        return all;
    }
    Eigen::MatrixXd massMatrix() const {
        const Eigen::MatrixXd m = masses.asDiagonal();
        const auto projected = [&](const Eigen::MatrixXd& r) {
            const Eigen::MatrixXd p = m * r;
            return Eigen::MatrixXd(p * (r.transpose() * p).inverse() * p.transpose());
        };
        const Eigen::MatrixXd w = projected(rigid(true)), h = projected(rigid(false));
        if (whole) return m + scaling * (m - w);
        return m + scaling * (m - h) + sharedScaling * scaling * (h - w);
    }
    template <class Move> void step(Move&& move, const NodeMotion& motion) {
        members.clear();
        for (std::size_t k = 0; k < units.size(); ++k) {
            const std::size_t from = k * first;
            members.push_back({units[k]->matrix(), everyLane(), &u[from], &v[from], &f[from], &last[from], {}, {}});
            for (int d = 0; d < 3; ++d)
                std::fill_n(members[k].offset[d].lane, lanes, double(k) * apart[d]);
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
template <class F> void eachScaling(Dice& dice, F&& visit) {
    const auto half = box(Point::Zero(), {0.11, 0.102, 0.081});
    const auto plane = elastic(half, {2, 1, 2}, 1), space = elastic(half, {1, 1, 1});
    const auto small = elastic(box(Point::Zero(), {0.08, 0.102, 0.081}), {1, 1, 1}, 1);
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
    Dice dice(41);
    eachScaling(dice, [&](Scaling s) {
        const Eigen::VectorXd force = s.listed(s.f), before = s.listed(s.v);
        const Eigen::MatrixXd m = s.massMatrix(), w = s.rigid(true);
        const double dt = 1e-5;
        s.step(moveScaled, {dt, 0, {0, 0, 0}, true, {false, s.plane, false}});
        const Eigen::VectorXd after = s.listed(s.v), change = (after - before) / dt;
        CHECK((m * change - force).norm() < 1e-10 * force.norm());
        CHECK((w.transpose() * (s.masses.cwiseProduct(change) - force)).norm() < 1e-12 * force.norm());
        CHECK(s.sum(&NodeSums::kinetic) == within(0.5 * before.dot(m * after), 1e-9));
        CHECK(s.sum(&NodeSums::damping) == 0);
    });
}

TEST_CASE("a block falls as it would with true masses") {
    Dice dice(42);
    eachScaling(dice, [&](Scaling s) {
        for (auto* rows : {&s.v, &s.f})
            rows->assign(rows->size(), Row{});
        s.step(moveScaled, {1e-5, 0, {0, 0, -9.81}, true, {false, s.plane, false}});
        const auto v = s.listed(s.v);
        for (int i = 0; i < v.size(); ++i)
            CHECK(std::abs(v[i] - (i % 3 == 2 ? -9.81e-5 : 0)) < 1e-15);
    });
}

TEST_CASE("damping of scaled masses takes what the energies say, and never gives any") {
    Dice dice(43);
    for (int trial = 0; trial < 20; ++trial)
        eachScaling(dice, [&](Scaling s) {
            const double viscous = trial % 3 == 0 ? 500 : 0, dt = trial % 2 ? 1e-5 : 1e-7;
            const Eigen::VectorXd force = s.listed(s.f), before = s.listed(s.v);
            const Eigen::MatrixXd m = s.massMatrix();
            s.step(moveScaled, {dt, 0.8, {0, 0, 0}, trial % 4 < 2, {false, s.plane, false}, viscous});
            const Eigen::VectorXd after = s.listed(s.v), lost = force - m * (after - before) / dt;
            const double damping = s.sum(&NodeSums::damping), pending = s.sum(&NodeSums::pending);
            CHECK(damping + pending >= 0);
            const double roundOff = 1e-9 * force.norm() * before.norm() * dt;
            CHECK(std::abs(damping - 0.5 * dt * lost.dot(before)) < roundOff);
            CHECK(std::abs(pending - 0.5 * dt * lost.dot(after)) < 10 * roundOff);
            CHECK(s.sum(&NodeSums::kinetic) == doctest::Approx(0.5 * before.dot(m * after)).epsilon(1e-8).scale(1e-9));
        });
}

TEST_CASE("every instruction set moves scaled masses to the same bits") {
    Dice dice(44);
    eachScaling(dice, [&](const Scaling& start) {
        const auto run = [&](const Functions& functions) {
            Scaling s = start;
            for (int step = 0; step < 5; ++step) {
                s.step(functions.moveScaled, {1e-6, 0.8, {0, 0, -9.81}, true, {false, s.plane, false}, 3});
                s.f = start.f;
            }
            std::vector<double> all;
            for (const auto* rows : {&s.u, &s.v, &s.last})
                for (const auto& row : *rows)
                    append(all, row);
            for (auto which : {&NodeSums::kinetic, &NodeSums::damping, &NodeSums::pending, &NodeSums::gravityWork})
                all.push_back(s.sum(which));
            return all;
        };
        const auto sets = instructionSets();
        const auto reference = run(sets[0]);
        CHECK(reference[0] != start.u[0].lane[0]); // it moved
        for (const auto& set : sets)
            CHECK(run(set) == reference);
    });
}
