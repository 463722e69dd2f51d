// SPDX-License-Identifier: GPL-2.0-or-later
// Checks of single bodies.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

// The body with this id. Throws std::invalid_argument, whose message begins with `what`, if there is none.
const yade::Body& bodyAt(const yade::Scene&, int id, const std::string& what);

// What is wrong with a body that must be a block, one sentence for each problem; empty if nothing is.
std::vector<std::string> problemsOf(const yade::Body&);

} // namespace masonry
