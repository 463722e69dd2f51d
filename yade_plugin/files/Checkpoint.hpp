// SPDX-License-Identifier: GPL-2.0-or-later
// The contents of a checkpoint and their form as bytes. Bytes that are cut short, altered or no checkpoint at all are
// refused with the reason.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace masonry {

// Numbers and texts by name. As bytes a checkpoint consists of a title line, the number of bytes that follow, the
// records, and a checksum of everything before it. A record consists of its kind ('n' for numbers, 't' for a text), the
// size of its name, the size of its value, the name and the value. Numbers are written as they are in memory (IEEE 754,
// little-endian), so that no bit of them is lost.
struct Checkpoint {
    std::map<std::string, std::vector<double>> numbers;
    std::map<std::string, std::string> texts;

    std::string bytes() const;

    // Reads a checkpoint from its bytes. Throws std::invalid_argument, which says what is wrong with them.
    static Checkpoint read(std::string_view bytes);

    // The bytes of a checkpoint with these records.
    static std::string sealed(std::string_view records);
};

// Checksum of some bytes (FNV-1a, 64 bits). Equal bytes turn different sums into different sums, so a change of a
// single byte always changes the result.
std::uint64_t sumOf(std::string_view bytes);

} // namespace masonry
