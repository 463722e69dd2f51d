// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDamping.hpp"
#include <Eigen/Geometry>
#include <cmath>

namespace masonry {

using Vector = Eigen::Vector3d;

// x'' + 2 z x' + x = 0 from x = 0 and x' = 1 on. The force 2 z x' + x is zero first at the time t of
// tan(w t) = 2 z w / (2 z² - 1) with w² = 1 - z², between 0 and pi/w, or of tanh(v t) = 2 z v / (2 z² - 1) with
// v² = z² - 1. There x' is -exp(-z t).
double restitutionOf(double z) {
    if (z < 1) {
        const double w = std::sqrt((1 - z) * (1 + z));
        return std::exp(-z * std::atan2(2 * z * w, 2 * z * z - 1) / w);
    }
    const double v = std::sqrt((z - 1) * (z + 1));
    const double x = 2 * z * v / (2 * z * z - 1);
    const double time = v < 1e-4 ? 2 * z / (2 * z * z - 1) : 0.5 * std::log((1 + x) / (1 - x)) / v;
    return std::exp(-z * time);
}

double dampingRatio(double restitution) {
    if (restitution >= 1) return 0;
    double low = 0, high = 1;
    while (restitutionOf(high) > restitution)
        high *= 2;
    while (high - low > 1e-13 * high) {
        const double middle = 0.5 * (low + high);
        (restitutionOf(middle) > restitution ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

DampingStep dampContact(const Overlap& overlap, const RelativeMotion& motion, double coefficient, double normalForce) {
    // Along the normal n, the point x of the other block moves with n·v + x·(n × w).
    const Vector& n = overlap.normal;
    const double along = n.dot(motion.velocity);
    const Vector slope = n.cross(motion.spin);
    const double flow = along * overlap.area + overlap.firstMoment.dot(slope);
    const Vector first = along * overlap.firstMoment + overlap.secondMoment * slope;
    const double square = along * flow + first.dot(slope);
    double share = coefficient;
    if (coefficient * flow > normalForce) share = normalForce / flow;
    return {-share * flow, -share * first.cross(n), share * (square > 0 ? square : 0)};
}

} // namespace masonry
