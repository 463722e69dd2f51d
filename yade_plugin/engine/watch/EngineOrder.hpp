// SPDX-License-Identifier: GPL-2.0-or-later
// Which engines a step needs, and in which order.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

// All that is wrong with O.engines, in one sentence; empty if nothing is. `jointed`: whether the scene has joints.
std::string problemOfEngines(const yade::Scene&, bool jointed);

// Whether an engine is in no ParallelEngine. That runs engines on threads of its own, from which no error could come
// back: the program would end. The engine then does nothing and says so on the error stream, and the next engine of
// this plugin throws the error.
bool standsAlone(const yade::Engine&);
// Throws that error as std::invalid_argument, once and in the same step.
void refuseParallelEngine();

} // namespace masonry
