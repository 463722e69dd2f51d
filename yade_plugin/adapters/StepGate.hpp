// Keeps Python's readers and the engines of a running scene apart, so that YADE's prompt is safe while O.run() works in
// the background. Readers see the state after a whole step, and a step never begins while somebody reads.
#pragma once
#include <condition_variable>
#include <mutex>
#include <thread>

namespace masonry {

class StepGate {
public:
    static StepGate& instance();

    // An engine begins and ends its action. `stepDone`: it is the last of its step that changes anything of ours.
    void enter();
    void leave(bool stepDone);

    // Somebody outside the step reads or changes something. May be nested in one thread, and within a step of the same
    // thread, as a PyRunner does.
    void lock();
    void unlock();

private:
    template <class Ready> void wait(std::unique_lock<std::mutex>&, Ready&& ready);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::thread::id stepper_, reader_; // the thread that made the last step; the one that reads now
    bool acting_ = false;              // whether an engine is at work
    bool inStep_ = false;              // whether a step has begun and has not ended
    int depth_ = 0;                    // how often the reader has locked
    int waiting_ = 0;                  // readers that wait
};

// The present thread reads or changes what belongs to a scene, while this exists.
class BetweenSteps {
public:
    BetweenSteps() { StepGate::instance().lock(); }
    ~BetweenSteps() { StepGate::instance().unlock(); }
    BetweenSteps(const BetweenSteps&) = delete;
    BetweenSteps& operator=(const BetweenSteps&) = delete;
};

} // namespace masonry
