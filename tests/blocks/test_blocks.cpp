// Joint polygons and subcontacts of convex blocks, in any orientation.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "blocks/FaceContact.hpp"
#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <random>

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
    CHECK(surface == doctest::Approx(2 * (0.22 * 0.102 + 0.22 * 0.081 + 0.102 * 0.081)));
}

TEST_CASE("two bricks half over each other share half a bed face, in any orientation") {
    std::mt19937 dice(1);
    for (int i = 0; i < 200; ++i) {
        const auto motion = randomMotion(dice);
        const auto lower = moved(box(Point::Zero(), brick), motion);
        const auto upper = moved(box({0.11, 0, 0.081}, brick), motion);
        const auto contact = coincidentFaces(lower, upper);
        REQUIRE(contact);
        CHECK((contact->normal - motion.rotation().col(2)).norm() < 1e-9);
        CHECK(area(contact->polygon, contact->normal) == doctest::Approx(0.11 * 0.102).epsilon(1e-9));
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
    CHECK(area(contact->polygon, contact->normal) == doctest::Approx(2 * std::sqrt(2.) - 2));
}

TEST_CASE("a gap or overlap within the tolerance is a joint midway, beyond it is none") {
    const double size = brick.norm();
    for (double gap : {0.9e-4 * size, -0.9e-4 * size}) {
        const auto contact = coincidentFaces(box(Point::Zero(), brick), box({0, 0, 0.081 + gap}, brick));
        REQUIRE(contact);
        CHECK(contact->polygon[0].z() == doctest::Approx(0.081 + 0.5 * gap).epsilon(1e-9));
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

TEST_CASE("subcontact areas add up and their first moment is the polygon's, for any polygon and division") {
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
        const Point normal = motion.rotation().col(2);
        const double whole = area(polygon, normal);
        for (int along : {1, 2, 5})
            for (int across : {1, 3}) {
                double sum = 0;
                Point moment = Point::Zero();
                for (const auto& s : subdivide(polygon, normal, longestEdge(polygon), along, across))
                    sum += s.area, moment += s.area * s.centre;
                CHECK(sum == doctest::Approx(whole).epsilon(1e-9));
                CHECK((moment / sum - centroid(polygon, normal)).norm() < 1e-9);
            }
    }
}

TEST_CASE("a row of four subcontacts stands at the middle of the quarters") {
    const auto contact =
        coincidentFaces(box(Point::Zero(), {0.11, 0.102, 0.081}), box({0, 0, 0.081}, {0.11, 0.102, 0.081}));
    REQUIRE(contact);
    const auto row = subdivide(contact->polygon, contact->normal, Point::UnitX(), 4, 1);
    REQUIRE(row.size() == 4);
    for (int i = 0; i < 4; ++i) {
        CHECK((row[i].centre - Point(0.11 * (i + 0.5) / 4, 0.051, 0.081)).norm() < 1e-12);
        CHECK(row[i].area == doctest::Approx(0.11 * 0.102 / 4));
        CHECK(row[i].cell.size() == 4);
    }
}
