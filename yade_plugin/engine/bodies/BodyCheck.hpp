// SPDX-License-Identifier: GPL-2.0-or-later
// Checks of single bodies.
#pragma once
#include "ClassRole.hpp"

namespace masonry {

// The body with this id. Throws std::invalid_argument if there is none. The message begins with the name of the class
// that has declared `role`, if any, and `what`.
const yade::Body& bodyAt(const yade::Scene&, int id, const char* what, ClassRole role = ClassRole::None);

// What is wrong with a body that must be a block, one sentence for each problem; empty if nothing is.
std::vector<std::string> problemsOf(const yade::Body&);

} // namespace masonry
