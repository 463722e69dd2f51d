// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law in columns against the law for one subcontact: the same bits, whatever kind of joint and path.
#include "law/Laws.hpp"
#include "law/common/ColumnsSideBySide.hpp"
#include "law/cyclic_softening/CyclicColumns.hpp"
#include "law/cyclic_softening/CyclicLaw.hpp"
#include "law/cyclic_softening/CyclicSideBySide.hpp"
#include "states.hpp"
#include <doctest/doctest.h>
#include <string>
#include <vector>

using namespace masonry;

namespace {

JointProperties someKind(Chance& dice) {
    for (;;) {
        JointProperties p;
        p.law = "cyclic";
        p.shearStiffnessLoss = dice.happens(0.4) ? 0 : dice.between(0, 0.9);
        p.compressionStiffnessLoss = dice.happens(0.3) ? 0 : dice.between(0, 0.99);
        p.bondLossByCrushing = dice.happens(0.3) ? 0 : dice.between(0, 1);
        if (dice.happens(0.5)) {
            p.dilatancy = dice.between(0, 0.3);
            p.dilatancyDecay = dice.happens(0.5) ? 0 : dice.logarithmic(1, 1e4);
        }
        if (dice.happens(0.5)) p.residualCohesion = dice.between(0, 0.05e6);
        if (dice.happens(0.3)) p.friction = 0.6;
        if (dice.happens(0.25)) {
            p.initialClosingStiffness = dice.logarithmic(1e9, 3e11);
            p.closureLimit = dice.logarithmic(1e-6, 1e-3);
            p.tensileStrength = 0;
            p.compressionStiffnessLoss = 0;
        }
        p.cap = !dice.happens(0.3);
        if (dice.happens(0.3)) {
            p.compressiveStrength = 1e6;
            p.compressiveFractureEnergy = 5000;
        }
        if (problemsOf(p).empty()) return p;
    }
}

} // namespace

TEST_CASE("cyclic: subcontacts in columns follow the law for one to the last bit, and energies balance") {
    Chance dice{std::mt19937_64(7)};
    int regimes[4] = {};
    for (int kind = 0; kind < 200; ++kind) {
        const auto p = someKind(dice);
        const auto law = std::make_shared<const CyclicLaw>(p);
        ElasticStiffness k{p.normalStiffness, p.shearStiffness};
        if (dice.happens(0.5)) {
            const double length = dice.logarithmic(1e-3, 0.1);
            k = inSeriesWithUnits(p, length / 4.8e9, length / 2.07e9);
        }
        const int joints = dice.happens(0.1) ? 1 : int(dice.between(2, 41));
        ColumnsSideBySide<CyclicLaw> columns(law, k, joints, 1);
        const auto e = law->equations(k);
        std::vector<CyclicState> states(joints);
        std::vector<Energies> lost(joints);
        std::vector<double> opening(joints), a(joints), b(joints), stress(joints);
        const bool plane = dice.happens(0.5);
        const double normal = dice.logarithmic(1e-8, 1e-3), shear = dice.logarithmic(1e-8, 1e-3);
        double opens = 0, slides = 0;
        for (int step = 0; step < 120; ++step) {
            if (step % 30 == 0) {
                opens = dice.between(-1.5, 1);
                slides = dice.between(-1.5, 1.5);
            }
            for (int j = 0; j < joints; ++j) {
                const bool rests = dice.happens(0.2);
                opening[j] = rests ? 0 : normal * (dice.between(-1, 1) + opens);
                a[j] = rests ? 0 : shear * (dice.between(-1, 1) + slides);
                b[j] = rests || plane ? 0 : shear * dice.between(-1, 1);
            }
            for (int from = 0; from < joints;) {
                const int count = std::min(joints - from, 8 * int(dice.between(1, 5)));
                columns.advance(0, from, count, &opening[from], &a[from], plane ? nullptr : &b[from], &stress[from]);
                from += count;
            }
            for (int j = 0; j < joints; ++j) {
                const CyclicState old = states[j];
                CyclicState& now = states[j];
                const auto by = law->advance(e, now, {opening[j], {a[j], b[j]}});
                lost[j].tension += by.tension;
                lost[j].shear += by.shear;
                lost[j].compression += by.compression;
                ++regimes[int(now.regime)];
                const auto found = difference(now, lost[j], columns.get(0, j), columns.dissipated(0, j));
                REQUIRE_MESSAGE(found.empty(), "kind ", kind, ", step ", step, ", joint ", j, ": ", found);
                REQUIRE(stress[j] == now.normalStress);
                if (e.curved) continue; // its trapezoid errs, which is no loss
                const double work = 0.5 * ((old.normalStress + now.normalStress) * opening[j] +
                                           (old.shearStress.a + now.shearStress.a) * a[j] +
                                           (old.shearStress.b + now.shearStress.b) * b[j]);
                const double held = sum(law->stored(k, now)), before = sum(law->stored(k, old));
                REQUIRE(std::abs(work - (held - before) - sum(by)) <= 1e-11 * (std::abs(work) + held + before + 1e-12));
            }
        }
    }
    for (int each : regimes)
        CHECK(each > 1000);
}

