// SPDX-License-Identifier: GPL-2.0-or-later
// The choice of the number of threads, and loops that threads share.
#include "common/Crew.hpp"
#include "common/Parallel.hpp"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <random>
#include <set>
#include <thread>
#include <vector>

using namespace masonry;

namespace {

// Takes steps for some time of its own clock, in which a step takes what `cost` says. Returns the share of the time
// that these steps took beyond those on the best number of threads.
double ride(ThreadChoice& choice, double seconds, const std::function<double(int threads)>& cost) {
    double best = HUGE_VAL, time = 0;
    int steps = 0;
    for (int threads = 1; threads <= 16; threads *= 2)
        best = std::min(best, cost(threads));
    for (; time < seconds; ++steps) {
        const double took = cost(choice.threads());
        time += took;
        choice.stepTook(took);
    }
    return time / (steps * best) - 1;
}

double idle(int threads) { return threads == 1 ? 100e-6 : 60e-6; }

// A loop over pieces that is shared, as Parallel hands it over.
template <class Body> void share(Crew& crew, const Body& body, int pieces, int threads) {
    const auto call = [](const void* of, int first, int beyond) { (*static_cast<const Body*>(of))(first, beyond); };
    crew.run({&body, call, pieces}, threads);
}

} // namespace

TEST_CASE("one thread is all there is where no more are allowed") {
    ThreadChoice choice(1);
    for (int n = 0; n < 1000; ++n)
        choice.stepTook(0.01);
    CHECK(choice.threads() == 1);
    CHECK(choice.records().size() == 1);
    CHECK(choice.records()[0].steps == 1000);
    CHECK(choice.records()[0].time == doctest::Approx(10));
}

TEST_CASE("more threads are taken where they are quicker, and trials of fewer cost little") {
    ThreadChoice choice(2);
    CHECK(ride(choice, 10, idle) < 0.01);
    CHECK(choice.records()[1].steps > 50 * choice.records()[0].steps);
}

TEST_CASE("one thread is taken where more are slower, however much slower") {
    for (double times : {1.02, 1.5, 4.0, 50.0}) {
        ThreadChoice choice(2);
        const auto busy = [&](int threads) { return threads == 1 ? 100e-6 : times * 100e-6; };
        ride(choice, 0.5, busy); // the first trial
        CHECK_MESSAGE(ride(choice, 20, busy) < 0.04, times);
    }
}

TEST_CASE("the best of sixteen numbers is found, also if it is none of the ends") {
    ThreadChoice choice(16);
    const auto cost = [](int threads) { return 1e-3 / threads + 25e-6 * threads; }; // least at about six
    CHECK(ride(choice, 5, cost) < 0.03);
    const auto& records = choice.records();
    const auto most = std::max_element(records.begin(), records.end(),
                                       [](const auto& a, const auto& b) { return a.steps < b.steps; });
    CHECK((most->threads == 4 || most->threads == 8));
}

TEST_CASE("a machine that becomes busy, and idle again, is noticed within a second") {
    ThreadChoice choice(2);
    const auto busy = [](int threads) { return threads == 1 ? 130e-6 : 400e-6; };
    ride(choice, 5, idle);
    CHECK(choice.threads() == 2);
    ride(choice, 0.2, busy);
    CHECK(ride(choice, 5, busy) < 0.1);
    ride(choice, 3, idle);
    CHECK(ride(choice, 5, idle) < 0.02);
}

TEST_CASE("steps that take very different times do not lead to the slower number") {
    // As on a machine whose cores are shared: a step is held up for some milliseconds, more often on two threads.
    std::mt19937 dice(5);
    std::uniform_real_distribution<> chance;
    ThreadChoice choice(2);
    double wasted = 0, time = 0;
    while (time < 60) {
        const bool two = choice.threads() == 2;
        const double took = (two ? 60e-6 : 100e-6) + (chance(dice) < (two ? 0.1 : 0.03) ? 3e-3 : 0);
        time += took;
        wasted += two ? took : 0;
        choice.stepTook(took);
    }
    CHECK(wasted < 0.15 * time); // of trials, which cost a half of that
}

TEST_CASE("a scene that has changed is measured anew") {
    ThreadChoice choice(2);
    ride(choice, 3, idle);
    CHECK(choice.threads() == 2);
    choice.forget();
    CHECK(choice.threads() == 1);
    CHECK(choice.records()[1].steps > 0); // what was counted stays
}

TEST_CASE("every piece of a loop is done once, on any number of threads") {
    Crew crew;
    std::mt19937 dice(3);
    for (int n = 0; n < 20000; ++n) {
        const int pieces = std::uniform_int_distribution<>(1, n % 50 == 0 ? 2000 : 40)(dice);
        const int threads = std::uniform_int_distribution<>(1, 5)(dice);
        std::vector<int> times(pieces, 0); // every place is written by one thread
        const auto body = [&](int first, int beyond) {
            for (int i = first; i < beyond; ++i)
                ++times[i];
        };
        share(crew, body, pieces, threads);
        REQUIRE(std::all_of(times.begin(), times.end(), [](int count) { return count == 1; }));
    }
}

TEST_CASE("a loop ends although a thread comes late, and threads that slept are woken") {
    Crew crew;
    std::mutex guard;
    std::set<std::thread::id> seen;
    const auto body = [&](int, int) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const std::lock_guard<std::mutex> held(guard);
        seen.insert(std::this_thread::get_id());
    };
    for (int n = 0; n < 20; ++n) {
        share(crew, body, 24, 3);
        std::this_thread::sleep_for(std::chrono::milliseconds(2)); // longer than their patience
    }
    CHECK(seen.size() == 3);
}

TEST_CASE("loops over numbers cover them all, with pieces of the size that is asked for") {
    auto& parallel = Parallel::instance();
    for (int threads : {1, 2, 4}) {
        parallel.allow(threads, true);
        for (int count : {0, 1, 63, 64, 65, 1000}) {
            std::vector<int> times(count, 0);
            std::atomic<bool> whole{true};
            parallel.overPieces(count, 64, [&](int first, int beyond) {
                if (first % 64 || (beyond % 64 && beyond != count)) whole = false;
                for (int i = first; i < beyond; ++i)
                    ++times[i];
            });
            CHECK(whole);
            CHECK(std::all_of(times.begin(), times.end(), [](int n) { return n == 1; }));
        }
    }
    parallel.allow(1);
}
