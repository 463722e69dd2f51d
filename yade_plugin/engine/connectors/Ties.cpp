// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ties.hpp"
#include "common/PlainVector.hpp"
#include <algorithm>

namespace masonry {

struct Ties::Piece {
    using Column = double[most];
    // Input: place and orientation (w, x, y, z) of the bodies of both ends, and columns of the ties.
    Column place[2][3], turn[2][4];
    const double *arm[2][3], *span[3], *length, *stiffness, *strength, *breaking, *both, *whole, *rest, *restBefore;
    double *elongation, *force, *flow;
    Column turned[2][3]; // scratch: arms as they are now
    // Output: force and torque on the bodies of both ends, the force on the first one; energies.
    Column pull[3], torque[2][3], given, stored, dissipated;
    Column yields, breaks; // 1 where a tie has yielded or broken in this step, else 0
};

std::vector<std::string> Ties::problems() const {
    auto found = problemsOfEnds();
    check(found, "stiffness", stiffness, count(), ofStiffness());
    check(found, "strength", strength, count(), ofStrength());
    check(found, "breaking", breaking, count(), ofBreaking());
    check(found, "rest", rest, count(), ofRest());
    if (int(compression.size()) != count()) found.push_back("compression must have 0 or 1 for each connector");
    for (std::size_t i = 0; found.empty() && i < points1.size(); ++i)
        if (!((points2[i] - points1[i]).norm() > 0))
            found.push_back("the ends of connector " + std::to_string(i) + " must not be at the same place");
    return found;
}

void Ties::prepare(SceneContents& contents) {
    const int n = count();
    fit(elongations, n, 0.0);
    fit(forces, n, 0.0);
    fit(flows, n, 0.0);
    fit(yieldedAt, n, -1);
    fit(brokenAt, n, -1);
    fit(restBefore, n, 0.0);
    if (revision_ == contents.revision()) return;
    revision_ = contents.revision();
    both_.assign(compression.begin(), compression.end());
    whole_.clear();
    for (int step : brokenAt)
        whole_.push_back(step < 0 ? 1 : 0);
    length_.clear();
    for (int d = 0; d < 3; ++d) {
        span_[d].clear();
        arms_[0][d].clear();
        arms_[1][d].clear();
    }
    for (std::size_t i = 0; i < bodies1.size(); ++i) {
        const Vector3r span = points2[i] - points1[i];
        length_.push_back(span.norm());
        for (int d = 0; d < 3; ++d)
            span_[d].push_back(span[d]);
        for (int end = 0; end < 2; ++end) {
            const int body = (end ? bodies2 : bodies1)[i];
            Vector3r arm = Vector3r::Zero();
            if (body != ground) {
                contents.bodies.detectMove(body);
                const auto& s = contents.bodies.state(body);
                arm = s.refOri.conjugate() * ((end ? points2 : points1)[i] - s.refPos);
            }
            for (int d = 0; d < 3; ++d)
                arms_[end][d].push_back(arm[d]);
        }
    }
}

void Ties::gather(SceneContents& contents, Piece& piece, int first, int count) const {
    auto& bodies = contents.bodies;
    const bool noticed = contents.loop != nullptr; // that engine has looked whether scripts have moved bodies
    for (int end = 0; end < 2; ++end) {
        const int* ids = (end ? bodies2 : bodies1).data() + first;
        const Vector3r* points = (end ? points2 : points1).data() + first;
        for (int i = 0; i < count; ++i) {
            const int body = ids[i];
            if (body == ground) {
                for (int d = 0; d < 3; ++d) {
                    piece.place[end][d][i] = points[i][d];
                    piece.turn[end][1 + d][i] = 0;
                }
                piece.turn[end][0][i] = 1;
                continue;
            }
            if (!noticed) bodies.detectMove(body);
            for (int d = 0; d < 3; ++d)
                piece.place[end][d][i] = bodies.position[d][body];
            for (int d = 0; d < 4; ++d)
                piece.turn[end][d][i] = bodies.orientation[d][body];
        }
    }
}

// Let e be the elongation of the distance between the ends, u = e - rest that of the bar since it got its length, and p
// its plastic part. The force is F = k (u - p), not below 0 in a bar without compression, and p grows where F would
// pass the strength. By the trapezoidal rule the bar takes up (F + F') / 2 (u' - u) in a step: what is not stored in
// F² / (2 k) is dissipated. Where `rest` changes, the bar is tightened from outside, which does -(F + F') / 2 times
// that change.
MASONRY_VECTORISED
void Ties::pull(int count, Piece& p) {
    const double *k = p.stiffness, *rest = p.rest, *restBefore = p.restBefore, *strength = p.strength;
    const double *breaking = p.breaking, *both = p.both, *whole = p.whole, *lengthThen = p.length;
    double *elongation = p.elongation, *force = p.force, *flow = p.flow;
    for (int e = 0; e < 2; ++e) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i)
            put(p.turned[e], i, quaternionAt(p.turn[e], i).turn(vectorAt(p.arm[e], i)));
    }
    double *given = p.given, *lost = p.dissipated, *held = p.stored, *yields = p.yields, *breaks = p.breaks;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        const PlainVector line =
            (vectorAt(p.place[1], i) + vectorAt(p.turned[1], i)) - (vectorAt(p.place[0], i) + vectorAt(p.turned[0], i));
        const PlainVector span = vectorAt(p.span, i);
        const double length = std::sqrt(dot(line, line));
        // l² - L² = (l - L) (l + L), which loses no digits
        const double more = dot(line - span, line + span);
        const double longer = more / (length + lengthThen[i]);
        const double stiff = k[i], strong = strength[i], is = whole[i], before = force[i];
        const double u = longer - rest[i], elastic = stiff * (u - flow[i]);
        const double pushed = both[i] != 0 ? elastic : 0.0, carried = elastic < 0 ? pushed : elastic;
        const double upTo = carried < 0 ? -strong : strong, flown = is * (carried - upTo) / stiff;
        const bool over = std::abs(carried) > strong;
        const double after = is * (over ? upTo : carried), soft = 0.5 / stiff, energy = soft * after * after;
        const double mean = 0.5 * (before + after), tightened = rest[i] - restBefore[i];
        const double taken = mean * (longer - elongation[i] - tightened) - energy + soft * before * before;
        const bool apart = is * u > breaking[i];
        given[i] = -mean * tightened;
        lost[i] = apart ? taken + energy : taken;
        held[i] = apart ? 0.0 : energy;
        yields[i] = over ? is : 0.0;
        breaks[i] = apart ? 1.0 : 0.0;
        flow[i] += over ? flown : 0.0;
        const double remains = apart ? 0.0 : after, share = remains / length;
        force[i] = remains;
        elongation[i] = longer;
        put(p.pull, i, share * line);
    }
    for (int e = 0; e < 2; ++e) {
        MASONRY_INDEPENDENT
        for (int i = 0; i < count; ++i)
            put(p.torque[e], i, cross(vectorAt(p.turned[e], i), vectorAt(p.pull, i)));
    }
}

