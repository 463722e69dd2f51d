// SPDX-License-Identifier: GPL-2.0-or-later
// A checkpoint that is written and read is the same to the last bit, and bytes that are not a whole one are refused.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "files/Checkpoint.hpp"
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <stdexcept>

using masonry::Checkpoint;

namespace {

Checkpoint example() {
    Checkpoint c;
    c.numbers["bodies"] = {1.0 / 3, -0.0, 5e-324, 1.7976931348623157e308};
    c.numbers["empty"] = {};
    c.texts["extra"] = std::string("{\"stage\": \"push\"}\0\n", 19);
    return c;
}

std::string refusal(const std::string& bytes) {
    try {
        Checkpoint::read(bytes);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

bool says(const std::string& bytes, const char* words) { return refusal(bytes).find(words) != std::string::npos; }

std::string number(std::uint64_t value) { return std::string(reinterpret_cast<const char*>(&value), sizeof value); }

} // namespace

TEST_CASE("a checkpoint comes back to the last bit") {
    const auto made = example(), back = Checkpoint::read(made.bytes());
    CHECK(back.texts == made.texts);
    REQUIRE(back.numbers.size() == made.numbers.size());
    for (const auto& [name, values] : made.numbers) {
        const auto& other = back.numbers.at(name);
        REQUIRE(other.size() == values.size());
        CHECK((values.empty() || std::memcmp(values.data(), other.data(), values.size() * sizeof(double)) == 0));
    }
}

TEST_CASE("a checkpoint with any one bit flipped is refused") {
    const auto bytes = example().bytes();
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        auto other = bytes;
        other[bit / 8] ^= char(1 << bit % 8);
        if (refusal(other) == "accepted") FAIL("bit " << bit);
    }
}

TEST_CASE("a checkpoint cut short anywhere is refused and said to be cut short") {
    const auto bytes = example().bytes();
    for (std::size_t size = 0; size < bytes.size(); ++size)
        if (!says(bytes.substr(0, size), "is cut short")) FAIL(size << ": " << refusal(bytes.substr(0, size)));
    CHECK(says(bytes + "x", "is damaged: its size"));
}

TEST_CASE("other files are named for what they are") {
    CHECK(says("time_s,displacement_mm\n", "is no masonry checkpoint"));
    CHECK(says("masonry checkpoint, format 9\n12345678", "another version of the plugin: it begins with "
                                                         "'masonry checkpoint, format 9'"));
}

TEST_CASE("records that lie about their sizes are refused although the sum is right") {
    const auto largest = std::numeric_limits<std::uint64_t>::max();
    for (const auto& records :
         {std::string("n"), "n" + number(1), "n" + number(1) + number(8) + "a", "n" + number(largest) + number(8) + "a",
          "n" + number(1) + number(largest) + "a", "t" + number(1) + number(largest - 7) + "a"})
        CHECK(says(Checkpoint::sealed(records), "a record is longer than the file"));
    const auto one = "n" + number(1) + number(8) + "a" + number(0);
    CHECK(refusal(Checkpoint::sealed(one)) == "accepted");
    CHECK(says(Checkpoint::sealed(one + one), "there twice"));
    const auto text = "t" + number(1) + number(2) + "aok";
    CHECK(refusal(Checkpoint::sealed(text)) == "accepted");
    CHECK(says(Checkpoint::sealed(text + text), "there twice"));
    CHECK(says(Checkpoint::sealed("x" + one.substr(1)), "no known kind"));
    CHECK(says(Checkpoint::sealed("n" + number(1) + number(7) + "a1234567"), "no known kind"));
}

TEST_CASE("a file that is too short for its own sum is said to be damaged") {
    const auto empty = Checkpoint::sealed("");
    const auto title = empty.substr(0, empty.size() - 2 * sizeof(std::uint64_t));
    for (std::uint64_t size = 0; size < sizeof(std::uint64_t); ++size)
        CHECK(says(title + number(size) + std::string(size, 'x'), "is damaged: its size is not what it says"));
}
