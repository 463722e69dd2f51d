// SPDX-License-Identifier: GPL-2.0-or-later
#include "CompressionCurve.hpp"

namespace masonry {

CompressionCurve::CompressionCurve(double kn, double fcp, double elasticLimitRatio, double residualRatio,
                                   double peakRatio, double Gc)
    : elasticLimit(elasticLimitRatio * fcp),
      peak(fcp),
      middle(0.5 * (1 + residualRatio) * fcp),
      residual(residualRatio * fcp),
      limitClosure(elasticLimit / kn),
      peakClosure(peakRatio * fcp / kn), // eq. (19)
      fractureEnergy(Gc) {
    const double kappa = peakClosure * peak;      // eq. (25)
    const double xi = peakClosure * residual;     // eq. (25)
    const double elastic = fcp * fcp / (18 * kn); // the elastic triangle, with fel = fcp/3
    const double hardening = 0.65 * (peakClosure - limitClosure) * fcp;
    softeningRatio = (Gc - elastic - hardening + 0.75 * kappa + 0.25 * xi) / (kappa + xi); // eq. (24)
    middleClosure = softeningRatio * peakClosure;                                          // eq. (23)
}

double CompressionCurve::smallestFractureEnergy(double kn, double fcp, double elasticLimitRatio, double residualRatio,
                                                double peakRatio) {
    const CompressionCurve c(kn, fcp, elasticLimitRatio, residualRatio, peakRatio, 0);
    const double kappa = c.peakClosure * c.peak;
    const double xi = c.peakClosure * c.residual;
    return fcp * fcp / (18 * kn) + 0.65 * (c.peakClosure - c.limitClosure) * fcp + 0.25 * kappa + 0.75 * xi;
}

} // namespace masonry
