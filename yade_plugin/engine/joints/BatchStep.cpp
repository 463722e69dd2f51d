// SPDX-License-Identifier: GPL-2.0-or-later
#include "BatchStep.hpp"
#include "JointImpact.hpp"
#include "common/Vectorised.hpp"
#include "engine/units/Zones.hpp"
#include "law/common/JointDamping.hpp"
#include <algorithm>

namespace masonry {

namespace {

constexpr int most = JointFrames::most;
constexpr unsigned char atRest = 2; // of JointShapes::converted

} // namespace

template <bool plane>
BatchStep<plane>::BatchStep(JointBatches& all, const SceneContents& store, const JointBatches::Batch& batch)
    : all_(all),
      own_(all.kinds[batch.kind]),
      kind_(store.kinds[batch.kind]),
      shapes_(*kind_.shapes),
      states_(*kind_.states->columns.unsynchronised()),
      bodies_(store.bodies),
      dt_(store.scene().dt),
      stiffnessDamping_(store.loop->stiffnessDamping),
      impacts_(store.loop->impacts),
      first_(batch.from),
      beyond_(batch.from + batch.count) {}

// Whether contacts have taken the place of a joint and of those in the same lanes.
template <bool plane> bool BatchStep<plane>::isReplaced(int joint) const {
    const auto* converted = &shapes_.converted[joint];
    return std::all_of(converted, converted + std::min(lanes, beyond_ - joint),
                       [](unsigned char c) { return c == atRest; });
}

// Joints are advanced together in whole lanes, which are either all intact or all not. Joints that are replaced keep
// their state, and have no forces.
template <bool plane> StepLosses BatchStep<plane>::advance() {
    const auto& pointwise = shapes_.pointwise;
    for (from_ = first_; from_ < beyond_;) {
        const bool replaced = isReplaced(from_);
        int beyond = from_ + lanes;
        while (beyond < beyond_ && pointwise[beyond] == pointwise[from_] && isReplaced(beyond) == replaced)
            beyond += lanes;
        n_ = std::min(beyond, beyond_) - from_;
        if (replaced)
            std::fill_n(onJoint(from_), std::size_t(Arithmetic::perJoint) * n_, 0.0);
        else {
            align();
            if (pointwise[from_]) {
                const auto losses = advancePoints();
                losses_.damping += losses.damping;
                losses_.impacts += losses.impacts;
            } else if (!advanceIntact())
                continue; // again, because some of these joints are not intact any more
        }
        from_ = beyond;
    }
    return losses_;
}

template <bool plane> void BatchStep<plane>::align() {
    const int own = own_.alike ? 0 : from_;
    // In a planar run the complex number z + ix stands for a place (see JointFrames.hpp).
    const auto& p = bodies_.position;
    const double* const position[3] = {p[plane ? 2 : 0].data(), p[plane ? 0 : 1].data(), p[plane ? 1 : 2].data()};
    const double *turn[4] = {}, *frame1[4], *frame2[4], *span[3];
    for (int d = 0; d < 4; ++d) {
        if (!plane || d < 2) turn[d] = plane ? all_.turn[d].data() : bodies_.orientation[d].data();
        frame1[d] = &own_.frame1[d][own];
        frame2[d] = &own_.frame2[d][own];
    }
    for (int d = 0; d < 3; ++d)
        span[d] = &own_.span[d][own];
    const int *body1 = &own_.body1[from_], *body2 = &own_.body2[from_];
    if (kind_.attached)
        Arithmetic::alignNodal(n_, body1, body2, turn, frame1, frame2, frames_);
    else
        Arithmetic::alignRigid(n_, body1, body2, position, turn, frame1, frame2, span, frames_);
}

// Advances intact joints. If one of them is about to yield, it and those in the same lanes are no longer intact; then
// nothing else happens and the answer is false.
template <bool plane> bool BatchStep<plane>::advanceIntact() {
    const std::size_t face = shapes_.alike ? 0 : from_;
    const IntactFaces faces{{&shapes_.middle[0][face], &shapes_.middle[1][face], &shapes_.middle[2][face]},
                            &shapes_.faceArea[face],
                            {&shapes_.inertia[0][face], &shapes_.inertia[1][face], &shapes_.inertia[2][face]},
                            states_.stiffness().normal,
                            states_.stiffness().shear};
    Arithmetic::spreadIntact(n_, faces, frames_);
    if (endsIntact(faces)) return false;
    for (int p = 0; p < shapes_.points; ++p) {
        openIntact(n_, faces, offset(1, p), offset(2, p), frames_);
        states_.remember(p, from_, n_, frames_.step[0]);
    }
    const auto columns = [&](LinearField& field) {
        return std::array<double*, 6>{&field.middle[0][from_], &field.middle[1][from_], &field.middle[2][from_],
                                      &field.turn[0][from_],   &field.turn[1][from_],   &field.turn[2][from_]};
    };
    const auto jumps = columns(shapes_.linear);
    if (shapes_.damped.empty())
        keepIntact(n_, frames_, jumps.data());
    else
        losses_.damping +=
            dampIntact(n_, faces, stiffnessDamping_ / dt_, jumps.data(), columns(shapes_.damped).data(), frames_);
    Arithmetic::pullIntact(n_, faces, frames_);
    finish();
    return true;
}

// Looks whether intact joints are about to yield, and ends their being intact.
template <bool plane> bool BatchStep<plane>::endsIntact(const IntactFaces& faces) {
    Mask yielding[most] = {};
    const bool convex = states_.isConvex();
    for (int p = 0; p < (convex ? int(shapes_.rim.size()) : shapes_.points); ++p) {
        const int point = convex ? shapes_.rim[p] : p;
        Arithmetic::jumpIntact(n_, faces, offset(1, point), offset(2, point), frames_);
        states_.findYielding(n_, frames_.step[0], frames_.step[1], plane ? nullptr : frames_.step[2], yielding);
    }
    Mask any = 0;
    for (int i = 0; i < n_; ++i)
        any |= yielding[i];
    for (int first = 0; any && first < n_; first += lanes) {
        const int beyond = std::min(first + lanes, n_);
        if (std::any_of(yielding + first, yielding + beyond, [](Mask m) { return m != 0; }))
            shapes_.endIntact(from_ + first);
    }
    return any != 0;
}

template <bool plane> void BatchStep<plane>::finish() {
    if (kind_.attached)
        Arithmetic::finishNodal(n_, frames_, onJoint(from_));
    else
        Arithmetic::finishRigid(n_, frames_, onJoint(from_));
}

// Finds the jumps at a point of joints between rigid blocks. Converted joints keep theirs.
template <bool plane> void BatchStep<plane>::moveRigid(int point) {
    const std::size_t i = shapes_.at(point, from_);
    double* const jump[3] = {&shapes_.jump[0][i], &shapes_.jump[1][i], &shapes_.jump[2][i]};
    Vector3r kept[most];
    for (int c = 0; c < convertedCount_; ++c)
        for (int d = 0; d < 3; ++d)
            kept[c][d] = jump[d][convertedJoints_[c]];
    Arithmetic::jumpRigid(n_, offset(0, point), offset(1, point), offset(2, point), jump[0], jump[1], jump[2], frames_);
    for (int c = 0; c < convertedCount_; ++c)
        for (int d = 0; d < 3; ++d) {
            jump[d][convertedJoints_[c]] = kept[c][d];
            frames_.step[d][convertedJoints_[c]] = 0;
        }
}

// Advances joints by their points.
template <bool plane> StepLosses BatchStep<plane>::advancePoints() {
    StepLosses losses;
    convertedCount_ = 0;
    for (int j = 0; j < n_; ++j)
        if (shapes_.converted[from_ + j]) convertedJoints_[convertedCount_++] = j;
    const int stride = int(own_.body1.size());
    double sumA[most], sumB[most]; // shear stresses of the law and of what is added to them
    for (int p = 0; p < shapes_.points; ++p) {
        const std::size_t i = shapes_.at(p, from_), first = std::size_t(p) * stride + from_;
        const double* area = &shapes_.area[shapes_.alike ? shapes_.shape(p, 0) : i];
        double *j0 = &shapes_.jump[0][i], *j1 = &shapes_.jump[1][i], *j2 = &shapes_.jump[2][i];
        if (kind_.attached)
            Arithmetic::jumpNodal(n_, &own_.place1[first], &own_.place2[first], all_.zones->displacementRows(), j0, j1,
                                  j2, frames_);
        else
            moveRigid(p);
        states_.advance(p, from_, n_, frames_.step[0], frames_.step[1], plane ? nullptr : frames_.step[2],
                        frames_.normalStress);
        const double *a = states_.shearStressA(p, from_), *b = states_.shearStressB(p, from_);
        if (addBesideLaw(p, area, sumA, sumB, losses)) {
            a = sumA;
            b = sumB;
        }
        if (kind_.attached)
            Arithmetic::pullNodal(n_, area, frames_.normalStress, a, b, j0, j1, j2, frames_,
                                  &all_.onPoints[std::size_t(Arithmetic::perPoint) * (own_.firstPoint + first)]);
        else
            Arithmetic::pullRigid(n_, area, frames_.normalStress, a, b, offset(0, p), offset(1, p), frames_);
    }
    finish();
    for (int c = 0; c < convertedCount_; ++c) {
        const int joint = from_ + convertedJoints_[c];
        shapes_.converted[joint] = atRest;
        std::fill_n(onJoint(joint), Arithmetic::perJoint, 0.0);
    }
    return losses;
}

// Adds the stresses of damping and impacts at a point to those of the law. Returns whether there are any; then the
// shear stresses stand in the two columns.
template <bool plane>
bool BatchStep<plane>::addBesideLaw(int point, const double* area, double* shearA, double* shearB, StepLosses& losses) {
    const bool damped = !shapes_.viscous[0].empty();
    const bool meets =
        !shapes_.closing.empty() && std::find(shapes_.rim.begin(), shapes_.rim.end(), point) != shapes_.rim.end();
    if (!damped && !meets) return false;
    static constexpr double none[most] = {};
    const double* const change[3] = {frames_.step[0], frames_.step[1], plane ? none : frames_.step[2]};
    std::copy_n(states_.shearStressA(point, from_), n_, shearA);
    if (plane)
        std::fill_n(shearB, n_, 0.0);
    else
        std::copy_n(states_.shearStressB(point, from_), n_, shearB);
    if (damped) {
        const std::size_t i = shapes_.at(point, from_);
        const auto& properties = states_.law().properties();
        const double times = stiffnessDamping_ / dt_;
        const JointDamping damping{times * states_.stiffness().normal, times * states_.stiffness().shear,
                                   properties.elastic, states_.isBonded(), properties.friction};
        double* const viscous[3] = {&shapes_.viscous[0][i], &shapes_.viscous[1][i], &shapes_.viscous[2][i]};
        losses.damping +=
            addJointDamping(n_, damping, states_.regime(point, from_), states_.column(Role::BondDamage, point, from_),
                            area, change, frames_.normalStress, shearA, shearB, viscous);
    }
    if (meets)
        losses.impacts += addImpacts({bodies_, all_.jointedArea, dt_, impacts_}, shapes_, point, from_, n_, area,
                                     change, frames_.normalStress, shearA, shearB);
    return true;
}

template class BatchStep<true>;
template class BatchStep<false>;

} // namespace masonry
