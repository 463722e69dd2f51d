// SPDX-License-Identifier: GPL-2.0-or-later
#include "Parallel.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

namespace {

// Where many programs share the cores, each runs for some milliseconds at a time. A window holds several of these
// turns, and what a single window says is still off by a third.
constexpr double window = 0.02;  // time in which steps are looked at together [s]
constexpr double trial = 0.1;    // time for which another number of threads is tried before it is taken [s]
constexpr double hopeless = 1.1; // of the time of the best number, above which a trial ends after a window [-]
constexpr double gain = 0.97;    // of the time of the best number, below which more threads take its place [-]
constexpr double worst = 0.03;   // share of a run's time that trials of a slower number may cost [-]
constexpr double rest = 0.2;     // shortest time between two trials [s]
constexpr double longest = 2;    // longest time between two trials [s]
constexpr double newest = 0.25;  // weight of the last window in the mean of the last windows [-]
// Steps that take less than this [s] are timed one in so many, because the clock takes some hundredths of them.
constexpr double quick = 5e-5;
constexpr int timedOfQuick = 8;

} // namespace

ThreadChoice::ThreadChoice(int most) {
    for (int n = 1; n < most; n *= 2)
        counts_.push_back(n);
    counts_.push_back(std::max(1, most));
    for (int n : counts_)
        records_.push_back({n});
    go(0);
}

void ThreadChoice::forget() {
    for (auto& record : records_)
        record.recent = 0;
    best_ = confirmed_ = 0;
    next_ = 1;
    pause_ = 0;
    go(best_);
}

void ThreadChoice::stepTook(Seconds time, int steps) {
    auto& record = records_[present_];
    record.steps += steps;
    record.time += steps * time;
    if (counts_.size() == 1) return;
    steps_ += steps;
    time_ += steps * time;
    if (time_ < due_) return;
    present_ == best_ ? endWindow() : judge();
}

void ThreadChoice::go(int place) {
    present_ = place;
    steps_ = 0;
    time_ = 0;
    due_ = window;
}

// The best number was used for a window.
void ThreadChoice::endWindow() {
    auto& recent = records_[best_].recent;
    const double mean = time_ / double(steps_);
    recent = recent > 0 ? recent + newest * (mean - recent) : mean;
    pause_ -= time_;
    // More threads than one have become slower than fewer were: other programs may need the cores now.
    const bool slower = best_ > 0 && recent > records_[best_ - 1].recent;
    if (slower) next_ = -1;
    if (pause_ > 0 && !slower) return go(best_);
    const int place = best_ + next_;
    go(place >= 0 && place < int(counts_.size()) ? place : best_ - next_);
}

// Another number is tried.
void ThreadChoice::judge() {
    const double mean = time_ / double(steps_), best = records_[best_].recent;
    if (mean <= hopeless * best && time_ < trial) {
        due_ = time_ + window;
        return;
    }
    records_[present_].recent = mean;
    const bool more = present_ > best_;
    if (mean < (more ? gain : 1.0) * best) {
        next_ = more ? 1 : -1; // it may pay to go further in this direction
        best_ = present_;
        confirmed_ = 0;
        const int further = best_ + next_;
        pause_ = 0;
        if (further < 0 || further >= int(counts_.size())) settleFor(0);
    } else {
        next_ = -next_;
        ++confirmed_;
        settleFor((time_ - double(steps_) * best) / worst);
    }
    go(best_);
}

// Trials become rare where they find nothing new, and the rarer the more they cost.
void ThreadChoice::settleFor(Seconds pause) {
    pause_ = std::max(pause, std::min(longest, rest * std::pow(2.0, confirmed_)));
}

// ---- loops ------------------------------------------------------------------------------------------------------

Parallel& Parallel::instance() {
    static auto& one = *new Parallel; // never destroyed: threads may be at work when the process ends
    return one;
}

void Parallel::allow(int threads, bool always) {
    allowed_ = std::clamp(threads, 1, Crew::most);
    always_ = always;
    choice_ = ThreadChoice(allowed_);
    timed_ = false;
    until_ = 1;
    if (allowed_ > 1 && !crew_) crew_ = new Crew;
}

void Parallel::stepBegins() {
    if (allowed_ == 1 || always_) return;
    if (timed_) {
        const double time = std::chrono::duration<double>(spent_).count();
        const int each = time < quick ? timedOfQuick : 1;
        choice_.stepTook(time, each);
        spent_ = {};
        until_ = each;
    }
    timed_ = --until_ <= 0;
}

void Parallel::run(const Crew::Loop& all) {
    const int threads = always_ ? allowed_ : choice_.threads();
    const auto began = timed_ ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point();
    if (threads == 1 || all.pieces <= 1)
        all.call(all.of, 0, all.pieces);
    else
        crew_->run(all, threads);
    if (timed_) spent_ += std::chrono::steady_clock::now() - began;
}

} // namespace masonry
