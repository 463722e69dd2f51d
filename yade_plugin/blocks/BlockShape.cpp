// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockShape.hpp"
#include "ConvexHull.hpp"
#include <Eigen/Eigenvalues>
#include <cmath>

namespace masonry {

namespace {

using Matrix = Eigen::Matrix3d;

// Inertia about the origin of a tetrahedron with these corners, for a density of 1. The integral of the product of two
// coordinates over a tetrahedron is det/120 times the sum of the products of all pairs of corners, those of a corner
// with itself taken twice.
Matrix tetrahedronInertia(const std::array<Point, 4>& c) {
    const Point u = c[1] - c[0], v = c[2] - c[0], w = c[3] - c[0];
    const double det = std::abs(u[0] * v[1] * w[2] + v[0] * w[1] * u[2] + w[0] * u[1] * v[2] - u[0] * w[1] * v[2] -
                                v[0] * u[1] * w[2] - w[0] * v[1] * u[2]);
    const auto moment = [&](int a, int b) { // of the squares of the coordinates a and b
        double sum = 0;
        for (int axis : {a, b})
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i <= j; ++i)
                    sum += c[i][axis] * c[j][axis];
        return det * sum / 60;
    };
    const auto product = [&](int a, int b) {
        double sum = 0;
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i)
                sum += (i == j ? 2 : 1) * c[i][a] * c[j][b];
        return -(det * sum / 120);
    };
    Matrix m;
    m << moment(1, 2), product(0, 1), product(0, 2), //
        product(0, 1), moment(0, 2), product(1, 2),  //
        product(0, 2), product(1, 2), moment(0, 1);
    return m;
}

// Inertia about the origin of a point of unit mass.
Matrix pointInertia(const Point& p) {
    Matrix m;
    m << p[1] * p[1] + p[2] * p[2], -p[0] * p[1], -p[0] * p[2], //
        -p[0] * p[1], p[0] * p[0] + p[2] * p[2], -p[2] * p[1],  //
        -p[0] * p[2], -p[2] * p[1], p[1] * p[1] + p[0] * p[0];
    return m;
}

// A right-handed rotation whose first two columns have their largest component above zero.
Matrix directed(const Matrix& axes) {
    Matrix m = axes;
    for (int column : {0, 1}) {
        int largest;
        m.col(column).cwiseAbs().maxCoeff(&largest);
        if (m(largest, column) < 0) m.col(column) *= -1;
    }
    m.col(2) = m.col(0).cross(m.col(1)).eval();
    return m;
}

} // namespace

BlockShape blockAround(const std::vector<Point>& points) {
    BlockShape block;
    const auto hull = convexHull(points);
    block.vertices = hull.corners;
    for (const auto& face : hull.faces)
        for (std::size_t i = 2; i < face.size(); ++i)
            block.triangles.push_back({face[0], face[i - 1], face[i]});

    block.volume = 0;
    block.centroid = Point::Zero();
    const Point apex = block.vertices[0];
    for (const auto& t : block.triangles) {
        const Point &a = block.vertices[t[0]], &b = block.vertices[t[1]], &c = block.vertices[t[2]];
        const double part = std::abs((apex - c).dot((a - c).cross(b - c))) / 6;
        block.volume += part;
        block.centroid = block.centroid + (apex + a + b + c) / 4 * part;
    }
    block.centroid = block.centroid / block.volume;
    for (auto& v : block.vertices)
        v = v - block.centroid;

    Matrix inertia = Matrix::Zero();
    const Point origin = Point::Zero();
    for (const auto& t : block.triangles) {
        const Point &a = block.vertices[t[0]], &b = block.vertices[t[1]], &c = block.vertices[t[2]];
        const double part = std::abs((origin - c).dot((a - c).cross(b - c)) / 6);
        const Point middle = (origin + a + b + c) / 4;
        inertia = inertia + tetrahedronInertia({origin - middle, a - middle, b - middle, c - middle}) +
                  pointInertia(middle) * part;
    }
    block.orientation = Eigen::Quaterniond::Identity();
    block.inertia = inertia.diagonal();
    // Below this sum of the products of inertia [m⁵] the given axes are the principal ones, as in YADE's Polyhedra.
    if (std::abs(inertia(0, 1)) + std::abs(inertia(0, 2)) + std::abs(inertia(1, 2)) < 1e-13) return block;
    const Eigen::SelfAdjointEigenSolver<Matrix> principal(inertia);
    block.inertia = principal.eigenvalues();
    block.orientation = Eigen::Quaterniond(directed(principal.eigenvectors()));
    for (auto& v : block.vertices)
        v = block.orientation.conjugate() * v;
    return block;
}

} // namespace masonry