void Ties::scatter(yade::ForceContainer::Sums sums, const Piece& p, int first, int count) const {
    for (int i = 0; i < count; ++i) {
        const int one = bodies1[first + i], other = bodies2[first + i];
        const Vector3r pull(p.pull[0][i], p.pull[1][i], p.pull[2][i]);
        if (one != ground) {
            sums.forces[one] += pull;
            sums.torques[one] += Vector3r(p.torque[0][0][i], p.torque[0][1][i], p.torque[0][2][i]);
        }
        if (other != ground) {
            sums.forces[other] -= pull;
            sums.torques[other] -= Vector3r(p.torque[1][0][i], p.torque[1][1][i], p.torque[1][2][i]);
        }
    }
}

void Ties::act(SceneContents& contents) {
    prepare(contents);
    const auto sums = contents.scene().forces().sums(contents.bodies.size());
    const int step = int(contents.scene().iter), all = count();
    Piece piece;
    stored = 0;
    for (int first = 0; first < all; first += most) {
        const int n = std::min(most, all - first);
        gather(contents, piece, first, n);
        for (int end = 0; end < 2; ++end)
            for (int d = 0; d < 3; ++d)
                piece.arm[end][d] = &arms_[end][d][first];
        for (int d = 0; d < 3; ++d)
            piece.span[d] = &span_[d][first];
        piece.length = &length_[first];
        piece.stiffness = &stiffness[first];
        piece.strength = &strength[first];
        piece.breaking = &breaking[first];
        piece.both = &both_[first];
        piece.whole = &whole_[first];
        piece.rest = &rest[first];
        piece.restBefore = &restBefore[first];
        piece.elongation = &elongations[first];
        piece.force = &forces[first];
        piece.flow = &flows[first];
        pull(n, piece);
        scatter(sums, piece, first, n);
        for (int i = 0; i < n; ++i) {
            given += piece.given[i];
            dissipated += piece.dissipated[i];
            stored += piece.stored[i];
            if (piece.yields[i] + piece.breaks[i] == 0) continue;
            const auto tie = std::size_t(first + i);
            if (piece.yields[i] != 0 && yieldedAt[tie] < 0) yieldedAt[tie] = step;
            if (piece.breaks[i] != 0) {
                brokenAt[tie] = step;
                whole_[tie] = 0;
            }
        }
    }
    restBefore = rest;
}

Connectors::View Ties::view(const SceneContents& contents, int tie) const {
    const auto i = std::size_t(tie);
    if (i >= forces.size()) return {};
    const Vector3r line = endOf(contents, bodies2[i], points2[i]).place - endOf(contents, bodies1[i], points1[i]).place;
    const int condition = brokenAt[i] >= 0 ? 2 : yieldedAt[i] >= 0 ? 1 : 0;
    return {forces[i] * line.normalized(), forces[i], elongations[i], condition};
}

} // namespace masonry
