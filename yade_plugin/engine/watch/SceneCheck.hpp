// SPDX-License-Identifier: GPL-2.0-or-later
// Checks whether a scene can be run.
#pragma once

namespace masonry {

class SceneStore;

// Throws std::invalid_argument with all problems that prevent a run: engines in a wrong order, wrong blocks, joints
// that connect() did not make, and blocks that were added after connect().
void checkScene(const SceneStore&);

// Throws std::invalid_argument with all problems that prevent a step. Checks the scene only when it has changed, the
// time step always. In a scene that no engine watches over, it throws RunEnded if a block has collapsed.
void checkBeforeStep(SceneStore&);

} // namespace masonry
