// SPDX-License-Identifier: GPL-2.0-or-later
// The largest eigenvalue of a symmetric positive semidefinite operator, by the method of Lanczos.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace masonry {

constexpr double marginOfLanczos = 0.02;

// How many steps are enough for `count` components; see largestEigenvalue().
inline int enoughSteps(int count) {
    constexpr double chance = 1e-12;
    return int(std::ceil(0.5 + 0.5 * std::log(1.648 * std::sqrt(count) / chance) / std::sqrt(marginOfLanczos)));
}

// A random unit vector, the same in every run; zero where components cannot move. Returns how many can.
inline int startOf(const std::vector<bool>& moves, Eigen::VectorXd& start) {
    std::mt19937_64 dice(1);
    std::normal_distribution<> normal;
    start.setZero(Eigen::Index(moves.size()));
    int count = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        if (!moves[i]) continue;
        start[Eigen::Index(i)] = normal(dice);
        ++count;
    }
    if (count > 0) start.normalize();
    return count;
}

// A number that is at least the largest eigenvalue, and at most 2.1 % above it. `multiply(x, y)` sets y to the operator
// times x. `moves` says which components of the vectors can be other than zero; `multiply` must leave the others at
// zero.
//
// Let the start vector be uniform on the sphere of n dimensions. After k steps of Lanczos the estimate is less than 1 -
// e times the largest eigenvalue with a probability of at most 1.648 sqrt(n) exp(-sqrt(e) (2k - 1)), whatever the
// operator; after n steps it is the eigenvalue (Kuczyński and Woźniakowski 1992, doi 10.1137/0613066). With e = 0.02,
// and k so large that this probability is 1e-12, some 120, the estimate divided by 1 - e is taken as the bound.
template <class Multiply> double largestEigenvalue(const std::vector<bool>& moves, Multiply&& multiply) {
    Eigen::VectorXd now;
    const int count = startOf(moves, now);
    if (count == 0) return 0;
    const int enough = enoughSteps(count);
    std::vector<double> diagonal, beside; // entries of the tridiagonal matrix that Lanczos makes of the operator
    Eigen::VectorXd before = Eigen::VectorXd::Zero(now.size()), next = before;
    double top = 0; // bound of that matrix's eigenvalues by Gershgorin's circles
    while (int(diagonal.size()) < std::min(count, enough)) {
        multiply(now, next);
        if (!beside.empty()) next -= beside.back() * before;
        diagonal.push_back(now.dot(next));
        next -= diagonal.back() * now;
        const double last = beside.empty() ? 0 : beside.back();
        beside.push_back(next.norm());
        top = std::max(top, diagonal.back() + last + beside.back());
        if (!(beside.back() > 1e-14 * top)) break; // the next vector is round-off only: the matrix is complete
        before.swap(now);
        now = next / beside.back();
    }
    if (!(top > 0) || !std::isfinite(top))
        throw std::invalid_argument("largest eigenvalue: the operator is no matrix of finite numbers with one above 0");
    // A value lies above all eigenvalues of the matrix if the matrix minus the value has negative pivots only.
    const auto isAbove = [&](double value) {
        double pivot = -1;
        for (std::size_t k = 0; k < diagonal.size() && pivot < 0; ++k)
            pivot = diagonal[k] - value - (k > 0 ? beside[k - 1] * beside[k - 1] / pivot : 0);
        return pivot < 0;
    };
    double low = 0, high = top * (1 + 1e-12);
    for (int i = 0; i < 60; ++i)
        (isAbove(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return int(diagonal.size()) < enough ? high : high / (1 - marginOfLanczos);
}

// A unit vector made of the modes with the highest eigenvalues, by power iteration: it only has to show which part is
// stiffest.
template <class Multiply> Eigen::VectorXd highMode(const std::vector<bool>& moves, Multiply&& multiply) {
    Eigen::VectorXd mode;
    const int count = startOf(moves, mode);
    Eigen::VectorXd next = mode;
    for (int i = 0; count > 0 && i < enoughSteps(count); ++i) {
        multiply(mode, next);
        mode = next.normalized();
    }
    return mode;
}

} // namespace masonry
