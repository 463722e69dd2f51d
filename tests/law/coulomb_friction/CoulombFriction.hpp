// SPDX-License-Identifier: GPL-2.0-or-later
// A joint law for tests, which shows what a law needs to be one: this folder and an entry in the list (law/Laws.cpp).
// Closed faces are linear elastic and slip by Coulomb friction, tau <= -sigma tan(phi). Open faces carry nothing. A
// bond of the strength ft carries tension, and tau <= (ft - sigma) tan(phi), until the first yield breaks it.
#pragma once
#include "law/common/ColumnsOf.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

class CoulombFriction : public Law {
public:
    static constexpr const char* name = "coulomb";
    static constexpr const char* meaning = "Coulomb friction with a brittle bond";

    struct Column : SharedColumn {
        enum { Slip = SharedColumn::count, Broken, count };
        static constexpr int of(Role role) { return role == Role::BondDamage ? int(Broken) : none; }
    };
    struct State : JointState {
        double slip = 0;   // [m] accumulated, >= 0
        double broken = 0; // 1 where the bond has broken

        template <class S, class Visit> static void visitNumbers(S& s, Visit&& visit) {
            JointState::visitNumbers(s, visit);
            visit("slip", s.slip, Column::Slip);
            visit("broken", s.broken, Column::Broken);
        }
    };
    struct Equations {
        double kn = 0, ks = 0; // [Pa/m]
        double tanPhi = 0;     // [-]
        double ft = 0;         // [Pa]

        double bond(const State& s) const { return s.broken ? 0 : ft; }
        double strength(const State& s) const { return std::max(0.0, (bond(s) - s.normalStress) * tanPhi); }
    };

    explicit CoulombFriction(const JointProperties& p) : Law(p, problems(p)) {}
    static bool reads(const std::string& property) { return property == "friction" || property == "tensileStrength"; }
    static std::vector<Problem> problems(const JointProperties& p) { return p.outOfBounds(reads); }
    Equations equations(const ElasticStiffness& k) const {
        return {k.normal, k.shear, properties().friction, properties().tensileStrength};
    }

    static double normalStress(const Equations& e, const State& s) {
        return e.bond(s) > 0 ? e.kn * s.opening : std::min(e.kn * s.opening, 0.0);
    }

    Energies advance(const Equations& e, State& s, const Jump& jump) const {
        const Shear trial{s.shearStress.a + e.ks * jump.slide.a, s.shearStress.b + e.ks * jump.slide.b};
        const double size = std::hypot(trial.a, trial.b); // [Pa]
        const double before = s.normalStress;
        s.opening += jump.opening;
        s.normalStress = normalStress(e, s);
        double torn = 0; // [J/m²]
        if (e.bond(s) > 0 && (s.normalStress > e.ft || size > e.strength(s))) {
            s.broken = 1;
            s.normalStress = normalStress(e, s);
            const double stored = 0.5 * (s.normalStress * s.normalStress - before * before) / e.kn;
            torn = 0.5 * (before + s.normalStress) * jump.opening - stored;
        }
        const double strength = e.strength(s); // [Pa]
        const bool slips = size > strength;
        const double share = slips ? strength / size : 1; // of the trial stress that stays
        const double slip = (1 - share) * size / e.ks;    // [m]
        const double mean =
            slips ? 0.5 * ((s.shearStress.a * trial.a + s.shearStress.b * trial.b) / size + strength) : 0;
        s.shearStress = {share * trial.a, share * trial.b};
        s.slip += slip;
        s.regime = slips ? Regime::Slipping : Regime::Elastic;
        return {torn, mean * slip, 0};
    }

    static Energies stored(const ElasticStiffness& k, const State& s) {
        const double tau = std::hypot(s.shearStress.a, s.shearStress.b);
        return {0, 0.5 * tau * tau / k.shear, 0.5 * s.normalStress * s.normalStress / k.normal};
    }
    Yield yielding(const ElasticStiffness& k, const State& s) const {
        const double tau = std::hypot(s.shearStress.a, s.shearStress.b);
        const Equations e = equations(k);
        const double strength = e.strength(s), bond = e.bond(s);
        return {(s.normalStress - bond) / std::max(std::abs(s.normalStress) + bond, 1.0),
                (tau - strength) / std::max(tau + strength, 1.0), -1};
    }
    static void show(const Equations& e, const State& s, const ShowField& show) {
        static const JointField mobilised{"mobilised_friction", number("-", "Shear stress over frictional strength")};
        const double strength = e.strength(s);
        show(field::slip, s.slip);
        show(field::damageTension, s.broken);
        show(mobilised, strength > 0 ? std::hypot(s.shearStress.a, s.shearStress.b) / strength : 0);
    }

    std::unique_ptr<LawColumns> columns(const ElasticStiffness& k, int joints, int points) const override {
        return std::make_unique<ColumnsOf<CoulombFriction>>(
            std::static_pointer_cast<const CoulombFriction>(shared_from_this()), k, joints, points);
    }
};

} // namespace masonry
