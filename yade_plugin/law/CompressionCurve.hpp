// Strength in compression as a function of the largest closure: hardening to the peak, softening to the residual,
// paper eqs. (18)-(25); law/README.md, Compression. Closure and stress are positive here.
#pragma once
#include "common/Vectorised.hpp"
#include <cmath>

namespace masonry {

struct CompressionCurve {
    double elasticLimit = 0, peak = 0, middle = 0, residual = 0; // [Pa] fel, fcp, fcm, fcr
    double limitClosure = 0, peakClosure = 0, middleClosure = 0; // [m] uel, ucp, ucm
    double softeningRatio = 0;                                   // [-] m, eq. (24)

    CompressionCurve() = default;
    CompressionCurve(double normalStiffness, double peakStrength, double elasticLimitRatio, double residualRatio,
                     double peakRatio, double fractureEnergy);

    // Eq. (24): the smallest fracture energy [J/m²] for which m >= 1.
    static double smallestFractureEnergy(double normalStiffness, double peakStrength, double elasticLimitRatio,
                                         double residualRatio, double peakRatio);

    // In what follows `stretch` = 1/kn* - 1/kn [m/Pa] is what lumped units add to the elastic closure: it moves the
    // elastic limit and the peak by their own elastic parts (law/README.md, Rigid units).

    // Strength [Pa] at the largest closure u [m].
    MASONRY_INLINED double strength(double u, double stretch = 0) const {
        return isBeyondMiddle(u, stretch) ? beyondMiddle(u, stretch) : upToMiddle(u, stretch);
    }

    // Closure at which the joint begins to harden [m].
    MASONRY_INLINED double limit(double stretch) const { return limitClosure + elasticLimit * stretch; }

    // The strength up to ucm, without branches, so that it is found for several subcontacts at a time.
    MASONRY_INLINED double upToMiddle(double u, double stretch) const {
        const double start = limit(stretch);
        const double top = peakAt(stretch);
        const double hardening = (u - start) / (top - start); // eq. (18), with the peak at ucp [decided]
        const double softening = (u - top) / width();         // eqs. (20), (21), second row
        const double beforePeak = elasticLimit + (peak - elasticLimit) * std::sqrt(hardening * (2 - hardening));
        const double afterPeak = peak + (middle - peak) * softening * softening;
        return u <= start ? elasticLimit : u < top ? beforePeak : afterPeak;
    }

    // The strength beyond ucm, eqs. (20), (21), third row.
    MASONRY_INLINED bool isBeyondMiddle(double u, double stretch) const { return u - peakAt(stretch) >= width(); }
    double beyondMiddle(double u, double stretch) const {
        const double slope = 2 * (middle - peak) / width(); // eq. (22)
        const double beyond = u - peakAt(stretch) - width();
        return residual + (middle - residual) * std::exp(slope * beyond / (middle - residual));
    }

    // Compression damage dc of eqs. (20), (21).
    double damage(double u, double stretch = 0) const {
        return u <= peakAt(stretch) ? 0 : 1 - strength(u, stretch) / peak;
    }

private:
    MASONRY_INLINED double peakAt(double stretch) const { return peakClosure + peak * stretch; }
    MASONRY_INLINED double width() const { return middleClosure - peakClosure; }
};

} // namespace masonry