TEST_CASE("cyclic: subcontacts that wait among others follow the law for one with all vector units of this processor") {
    constexpr int many = 29;
    const auto processors = cyclic::processors();
    for (const auto& processor : processors)
        MESSAGE("vector units: ", std::string(processor.name));
    Chance dice{std::mt19937_64(13)};
    int regimes[4] = {};
    for (int kind = 0; kind < 100; ++kind) {
        const auto p = someKind(dice);
        const auto law = std::make_shared<const CyclicLaw>(p);
        const auto e = law->equations({p.normalStiffness, p.shearStiffness});
        const double normal = dice.logarithmic(1e-8, 1e-3), shear = dice.logarithmic(1e-8, 1e-3);
        const auto some = [&](double opens) {
            return Jump{normal * (dice.between(-1, 1) + opens),
                        {shear * dice.between(-2, 2), shear * dice.between(-1, 1)}};
        };
        std::vector<double> memory(std::size_t(CyclicColumn::count) * many);
        const Columns columns{memory.data(), many};
        std::vector<CyclicState> states(many);
        std::vector<double> opening(many), a(many), b(many);
        std::vector<Mask> pending(many);
        const double share = dice.between(0, 1);
        for (int j = 0; j < many; ++j) {
            for (int step = 0; step < 10; ++step)
                law->advance(e, states[j], some(j % 2 ? -1 : 0.5));
            const CyclicState& s = states[j];
            CyclicState::visitNumbers(s, [&](const char*, double number, int column) { columns[column][j] = number; });
            keep(consequences(e, s), columns, j);
            const Jump jump = some(dice.between(-2, 2));
            opening[j] = jump.opening, a[j] = jump.slide.a, b[j] = jump.slide.b;
            pending[j] = dice.happens(share);
        }
        for (const auto& processor : processors) {
            std::vector<double> copy = memory;
            const Columns own{copy.data(), many};
            std::vector<TableRows> rows(many, {0, 0});
            std::vector<Regime> regime(many, Regime::Elastic);
            std::vector<double> stress(many, -1);
            processor.advance({e, law->tension(), law->shear(), law->shear().lastRatio() - 1}, own, rows.data(),
                              regime.data(), {opening.data(), a.data(), b.data(), false}, pending.data(), many,
                              stress.data());
            for (int j = 0; j < many; ++j) {
                CAPTURE(std::string(processor.name));
                CAPTURE(kind);
                CAPTURE(j);
                if (!pending[j]) { // nothing happened to it
                    for (int column = 0; column < CyclicColumn::count; ++column)
                        REQUIRE(own[column][j] == columns[column][j]);
                    REQUIRE(stress[j] == -1);
                    continue;
                }
                CyclicState one = states[j], fromColumns = states[j];
                const auto lost = law->advance(e, one, {opening[j], {a[j], b[j]}});
                CyclicState::visitNumbers(fromColumns,
                                          [&](const char*, double& number, int column) { number = own[column][j]; });
                fromColumns.normalStress = stress[j];
                fromColumns.regime = regime[j];
                const auto found = difference(one, lost, fromColumns,
                                              {own[CyclicColumn::LostTension][j], own[CyclicColumn::LostShear][j],
                                               own[CyclicColumn::LostCompression][j]});
                REQUIRE_MESSAGE(found.empty(), found);
                ++regimes[int(one.regime)];
            }
        }
    }
    for (int each : regimes)
        CHECK(each > 50 * int(processors.size()));
}
