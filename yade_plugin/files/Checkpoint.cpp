// SPDX-License-Identifier: GPL-2.0-or-later
#include "Checkpoint.hpp"
#include <cstring>
#include <stdexcept>

namespace masonry {

namespace {

constexpr std::string_view title = "masonry checkpoint, format 3\n";
constexpr std::string_view family = title.substr(0, title.find(','));

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void append(std::string& bytes, std::uint64_t number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

class Reader {
public:
    explicit Reader(std::string_view bytes) : remaining_(bytes) {}
    bool done() const { return remaining_.empty(); }

    std::string_view take(std::uint64_t size) {
        if (size > remaining_.size()) refuse("is damaged: a record is longer than the file");
        const auto taken = remaining_.substr(0, size);
        remaining_.remove_prefix(size);
        return taken;
    }
    std::uint64_t number() {
        std::uint64_t value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }

private:
    std::string_view remaining_;
};

} // namespace

std::uint64_t sumOf(std::string_view bytes) {
    std::uint64_t sum = 0xcbf29ce484222325;
    for (const char byte : bytes)
        sum = (sum ^ std::uint8_t(byte)) * 0x100000001b3;
    return sum;
}

std::string Checkpoint::sealed(std::string_view records) {
    std::string all(title);
    append(all, records.size() + sizeof(std::uint64_t));
    all += records;
    append(all, sumOf(all));
    return all;
}

std::string Checkpoint::bytes() const {
    std::string records;
    const auto add = [&](char kind, const std::string& name, const void* value, std::size_t size) {
        records += kind;
        append(records, name.size());
        append(records, size);
        records += name;
        records.append(static_cast<const char*>(value), size);
    };
    for (const auto& [name, values] : numbers)
        add('n', name, values.data(), values.size() * sizeof(double));
    for (const auto& [name, text] : texts)
        add('t', name, text.data(), text.size());
    return sealed(records);
}

Checkpoint Checkpoint::read(std::string_view bytes) {
    if (bytes.substr(0, title.size()) != title) {
        if (title.substr(0, bytes.size()) == bytes) refuse("is cut short: " + std::to_string(bytes.size()) + " bytes");
        if (bytes.substr(0, family.size()) != family) refuse("is no masonry checkpoint");
        refuse("is of another version of the plugin: it begins with '" +
               std::string(bytes.substr(0, std::min(bytes.find('\n'), title.size()))) + "', this one reads '" +
               std::string(title.substr(0, title.size() - 1)) + "'");
    }
    Reader whole(bytes.substr(title.size()));
    const std::size_t head = title.size() + sizeof(std::uint64_t);
    if (bytes.size() < head) refuse("is cut short: " + std::to_string(bytes.size()) + " bytes");
    const auto rest = whole.number();
    if (rest > bytes.size() - head)
        refuse("is cut short: " + std::to_string(bytes.size() - head) + " bytes after its head instead of " +
               std::to_string(rest));
    if (rest < bytes.size() - head || rest < sizeof(std::uint64_t)) refuse("is damaged: its size is not what it says");
    const auto records = whole.take(rest - sizeof(std::uint64_t));
    if (whole.number() != sumOf(bytes.substr(0, bytes.size() - sizeof(std::uint64_t))))
        refuse("is damaged: its bytes do not give the sum that they had when it was written");

    Checkpoint made;
    for (Reader reader(records); !reader.done();) {
        const char kind = reader.take(1)[0];
        const auto nameSize = reader.number(), size = reader.number();
        const std::string name(reader.take(nameSize));
        const auto value = reader.take(size);
        bool fresh = false;
        if (kind == 't')
            fresh = made.texts.emplace(name, value).second;
        else if (kind == 'n' && size % sizeof(double) == 0) {
            std::vector<double> numbers(size / sizeof(double));
            if (size) std::memcpy(numbers.data(), value.data(), size);
            fresh = made.numbers.emplace(name, std::move(numbers)).second;
        }
        if (!fresh) refuse("is damaged: a record is of no known kind, or there twice");
    }
    return made;
}

} // namespace masonry
