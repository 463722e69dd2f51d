// Checks whether a scene can be run.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

class SceneStore;

// The body with this id. Throws std::invalid_argument, whose message begins with `what`, if there is none.
const yade::Body& bodyAt(const yade::Scene&, int id, const std::string& what);

// Whether an engine is in no ParallelEngine. That runs engines on threads of its own, from which no error could come
// back: the program would end. The engine then does nothing and says so on the error stream, and the next engine of
// this plugin throws the error.
bool standsAlone(const yade::Engine&);
// The error of an engine that does not stand alone, once and in the same step; else an empty text.
std::string refusalInParallel();

// What is wrong with a body that must be a block, one sentence for each problem; empty if nothing is.
std::vector<std::string> problemsOf(const yade::Body&);

// Throws std::invalid_argument with all problems that prevent a run: engines in a wrong order, wrong blocks, joints
// that connect() did not make, and blocks that were added after connect().
void checkScene(const SceneStore&);

} // namespace masonry
