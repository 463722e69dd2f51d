// SPDX-License-Identifier: GPL-2.0-or-later
// A joint law for tests, which shows what a law needs to be one: this folder and an entry in the list (law/Laws.cpp).
// Closed faces are linear elastic and slip by Coulomb friction, tau <= -sigma tan(phi). Open faces carry nothing. There
// is no bond, so nothing softens.
#pragma once
#include "law/common/ColumnsOf.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

class CoulombFriction : public Law {
public:
    static constexpr const char* name = "coulomb";
    static constexpr const char* meaning = "Coulomb friction without bond and softening";

    struct Column : SharedColumn {
        enum { Slip = SharedColumn::count, count };
    };
    struct State : JointState {
        double slip = 0; // [m] accumulated, >= 0

        template <class S, class Visit> static void visitNumbers(S& s, Visit&& visit) {
            JointState::visitNumbers(s, visit);
            visit("slip", s.slip, Column::Slip);
        }
    };
    struct Equations {
        double kn = 0, ks = 0; // [Pa/m]
        double tanPhi = 0;     // [-]
    };

    explicit CoulombFriction(const JointProperties& p) : Law(p, problems(p)) {}
    static bool reads(const std::string& property) { return property == "friction"; }
    static std::vector<std::string> problems(const JointProperties& p) { return p.outOfBounds(reads); }
    Equations equations(const ElasticStiffness& k) const { return {k.normal, k.shear, properties().friction}; }

    static double normalStress(const Equations& e, const State& s) { return std::min(e.kn * s.opening, 0.0); }

    Energies advance(const Equations& e, State& s, const Jump& jump) const {
        const Shear trial{s.shearStress.a + e.ks * jump.slide.a, s.shearStress.b + e.ks * jump.slide.b};
        const double size = std::hypot(trial.a, trial.b); // [Pa]
        s.opening += jump.opening;
        s.normalStress = normalStress(e, s);
        const double strength = -s.normalStress * e.tanPhi; // [Pa]
        const bool slips = size > strength;
        const double share = slips ? strength / size : 1; // of the trial stress that stays
        const double slip = (1 - share) * size / e.ks;    // [m]
        const double mean =
            slips ? 0.5 * ((s.shearStress.a * trial.a + s.shearStress.b * trial.b) / size + strength) : 0;
        s.shearStress = {share * trial.a, share * trial.b};
        s.slip += slip;
        s.regime = slips ? Regime::Slipping : Regime::Elastic;
        return {0, mean * slip, 0};
    }

    static Energies stored(const ElasticStiffness& k, const State& s) {
        const double tau = std::hypot(s.shearStress.a, s.shearStress.b);
        return {0, 0.5 * tau * tau / k.shear, 0.5 * s.normalStress * s.normalStress / k.normal};
    }
    Yield yielding(const ElasticStiffness& k, const State& s) const {
        const double tau = std::hypot(s.shearStress.a, s.shearStress.b);
        const double strength = -s.normalStress * equations(k).tanPhi;
        return {-1, (tau - strength) / std::max(tau + strength, 1.0), -1};
    }
    static void show(const Equations& e, const State& s, const ShowField& show) {
        static const JointField mobilised{"mobilised_friction", number("-", "Shear stress over frictional strength")};
        const double strength = -s.normalStress * e.tanPhi;
        show(field::slip, s.slip);
        show(mobilised, strength > 0 ? std::hypot(s.shearStress.a, s.shearStress.b) / strength : 0);
    }

    std::unique_ptr<LawColumns> columns(const ElasticStiffness& k, int joints, int points) const override {
        return std::make_unique<ColumnsOf<CoulombFriction>>(
            std::static_pointer_cast<const CoulombFriction>(shared_from_this()), k, joints, points);
    }
};

} // namespace masonry
