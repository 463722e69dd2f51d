// SPDX-License-Identifier: GPL-2.0-or-later
// Compares the declarations in Yade.hpp with the running YADE, before any class is registered. README.md says what is
// compared and how.
#pragma once
#include <string>
#include <vector>

namespace masonry::host {

// One line for each difference: class, member, what was expected and what was found. A YADE of an unknown version whose
// layout fits is one, too, unless the environment variable MASONRY_UNKNOWN_YADE is 1: then it is a warning.
std::vector<std::string> differences();

// The YADE versions that this build can run in, for messages.
std::string knownVersions();

// Whether the running YADE has a class of this name. Some builds of YADE lack some classes.
bool has(const std::string& className);

} // namespace masonry::host
