// SPDX-License-Identifier: GPL-2.0-or-later
// Any bytes must be refused with an error or read as a checkpoint, which must then be the same after writing and
// reading.
#include "files/Checkpoint.hpp"
#include <stdexcept>

using masonry::Checkpoint;

namespace {

void read(std::string_view bytes) {
    try {
        const auto taken = Checkpoint::read(bytes).bytes();
        if (Checkpoint::read(taken).bytes() != taken) __builtin_trap();
    } catch (const std::invalid_argument&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    read(bytes);
    read(Checkpoint::sealed(bytes)); // with a checksum that fits, so that the records are read, too
    return 0;
}
