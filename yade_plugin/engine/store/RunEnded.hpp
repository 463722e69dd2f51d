// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <stdexcept>
#include <string>

namespace masonry {

// Why a run ends before it was meant to. Python finds `code` and `block` as attributes of the error.
struct RunEnded : std::runtime_error {
    const char* code; // "collapsed", "unstable" or "not finite"
    int block;        // id of the block that has collapsed, else -1

    RunEnded(const char* code, const std::string& message, int block = -1)
        : std::runtime_error(message), code(code), block(block) {}
};

} // namespace masonry
