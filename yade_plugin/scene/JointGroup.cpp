// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointGroup.hpp"
#include "common/Vectorised.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace masonry {

JointShapes::JointShapes(int count, int pointCount)
    : points(pointCount), stride(count == 1 ? 1 : (count + lanes - 1) / lanes * lanes), joints(count) {
    for (auto* column : {&jump[0], &jump[1], &jump[2], &area, &offset[0], &offset[1], &offset[2]})
        column->assign(std::size_t(stride) * points, 0);
    const int whole = (count + lanes - 1) / lanes * lanes; // whole lanes, also of one joint
    byPoints.assign(whole, 0);
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

void LinearField::take(int joint, const LinearField& from, int other) {
    for (int d = 0; d < 3; ++d) {
        middle[d][joint] = from.middle[d][other];
        turn[d][joint] = from.turn[d][other];
    }
}

void JointShapes::take(int joint, const JointShapes& from, int other) {
    joints[joint] = from.joints[other];
    byPoints[joint] = from.byPoints[other];
    linear.take(joint, from.linear, other);
    if (!from.damped.empty()) {
        makeViscous();
        damped.take(joint, from.damped, other);
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
    if (alike || count < most) return;
    const double length = joints[0].span().norm();
    for (int p = 0; p < points; ++p)
        for (int j = 1; j < count; ++j) {
            if (!sameButRoundOff(areaAt(p, j), areaAt(p, 0), areaAt(p, 0))) return;
            for (int d = 0; d < 3; ++d)
                if (!sameButRoundOff(offsetAt(p, j)[d], offsetAt(p, 0)[d], length)) return;
        }
    for (auto* column : {&area, &offset[0], &offset[1], &offset[2]}) {
        std::vector<double> shared(std::size_t(most) * points);
        for (int p = 0; p < points; ++p)
            std::fill_n(shared.begin() + p * most, most, (*column)[std::size_t(p) * stride]);
        column->swap(shared);
    }
    alike = true;
}

void JointShapes::readFields(int joint, double* numbers) const {
    *numbers++ = byPoints[joint];
    for (const auto* field : {&linear, &damped})
        for (const auto* columns : {field->middle, field->turn})
            for (int d = 0; d < 3; ++d)
                *numbers++ = field->empty() ? 0 : columns[d][joint];
}

void JointShapes::writeFields(int joint, const double* numbers) {
    byPoints[joint] = *numbers++ != 0;
    bool moving = false; // whether there is a stress of damping
    for (int i = 6; i < 12; ++i)
        moving = moving || numbers[i] != 0;
    if (moving) makeViscous();
    for (auto* field : {&linear, &damped})
        for (auto* columns : {field->middle, field->turn})
            for (int d = 0; d < 3; ++d, ++numbers)
                if (!field->empty()) columns[d][joint] = *numbers;
}

void JointShapes::bringPointsOf(int j) {
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

void JointShapes::writePoints() {
    behind = false;
    for (int j = 0; j < int(joints.size()); ++j)
        if (!byPoints[j]) bringPointsOf(j);
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

// Marks the points that are corners of the convex hull of all: those from which all others lie within less than half a
// turn.
void markCorners(const std::vector<std::array<double, 2>>& points, std::vector<bool>& corner) {
    const double half = M_PI * (1 + 1e-6);
    for (std::size_t p = 0; p < points.size(); ++p) {
        std::vector<double> angles;
        for (const auto& other : points)
            if (other != points[p]) angles.push_back(std::atan2(other[1] - points[p][1], other[0] - points[p][0]));
        std::sort(angles.begin(), angles.end());
        double widest = angles.empty() ? 2 * M_PI : angles.front() + 2 * M_PI - angles.back();
        for (std::size_t n = 1; n < angles.size(); ++n)
            widest = std::max(widest, angles[n] - angles[n - 1]);
        if (widest > half) corner[p] = true;
    }
}

} // namespace

void JointShapes::findMiddles() {
    const int count = alike ? JointFrames::most : int(byPoints.size());
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
