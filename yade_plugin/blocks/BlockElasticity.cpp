// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockElasticity.hpp"
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <map>
#include <stdexcept>

namespace masonry {

BlockElasticity::BlockElasticity(BlockMesh mesh, double E, double nu, double density, int held)
    : mesh_(std::move(mesh)), held_(held) {
    if (!(E > 0) || !std::isfinite(E))
        throw std::invalid_argument("Young's modulus must be a finite number above 0 Pa");
    if (!(nu > -1 && nu < 0.5)) throw std::invalid_argument("Poisson's ratio must be above -1 and below 0.5");
    if (!(density > 0) || !std::isfinite(density))
        throw std::invalid_argument("density must be a finite number above 0 kg/m³");
    if (mesh_.across >= 0 && mesh_.across != held)
        throw std::invalid_argument("nodes of a plane unit must be held across its plane");
    lambda_ = E * nu / ((1 + nu) * (1 - 2 * nu));
    shear_ = E / (2 * (1 + nu));
    if (held >= 0) lambda_ = 2 * lambda_ * shear_ / (lambda_ + 2 * shear_);
    masses_.assign(mesh_.nodes.size(), 0);
    meanGradients_.assign(mesh_.nodes.size(), Point::Zero());
    for (const auto& nodes : mesh_.zones) {
        std::array<Point, 4> c, gradients;
        for (int i = 0; i < 4; ++i)
            c[i] = mesh_.nodes[nodes[i]];
        Matrix3 edges;
        edges << c[1] - c[0], c[2] - c[0], c[3] - c[0];
        const Matrix3 inverse = edges.inverse(); // its rows are the gradients of the shape functions of nodes 1 to 3
        for (int i = 1; i < 4; ++i)
            gradients[i] = inverse.row(i - 1);
        gradients[0] = -(gradients[1] + gradients[2] + gradients[3]);
        addZone(nodes, 4, gradients, masonry::volume(c), density);
    }
    if (mesh_.across >= 0)
        for (const auto& t : mesh_.triangles) {
            const Point &p = mesh_.nodes[t[0]], &q = mesh_.nodes[t[1]], &r = mesh_.nodes[t[2]];
            const Point axis = Point::Unit(held);
            const double twice = (q - p).cross(r - p)[held]; // area [m²]
            const std::array<Point, 4> gradients{axis.cross(r - q) / twice, axis.cross(p - r) / twice,
                                                 axis.cross(q - p) / twice, Point::Zero()};
            addZone({t[0], t[1], t[2], t[0]}, 3, gradients, 0.5 * twice * mesh_.thickness, density);
        }
    double whole = 0;
    for (const auto& z : zones_)
        whole += z.volume;
    for (auto& g : meanGradients_) {
        g /= whole;
        if (held >= 0) g[held] = 0; // so that the block turns about the held direction only
    }
    mass_ = density * whole;
    assemble();
    if (mesh_.across >= 0) pair();
}

void BlockElasticity::addZone(const std::array<int, 4>& nodes, int corners, const std::array<Point, 4>& gradients,
                              double volume, double density) {
    zones_.push_back({nodes, gradients, volume});
    for (int i = 0; i < corners; ++i) {
        masses_[nodes[i]] += density * volume / corners;
        meanGradients_[nodes[i]] += volume * gradients[i];
    }
}

// Builds the stiffness matrix of the whole block, without the rows and columns of the held direction.
void BlockElasticity::assemble() {
    std::vector<std::map<int, double>> rows(3 * mesh_.nodes.size());
    for (std::size_t z = 0; z < zones_.size(); ++z) {
        const auto k = stiffness(int(z));
        const int degrees = mesh_.across >= 0 ? 9 : 12;
        for (int i = 0; i < degrees; ++i)
            for (int j = 0; j < degrees; ++j)
                if (i % 3 != held_ && j % 3 != held_)
                    rows[3 * zones_[z].nodes[i / 3] + i % 3][3 * zones_[z].nodes[j / 3] + j % 3] += k(i, j);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (int(i) % 3 == held_) continue;
        const int first = int(columns_.size());
        for (const auto& [column, value] : rows[i]) {
            columns_.push_back(column);
            values_.push_back(value);
        }
        rows_.push_back({int(i), first, int(columns_.size())});
    }
}

// Writes the matrix of a plane unit in blocks of four numbers for every pair of nodes.
void BlockElasticity::pair() {
    const int b = (held_ + 2) % 3; // the second direction of the plane
    std::vector<std::map<int, std::array<double, 4>>> blocks(mesh_.nodes.size());
    for (const auto& row : rows_)
        for (int e = row.first; e < row.beyond; ++e)
            blocks[row.degree / 3][columns_[e] / 3][2 * (row.degree % 3 == b) + (columns_[e] % 3 == b)] = values_[e];
    pairStart_.push_back(0);
    for (const auto& list : blocks) {
        for (const auto& [node, values] : list) {
            pairNode_.push_back(node);
            pairValues_.insert(pairValues_.end(), values.begin(), values.end());
        }
        pairStart_.push_back(int(pairNode_.size()));
    }
}

Matrix3 BlockElasticity::rotation(const Point* u) const {
    Matrix3 r = Matrix3::Identity();
    for (std::size_t i = 0; i < meanGradients_.size(); ++i)
        r += u[i] * meanGradients_[i].transpose();
    // Newton's iteration converges to the rotation; at elastic strains two steps are enough.
    for (int i = 0; i < 4; ++i) {
        const Matrix3 next = 0.5 * (r + r.inverse().transpose());
        const double change = (next - r).squaredNorm();
        r = next;
        if (change < 1e-24) break;
    }
    return r;
}

BlockMatrix BlockElasticity::matrix() const {
    return {mesh_.nodes[0].data(), meanGradients_[0].data(), masses_.data(),      values_.data(),
            rows_.data(),          columns_.data(),          int(masses_.size()), int(rows_.size()),
            mesh_.across,          pairStart_.data(),        pairNode_.data(),    pairValues_.data()};
}

Matrix3 BlockElasticity::stress(int zone, const Point* u, const Matrix3& rotation) const {
    const auto& z = zones_[zone];
    Matrix3 gradient = Matrix3::Zero();
    for (int i = 0; i < 4; ++i)
        gradient += turnedBack(z.nodes[i], u, rotation) * z.gradients[i].transpose();
    Matrix3 stress = stressOf(gradient);
    if (mesh_.across >= 0) stress(held_, held_) = 0; // plane stress
    return stress;
}

Eigen::Matrix<double, 12, 12> BlockElasticity::stiffness(int zone) const {
    const auto& z = zones_[zone];
    Eigen::Matrix<double, 12, 12> k;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const Point &a = z.gradients[i], &b = z.gradients[j];
            k.block<3, 3>(3 * i, 3 * j) = z.volume * (lambda_ * a * b.transpose() + shear_ * b * a.transpose() +
                                                      shear_ * a.dot(b) * Matrix3::Identity());
        }
    return k;
}

} // namespace masonry
