// SPDX-License-Identifier: GPL-2.0-or-later
// Checks whether a scene can be run.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

class SceneStore;

// Whether an engine is in no ParallelEngine. That runs engines on threads of its own, from which no error could come
// back: the program would end. The engine then does nothing and says so on the error stream, and the next engine of
// this plugin throws the error.
bool standsAlone(const yade::Engine&);
// Throws that error as std::invalid_argument, once and in the same step.
void refuseParallelEngine();

// Throws std::invalid_argument with all problems that prevent a run: engines in a wrong order, wrong blocks, joints
// that connect() did not make, and blocks that were added after connect().
void checkScene(const SceneStore&);

// Throws std::invalid_argument with all problems that prevent a step. Checks the scene only when it has changed, the
// time step always. In a scene that no engine watches over, it throws std::runtime_error
// if a block has collapsed.
void checkBeforeStep(SceneStore&);

} // namespace masonry
