// SPDX-License-Identifier: GPL-2.0-or-later
// A force that keeps the energy where a contact, or a part of its area, begins or ends within a step. The equations are
// derived in contact/README.md.
#pragma once

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

} // namespace masonry
