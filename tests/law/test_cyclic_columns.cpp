// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law in columns against the law for one subcontact: the same bits, whatever kind of joint and path.
#include "law/common/ColumnsSideBySide.hpp"
#include "law/cyclic_softening/CyclicColumns.hpp"
#include "law/cyclic_softening/CyclicSideBySide.hpp"
#include "paths.hpp"
#include <doctest/doctest.h>

using namespace masonry;

TEST_CASE("cyclic: subcontacts that wait among others follow the law for one with all vector units of this processor") {
    constexpr int many = 29;
    const auto processors = cyclic::processors();
    for (const auto& processor : processors)
        MESSAGE("vector units: ", std::string(processor.name));
    Dice dice(13);
    int regimes[4] = {};
    for (int kind = 0; kind < 100; ++kind) {
        const auto joint = DrawnJoint::of(dice);
        const CyclicLaw law(joint.properties);
        const auto e = law.equations(joint.stiffness);
        const double normal = joint.reach * dice.logarithmic(1e-3, 1), shear = joint.reach * dice.logarithmic(1e-3, 1);
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
                law.advance(e, states[j], some(j % 2 ? -1 : 0.5));
            const CyclicState& s = states[j];
            CyclicState::visitNumbers(s, [&](const char*, double number, int column) { columns[column][j] = number; });
            keep(derive(e, s), columns, j);
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
            processor.advance(
                {e, law.tension(), law.shear(), law.shear().lastRatio() - 1}, rows.data(),
                {own, {opening.data(), a.data(), b.data(), false}, regime.data(), pending.data(), many, stress.data()});
            for (int j = 0; j < many; ++j) {
                CAPTURE(std::string(processor.name));
                if (!pending[j]) { // nothing happened to it
                    for (int column = 0; column < CyclicColumn::count; ++column)
                        REQUIRE(own[column][j] == columns[column][j]);
                    REQUIRE(stress[j] == -1);
                    continue;
                }
                CyclicState one = states[j], fromColumns = states[j];
                const auto lost = law.advance(e, one, {opening[j], {a[j], b[j]}});
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
