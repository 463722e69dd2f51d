// SPDX-License-Identifier: GPL-2.0-or-later
// The joint law of the paper on one subcontact: tension cut-off F1, Coulomb slip F2, elliptical cap F3 (eqs. (8), (9)),
// coupled softening (eqs. (10)-(17)), hardening and softening in compression (eqs. (18)-(25)). law/README.md states it.
#pragma once
#include "PiecewiseEquations.hpp"
#include "PiecewiseState.hpp"
#include "law/common/JointField.hpp"
#include "law/common/Law.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

class PiecewiseLaw : public Law {
public:
    static constexpr const char* name = "softening";
    static constexpr const char* meaning = "the paper's law";

    using State = PiecewiseState;
    using Column = PiecewiseColumn;
    using Equations = PiecewiseEquations;

    // Whether so many subcontacts that may yield are advanced faster one by one than side by side in their groups of
    // eight. Side by side a group costs as much as one subcontact by itself, and the first group as much as two
    // (measured, tests/law/benchmark_law.cpp).
    static constexpr bool fasterOneByOne(int many, int groups) { return many <= groups; }

    // Throws std::invalid_argument with all problems of the properties at once.
    explicit PiecewiseLaw(const JointProperties& properties) : PiecewiseLaw(properties, problems(properties)) {}
    // For a law that is made of this one, with the problems that it has found.
    PiecewiseLaw(const JointProperties& properties, const std::vector<Problem>& problems);

    // Whether the law ever reads a property of joints, and what is wrong with the properties of a joint.
    static bool reads(const std::string& property);
    static std::vector<Problem> problems(const JointProperties& properties) { return problems(properties, reads); }
    // The same for a law that reads others, too.
    static std::vector<Problem> problems(const JointProperties& properties, bool (*reads)(const std::string&));

    const CompressionCurve& compression() const override { return own_.curve; }
    double squaredCapStress(double normal, double squaredShear) const override {
        return own_.capStress(normal, squaredShear);
    }
    const SofteningTable& tension() const override { return tension_; }
    const SofteningTable& shear() const override { return shear_; }

    // The equations for a joint that shows the stiffness k, its own or lumped with rigid units. Softening and crushing
    // displacements stay those of the joint itself (law/README.md, Rigid units).
    PiecewiseEquations equations(const ElasticStiffness& k) const {
        PiecewiseEquations e = own_;
        e.kn = k.normal;
        e.ks = k.shear;
        e.onset = e.ft / k.normal;
        e.stretch = stretch(k);
        e.normalShift = e.stretch * e.ownKn;
        e.shearShift = std::max(0.0, 1 / k.shear - 1 / e.ownKs) * e.ownKs;
        return e;
    }

    // One step: takes the state on by the jump and returns the energy dissipated in it. In place and inlined, because
    // copies of the state cost as much as the law.
    MASONRY_INLINED Energies advance(const ElasticStiffness& k, PiecewiseState& s, const Jump& jump) const {
        return advance(equations(k), s, jump);
    }
    MASONRY_INLINED Energies advance(const PiecewiseEquations& e, PiecewiseState& s, const Jump& jump) const {
        // 1, opening
        const auto moved = e.open(s.opening, s.crushing - s.dilation, s.largestOpening, jump.opening);
        double intact = PiecewiseEquations::intact(s.tensionDamage, s.shearDamage);
        const double oldStiffness = moved.before > 0 ? e.secant(intact, s.largestOpening) : e.kn;
        const double oldNormal = s.normalStress;
        s.opening = moved.total;
        s.regime = Regime::Elastic;
        const Shear old = s.shearStress;
        const Shear trial{old.a + e.ks * jump.slide.a, old.b + e.ks * jump.slide.b}; // eq. (7)
        if (moved.tears) {
            s.largestOpening = moved.farthest;
            const auto at = e.tensionReading(moved.elastic, s.shearDamage);
            const double damage = tension_.damage(at.ratio, at.shift);
            if (damage > s.tensionDamage) {
                s.tensionDamage = damage;
                s.regime = Regime::Opening;
                intact = PiecewiseEquations::intact(s.tensionDamage, s.shearDamage);
            }
        }
        double newStiffness = moved.open ? e.secant(intact, s.largestOpening) : e.kn;
        s.normalStress = newStiffness * moved.elastic;

        // 2, Coulomb slip
        const double tauSquared = trial.a * trial.a + trial.b * trial.b;
        const double size = std::sqrt(tauSquared);
        Energies dissipated;
        double slip = 0;
        double dilation = 0;
        s.shearStress = trial;
        if (size > e.slipStrength(intact, s.normalStress, moved.elastic)) {
            const auto at = e.shearReading(size, s.normalStress, moved.elastic, s.slip, s.tensionDamage);
            const double damage = shear_.damage(at.ratio, at.shift);
            const bool weaker = damage > s.shearDamage;
            if (weaker) {
                s.shearDamage = damage;
                if (e.relaxes(s.largestOpening)) { // the units give back what the bond has lost
                    const auto reopened = e.tensionReading(s.largestOpening, damage);
                    s.tensionDamage = std::max(s.tensionDamage, tension_.damage(reopened.ratio, reopened.shift));
                }
                intact = PiecewiseEquations::intact(s.tensionDamage, s.shearDamage);
            }
            const bool dilates = !moved.open && e.tanPsi > 0;
            const auto slid = e.slide(size, s.normalStress, moved.elastic, intact, dilates ? e.dilatancy(s.slip) : 0);
            if (slid.slides) {
                const double before = s.dilation;
                slip = slid.slip;
                s.slip += slip;
                s.dilation += slid.dilation;
                dilation = s.dilation - before;
                s.normalStress = slid.sigma;
                s.shearStress = {slid.share * trial.a, slid.share * trial.b};
                s.regime = Regime::Slipping;
            }
            if (moved.open && weaker) {
                newStiffness = e.secant(intact, s.largestOpening);
                s.normalStress = newStiffness * moved.elastic;
            }
        }

        // 3, cap
        double crushingSlip = 0;
        double closure = 0;
        if (e.cap) {
            if (s.normalStress < 0) s.largestClosure = std::max(s.largestClosure, -s.opening);
            const double tau2 = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
            if (e.capStress(s.normalStress, tau2) > e.smallestFcSquared) {
                const double fc = e.curve.strength(s.largestClosure, e.stretch);
                const auto crushed = e.crush(s.normalStress, tau2, fc);
                if (crushed.crushes) {
                    const double before = s.crushing;
                    s.normalStress = crushed.sigma;
                    s.crushing += crushed.closure;
                    closure = s.crushing - before;
                    crushingSlip = crushed.slip;
                    s.slip += crushingSlip;
                    s.shearStress = {crushed.share * s.shearStress.a, crushed.share * s.shearStress.b};
                    s.regime = Regime::Crushing;
                }
            }
        }

        const double meanNormal = 0.5 * (oldNormal + s.normalStress);
        if (slip + crushingSlip > 0) {
            const double meanShear =
                PiecewiseEquations::meanShear(old.a, old.b, s.shearStress.a, s.shearStress.b, trial.a, trial.b, size);
            dissipated.shear = meanShear * slip + meanNormal * dilation;
            dissipated.compression = meanShear * crushingSlip;
        }
        dissipated.compression -= meanNormal * closure;
        dissipated.tension = PiecewiseEquations::lostInTension(oldStiffness, newStiffness, oldNormal, s.normalStress,
                                                               moved.before, s.opening + (s.crushing - s.dilation));
        return dissipated;
    }

