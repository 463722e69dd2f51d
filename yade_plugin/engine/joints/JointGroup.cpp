// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointGroup.hpp"
#include "common/Vectorised.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace masonry {

JointShapes::JointShapes(int count, int pointCount)
    : points(pointCount), stride(count == 1 ? 1 : (count + lanes - 1) / lanes * lanes), joints(count) {
    for (auto* column : {&jump[0], &jump[1], &jump[2], &area, &offset[0], &offset[1], &offset[2]})
        column->assign(std::size_t(stride) * points, 0);
    const int whole = (count + lanes - 1) / lanes * lanes; // whole lanes, also of one joint
    refined.resize(count);
    converted.assign(whole, 0);
    pointwise.assign(whole, 0);
    linear.resize(whole);
}

void LinearField::resize(std::size_t count) {
    for (auto* columns : {middle, turn})
        for (int d = 0; d < 3; ++d)
            columns[d].resize(count, 0);
}

void LinearField::clear() {
    for (auto* columns : {middle, turn})
        for (int d = 0; d < 3; ++d)
            columns[d].clear();
}

std::array<double, 6> LinearField::numbersOf(int j) const {
    if (empty()) return {};
    return {middle[0][j], middle[1][j], middle[2][j], turn[0][j], turn[1][j], turn[2][j]};
}

void LinearField::setNumbers(int joint, const std::array<double, 6>& numbers) {
    for (int d = 0; d < 3; ++d) {
        middle[d][joint] = numbers[d];
        turn[d][joint] = numbers[3 + d];
    }
}

void JointShapes::take(int joint, JointShapes& from, int other) {
    settled = settled || from.settled;
    joints[joint] = from.joints[other];
    refined[joint] = from.refined[other];
    converted[joint] = from.converted[other];
    pointwise[joint] = from.pointwise[other];
    linear.setNumbers(joint, from.linear.numbersOf(other));
    if (!from.damped.empty()) {
        makeViscous();
        damped.setNumbers(joint, from.damped.numbersOf(other));
    }
    for (int p = 0; p < points; ++p) {
        setJump(p, joint, from.jumpAt(p, other));
        setViscous(p, joint, from.viscousAt(p, other));
        setImpact(p, joint, from.impactAt(p, other));
        setShape(p, joint, from.offsetAt(p, other), from.areaAt(p, other));
    }
}

void JointShapes::shareShapes() {
    constexpr int most = JointFrames::most;
    const int count = int(joints.size());
    const bool exactly = std::exchange(settled, true);
    if (alike || count < most) return;
    const double length = joints[0].span().norm();
    const auto same = [exactly](double a, double b, double scale) {
        return exactly ? a == b : sameButRoundOff(a, b, scale);
    };
    for (int p = 0; p < points; ++p)
        for (int j = 1; j < count; ++j) {
            if (!same(areaAt(p, j), areaAt(p, 0), areaAt(p, 0))) return;
            for (int d = 0; d < 3; ++d)
                if (!same(offsetAt(p, j)[d], offsetAt(p, 0)[d], length)) return;
        }
    for (auto* column : {&area, &offset[0], &offset[1], &offset[2]}) {
        std::vector<double> shared(std::size_t(most) * points);
        for (int p = 0; p < points; ++p)
            std::fill_n(shared.begin() + p * most, most, (*column)[std::size_t(p) * stride]);
        column->swap(shared);
    }
    alike = true;
}

void JointReference::visitState(StateNumbers& n) {
    auto all = polygon();
    n(normal, tangent, all, sides[0], sides[1]);
    if (all != polygon()) corners = std::make_shared<Polygon>(std::move(all));
    std::vector<Attachment> none[2];
    auto& points = attached ? attached->sides : none;
    n(points[0], points[1]);
}

void RefinedJoint::visitState(StateNumbers& n) {
    auto all = coarse ? *coarse : std::vector<JointPoint>();
    n(points, all);
    if (n.back) coarse = all.empty() ? nullptr : std::make_shared<const std::vector<JointPoint>>(std::move(all));
}

void JointShapes::visitShape(int j, StateNumbers& n) {
    settled = settled || n.back;
    n(joints[j], refined[j]);
    for (int p = 0; p < points; ++p) {
        JointPoint point{offsetAt(p, j), areaAt(p, j)};
        n(point);
        if (n.back) setShape(p, j, point.offset, point.area);
    }
}

void JointShapes::visitState(int j, StateNumbers& n) {
    auto jumps = linear.numbersOf(j), rates = damped.numbersOf(j);
    n(pointwise[j], converted[j], jumps, rates);
    if (n.back) {
        linear.setNumbers(j, jumps);
        if (rates != std::array<double, 6>{}) makeViscous();
        if (!damped.empty()) damped.setNumbers(j, rates);
    }
    for (int p = 0; p < points; ++p) {
        Vector3r now = jumpAt(p, j), damping = viscousAt(p, j);
        Impact met = impactAt(p, j);
        n(now, damping, met);
        if (!n.back) continue;
        setJump(p, j, now);
        setViscous(p, j, damping);
        setImpact(p, j, met);
    }
}

