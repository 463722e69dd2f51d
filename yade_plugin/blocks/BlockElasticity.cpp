#include "BlockElasticity.hpp"
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace masonry {

BlockElasticity::BlockElasticity(BlockMesh mesh, double E, double nu, double density, bool planeStress)
    : mesh_(std::move(mesh)) {
    if (!(E > 0) || !std::isfinite(E))
        throw std::invalid_argument("Young's modulus must be a finite number above 0 Pa");
    if (!(nu > -1 && nu < 0.5)) throw std::invalid_argument("Poisson's ratio must be above -1 and below 0.5");
    if (!(density > 0) || !std::isfinite(density))
        throw std::invalid_argument("density must be a finite number above 0 kg/m³");
    lambda_ = E * nu / ((1 + nu) * (1 - 2 * nu));
    shear_ = E / (2 * (1 + nu));
    if (planeStress) lambda_ = 2 * lambda_ * shear_ / (lambda_ + 2 * shear_);
    masses_.assign(mesh_.nodes.size(), 0);
    meanGradients_.assign(mesh_.nodes.size(), Point::Zero());
    double whole = 0;
    for (const auto& nodes : mesh_.zones) {
        Zone z;
        z.nodes = nodes;
        std::array<Point, 4> c;
        for (int i = 0; i < 4; ++i)
            c[i] = mesh_.nodes[nodes[i]];
        z.volume = masonry::volume(c);
        Matrix3 edges;
        edges << c[1] - c[0], c[2] - c[0], c[3] - c[0];
        const Matrix3 inverse = edges.inverse(); // rows are the gradients of nodes 1 to 3
        for (int i = 1; i < 4; ++i)
            z.gradients[i] = inverse.row(i - 1);
        z.gradients[0] = -(z.gradients[1] + z.gradients[2] + z.gradients[3]);
        for (int i = 0; i < 4; ++i) {
            masses_[nodes[i]] += density * z.volume / 4;
            meanGradients_[nodes[i]] += z.volume * z.gradients[i];
        }
        whole += z.volume;
        zones_.push_back(z);
    }
    for (auto& g : meanGradients_)
        g /= whole;
    mass_ = density * whole;
}

Matrix3 BlockElasticity::rotation(const Point* u) const {
    Matrix3 r = Matrix3::Identity();
    for (std::size_t i = 0; i < meanGradients_.size(); ++i)
        r += u[i] * meanGradients_[i].transpose();
    for (int i = 0; i < 4; ++i) { // Newton's iteration for the polar part; two steps are enough at elastic strains
        const Matrix3 next = 0.5 * (r + r.inverse().transpose());
        const double change = (next - r).squaredNorm();
        r = next;
        if (change < 1e-24) break;
    }
    return r;
}

// Strain of x = R (X + d): the gradient of R^T x is R^T (I + grad u), so with R^T taken out of the sum
// d_i = R^T (X_i + u_i) - X_i and its symmetric gradient is the strain.
Matrix3 BlockElasticity::strain(const Zone& z, const Point* u, const Matrix3& rotation) const {
    Matrix3 gradient = Matrix3::Identity(); // of X + u
    for (int i = 0; i < 4; ++i)
        gradient += u[z.nodes[i]] * z.gradients[i].transpose();
    const Matrix3 turned = rotation.transpose() * gradient;
    return 0.5 * (turned + turned.transpose()) - Matrix3::Identity();
}

Matrix3 BlockElasticity::stressOf(const Matrix3& strain) const {
    return lambda_ * strain.trace() * Matrix3::Identity() + 2 * shear_ * strain;
}

double BlockElasticity::addForces(const Point* u, const Matrix3& rotation, Point* forces) const {
    double energy = 0;
    for (const auto& z : zones_) {
        const Matrix3 e = strain(z, u, rotation), s = stressOf(e);
        const Matrix3 pull = -z.volume * rotation * s;
        for (int i = 0; i < 4; ++i)
            forces[z.nodes[i]] += pull * z.gradients[i];
        energy += 0.5 * z.volume * s.cwiseProduct(e).sum();
    }
    return energy;
}

Matrix3 BlockElasticity::stress(int zone, const Point* u, const Matrix3& rotation) const {
    return stressOf(strain(zones_[zone], u, rotation));
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
