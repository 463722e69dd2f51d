// Strength in compression as a function of the largest closure: hardening to the peak, softening to the residual,
// paper eqs. (18)-(25), law.md §4. Closure and stress are positive here.
#pragma once
#include <cmath>

namespace masonry {

struct CompressionCurve {
    double elasticLimit = 0, peak = 0, middle = 0, residual = 0; // [Pa] fel, fcp, fcm, fcr
    double limitClosure = 0, peakClosure = 0, middleClosure = 0; // [m] uel, ucp, ucm
    double softeningRatio = 0;                                   // [-] m, eq. (24)

    CompressionCurve() = default;
    CompressionCurve(double normalStiffness, double peakStrength, double elasticLimitRatio, double residualRatio,
                     double peakRatio, double fractureEnergy);

    // Eq. (24): the smallest fracture energy [J/m²] for which m >= 1, law.md §4.
    static double smallestFractureEnergy(double normalStiffness, double peakStrength, double elasticLimitRatio,
                                         double residualRatio, double peakRatio);

    // Strength [Pa] at the largest closure u [m]. `stretch` = 1/kn* - 1/kn [m/Pa] is what softer, lumped units add to
    // the elastic closure (law.md §7): it moves the elastic limit and the peak by their own elastic parts.
    double strength(double u, double stretch = 0) const {
        const double limit = limitClosure + elasticLimit * stretch;
        if (u <= limit) return elasticLimit;
        const double top = peakClosure + peak * stretch;
        if (u < top) { // eq. (18), with the peak at ucp [decided]
            const double x = (u - limit) / (top - limit);
            return elasticLimit + (peak - elasticLimit) * std::sqrt(x * (2 - x));
        }
        const double beyond = u - top, width = middleClosure - peakClosure;
        if (beyond < width) { // eqs. (20), (21), second row
            const double x = beyond / width;
            return peak + (middle - peak) * x * x;
        }
        const double slope = 2 * (middle - peak) / width;                                                 // eq. (22)
        return residual + (middle - residual) * std::exp(slope * (beyond - width) / (middle - residual)); // third row
    }

    // Compression damage dc of eqs. (20), (21).
    double damage(double u, double stretch = 0) const {
        return u <= peakClosure + peak * stretch ? 0 : 1 - strength(u, stretch) / peak;
    }
};

} // namespace masonry
