// SPDX-License-Identifier: GPL-2.0-or-later
// Bars between points of two bodies: elastic, yielding, breaking. An engine derives from it.
#pragma once
#include "Connectors.hpp"
#include "common/Property.hpp"

namespace masonry {

class Ties : public Connectors {
public:
    std::vector<double> stiffness; // E A / L [N/m]
    std::vector<double> strength;  // force at which a bar yields [N]
    std::vector<double> breaking;  // elongation since the bar got its length at which it breaks [m]
    std::vector<int> compression;  // whether a bar carries compression, too
    std::vector<double> rest;      // elongation without force [m]: below 0 it is prestressed, above 0 slack

    std::vector<double> elongations; // of the distance between the ends, in the last step [m]
    std::vector<double> forces;      // in the last step, positive in tension [N]
    std::vector<double> flows;       // plastic elongation so far [m]
    std::vector<int> yieldedAt;      // step in which a bar yielded first; -1: it has not
    std::vector<int> brokenAt;       // step in which it broke; -1: it has not
    std::vector<double> restBefore;  // `rest` in the last step [m]

    static Property ofStiffness() { return number("N/m", "").above(0); }
    static Property ofStrength() { return number("N", "").above(0); }
    static Property ofBreaking() { return number("m", "").above(0); }
    static Property ofRest() { return number("m", ""); }

    std::vector<std::string> problems() const;
    void act(SceneContents&) override;
    Vector3r stiffnessOf(int tie) const override { return Vector3r::Constant(stiffness[tie]); }
    Vector3r rotationalStiffnessOf(int) const override { return Vector3r::Zero(); }
    View view(const SceneContents&, int tie) const override;
    bool isBar() const override { return true; }

protected:
    // What was found from ends and reference state is found again in the next step.
    void forgetReference() { revision_ = -1; }

private:
    static constexpr int most = 64; // ties that are worked on at a time, so that all their numbers are in the cache
    struct Piece;                   // these numbers

    void prepare(SceneContents&);
    void gather(SceneContents&, Piece&, int first, int count) const;
    static void pull(int count, Piece&);
    void scatter(yade::ForceContainer::Sums, const Piece&, int first, int count) const;

    // Of every tie, found from the ends and the reference state: arms of both ends in the reference orientation of
    // their bodies [m], the way from one end to the other [m], and the length of that [m].
    std::vector<double> arms_[2][3], span_[3], length_;
    std::vector<double> both_, whole_; // 1 where a tie carries compression, and where it is not broken; else 0
    long revision_ = -1;               // SceneContents::revision() of that
};

} // namespace masonry
