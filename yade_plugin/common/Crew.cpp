// SPDX-License-Identifier: GPL-2.0-or-later
#include "Crew.hpp"
#include <algorithm>
#include <chrono>
#include <csignal>
#include <system_error>

namespace masonry {

namespace {

constexpr int portionsAThread = 4; // into how many portions a share is cut
// A thread that has nothing to do looks for work so long before it sleeps [s]. A step of a wall takes about as long,
// and to wake a thread takes half of that.
constexpr double patience = 1e-4;

void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

// Looks until something is so, for `patience` at most. Returns whether it is.
template <class Ready> bool lookFor(const Ready& ready) {
    const auto began = std::chrono::steady_clock::now();
    do {
        for (int n = 0; n < 200; ++n) {
            if (ready()) return true;
            pause();
        }
    } while (std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() < patience);
    return false;
}

} // namespace

void Crew::run(const Loop& loop, int threads) {
    grow(std::min(threads, most));
    threads = std::min(threads, int(others_.size()) + 1);
    const std::uint64_t turn = turn_.load(std::memory_order_relaxed) + 1;
    loop_ = loop;
    threads_ = threads;
    portions_ = std::min({loop.pieces, threads * portionsAThread, 255});
    done_.store(0, std::memory_order_relaxed);
    for (int n = 0; n < threads; ++n) {
        const std::uint64_t first = n * portions_ / threads, beyond = (n + 1) * portions_ / threads;
        shares_[n].next.store(turn << 16 | first << 8 | beyond, std::memory_order_release);
    }
    turn_.store(turn); // in one order with `sleepers_` for all threads: either they see the turn, or this sees them
    if (sleepers_.load() > 0) {
        { const std::lock_guard<std::mutex> held(mutex_); }
        called_.notify_all();
    }
    work(0, turn);
    const auto finished = [this] { return done_.load(std::memory_order_acquire) == portions_; };
    while (!lookFor(finished))
        std::this_thread::yield(); // a thread that has begun may have lost its core
}

// Takes a portion of a share. Returns its number, or -1 if all are taken.
int Crew::take(int share, std::uint64_t turn) {
    auto& next = shares_[share].next;
    std::uint64_t seen = next.load(std::memory_order_acquire);
    for (;;) {
        const int first = int(seen >> 8 & 255), beyond = int(seen & 255);
        if (seen >> 16 != turn || first >= beyond) return -1;
        if (next.compare_exchange_strong(seen, seen + 256, std::memory_order_acq_rel)) return first;
    }
}

// Does portions of the present loop, those of the own share first, until all are taken.
void Crew::work(int place, std::uint64_t turn) {
    int did = 0;
    int threads = 1; // is known when a portion was taken
    for (int n = 0; n < threads || n == 0; ++n) {
        const int share = n == 0 ? place : (place + n) % threads;
        for (int portion; (portion = take(share, turn)) >= 0; ++did) {
            threads = threads_;
            const auto edge = [this](int number) { return int(std::int64_t(loop_.pieces) * number / portions_); };
            loop_.call(loop_.of, edge(portion), edge(portion + 1));
        }
    }
    if (did > 0) done_.fetch_add(did, std::memory_order_release);
}

void Crew::serve(int place) {
    std::uint64_t seen = 0;
    for (;;) {
        const auto called = [&] { return turn_.load(std::memory_order_acquire) != seen; };
        if (!lookFor(called)) {
            std::unique_lock<std::mutex> held(mutex_);
            sleepers_.fetch_add(1);
            called_.wait(held, [&] { return turn_.load() != seen; });
            sleepers_.fetch_sub(1);
        }
        if (ends_) return;
        seen = turn_.load(std::memory_order_acquire);
        work(place, seen);
    }
}

Crew::~Crew() {
    ends_ = true;
    {
        const std::lock_guard<std::mutex> held(mutex_);
        turn_.fetch_add(1);
    }
    called_.notify_all();
    for (auto& thread : others_)
        thread.join();
}

void Crew::grow(int threads) {
    if (int(others_.size()) + 1 >= threads) return;
    sigset_t all, before; // signals are for the threads of the host
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    try {
        while (int(others_.size()) + 1 < threads)
            others_.emplace_back([this, place = int(others_.size()) + 1] { serve(place); });
    } catch (const std::system_error&) { // a limit of the system
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

} // namespace masonry
