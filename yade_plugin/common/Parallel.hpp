// SPDX-License-Identifier: GPL-2.0-or-later
// Loops of a step on several threads, if that is quicker than on one.
//
// That depends on the scene and on what else the machine does: where other programs use all cores, a step on two
// threads takes several times as long as on one, because a thread without a core keeps the other waiting. So it is
// measured while the run goes on. All loops give the same bits on any number of threads, which may change from step to
// step.
#pragma once
#include "Crew.hpp"
#include <algorithm>
#include <chrono>
#include <vector>

namespace masonry {

// Chooses the number of threads by the time that steps take. It knows nothing of loops and threads.
class ThreadChoice {
public:
    using Seconds = double;

    // `most` threads may be used, at least one.
    explicit ThreadChoice(int most = 1);

    // The number of threads for the next step.
    int threads() const { return counts_[present_]; }
    // Takes notice of how long so many steps took each with that number.
    void stepTook(Seconds time, int steps = 1);
    // The scene has changed, so what was measured is no longer true.
    void forget();

    struct Record {
        int threads;
        long steps = 0;
        Seconds time = 0;   // of all these steps
        Seconds recent = 0; // mean time of a step in the last windows, 0 before the first
    };
    const std::vector<Record>& records() const { return records_; }

private:
    void endWindow();
    void judge();
    void settleFor(Seconds pause);
    void go(int place);

    std::vector<int> counts_; // numbers of threads that are tried: 1, 2, 4, … and the largest
    std::vector<Record> records_;
    int present_ = 0; // place in counts_ of the number that is used now
    int best_ = 0;    // place of the number that is used when nothing is tried
    int next_ = 1;    // how far from the best the next trial is: 1 upwards, -1 downwards
    long steps_ = 0;  // of the present window, or trial
    Seconds time_ = 0;
    Seconds due_ = 0;   // the time at which it is looked at
    Seconds pause_ = 0; // until the next trial
    int confirmed_ = 0; // how many trials have found no better number since the last change
};

class Parallel {
public:
    static Parallel& instance();

    // The largest number of threads that loops may use [-], 1 when the process begins. `always`: they are used in every
    // step, without measuring whether that is quicker, for tests and benchmarks.
    void allow(int threads, bool always = false);
    int allowed() const { return allowed_; }
    const ThreadChoice& choice() const { return choice_; }

    // To be called before the first loop of every step.
    void stepBegins();
    // To be called when another scene, or a changed one, is stepped from now on.
    void sceneChanged() { choice_.forget(); }

    // Calls body(first, beyond) for the pieces of the numbers from 0 to count - 1, each with `piece` of them but the
    // last. Any thread may take any piece, so the body must give the same result in any order.
    template <class Body> void overPieces(int count, int piece, const Body& body) {
        const auto pieces = [&](int first, int beyond) { body(first * piece, std::min(count, beyond * piece)); };
        run({&pieces,
             [](const void* of, int first, int beyond) { (*static_cast<decltype(&pieces)>(of))(first, beyond); },
             (count + piece - 1) / piece});
    }

private:
    void run(const Crew::Loop&);

    Crew* crew_ = nullptr; // never destroyed: its threads may be at work when the process ends
    int allowed_ = 1;
    bool always_ = false;
    ThreadChoice choice_;
    bool timed_ = false;                          // whether the present step is timed
    int until_ = 1;                               // how many steps from now the next one is timed
    std::chrono::steady_clock::duration spent_{}; // in the loops of the present step, if it is timed
};

} // namespace masonry
