// The joint law of the paper on one subcontact: tension cut-off F1, Coulomb slip F2, elliptical cap F3 (eqs. (8), (9)),
// coupled softening (eqs. (10)-(17)), hardening and softening in compression (eqs. (18)-(25)); law.md §5 is the order.
#pragma once
#include "CompressionCurve.hpp"
#include "JointProperties.hpp"
#include "JointState.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

class JointLaw {
public:
    // Throws std::invalid_argument with all problems of the properties at once.
    explicit JointLaw(const JointProperties& properties);

    const JointProperties& properties() const { return p_; }
    const CompressionCurve& compression() const { return curve_; }
    const SofteningTable& tension() const { return tension_; }
    const SofteningTable& shear() const { return shear_; }

    // One step. `k` is the stiffness that the joint shows, its own or lumped with rigid units; softening and crushing
    // displacements stay those of the joint itself (law.md §7).
    // Takes the state on by the jump and returns the energy dissipated in the step. In place and inlined, because
    // copies of the state cost as much as the law.
    [[gnu::always_inline]] Energies advance(const ElasticStiffness& k, JointState& s, const Jump& jump) const {
        const JointState old = s;
        Energies dissipated;
        s.opening += jump.opening;
        s.regime = Regime::Elastic;
        Shear trial{old.shearStress.a + k.shear * jump.slide.a, old.shearStress.b + k.shear * jump.slide.b}; // eq. (7)
        if (p_.elastic) {
            s.normalStress = k.normal * s.opening; // eq. (6)
            s.shearStress = trial;
            return dissipated;
        }

        // law.md §5, 1: normal stress from the elastic opening
        const double oldElasticOpening = old.opening + old.crushing - old.dilation;
        const double elasticOpening = s.opening + s.crushing - s.dilation;
        const bool open = elasticOpening > 0;
        if (open) {
            if (elasticOpening > s.largestOpening) {
                s.largestOpening = elasticOpening;
                // eq. (12); the ratio counts from the peak with the joint's own ft/kn (law.md §7)
                const double ratio =
                    1 + (elasticOpening - p_.tensileStrength / k.normal) * p_.normalStiffness / p_.tensileStrength;
                s.tensionDamage = std::max(s.tensionDamage, tension_.damage(ratio));
            }
            s.normalStress = openStress(k, s, elasticOpening);
            if (s.tensionDamage > old.tensionDamage) s.regime = Regime::Opening;
        } else
            s.normalStress = k.normal * elasticOpening;

        // law.md §5, 2: Coulomb slip
        const Shear elastic = trial; // both returns below are along it
        const double size = std::sqrt(trial.a * trial.a + trial.b * trial.b);
        double strength = slipStrength(s), slip = 0;
        if (size > strength) {
            const double peak = p_.cohesion - s.normalStress * p_.friction; // eq. (15), with the current sigma
            // eq. (13) with u = s + |tau_trial|/ks [decided]
            const double ratio = 1 + (s.slip + (size - peak) / k.shear) * p_.shearStiffness / peak;
            s.shearDamage = std::max(s.shearDamage, shear_.damage(peak > 0 ? ratio : HUGE_VAL));
            strength = slipStrength(s);
            if (size > strength) {
                const bool dilates = !open && p_.dilatancy > 0; // eq. (9)
                const double tanPsi = dilates ? p_.dilatancy * std::exp(-p_.dilatancyDecay * s.slip) : 0;
                slip = (size - strength) / (k.shear + k.normal * friction(s) * tanPsi);
                s.slip += slip;
                s.dilation += tanPsi * slip;
                s.normalStress -= k.normal * tanPsi * slip;
                const double left = std::max(0.0, 1 - k.shear * slip / size);
                trial = {left * trial.a, left * trial.b};
                s.regime = Regime::Slipping;
            }
            if (open && s.shearDamage > old.shearDamage) s.normalStress = openStress(k, s, elasticOpening);
        }

        // law.md §5, 3: cap, returned radially
        double crushingSlip = 0;
        if (p_.cap && s.normalStress < 0) {
            s.largestClosure = std::max(s.largestClosure, -s.opening);
            const double sigma = s.normalStress, tau2 = trial.a * trial.a + trial.b * trial.b;
            const double quadratic = p_.capNormal * sigma * sigma + p_.capShear * tau2, linear = p_.capLinear * sigma;
            if (quadratic + linear > smallestStrengthSquared_) {
                const double fc = compressiveStrength(k, s.largestClosure);
                if (quadratic + linear > fc * fc) { // F3 > 0, eq. (8c): root of quadratic x² + linear x = fc²
                    const double root = std::sqrt(linear * linear + 4 * quadratic * fc * fc);
                    const double scale = linear > 0 ? 2 * fc * fc / (linear + root) : (root - linear) / (2 * quadratic);
                    s.normalStress *= scale;
                    s.crushing += (s.normalStress - sigma) / k.normal;
                    crushingSlip = (1 - scale) * std::sqrt(tau2) / k.shear;
                    s.slip += crushingSlip;
                    trial = {scale * trial.a, scale * trial.b};
                    s.regime = Regime::Crushing;
                }
            }
        }
        s.shearStress = trial;

        // The trapezoidal work of the step is mean stress times jump, and the jump is the change of the elastic
        // displacements plus what flowed. The mean stress on the flow is dissipated; the elastic parts of shear and
        // closed joints are stored exactly; what remains of the elastic opening is the damage in tension.
        const double meanNormal = 0.5 * (old.normalStress + s.normalStress);
        if (slip + crushingSlip > 0) {
            const double meanShear =
                0.5 * ((old.shearStress.a + trial.a) * elastic.a + (old.shearStress.b + trial.b) * elastic.b) / size;
            dissipated.shear = meanShear * slip + meanNormal * (s.dilation - old.dilation);
            dissipated.compression = meanShear * crushingSlip;
        }
        dissipated.compression -= meanNormal * (s.crushing - old.crushing);
        if (open || oldElasticOpening > 0)
            dissipated.tension =
                0.5 * (old.normalStress * (s.opening + s.crushing - s.dilation) - s.normalStress * oldElasticOpening);
        return dissipated;
    }

