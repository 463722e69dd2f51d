// Any bytes are refused in words or taken, and what is taken comes back the same.
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
    read(Checkpoint::sealed(bytes)); // so that the records are reached, too
    return 0;
}