void JointShapes::synchronise(int j) {
    const auto& k = law->stiffness();
    const std::size_t f = face(j);
    for (int p = 0; p < points; ++p) {
        const std::size_t i = at(p, j), s = alike ? shape(p, 0) : i;
        const double b1 = offset[1][s] - middle[1][f], b2 = offset[2][s] - middle[2][f];
        const Vector3r now = linear.at(j, b1, b2);
        setVector(jump, i, now);
        law->setElastic(p, j, now[0], now[1], now[2]);
        if (damped.empty()) continue;
        const Vector3r rate = damped.at(j, b1, b2);
        setVector(viscous, i, {k.normal * rate[0], k.shear * rate[1], k.shear * rate[2]});
    }
}

void JointShapes::endIntact(int joint) {
    const int first = joint / lanes * lanes;
    for (int j = first; j < std::min(first + lanes, int(joints.size())); ++j)
        if (!pointwise[j]) {
            synchronise(j);
            pointwise[j] = 1;
        }
}

void JointShapes::writePoints() {
    stale = false;
    for (int j = 0; j < int(joints.size()); ++j)
        if (!pointwise[j]) synchronise(j);
}

bool JointShapes::isIntact(int j) const {
    const auto& k = law->stiffness();
    const std::size_t f = face(j);
    double size = 0;
    for (int p = 0; p < points; ++p)
        size = std::max(size, vectorAt(jump, at(p, j)).cwiseAbs().maxCoeff());
    const double close = 1e-9 * size + 1e-12 * std::sqrt(faceArea[f]); // round-off of stresses, and of places of blocks
    for (int p = 0; p < points; ++p) {
        const std::size_t i = at(p, j), s = alike ? shape(p, 0) : i;
        const Vector3r now = vectorAt(jump, i);
        const Vector3r made = linear.at(j, offset[1][s] - middle[1][f], offset[2][s] - middle[2][f]);
        const JointState state = law->state(p, j);
        const Vector3r elastic(state.opening, state.shearStress.a / k.shear, state.shearStress.b / k.shear);
        if (!law->isIntact(p, j) || !((now - made).cwiseAbs().maxCoeff() <= close) ||
            !((now - elastic).cwiseAbs().maxCoeff() <= close))
            return false;
    }
    return true;
}

namespace {

// Marks the points that are corners of the convex hull of all.
void markCorners(const std::vector<std::array<double, 2>>& points, std::vector<bool>& corner) {
    constexpr double straight = 3e-6; // sine of the least turn at a corner
    double size = 0;
    for (const auto& point : points)
        size = std::max({size, std::abs(point[0]), std::abs(point[1])});
    const auto rounded = [&](double place) { return std::round(place / (1e-9 * size)); };
    const auto before = [&](int a, int b) {
        const double x[] = {rounded(points[a][0]), rounded(points[b][0])};
        return x[0] < x[1] || (x[0] == x[1] && points[a][1] < points[b][1]);
    };
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), before);
    for (int half = 0; half < 2; ++half) {
        std::vector<int> chain; // of one side of the hull, counter-clockwise
        const auto isCorner = [&](int next) {
            const auto &a = points[chain[chain.size() - 2]], &b = points[chain.back()], &c = points[next];
            const double u[] = {b[0] - a[0], b[1] - a[1]}, v[] = {c[0] - b[0], c[1] - b[1]};
            return u[0] * v[1] - u[1] * v[0] > straight * std::hypot(u[0], u[1]) * std::hypot(v[0], v[1]);
        };
        for (int next : order) {
            while (chain.size() > 1 && !isCorner(next))
                chain.pop_back();
            chain.push_back(next);
        }
        for (int p : chain)
            corner[p] = true;
        std::reverse(order.begin(), order.end());
    }
}

} // namespace

void JointShapes::findMiddles() {
    const int count = alike ? JointFrames::most : int(pointwise.size());
    for (auto* column : {&middle[0], &middle[1], &middle[2], &faceArea, &inertia[0], &inertia[1], &inertia[2]})
        column->assign(count, 0);
    std::vector<bool> corner(points, false);
    for (int f = 0; f < count; ++f) {
        const int j = alike ? 0 : std::min(f, int(joints.size()) - 1); // padding has the numbers of the last joint
        Vector3r first = Vector3r::Zero();
        for (int p = 0; p < points; ++p) {
            faceArea[f] += areaAt(p, j);
            first += areaAt(p, j) * offsetAt(p, j);
        }
        const Vector3r centre = first / faceArea[f];
        for (int d = 0; d < 3; ++d)
            middle[d][f] = centre[d];
        std::vector<std::array<double, 2>> places;
        for (int p = 0; p < points; ++p) {
            const Vector3r b = offsetAt(p, j) - centre;
            inertia[0][f] += areaAt(p, j) * b[1] * b[1];
            inertia[1][f] += areaAt(p, j) * b[2] * b[2];
            inertia[2][f] += areaAt(p, j) * b[1] * b[2];
            places.push_back({b[1], b[2]});
        }
        if (!alike || f == 0) markCorners(places, corner);
    }
    rim.clear();
    for (int p = 0; p < points; ++p)
        if (corner[p]) rim.push_back(p);
}

} // namespace masonry
