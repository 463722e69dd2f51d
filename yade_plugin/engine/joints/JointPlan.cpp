// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointPlan.hpp"
#include "JointForces.hpp"
#include "common/Memory.hpp"
#include "common/Parallel.hpp"
#include <algorithm>
#include <atomic>

namespace masonry {

// Takes from the host the bodies that somebody else has moved. Returns false if the batches are for a planar run and a
// body has left the plane, or is no longer held in it.
bool JointPlan::detectChanges(SceneContents& store) {
    auto& bodies = store.bodies;
    std::atomic<bool> fits{true};
    Parallel::instance().overPieces(bodies.size(), bodiesAtOnce, [&](int first, int beyond) {
        double aside = 0; // largest distance of a body from its plane [m]
        bool held = true;
        for (int b = first; b < beyond; ++b) {
            if (!all_.joined[b]) continue;
            bodies.detectMove(b);
            aside = std::max(aside, std::abs(bodies.position[1][b] - all_.referenceY[b]));
            held = held && (bodies.isUnit[b] || !all_.plane || isHeldInPlane(bodies, b));
        }
        if (!all_.plane) return;
        const double* orientation[4];
        const double* fromReference[4];
        for (int d = 0; d < 4; ++d) {
            orientation[d] = &bodies.orientation[d][first];
            fromReference[d] = &bodies.fromReference[d][first];
        }
        const double turned =
            turnsInPlane(beyond - first, orientation, fromReference, &all_.turn[0][first], &all_.turn[1][first]);
        // also false if a number is not finite
        if (!(held && aside < outOfPlaneTolerance && turned < outOfPlaneTolerance)) fits = false;
    });
    return fits;
}

// Gives joints the columns of damping and impacts.
void JointPlan::prepareLosses(SceneContents& store) {
    if (store.loop->stiffnessDamping > 0)
        for (std::size_t k = 0; k < all_.kinds.size(); ++k) {
            auto& shapes = *store.kinds[k].shapes;
            shapes.makeViscous();
            if (!all_.kinds[k].intact || shapes.law->law().properties().elastic || shapes.law->isBonded()) continue;
            // without a bond the stress of damping is cut point by point
            for (int first = 0; first < int(shapes.joints.size()); first += lanes)
                shapes.endIntact(first);
            all_.kinds[k].intact = false;
        }
    for (auto& kind : store.kinds)
        if (store.loop->impacts && !kind.attached && kind.shapes->law->law().properties().restitution < 1)
            kind.shapes->makeImpacts();
}

template <bool plane> void JointPlan::step(SceneContents& store) {
    if (all_.zones) moveDependentPoints<plane>(all_, store);
    prepareLosses(store);
    losses_.assign(all_.batches.size(), {});
    Parallel::instance().overPieces(int(all_.order.size()), 1, [&](int first, int beyond) {
        for (int place = first; place < beyond; ++place) {
            const int n = all_.order[place];
            losses_[n] = BatchStep<plane>(all_, store, all_.batches[n]).advance();
        }
    });
    for (std::size_t k = 0; k < all_.kinds.size(); ++k)
        if (all_.kinds[k].intact) store.kinds[k].shapes->stale = true;
    // The step that follows damping or an impact has taken half of its work; after that there is nothing left of it.
    for (auto& kind : store.kinds) {
        if (store.loop->stiffnessDamping == 0) kind.shapes->dropViscous();
        if (!store.loop->impacts) kind.shapes->dropImpacts();
    }
    gatherForces<plane>(all_, store);
    for (const auto& losses : losses_) {
        store.loop->dampingWork += losses.damping;
        store.loop->impactWork += losses.impacts;
    }
}

void JointPlan::advance(SceneContents& store) {
    if (store_ != &store || revision_ != store.revision()) {
        all_.build(store, true);
        store_ = &store;
        revision_ = store.revision();
        giveMemoryBack();
    }
    if (!detectChanges(store)) {
        all_.build(store, false);
        detectChanges(store);
    }
    all_.plane ? step<true>(store) : step<false>(store);
}

} // namespace masonry
