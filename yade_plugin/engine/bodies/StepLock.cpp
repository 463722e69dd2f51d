// SPDX-License-Identifier: GPL-2.0-or-later
#include "StepLock.hpp"
#include "common/Parallel.hpp"
#include "host/Yade.hpp"
#include <chrono>
#include <new>
#include <omp.h>
#include <pthread.h>

namespace masonry {

namespace {

// Releases Python's interpreter while this thread waits, because the thread for which it waits may need the
// interpreter.
class WithoutInterpreter {
public:
    WithoutInterpreter() : state_(PyGILState_Check() ? PyEval_SaveThread() : nullptr) {}
    ~WithoutInterpreter() {
        if (state_) PyEval_RestoreThread(state_);
    }

private:
    PyThreadState* state_;
};

bool runsInBackground() { return Singleton<yade::Omega>::instance().isRunning(); }

} // namespace

StepLock& StepLock::instance() {
    static StepLock gate;
    return gate;
}

// Never waits for the interpreter while it holds the mutex. A thread that holds the interpreter may be waiting for the
// mutex, and the two would then wait for each other.
template <class Ready> void StepLock::wait(std::unique_lock<std::mutex>& held, Ready&& ready) {
    while (!ready()) { // again, because another thread may have gone first while this one took the interpreter back
        held.unlock();
        {
            const WithoutInterpreter free;
            held.lock();
            while (!ready())
                changed_.wait_for(held, std::chrono::milliseconds(20));
            held.unlock();
        }
        held.lock();
    }
}

void StepLock::enter() {
    std::unique_lock<std::mutex> held(mutex_);
    const auto me = std::this_thread::get_id();
    wait(held, [&] {
        if (acting_ && stepper_ != me)
            return false; // O.pause() does not wait for the end of a step, and O.step() may follow
        return (depth_ == 0 || reader_ == me) && (inStep_ || waiting_ == 0);
    });
    stepper_ = me;
    acting_ = inStep_ = true;
}

void StepLock::exit(bool stepDone) {
    const std::lock_guard<std::mutex> held(mutex_);
    acting_ = false;
    if (stepDone) inStep_ = false;
    if (waiting_ > 0) changed_.notify_all();
}

void StepLock::lock() {
    std::unique_lock<std::mutex> held(mutex_);
    const auto me = std::this_thread::get_id();
    const bool nested = depth_ > 0 && reader_ == me;
    const bool ownAction = acting_ && stepper_ == me;
    if (!nested && !ownAction) {
        ++waiting_;
        wait(held, [&] {
            if (depth_ > 0 || acting_) return false;
            // A step that failed may never have called exit(), so it is not waited for once the run has ended.
            return !inStep_ || stepper_ == me || !runsInBackground();
        });
        --waiting_;
        reader_ = me;
    }
    ++depth_;
    if (ownAction && depth_ == 1) reader_ = me;
}

void StepLock::watchForks() {
    pthread_atfork([] { instance().lock(); }, [] { instance().unlock(); }, [] { instance().startAnew(); });
}

// Other threads may have held the mutex, or waited, when the process was forked. They are gone, so both are made anew.
void StepLock::startAnew() {
    const int depth = depth_ - 1; // without the lock of the fork
    const auto reader = reader_;
    new (this) StepLock;
    depth_ = depth;
    reader_ = reader;
    omp_set_num_threads(1);
    Parallel::instance().allow(1);
}

void StepLock::unlock() {
    const std::lock_guard<std::mutex> held(mutex_);
    if (--depth_ == 0) changed_.notify_all();
}

} // namespace masonry
