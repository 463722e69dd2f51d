// What a checkpoint holds, and its bytes. No file is opened here, and nothing that is read is trusted: bytes that are
// cut short, altered or of another kind are refused in words.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace masonry {

// Numbers and texts by name. The bytes are a title line, the number of bytes that follow, the records, and a sum over
// everything before it. A record is its kind ('n' or 't'), the sizes of name and value, the name, and the value:
// numbers as they stand in memory (IEEE 754, little-endian), so that they come back to the last bit.
struct Checkpoint {
    std::map<std::string, std::vector<double>> numbers;
    std::map<std::string, std::string> texts;

    std::string bytes() const;
    // Throws std::invalid_argument that says what is wrong with the bytes.
    static Checkpoint read(std::string_view bytes);

    // Title and size before some records, and the sum behind them.
    static std::string sealed(std::string_view records);
};

// FNV-1a: each byte leads from one sum to another in a one-to-one way, so that no single altered byte goes unnoticed.
std::uint64_t sumOf(std::string_view bytes);

} // namespace masonry
