// SPDX-License-Identifier: GPL-2.0-or-later
// Threads that share the pieces of a short loop.
//
// A step has a handful of loops of some ten microseconds each, so a thread must begin within a microsecond, and must
// not keep the others waiting when it has no core. Each thread has a share of the loop, the same part in every step,
// whose numbers are then in its cache, and then takes pieces of the others' shares. So the caller can do the whole loop
// alone if no other thread comes in time, and waits only for pieces that another thread has begun. Threads with nothing
// to do look for work for a short while, and then sleep.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace masonry {

class Crew {
public:
    static constexpr int most = 60; // largest number of threads

    Crew() = default;
    ~Crew(); // ends the threads
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    // A loop: call(of, first, beyond) does the pieces from `first` to `beyond` - 1, in any order and on any thread.
    struct Loop {
        const void* of;
        void (*call)(const void* of, int first, int beyond);
        int pieces;
    };

    // Does all pieces of a loop on so many threads, the caller's among them. Only one thread may call this at a time.
    // If the system gives no further threads, those that there are do the work.
    void run(const Loop&, int threads);

private:
    struct alignas(64) Share {
        // Three numbers in 48, 8 and 8 bits: the loop, the first portion that nobody has taken, and the end of the
        // portions. A thread that comes late finds another loop, and takes nothing.
        std::atomic<std::uint64_t> next{0};
    };

    void grow(int threads);
    void work(int place, std::uint64_t turn);
    int take(int share, std::uint64_t turn);
    void serve(int place);

    Share shares_[most];
    alignas(64) std::atomic<std::uint64_t> turn_{0}; // number of the present loop
    alignas(64) std::atomic<int> done_{0};           // portions of the present loop that are done
    alignas(64) std::atomic<int> sleepers_{0};
    std::mutex mutex_; // guards the sleep of threads
    std::condition_variable called_;
    // The present loop. Whoever has taken a portion of it may read these; the caller changes them only when all
    // portions are done.
    Loop loop_{};
    int threads_ = 1, portions_ = 0;
    std::vector<std::thread> others_; // the threads beside the caller's
    std::atomic<bool> ends_{false};
};

} // namespace masonry
