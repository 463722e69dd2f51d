// SPDX-License-Identifier: GPL-2.0-or-later
// Measures the time that the law takes for one subcontact and one step, in columns and one by one. It is a program of
// its own and not a test:
//   cmake -S . -B build -DMASONRY_BENCHMARKS=ON && make -C build benchmark_law && build/benchmark_law
#include "law/common/ColumnsSideBySide.hpp"
#include "law/cyclic_softening/CyclicColumns.hpp"
#include "law/cyclic_softening/CyclicLaw.hpp"
#include "law/piecewise_softening/PiecewiseLaw.hpp"
#include "law/piecewise_softening/PiecewiseSideBySide.hpp"
#include <algorithm>
#include <benchmark/benchmark.h>

using namespace masonry;

namespace {

constexpr int joints = 816, points = 12; // as many subcontacts as COMP-4 has
constexpr int size = joints * points;
constexpr int most = Columns::most;

// The first jump brings subcontacts into a regime; the jumps after it keep them there.
struct Regime {
    const char* name;
    Jump before, jump;
    bool turns;           // whether the jump changes its sign with every step
    int every = 1;        // every how many joints one moves; the others are at rest
    double dilatancy = 0; // [-]
};
const Jump press{-1e-6, {}}; // to 0.34 MPa
const Jump crush{-1e-4, {}}; // beyond the elastic limit
const Jump crack{2e-6, {}};  // beyond the tensile strength
const Jump slipped{-1e-6, {1e-5, 0}};
const Jump rest{1e-10, {1e-11, 0}};
const Regime regimes[] = {{"elastic", press, rest, true},
                          {"cracked and elastic", crack, {-1e-10, {}}, true},
                          {"slipping", press, {0, {1e-7, 0}}, false},
                          {"dilating", press, {0, {1e-7, 0}}, false, 1, 0.1},
                          {"opening", press, {1e-7, {0, 0}}, false},
                          {"crushing", crush, {-1e-7, {0, 0}}, false},
                          {"one in eight slipping", press, {0, {1e-7, 0}}, false, 8},
                          {"one in eight opening", crack, {1e-7, {}}, false, 8},
                          {"one in eight crushing", crush, {-1e-7, {}}, false, 8}};

JointProperties kind(const Regime& regime) {
    JointProperties bed;
    bed.dilatancy = regime.dilatancy;
    return bed;
}

Jump jumpOf(const Regime& regime, int joint, double sign) {
    const Jump& jump = joint % regime.every == 0 ? regime.jump : rest;
    return {sign * jump.opening, {sign * jump.slide.a, 0}};
}

void report(benchmark::State& state) {
    state.counters["ns a subcontact"] =
        benchmark::Counter(double(size), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class LawType> void columns(benchmark::State& state, const Regime& regime) {
    const auto law = std::make_shared<const LawType>(kind(regime));
    const auto& bed = law->properties();
    ColumnsSideBySide<LawType> all(law, {bed.normalStiffness, bed.shearStiffness}, joints, points);
    std::vector<double> n(joints), a(joints), sigma(joints);
    const auto jump = [&](double sign) {
        for (int j = 0; j < joints; ++j) {
            n[j] = jumpOf(regime, j, sign).opening;
            a[j] = jumpOf(regime, j, sign).slide.a;
        }
    };
    const auto step = [&] {
        for (int from = 0; from < joints; from += most)
            for (int point = 0; point < points; ++point)
                all.advance(point, from, std::min(most, joints - from), &n[from], &a[from], nullptr, &sigma[from]);
    };
    std::fill(n.begin(), n.end(), regime.before.opening);
    std::fill(a.begin(), a.end(), regime.before.slide.a);
    step();
    double sign = 1;
    jump(sign);
    for (auto _ : state) {
        step();
        if (!regime.turns) continue;
        state.PauseTiming();
        sign = -sign;
        jump(sign);
        state.ResumeTiming();
    }
    report(state);
}

void oneByOne(benchmark::State& state, const Regime& regime) {
    const PiecewiseLaw law(kind(regime));
    const auto& bed = law.properties();
    const PiecewiseEquations equations = law.equations({bed.normalStiffness, bed.shearStiffness});
    std::vector<PiecewiseState> all(size);
    for (auto& s : all)
        law.advance(equations, s, regime.before);
    double sign = 1;
    for (auto _ : state) {
        for (int i = 0; i < size; ++i)
            benchmark::DoNotOptimize(law.advance(equations, all[i], jumpOf(regime, i % joints, sign)));
        if (regime.turns) sign = -sign;
    }
    report(state);
}

void energies(benchmark::State& state, const Regime& regime) {
    const auto law = std::make_shared<const PiecewiseLaw>(kind(regime));
    const auto& bed = law->properties();
    ColumnsSideBySide<PiecewiseLaw> all(law, {bed.normalStiffness, bed.shearStiffness}, joints, points);
    for (int point = 0; point < points; ++point)
        for (int j = 0; j < joints; ++j)
            all.advanceOne(point, j, regime.before);
    const std::vector<double> area(std::size_t(points) * most, 1e-3);
    for (auto _ : state)
        benchmark::DoNotOptimize(all.energies(area.data(), true));
    report(state);
}

} // namespace

int main(int count, char** words) {
    for (const auto& regime : regimes) {
        const auto named = [&](const char* variant) { return std::string(variant) + "/" + regime.name; };
        benchmark::RegisterBenchmark(named("columns").c_str(), columns<PiecewiseLaw>, regime)->Iterations(300);
        benchmark::RegisterBenchmark(named("cyclic columns").c_str(), columns<CyclicLaw>, regime)->Iterations(300);
        benchmark::RegisterBenchmark(named("one by one").c_str(), oneByOne, regime)->Iterations(300);
    }
    benchmark::RegisterBenchmark("energies/elastic", energies, regimes[0])->Iterations(300);
    benchmark::RegisterBenchmark("energies/crushing", energies, regimes[5])->Iterations(300);
    benchmark::Initialize(&count, words);
    benchmark::RunSpecifiedBenchmarks();
}
