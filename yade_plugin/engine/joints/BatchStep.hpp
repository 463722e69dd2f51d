// SPDX-License-Identifier: GPL-2.0-or-later
// A step of the joints of a batch: from the places of blocks and nodes the jumps, from the jumps the stresses by the
// law, and from these what acts on blocks and nodes. See JointFrames for the arithmetic.
// What an intact joint is, says yade_plugin/README.md, Where the state lives. Its force and moment follow from the jump
// at the middle of the face and the moments of area. JointShapes::pointwise, which says which joints are advanced by
// points, is part of the state of a joint, so that a run that was saved goes on in the same bits.
#pragma once
#include "JointBatches.hpp"
#include "motion/JointFrames.hpp"

namespace masonry {

// Energies that a step takes [J].
struct StepLosses {
    double damping = 0, impacts = 0;
};

template <bool plane> class BatchStep {
public:
    BatchStep(JointBatches&, const SceneContents&, const JointBatches::Batch&);
    StepLosses advance();

private:
    using Arithmetic = JointArithmetic<plane>;

    bool isReplaced(int joint) const;
    void align();
    bool advanceIntact();
    bool endsIntact(const IntactFaces&);
    StepLosses advancePoints();
    void moveRigid(int point);
    bool addBesideLaw(int point, const double* area, double* shearA, double* shearB, StepLosses&);
    void finish();
    double* onJoint(int joint) { return &all_.onJoints[std::size_t(Arithmetic::perJoint) * (own_.first + joint)]; }
    const double* offset(int d, int point) const {
        return &shapes_.offset[d][shapes_.alike ? shapes_.shape(point, 0) : shapes_.at(point, from_)];
    }

    JointBatches& all_;
    const KindInStep& own_;
    const JointKind& kind_;
    JointShapes& shapes_;
    LawColumns& states_; // the step brings them up to date
    const BodyColumns& bodies_;
    const double dt_, stiffnessDamping_;
    const bool impacts_;
    const int first_, beyond_; // numbers of the batch's joints within their kind
    int from_ = 0, n_ = 0;     // first of the joints that are advanced together, and how many they are
    StepLosses losses_;
    int convertedJoints_[JointFrames::most], convertedCount_ = 0; // among the joints that are advanced together
    JointFrames frames_;
};

extern template class BatchStep<true>;
extern template class BatchStep<false>;

} // namespace masonry
