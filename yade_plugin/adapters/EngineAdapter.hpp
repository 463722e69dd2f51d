// SPDX-License-Identifier: GPL-2.0-or-later
// What the engines of this plugin have in common: step(store) of a class is its part of a step.
#pragma once
#include "Adapter.hpp"
#include "engine/watch/EngineOrder.hpp"
#include "engine/watch/EngineScope.hpp"

namespace masonry {

template <class Derived> class EngineAdapter : public Adapter<Derived, yade::GlobalEngine> {
public:
    bool isActivated() override { return standsAlone(*this); }
    void action() override {
        const EngineScope scope(*this->scene, *this);
        static_cast<Derived&>(*this).step(scope.store());
        scope.end();
    }
};

} // namespace masonry
