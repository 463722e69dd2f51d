// SPDX-License-Identifier: GPL-2.0-or-later
// Strength in compression as a function of the largest closure: hardening to the peak, softening to the residual,
// paper eqs. (18)-(25); law/README.md, Compression. Closure and stress are positive here.
#pragma once
#include "common/Pack.hpp"
#include <cmath>

namespace masonry {

struct CompressionCurve {
    double elasticLimit = 0, peak = 0, middle = 0, residual = 0; // [Pa] fel, fcp, fcm, fcr
    double limitClosure = 0, peakClosure = 0, middleClosure = 0; // [m] uel, ucp, ucm
    double softeningRatio = 0;                                   // [-] m, eq. (24)
    double fractureEnergy = 0;                                   // [J/m²] Gc

    CompressionCurve() = default;
    CompressionCurve(double normalStiffness, double peakStrength, double elasticLimitRatio, double residualRatio,
                     double peakRatio, double fractureEnergy);

    // Eq. (24): the smallest fracture energy [J/m²] for which m >= 1.
    static double smallestFractureEnergy(double normalStiffness, double peakStrength, double elasticLimitRatio,
                                         double residualRatio, double peakRatio);

    // In what follows `stretch` = 1/kn* - 1/kn [m/Pa] is what lumped units add to the elastic closure. Every point of
    // the curve moves by the elastic part at its own stress, u* = u + fc(u)·stretch (law/README.md, Rigid units).
    // Closures u are those of joint and units together.

    // Strength [Pa] at the largest closure u [m].
    MASONRY_INLINED double strength(double u, double stretch = 0) const {
        return isBeyondMiddle(u, stretch) ? beyondMiddle(u, stretch) : upToMiddle(u, stretch);
    }

    // Closure at which the joint begins to harden [m].
    MASONRY_INLINED double limit(double stretch) const { return limitClosure + elasticLimit * stretch; }

    // The strength up to ucm, without branches, so that it is found for several subcontacts at a time. Both parts are
    // roots of a quadratic equation, written so that nothing cancels.
    template <class T> MASONRY_INLINED T upToMiddle(const T& u, double stretch) const {
        const double start = limit(stretch);
        const double top = peakAt(stretch);
        const auto hardens = u < top;
        // eq. (18), with the peak at ucp [decided]: a x + b sqrt(x (2 - x)) = v
        const double a = peakClosure - limitClosure;
        const double b = stretch * (peak - elasticLimit);
        const T v = u - start;
        // eqs. (20), (21), second row: w = W xi - A xi²
        const double W = width();
        const double A = stretch * (peak - middle);
        const T w = u - top;
        const T inside = choose(hardens, b * b + 2 * a * v - v * v, W * W - 4 * A * w);
        const T side = root(larger(inside, T{}));
        const T fraction = choose(hardens, v * v, 2 * w) / choose(hardens, a * v + b * b + b * side, W + side);
        const T beforePeak = elasticLimit + (peak - elasticLimit) * root(T(fraction * (2 - fraction)));
        const T afterPeak = peak + (middle - peak) * fraction * fraction;
        return choose(u <= start, all<T>(elasticLimit), choose(hardens, beforePeak, afterPeak));
    }

    // The strength beyond ucm, eqs. (20), (21), third row.
    template <class T> MASONRY_INLINED MaskOf<T> isBeyondMiddle(const T& u, double stretch) const {
        return u - peakAt(stretch) >= fall(stretch);
    }
    double beyondMiddle(double u, double stretch) const {
        const double alpha = 2 * (middle - peak) / width(); // eq. (22)
        const double height = middle - residual;
        const double beyond = u - peakAt(stretch) - (width() - stretch * (peak - middle));
        // own - stretch height (1 - exp(alpha own / height)) = beyond, a convex function of the own closure beyond ucm.
        // Newton's method comes down to its largest root from the right.
        double own = beyond + stretch * height;
        double left = std::exp(alpha * own / height);
        for (int i = 0; i < 100; ++i) {
            const double excess = own - stretch * height * (1 - left) - beyond;
            const double next = own - excess / (1 + stretch * alpha * left);
            if (!(next < own)) break;
            own = next;
            left = std::exp(alpha * own / height);
        }
        return residual + height * left;
    }

    // Compression damage dc of eqs. (20), (21).
    double damage(double u, double stretch = 0) const {
        return u <= peakAt(stretch) ? 0 : 1 - strength(u, stretch) / peak;
    }

    // Steepest fall of the strength [Pa/m], which is at ucm: |alpha| of eq. (22). From stretch = 1/steepest() on the
    // softening branch snaps back: the units give back more than the joint closes. The strength then drops at once.
    double steepest() const { return 2 * (peak - middle) / width(); }

    // Gc [J/m²] of the curve that is this one but for a larger ucm, which it falls `gentler` times as slowly to.
    double fractureEnergyOf(double gentler) const {
        return fractureEnergy + (gentler - 1) * width() * (peak + residual); // eq. (24)
    }

private:
    MASONRY_INLINED double peakAt(double stretch) const { return peakClosure + peak * stretch; }
    MASONRY_INLINED double width() const { return middleClosure - peakClosure; }
    // From the peak to where the tail takes over [m]: ucm, or where the parabola snaps back before.
    MASONRY_INLINED double fall(double stretch) const {
        const double A = stretch * (peak - middle);
        return 2 * A <= width() ? width() - A : width() * width() / (4 * A);
    }
};

} // namespace masonry
