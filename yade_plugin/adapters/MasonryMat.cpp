// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryMat.hpp"
#include <memory>
#include <mutex>
#include <new>

MASONRY_DEFINE(MasonryMat)

namespace masonry {

using yade::State;

shared_ptr<State> MasonryMat::newAssocState() const {
    constexpr int places = 64;
    struct Shelf { // memory of many States, which is freed when the last of them is
        alignas(64) unsigned char memory[places][sizeof(State)];
    };
    static std::mutex mutex;
    static std::shared_ptr<Shelf> shelf;
    static int used = places;
    const std::lock_guard<std::mutex> held(mutex);
    if (used == places) {
        shelf = std::make_shared<Shelf>();
        used = 0;
    }
    auto* state = new (shelf->memory[used++]) State;
    return shared_ptr<State>(state, [kept = shelf](State* s) { s->~State(); });
}

} // namespace masonry
