// SPDX-License-Identifier: GPL-2.0-or-later
// Moves the state of a scene into a checkpoint or back. The same code does both: it names every value, and the
// direction decides which side is written. Values of a fixed size become plain numbers.
#pragma once
#include "files/Checkpoint.hpp"
#include "host/Yade.hpp"
#include "law/common/SofteningTable.hpp"
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace masonry {

using yade::Quaternionr;
using yade::Vector3r;

// Whether a type has a fixed number of numbers, and a function numbers() that visits them.
template <class T> struct IsNumbers : std::false_type {};
template <> struct IsNumbers<Vector3r> : std::true_type {};
template <> struct IsNumbers<Quaternionr> : std::true_type {};
template <> struct IsNumbers<TableRow> : std::true_type {};

// Calls `each` with every number of a value, in a fixed order.
template <class F> void numbers(double& value, F&& each) { each(value); }
template <class F> void numbers(Vector3r& v, F&& each) {
    for (int d = 0; d < 3; ++d)
        each(v[d]);
}
template <class F> void numbers(Quaternionr& q, F&& each) {
    each(q.w());
    each(q.x());
    each(q.y());
    each(q.z());
}
template <class F> void numbers(TableRow& r, F&& each) {
    each(r.ratio);
    each(r.damage);
}
template <class T> std::vector<double> flattened(std::vector<T>& values) {
    std::vector<double> flat;
    for (auto& value : values)
        numbers(value, [&](double& number) { flat.push_back(number); });
    return flat;
}

// Makes values of numbers. Returns false, and leaves `values` alone, if the numbers do not make up whole values.
template <class T> bool unflatten(const std::vector<double>& flat, std::vector<T>& values) {
    std::size_t width = 0, next = 0;
    T sample{};
    numbers(sample, [&](double&) { ++width; });
    if (flat.size() % width != 0) return false;
    values.resize(flat.size() / width);
    for (auto& value : values)
        numbers(value, [&](double& number) { number = flat[next++]; });
    return true;
}

class Transfer {
public:
    const bool back;   // whether the state goes from the checkpoint to the scene
    std::string owner; // stands before every name in the checkpoint, and says whose state it is

    Transfer(Checkpoint& file, bool back) : back(back), file_(file) {}

    template <class T> void operator()(const std::string& name, T& value) {
        if constexpr (std::is_same<T, std::string>::value) {
            auto& text = file_.texts[owner + name];
            if (back)
                value = text;
            else
                text = value;
        } else if constexpr (plain<T>())
            several(name, &value, 1);
    }
    template <class T> void operator()(const std::string& name, std::vector<T>& values) {
        if constexpr (plain<T>()) {
            if (back) values.resize(file_.numbers[owner + name].size() / width<T>());
            several(name, values.data(), values.size());
        }
    }
    // As many values as the scene has. A checkpoint with another number of them is refused.
    template <class T> void several(const std::string& name, T* values, std::size_t count) {
        auto& flat = file_.numbers[owner + name];
        flat.resize(back ? flat.size() : count * width<T>());
        if (flat.size() != count * width<T>()) damaged(name);
        std::size_t next = 0;
        for (std::size_t i = 0; i < count; ++i)
            each(values[i], [&](double& number) {
                auto& kept = flat[next++];
                if (back)
                    number = kept;
                else
                    kept = number;
            });
    }
    [[noreturn]] void damaged(const std::string& name) const {
        throw std::invalid_argument("does not fit this scene, at '" + owner + name + "'");
    }

private:
    template <class T> static constexpr bool plain() { return std::is_arithmetic<T>::value || IsNumbers<T>::value; }
    template <class T, class F> static void each(T& value, F&& visit) {
        if constexpr (std::is_arithmetic<T>::value) {
            double number = double(value);
            visit(number);
            if (std::is_integral<T>::value && !(std::abs(number) <= double(std::numeric_limits<T>::max())))
                throw std::invalid_argument("does not fit this scene: a whole number in it is too large");
            value = T(number);
        } else
            numbers(value, visit);
    }
    template <class T> static std::size_t width() {
        std::size_t count = 0;
        T sample{};
        each(sample, [&](double&) { ++count; });
        return count;
    }

    Checkpoint& file_;
};

// Base of all objects that have a state of their own in checkpoints.
struct Stateful {
    virtual ~Stateful() = default;
    virtual void transfer(Transfer&) = 0;
};

} // namespace masonry
