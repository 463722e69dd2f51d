// SPDX-License-Identifier: GPL-2.0-or-later
// Takes the properties of a joint from any bytes. They must be refused with an error, or give a joint whose tables and
// law fulfil what PROMISE() checks here.
#include "law/Laws.hpp"
#include "law/common/ColumnsSideBySide.hpp"
#include "law/piecewise_softening/PiecewiseLaw.hpp"
#include "law/piecewise_softening/PiecewiseSideBySide.hpp"
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>

using namespace masonry;

namespace {

#define PROMISE(kept) ((kept) ? void() : broken(#kept))
[[noreturn]] void broken(const char* promise) {
    std::fprintf(stderr, "broken: %s\n", promise);
    std::abort();
}

// Draws numbers from the bytes of the fuzzer.
class Dice {
public:
    Dice(const std::uint8_t* data, std::size_t size) : at_(data), remaining_(size) {}
    std::uint8_t byte() { return remaining_ ? (--remaining_, *at_++) : 0; }
    double raw() { // any bit pattern of a double
        double value = 0;
        unsigned char bytes[sizeof value];
        for (auto& b : bytes)
            b = byte();
        std::memcpy(&value, bytes, sizeof value);
        return value;
    }
    double factor() { return std::exp2(std::int8_t(byte()) / 4.0); } // 2^-32 to 2^32
    bool wild() const { return wild_; } // whether a number drawn was outside of these sizes

    double about(double usual) { // often the usual number, often another size of it, seldom any double
        const int kind = byte() % 8;
        if (kind == 7) return wild_ = true, raw();
        return kind < 4 ? usual : usual * factor();
    }
    std::vector<TableRow> table() {
        std::vector<TableRow> rows(byte() % 12);
        const bool rising = byte() % 4;
        TableRow last{1, 0};
        for (auto& row : rows) {
            row = last;
            const double ratio = rising ? last.ratio + factor() : raw();
            const double damage = rising ? last.damage + (1 - last.damage) * byte() / 255.0 : raw();
            last = {ratio, damage};
        }
        return rows;
    }

private:
    const std::uint8_t* at_;
    std::size_t remaining_;
    bool wild_ = false;
};

// Wherever lumped units move the rows to, damage never falls and both ways of reading agree.
void check(const SofteningTable& table, double shift = 0) {
    double before = 0, highest = 0;
    std::int32_t hint = 0;
    const auto at = [&](double ratio) {
        if (!(ratio >= highest)) return; // rows closer than numbers can tell
        highest = ratio;
        const double damage = table.damage(ratio, shift);
        PROMISE(damage >= before - (shift ? 1e-12 : 0) && damage >= 0 && damage <= 1);
        PROMISE(table.damage(ratio, shift, hint) == damage);
        before = std::max(before, damage);
    };
    for (const auto& row : table.rows())
        for (double part : {0.5, 1., 1.5})
            if (shift) at(row.ratio * part + shift * (1 - row.damage));
    for (std::size_t i = 0; !shift && i < table.rows().size(); ++i) {
        const auto& row = table.rows()[i];
        at(row.ratio);
        if (i + 1 == table.rows().size()) continue;
        const double next = table.rows()[i + 1].ratio;
        PROMISE(next >= row.ratio); // equal where an exponential is steeper than numbers can tell
        PROMISE(next == row.ratio || table.damage(row.ratio) == (row.ratio > 1 ? row.damage : 0));
        for (double part : {0.25, 0.5, 0.75})
            at(row.ratio + part * (next - row.ratio));
        at(std::nextafter(next, 0));
    }
    at(HUGE_VAL);
    if (shift && !table.rows().empty()) PROMISE(before == table.rows().back().damage);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Dice dice(data, size);
    JointProperties p;
    for (double* number :
         {&p.normalStiffness, &p.shearStiffness, &p.tensileStrength, &p.modeIFractureEnergy, &p.cohesion,
          &p.residualCohesion, &p.friction, &p.residualFriction, &p.dilatancy, &p.dilatancyDecay,
          &p.modeIIFractureEnergy, &p.compressiveStrength, &p.elasticLimitRatio, &p.residualStrengthRatio, &p.peakRatio,
          &p.compressiveFractureEnergy, &p.capNormal, &p.capShear, &p.capLinear})
        *number = dice.about(*number);
    p.elastic = dice.byte() % 8 == 7, p.cap = dice.byte() % 2;
    p.tensionTable = dice.table(), p.shearTable = dice.table();
    for (const auto* rows : {&p.tensionTable, &p.shearTable})
        if (SofteningTable::problems(*rows).empty()) {
            const SofteningTable table(*rows);
            check(table), check(table, dice.factor()), check(table, std::min(0.999999 / table.steepest(), 1e12));
        }

    const auto problems = problemsOf(p);
    std::shared_ptr<const PiecewiseLaw> law;
    try {
        law = std::make_shared<const PiecewiseLaw>(p);
    } catch (const std::invalid_argument& refusal) {
        PROMISE(!problems.empty() && *refusal.what());
        return 0;
    }
    PROMISE(problems.empty());
    check(law->tension()), check(law->shear());
    const double softer = 1 / (1 + std::abs(dice.factor()));
    const ElasticStiffness k{p.normalStiffness * softer, p.shearStiffness * softer};
    const PiecewiseEquations equations = law->equations(k);
    // A shift is infinite over a stiffness of 1e-309 Pa/m.
    if (std::isfinite(equations.normalShift)) check(law->tension(), equations.normalShift);
    if (std::isfinite(equations.shearShift)) check(law->shear(), equations.shearShift);
    for (const auto& sentence : law->snapsBack(k, 0.1))
        PROMISE(!sentence.empty());
    ColumnsSideBySide<PiecewiseLaw> columns(law, k, 1, 1);
    for (int step = 0; step < 24; ++step) {
        const auto jump = [&] { return (dice.byte() - 127) * 1e-6 * dice.factor(); };
        const PiecewiseState old = columns.get(0, 0);
        columns.advanceOne(0, 0, {jump(), {jump(), jump()}});
        const PiecewiseState state = columns.get(0, 0);
        if (dice.wild()) continue; // numbers of any size may overflow
        PROMISE(std::isfinite(state.normalStress) && std::isfinite(state.shearStress.a + state.shearStress.b));
        PROMISE(state.tensionDamage >= old.tensionDamage && state.tensionDamage <= 1);
        PROMISE(state.shearDamage >= old.shearDamage && state.shearDamage <= 1);
        PROMISE(state.slip >= old.slip && state.crushing >= old.crushing && state.dilation >= old.dilation);
    }
    return 0;
}