    // Normal stress of a state [Pa], eqs. (6) and (11).
    static double normalStress(const PiecewiseEquations& e, const PiecewiseState& s) {
        const double elasticOpening = s.opening + (s.crushing - s.dilation);
        const double intact = PiecewiseEquations::intact(s.tensionDamage, s.shearDamage);
        return e.stiffness(elasticOpening, e.secant(intact, s.largestOpening)) * elasticOpening;
    }

    // Elastic energy by mode [J/m²].
    static Energies stored(const ElasticStiffness& k, const PiecewiseState& s) {
        const double tauSquared = s.shearStress.a * s.shearStress.a + s.shearStress.b * s.shearStress.b;
        const double shear = PiecewiseEquations::storedShear(tauSquared, k.shear);
        const double normal = PiecewiseEquations::storedNormal(s.normalStress, s.opening + s.crushing - s.dilation);
        return s.normalStress > 0 ? Energies{normal, shear, 0} : Energies{0, shear, normal};
    }

    static void show(const PiecewiseEquations& e, const PiecewiseState& s, const ShowField& show) {
        show(field::slip, s.slip);
        show(field::damageTension, s.tensionDamage);
        show(field::damageShear, s.shearDamage);
        show(field::damageCompression, e.cap ? e.curve.damage(s.largestClosure, e.stretch) : 0);
        show(field::crushing, s.crushing);
    }

    // The yield functions F1 [Pa], F2 [Pa] and F3 [Pa²] of eqs. (8), and each over the size of its terms [-].
    Yield yield(const ElasticStiffness& k, const PiecewiseState& s) const;
    Yield yielding(const ElasticStiffness& k, const PiecewiseState& s) const { return relative(yield(k, s), k, s); }
    // Each of the functions `f` over the sum of the sizes of its terms and of the elastic stress of the largest jumps
    // so far [-], so that it exceeds zero by round-off only.
    Yield relative(const Yield& f, const ElasticStiffness& k, const PiecewiseState& s) const;

    std::unique_ptr<LawColumns> columns(const ElasticStiffness& k, int joints, int points) const override;

    std::vector<std::string> snapsBack(const ElasticStiffness& k, double distance) const override;

private:
    // [m/Pa] what lumped units add; nothing where properties were changed to ones softer than what the joint shows
    double stretch(const ElasticStiffness& k) const { return std::max(0.0, 1 / k.normal - 1 / own_.ownKn); }

    SofteningTable tension_, shear_;
    PiecewiseEquations own_; // with the joint's own stiffness
};

// The brittle Coulomb slip set: tension to zero and cohesion to its residual at the first yield, no cap.
JointProperties brittleCoulomb(JointProperties properties);

} // namespace masonry
