// Cost of the law a subcontact and step, in columns and one by one: a build of its own, not a test.
//   cmake -S . -B build -DMASONRY_BENCHMARKS=ON && make -C build benchmark_law && build/benchmark_law
#include "law/JointColumns.hpp"
#include <benchmark/benchmark.h>

using namespace masonry;

namespace {

constexpr int size = 9792, range = 32; // as many as COMP-4 has, and as many as MasonryJointLoop takes at a time

// Jumps that keep all subcontacts in one regime, after a closure that presses them to 0.34 MPa.
struct Regime {
    const char* name;
    Jump jump;
    bool turns; // whether the jump changes its sign with every step
};
const Regime regimes[] = {{"elastic", {1e-10, {1e-11, 0}}, true},
                          {"slipping", {0, {1e-7, 0}}, false},
                          {"opening", {1e-7, {0, 0}}, false},
                          {"crushing", {-1e-7, {0, 0}}, false}};
const Jump press{-1e-6, {}}, crush{-1e-4, {}};

void report(benchmark::State& state) {
    state.counters["ns a subcontact"] =
        benchmark::Counter(double(size), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void columns(benchmark::State& state, const Regime& regime) {
    const JointProperties bed;
    const JointLaw law(bed);
    JointColumns all(law, {bed.normalStiffness, bed.shearStiffness}, size);
    std::vector<double> n(size), a(size), b(size), sigma(size);
    const auto step = [&](const Jump& jump) {
        std::fill(n.begin(), n.end(), jump.opening), std::fill(a.begin(), a.end(), jump.slide.a);
        for (int i = 0; i < size; i += range)
            all.advance(law, i, range, &n[i], &a[i], &b[i], &sigma[i]);
    };
    step(regime.jump.opening < 0 ? crush : press);
    double sign = 1;
    for (auto _ : state) {
        for (int i = 0; i < size; i += range)
            all.advance(law, i, range, &n[i], &a[i], &b[i], &sigma[i]);
        state.PauseTiming();
        if (regime.turns) sign = -sign;
        std::fill(n.begin(), n.end(), sign * regime.jump.opening);
        std::fill(a.begin(), a.end(), sign * regime.jump.slide.a);
        state.ResumeTiming();
    }
    report(state);
}

void oneByOne(benchmark::State& state, const Regime& regime) {
    const JointProperties bed;
    const JointLaw law(bed);
    const ElasticStiffness k{bed.normalStiffness, bed.shearStiffness};
    std::vector<JointState> all(size);
    for (auto& s : all)
        law.advance(k, s, regime.jump.opening < 0 ? crush : press);
    double sign = 1;
    for (auto _ : state) {
        const Jump jump{sign * regime.jump.opening, {sign * regime.jump.slide.a, 0}};
        for (auto& s : all)
            benchmark::DoNotOptimize(law.advance(k, s, jump));
        if (regime.turns) sign = -sign;
    }
    report(state);
}

} // namespace

int main(int count, char** words) {
    for (const auto& regime : regimes) {
        benchmark::RegisterBenchmark((std::string("columns/") + regime.name).c_str(), columns, regime)->Iterations(300);
        benchmark::RegisterBenchmark((std::string("one by one/") + regime.name).c_str(), oneByOne, regime)
            ->Iterations(300);
    }
    benchmark::Initialize(&count, words);
    benchmark::RunSpecifiedBenchmarks();
}
