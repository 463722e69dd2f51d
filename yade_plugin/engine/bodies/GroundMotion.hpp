// SPDX-License-Identifier: GPL-2.0-or-later
// A record of the acceleration of the ground: blocks feel the opposite as a part of gravity.
#pragma once
#include "host/Yade.hpp"
#include <vector>

namespace masonry {

struct GroundMotion {
    std::vector<double> samples;       // one direction after the other; empty: there is no record
    std::vector<yade::Vector3r> axes;  // directions
    double interval = 0;               // between two samples [s]
    double factor = 1;                 // on the samples; the product is in m/s²
    yade::Vector3r beside = {0, 0, 0}; // gravity without the record [m/s²]
    yade::Vector3r last = {0, 0, 0};   // gravity of the last step [m/s²]

    long steps = 0;      // since the record began or the time step changed
    double before = 0;   // time of the record before these steps [s]
    double stepThen = 0; // their time step [s]

    // Sets gravity to that in the middle of a step, between samples by a straight line; without the record after its
    // end. Gravity that was changed since the last step is what acts beside the record from now on.
    void act(double dt, yade::Vector3r& gravity) {
        if (gravity != last) beside = gravity;
        gravity = last = gravityIn(dt);
    }

    template <class Visit> void visitState(Visit&& visit) { visit(steps, before, stepThen, beside, last); }

private:
    yade::Vector3r gravityIn(double dt) {
        if (dt != stepThen) {
            before += double(steps) * stepThen;
            steps = 0;
            stepThen = dt;
        }
        const double place = (before + (double(steps) + 0.5) * dt) / interval;
        const std::size_t count = samples.size() / axes.size();
        yade::Vector3r now = beside;
        if (!(place + 1 < double(count))) return now;
        const auto first = std::size_t(place);
        const double share = place - double(first);
        for (std::size_t n = 0; n < axes.size(); ++n) {
            const double* sample = &samples[n * count + first];
            now -= factor * ((1 - share) * sample[0] + share * sample[1]) * axes[n];
        }
        return now;
    }
};

} // namespace masonry
