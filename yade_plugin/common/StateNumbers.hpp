// SPDX-License-Identifier: GPL-2.0-or-later
// The one visitor of saved state: O.save(), checkpoints and the comparison of a scene with a checkpoint. A class says
// once which numbers its state has, and in which order:
//
//   template <class Visit> void visitState(Visit&& visit) { visit(position, touches, pairs); }
//
// The same function writes and reads them.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace masonry {

class StateNumbers {
public:
    const bool back; // whether numbers are read, and values set

    // Writes to the end of some numbers.
    explicit StateNumbers(std::vector<double>& to) : back(false), to_(&to), from_(to) {}
    // Reads numbers. `misfit` is what an error says if they do not make up the values that are asked for.
    StateNumbers(const std::vector<double>& from, std::string misfit)
        : back(true), from_(from), misfit_(std::move(misfit)) {}

    template <class... T> void operator()(T&... values) { (visit(values), ...); }

    // A number of things of which each has at least one number.
    void visitCount(std::size_t& count) {
        visit(count);
        if (back && count > from_.size() - next_) refuse();
    }
    // To be called when all has been read.
    void end() const {
        if (next_ != from_.size()) refuse();
    }
    [[noreturn]] void refuse() const { throw std::invalid_argument(misfit_); }

private:
    template <class T> void visit(T& value) {
        if constexpr (std::is_arithmetic<T>::value)
            visitNumber(value);
        else
            value.visitState(*this);
    }
    template <class T> void visitNumber(T& value) {
        if (!back) return to_->push_back(double(value));
        if (next_ == from_.size()) refuse();
        const double number = from_[next_++];
        if constexpr (std::is_integral<T>::value) {
            const double bound = std::ldexp(1.0, std::numeric_limits<T>::digits);
            if (!(std::abs(number) < bound && (std::is_signed<T>::value || number >= 0))) refuse();
        }
        value = T(number);
    }
    template <int Rows, int Columns> void visit(Eigen::Matrix<double, Rows, Columns>& matrix) {
        for (int i = 0; i < int(matrix.size()); ++i)
            visit(matrix.data()[i]);
    }
    void visit(Eigen::Quaterniond& q) { (*this)(q.w(), q.x(), q.y(), q.z()); }
    template <class T, std::size_t N> void visit(std::array<T, N>& values) {
        for (auto& value : values)
            visit(value);
    }
    template <class T> void visit(std::vector<T>& values) {
        std::size_t count = values.size();
        visitCount(count);
        values.resize(count);
        for (auto& value : values)
            visit(value);
    }

    std::vector<double>* to_ = nullptr; // null while numbers are read
    const std::vector<double>& from_;
    std::size_t next_ = 0;
    std::string misfit_;
};

} // namespace masonry