    // Elastic energy by mode [J/m²].
    static Energies stored(const ElasticStiffness& k, const JointState& s) {
        const double normal = 0.5 * s.normalStress * (s.opening + s.crushing - s.dilation);
        const double shear = 0.5 * (s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b) / k.shear;
        return s.normalStress > 0 ? Energies{normal, shear, 0} : Energies{0, shear, normal};
    }

    // Compression damage dc, eq. (21).
    double compressionDamage(const ElasticStiffness& k, const JointState& s) const {
        return p_.cap ? curve_.damage(s.largestClosure, stretch(k)) : 0;
    }

    // Strength of the cap [Pa] at a largest closure [m], and the closure at which it begins to harden.
    double compressiveStrength(const ElasticStiffness& k, double largestClosure) const {
        return curve_.strength(largestClosure, stretch(k));
    }
    double limitClosure(const ElasticStiffness& k) const {
        return curve_.limitClosure + curve_.elasticLimit * stretch(k);
    }

    // The yield functions at a state; at most zero after every step. F3 is -1 where the cap does not act, all are where
    // no strength is ever reached.
    struct Yield {
        double tension, slip, cap; // [Pa], [Pa], [Pa²]
    };
    Yield yield(const ElasticStiffness& k, const JointState& s) const;

    static double coupled(const JointState& s) { // d_ts, eq. (10)
        return s.tensionDamage + s.shearDamage - s.tensionDamage * s.shearDamage;
    }

private:
    double stretch(const ElasticStiffness& k) const { return 1 / k.normal - 1 / p_.normalStiffness; } // law.md §7
    double friction(const JointState& s) const {                                                      // eq. (17b)
        return p_.residualFriction + (p_.friction - p_.residualFriction) * (1 - coupled(s));
    }
    double slipStrength(const JointState& s) const { // eqs. (16), (17a)
        const double cohesion = p_.residualCohesion + (p_.cohesion - p_.residualCohesion) * (1 - coupled(s));
        return std::max(0.0, cohesion - s.normalStress * friction(s));
    }
    // Secant to the softened strength at the largest opening, eq. (11): closes at the origin, never pushes [decided].
    double openStress(const ElasticStiffness& k, const JointState& s, double elasticOpening) const {
        return std::min(k.normal, p_.tensileStrength * (1 - coupled(s)) / s.largestOpening) * elasticOpening;
    }

    JointProperties p_;
    SofteningTable tension_, shear_;
    CompressionCurve curve_;
    double smallestStrengthSquared_ = 0; // [Pa²] the cap cannot act below
};

// The brittle Coulomb slip set, law.md §9: tension to zero and cohesion to its residual at the first yield, no cap.
JointProperties brittleCoulomb(JointProperties properties);

} // namespace masonry
