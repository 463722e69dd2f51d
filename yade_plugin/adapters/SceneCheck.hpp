// Checks whether a scene can be run.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

class SceneStore;

// The body with this id. Throws std::invalid_argument, whose message begins with `what`, if there is none.
const yade::Body& bodyAt(const yade::Scene&, int id, const std::string& what);

// What is wrong with a body that must be a block, one sentence for each problem; empty if nothing is.
std::vector<std::string> problemsOf(const yade::Body&);

// Throws std::invalid_argument with all problems that prevent a run: engines in a wrong order, wrong blocks, joints
// that connect() did not make, and blocks that were added after connect().
void checkScene(const SceneStore&);

} // namespace masonry
