// Compares the declarations in Yade.hpp with the YADE that is running, before anything is registered.
#pragma once
#include <string>
#include <vector>

namespace masonry::host {

// Every difference, each naming class, member, expected and found; empty if the running YADE fits.
std::vector<std::string> differences();

// The YADE versions that this build knows.
std::string knownVersions();

} // namespace masonry::host
