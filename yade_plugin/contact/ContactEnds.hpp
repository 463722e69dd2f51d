// SPDX-License-Identifier: GPL-2.0-or-later
// A force that keeps the energy where a contact, or a part of its area, begins or ends within a step. The equations are
// derived in contact/README.md.
#pragma once
#include "ContactWrench.hpp"

namespace masonry {

// A force that is added to those of a step, as the relative motion of two blocks feels it.
struct AddedForce {
    double work;     // the force times the way of a step with the velocity before it acts [J]
    double response; // the same with the velocity that it gives in a step itself [J], at least 0
    double others;   // the same with the velocity that all other forces of the pair give in a step [J]
};

// The share of the force, -1 to 1, that takes this energy [J] from the blocks: the share of least size, or the one that
// takes most, if none takes all.
double shareThatTakes(const AddedForce&, double energy);

// What a pair remembers of its elastic force. All numbers are 0 for a pair that did not touch.
struct ElasticAccount {
    // The elastic wrench of the last step; 0 also where nothing is known of it, because a script has put blocks
    // elsewhere.
    Wrench push;
    double given = 0;  // what the blocks have given to it since the contact began, up to the place of the last step [J]
    double excess = 0; // elastic energy less the potential, in the step after the last force that kept the energy [J]
    bool kept = false; // whether the force of the last step did so

    template <class Visit> void visitState(Visit&& visit) { visit(push, given, excess, kept); }
};

struct ContactChange { // of the contact area since the last step
    bool begins;       // the pair did not touch then
    double area;       // change over the present area
};

// Counts what the blocks gave to the elastic wrench of the last step in the half step after it. To be called first in a
// step of a pair that touched.
void countLastPush(const NearBlocks&, double dt, ElasticAccount&);

// The elastic wrench of a step, which keeps the energy where the contact area becomes another one: `elastic` is that of
// the potential, `dashpot` what damping gives in this step, as far as it is known.
Wrench keepEnergy(const NearBlocks&, double normalStiffness, double dt, const ContactChange&, const Wrench& elastic,
                  const Wrench& dashpot, OverlapFinder&, ElasticAccount&);

// The first step after a contact, whose normal in the last step this was, in the axes of the one block: the blocks get
// what they gave and did not get back, or lose what they got too much. Returns whether there is a wrench that does so.
bool endOn(const NearBlocks&, const Eigen::Vector3d& normal, double dt, ElasticAccount&, Wrench&);

} // namespace masonry
