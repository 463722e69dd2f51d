// SPDX-License-Identifier: GPL-2.0-or-later
// Keeps Python and the engines of a running scene apart, so that attributes can be read and set at YADE's prompt while
// O.run() works in the background. A reader, any thread that reads or changes attributes, waits until a step has ended,
// and a step waits until no reader is at work.
#pragma once
#include <condition_variable>
#include <mutex>
#include <thread>

namespace masonry {

class StepLock {
public:
    static StepLock& instance();

    // To be called at the beginning and at the end of an engine's action; no two threads act at once. `stepDone`: the
    // last of this plugin's engines in the step has ended, or the step has failed.
    void enter();
    void exit(bool stepDone);

    // To be called before and after attributes are read or changed. May be nested in one thread. The thread that makes
    // the step may also call them within the step, as the Python code of a PyRunner does.
    void lock();
    void unlock();

    // Lets the process be forked between two steps only. A forked process has none of the other threads: neither that
    // of O.run() nor those of the loops, for which it would wait without end.
    static void watchForks();

private:
    void startAnew();
    template <class Ready> void wait(std::unique_lock<std::mutex>&, Ready&& ready);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::thread::id stepper_; // the thread that makes steps
    std::thread::id reader_;  // the thread that reads now
    bool acting_ = false;     // whether an engine is at work
    bool inStep_ = false;     // whether a step has begun and has not ended
    int depth_ = 0;           // how many times the reader has called lock() without unlock()
    int waiting_ = 0;         // number of readers that wait
};

// While this exists, no step begins, and the present thread may read and change attributes.
class BetweenSteps {
public:
    BetweenSteps() { StepLock::instance().lock(); }
    ~BetweenSteps() { StepLock::instance().unlock(); }
    BetweenSteps(const BetweenSteps&) = delete;
    BetweenSteps& operator=(const BetweenSteps&) = delete;
};

} // namespace masonry
