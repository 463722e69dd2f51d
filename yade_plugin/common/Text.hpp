// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers and lists as text, for messages.
#pragma once
#include <cstdio>
#include <string>
#include <vector>

namespace masonry {

inline std::string text(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", value);
    return buffer;
}

inline std::string joined(const std::vector<std::string>& parts, const char* separator = "\n  ") {
    std::string all;
    for (const auto& part : parts)
        all += (all.empty() ? "" : separator) + part;
    return all;
}

// The first parts, one on a line, and how many more there are.
inline std::string firstOf(std::vector<std::string> parts, std::size_t most = 10) {
    const std::size_t more = parts.size() > most ? parts.size() - most : 0;
    parts.resize(parts.size() - more);
    return joined(parts, "\n") + (more ? "\nand " + std::to_string(more) + " more" : "");
}

} // namespace masonry
