// SPDX-License-Identifier: GPL-2.0-or-later
// A step of all joints of a scene. What a plan keeps follows from the scene (JointBatches); BatchStep makes the step of
// a batch, JointForces brings the forces to bodies and nodes.
#pragma once
#include "BatchStep.hpp"

namespace masonry {

class JointPlan {
public:
    // Makes a step of the joints of the store's loop, and adds the energies that it takes there.
    void advance(SceneContents&);

private:
    bool detectChanges(SceneContents&);
    void prepareLosses(SceneContents&);
    template <bool plane> void step(SceneContents&);

    const SceneContents* store_ = nullptr; // the store for which the batches were made
    long revision_ = -1;                   // and its revision then
    JointBatches all_;
    std::vector<StepLosses> losses_; // scratch: of every batch
};

} // namespace masonry
