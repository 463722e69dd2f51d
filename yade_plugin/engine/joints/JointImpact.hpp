// SPDX-License-Identifier: GPL-2.0-or-later
// Impacts of rigid blocks at the ends of a joint that close after they have been open.
//
// G. W. Housner's rocking block (The behavior of inverted pendulum structures during earthquakes, Bulletin of the
// Seismological Society of America 53, 1963) meets its base at an edge that does not come back, and the edge about
// which it turned before has no impulse. On elastic points the impact lasts, all points share it, and what they have
// stored comes back. So a corner of the face gets in every step of its closing, beside the stress of the law, the
// impulse that ends its motion as an impact of two free rigid bodies does. A block's mass is shared among its joints in
// proportion to their areas, and the corners of a joint that meet at the same time have equal parts. So the impulses of
// a step end a motion and hardly reverse it, and they take energy at any time step.
#pragma once
#include "JointGroup.hpp"
#include "engine/bodies/BodyColumns.hpp"

namespace masonry {

struct JointImpacts {
    const BodyColumns& bodies;
    const std::vector<double>& jointedArea; // of the joints of every body [m²]
    double dt;                              // [s]
    bool act; // whether corners get impulses; else only the second half of the work of the last step is left to count
};

// Adds the stress of impacts to the stresses of the law [Pa] at a corner of the joints from..from+count, and brings
// JointShapes::impact and closing there up to date. `change` are the changes of the jump in this step [m]. Returns the
// energy taken in the step by the trapezoidal rule [J].
double addImpacts(const JointImpacts&, JointShapes&, int corner, int from, int count, const double* area,
                  const double* const* change, double* normal, double* shearA, double* shearB);

} // namespace masonry
