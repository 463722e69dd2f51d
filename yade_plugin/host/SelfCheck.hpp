// Compares the declarations in Yade.hpp with the running YADE, before any class is registered. README.md says what is
// compared and how.
#pragma once
#include <string>
#include <vector>

namespace masonry::host {

// One line for each difference: the class, its member, what was expected and what was found. Empty if the running YADE
// fits.
std::vector<std::string> differences();

// The YADE versions that this build can run in, for messages.
std::string knownVersions();

} // namespace masonry::host
