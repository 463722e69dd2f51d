// Numbers as users write them, for messages.
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

} // namespace masonry
