// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryContacts.hpp"
#include "engine/watch/CriticalTimeStep.hpp"

MASONRY_DEFINE(MasonryContacts)

namespace masonry {

void MasonryContacts::step(SceneStore& store) {
    act(store, store.gravity());
    conversion_.act(store, *this);
    lookAtFalls(store);
}

namespace {

// Bodies that no joints hold.
std::vector<int> looseIn(const SceneStore& store) {
    const auto held = heldByJoints(store);
    std::vector<int> loose;
    for (int body = 0; body < store.bodies.size(); ++body)
        if (store.bodies.has(body) && !held[body]) loose.push_back(body);
    return loose;
}

} // namespace

void MasonryContacts::lookAtFalls(SceneStore& store) {
    if (!takesJoints) return;
    falls_.watch(store);
    if (scene->iter % lookAtFallsEvery != 0) return;
    const auto loose = looseIn(store);
    falls_.look(store, loose, sizes(), store.gravity());
    undamp(store, loose);
}

void MasonryContacts::undamp(SceneStore& store, const std::vector<int>& loose) {
    if (dampsLoose) return;
    for (int body : loose)
        if (auto& state = store.bodies.state(body); state.isDamped) {
            state.isDamped = false;
            store.bodies.take(body);
        }
}

void MasonryContacts::follow(double share) {
    if (!(share >= 0 && share <= 1))
        throw std::invalid_argument(nameOf(ClassRole::Contacts) + ".follow: share " + text(share) +
                                    " must be at least 0 and at most 1");
    StillScene store;
    stepShare = share;
    undamp(*store, looseIn(*store));
    if (share > 0) beginFollowing(*store);
}

py::dict MasonryContacts::fallen() {
    const BetweenSteps still;
    py::dict found;
    for (const auto& fall : falls_.all()) {
        py::dict one;
        one["since"] = fall.since;
        one["fell"] = fall.fell < 0 ? py::object() : py::object(fall.fell);
        one["most"] = fall.most;
        one["at"] = fall.at;
        found[fall.body] = one;
    }
    return found;
}

Vector3r MasonryContacts::impulse(int body) {
    const BetweenSteps still;
    return impulseOn(body);
}

py::list MasonryContacts::pairs() {
    const BetweenSteps still;
    py::list found;
    for (const auto& touch : pairForces())
        found.append(py::make_tuple(touch.one, touch.other, touch.force, touch.torque));
    return found;
}

int MasonryContacts::countTouching() {
    const BetweenSteps still;
    return touching();
}

Vector3r MasonryContacts::forceBetween(int id1, int id2) {
    const BetweenSteps still;
    return forceOf(id1, id2);
}

} // namespace masonry
