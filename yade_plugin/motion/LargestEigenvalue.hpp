// The largest eigenvalue of a symmetric positive semidefinite operator, by the method of Lanczos.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace masonry {

struct LargestEigenvalue {
    double bound = 0;     // at least the eigenvalue, and at most 2.1 % above it
    Eigen::VectorXd mode; // of length one, in the upper part of the spectrum
};

// `multiply(x, y)` makes y the operator's image of x. `moves` says which components are part of it.
//
// From a start that is uniform on the sphere of n dimensions, k steps of Lanczos reach less than 1 - e of the largest
// eigenvalue with a probability of at most 1.648 sqrt(n) exp(-sqrt(e) (2k - 1)), whatever the operator, and reach all
// of it in n steps (Kuczyński and Woźniakowski 1992, doi 10.1137/0613066). So with e = 0.02 and k such
// that the probability is 1e-12 the value reached over 1 - e is a bound; it takes some 120 steps. The start is the same
// in every run, so that runs can be repeated.
template <class Multiply> LargestEigenvalue largestEigenvalue(const std::vector<bool>& moves, Multiply&& multiply) {
    constexpr double margin = 0.02, chance = 1e-12;
    std::mt19937_64 dice(1);
    std::normal_distribution<> normal;
    LargestEigenvalue result;
    auto& mode = result.mode;
    mode.resize(moves.size());
    int count = 0;
    for (std::size_t i = 0; i < moves.size(); ++i)
        mode[i] = moves[i] ? ++count, normal(dice) : 0.0;
    if (count == 0) return result;
    mode.normalize();

    const int enough = int(std::ceil(0.5 + 0.5 * std::log(1.648 * std::sqrt(count) / chance) / std::sqrt(margin)));
    std::vector<double> diagonal, beside; // of the tridiagonal matrix that stands for the operator
    Eigen::VectorXd now = mode, before = Eigen::VectorXd::Zero(mode.size()), next = before;
    double top = 0; // of its eigenvalues, by Gershgorin
    while (int(diagonal.size()) < std::min(count, enough)) {
        multiply(now, next);
        if (!beside.empty()) next -= beside.back() * before;
        diagonal.push_back(now.dot(next));
        next -= diagonal.back() * now;
        const double last = beside.empty() ? 0 : beside.back();
        beside.push_back(next.norm());
        top = std::max(top, diagonal.back() + last + beside.back());
        if (!(beside.back() > 1e-14 * top)) break; // nothing else can be reached
        before.swap(now);
        now = next / beside.back();
    }
    if (!(top > 0) || !std::isfinite(top))
        throw std::invalid_argument("largest eigenvalue: the operator is no matrix of finite numbers with one above 0");
    const auto isAbove = [&](double value) { // all eigenvalues: whether all pivots are negative
        double pivot = -1;
        for (std::size_t k = 0; k < diagonal.size() && pivot < 0; ++k)
            pivot = diagonal[k] - value - (k > 0 ? beside[k - 1] * beside[k - 1] / pivot : 0);
        return pivot < 0;
    };
    double low = 0, high = top * (1 + 1e-12);
    for (int i = 0; i < 60; ++i)
        (isAbove(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    result.bound = int(diagonal.size()) < enough ? high : high / (1 - margin);

    for (int i = 0; i < enough; ++i) { // the vectors of Lanczos are not kept, and powers are enough for the mode
        multiply(mode, next);
        mode = next.normalized();
    }
    return result;
}

} // namespace masonry
