// What a scene must be before a step is made.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

class SceneStore;

// The body of that id; std::invalid_argument that begins with `what` if there is none.
const yade::Body& bodyAt(const yade::Scene&, int id, const std::string& what);

// What keeps a body from being a block, one sentence each; empty if nothing does.
std::vector<std::string> problemsOf(const yade::Body&);

// Throws std::invalid_argument with all that keeps the scene from being run: order of the engines, blocks, joints that
// are not connect()'s, blocks that came after connect().
void checkScene(const SceneStore&);

} // namespace masonry
