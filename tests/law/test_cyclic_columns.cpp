// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law in columns against the law for one subcontact: the same bits, whatever kind of joint and path.
#include "law/Laws.hpp"
#include "law/common/ColumnsSideBySide.hpp"
#include "law/cyclic_softening/CyclicColumns.hpp"
#include "law/cyclic_softening/CyclicLaw.hpp"
#include "law/cyclic_softening/CyclicSideBySide.hpp"
#include <doctest/doctest.h>
#include <random>
#include <string>
#include <vector>

using namespace masonry;

namespace {

struct Dice {
    std::mt19937_64 engine;
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
    double scale(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    bool once(double share) { return between(0, 1) < share; }
};

JointProperties someKind(Dice& dice) {
    for (;;) {
        JointProperties p;
        p.law = "cyclic";
        p.shearStiffnessLoss = dice.once(0.4) ? 0 : dice.between(0, 0.9);
        p.compressionStiffnessLoss = dice.once(0.3) ? 0 : dice.between(0, 0.99);
        p.bondLossByCrushing = dice.once(0.3) ? 0 : dice.between(0, 1);
        if (dice.once(0.5)) {
            p.dilatancy = dice.between(0, 0.3);
            p.dilatancyDecay = dice.once(0.5) ? 0 : dice.scale(1, 1e4);
        }
        if (dice.once(0.5)) p.residualCohesion = dice.between(0, 0.05e6);
        if (dice.once(0.3)) p.friction = 0.6;
        if (dice.once(0.25)) {
            p.initialClosingStiffness = dice.scale(1e9, 3e11);
            p.closureLimit = dice.scale(1e-6, 1e-3);
            p.tensileStrength = 0;
            p.compressionStiffnessLoss = 0;
        }
        p.cap = !dice.once(0.3);
        if (dice.once(0.3)) {
            p.compressiveStrength = 1e6;
            p.compressiveFractureEnergy = 5000;
        }
        if (problemsOf(p).empty()) return p;
    }
}

// Visits every number of a state, with its name.
template <class F> void each(const CyclicState& s, F&& f) {
    CyclicState::visitNumbers(s, [&](const char* name, double number, int) { f(name, number); });
    f("normal stress", s.normalStress);
    f("regime", double(s.regime));
}

std::string difference(const CyclicState& one, const Energies& lostByOne, const CyclicState& column,
                       const Energies& lostByColumn) {
    std::vector<double> numbers;
    each(one, [&](const char*, double value) { numbers.push_back(value); });
    std::string found;
    std::size_t n = 0;
    each(column, [&](const char* name, double value) {
        if (value != numbers[n++]) found += std::string(name) + " ";
    });
    if (lostByOne.tension != lostByColumn.tension) found += "lost in tension ";
    if (lostByOne.shear != lostByColumn.shear) found += "lost in shear ";
    if (lostByOne.compression != lostByColumn.compression) found += "lost in compression ";
    return found;
}

double sum(const Energies& e) { return e.tension + e.shear + e.compression; }

} // namespace

TEST_CASE("cyclic: subcontacts in columns follow the law for one to the last bit, and energies balance") {
    Dice dice{std::mt19937_64(7)};
    int regimes[4] = {};
    for (int kind = 0; kind < 200; ++kind) {
        const auto p = someKind(dice);
        const auto law = std::make_shared<const CyclicLaw>(p);
        ElasticStiffness k{p.normalStiffness, p.shearStiffness};
        if (dice.once(0.5)) {
            const double length = dice.scale(1e-3, 0.1);
            k = inSeriesWithUnits(p, length / 4.8e9, length / 2.07e9);
        }
        const int joints = dice.once(0.1) ? 1 : int(dice.between(2, 41));
        ColumnsSideBySide<CyclicLaw> columns(law, k, joints, 1);
        const auto e = law->equations(k);
        std::vector<CyclicState> states(joints);
        std::vector<Energies> lost(joints);
        std::vector<double> opening(joints), a(joints), b(joints), stress(joints);
        const bool plane = dice.once(0.5);
        const double normal = dice.scale(1e-8, 1e-3), shear = dice.scale(1e-8, 1e-3);
        double opens = 0, slides = 0;
        for (int step = 0; step < 120; ++step) {
            if (step % 30 == 0) {
                opens = dice.between(-1.5, 1);
                slides = dice.between(-1.5, 1.5);
            }
            for (int j = 0; j < joints; ++j) {
                const bool rests = dice.once(0.2);
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
    Dice dice{std::mt19937_64(13)};
    int regimes[4] = {};
    for (int kind = 0; kind < 100; ++kind) {
        const auto p = someKind(dice);
        const auto law = std::make_shared<const CyclicLaw>(p);
        const auto e = law->equations({p.normalStiffness, p.shearStiffness});
        const double normal = dice.scale(1e-8, 1e-3), shear = dice.scale(1e-8, 1e-3);
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
            pending[j] = dice.once(share);
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

TEST_CASE("cyclic: energies of columns are those of the subcontacts times their areas") {
    Dice dice{std::mt19937_64(11)};
    for (int kind = 0; kind < 40; ++kind) {
        const auto p = someKind(dice);
        const auto law = std::make_shared<const CyclicLaw>(p);
        const ElasticStiffness k{p.normalStiffness, p.shearStiffness};
        const int joints = 37, points = 2;
        ColumnsSideBySide<CyclicLaw> columns(law, k, joints, points);
        std::vector<double> area(std::size_t(points) * columns.stride(), 1e300); // also in the padding
        double stored = 0, lost = 0, size = 0;
        for (int point = 0; point < points; ++point)
            for (int j = 0; j < joints; ++j) {
                for (int step = 0; step < 20; ++step) // the first joints stay elastic
                    columns.advanceOne(point, j, {(j < 16 ? 1e-9 : 1e-6) * dice.between(-2, 1), {j * 1e-9, -j * 1e-9}});
                const double each = area[point * columns.stride() + j] = 1e-3 * (1 + point) * (1 + j);
                stored += each * sum(law->stored(k, columns.get(point, j)));
                lost += each * sum(columns.dissipated(point, j));
                size +=
                    each * (sum(law->stored(k, columns.get(point, j))) + std::abs(sum(columns.dissipated(point, j))));
            }
        const auto sums = columns.energies(area.data(), false);
        CHECK(size > 0);
        CHECK(std::abs(sum(sums.stored) - stored) <= 1e-13 * size);
        CHECK(std::abs(sum(sums.dissipated) - lost) <= 1e-13 * size);
    }
}

TEST_CASE("cyclic: what is written into columns is read from them") {
    JointProperties p;
    p.law = "cyclic";
    const auto law = std::make_shared<const CyclicLaw>(p);
    ColumnsSideBySide<CyclicLaw> columns(law, {p.normalStiffness, p.shearStiffness}, 5, 2);
    CyclicState s;
    double value = 0;
    for (double* number :
         {&s.opening, &s.crushing, &s.dilation, &s.slip, &s.largestOpening, &s.largestClosure, &s.shearStress.a,
          &s.shearStress.b, &s.plasticSlip.a, &s.plasticSlip.b, &s.shearSoftening, &s.capDisplacement})
        *number = 1e-4 * ++value;
    s.opening = 1e-3;
    s.tensionDamage = 0.25;
    s.shearDamage = 0.5;
    s.shearStiffnessLoss = 0.125;
    s.regime = Regime::Slipping;
    columns.set(1, 4, s);
    s.normalStress = columns.get(1, 4).normalStress;
    CHECK(s.normalStress > 0);
    CHECK(difference(s, {}, columns.get(1, 4), {}) == "");
    CHECK(columns.get(1, 3).plasticSlip.a == 0);
}
