// SPDX-License-Identifier: GPL-2.0-or-later
// The elasticity of masonry units of one material. A material derives from it.
#pragma once
#include "Fixed.hpp"

namespace masonry {

class UnitMaterial {
public:
    double young = 4.8e9;  // Young's modulus [Pa]
    double poisson = 0.16; // Poisson's ratio [-]

    double shearModulus() const { return young / (2 * (1 + poisson)); } // [Pa]

    // To be called when a joint of such a unit is made, or such a unit divided: its elasticity is fixed then.
    void usedIn(const yade::Scene& scene) const { fixed_.fix(scene, {young, poisson}); }
    // One sentence for each value that was changed since then.
    std::vector<std::string> changedTooLate() const { return fixed_.problems({"young", "poisson"}, {young, poisson}); }

private:
    mutable Fixed fixed_;
};

} // namespace masonry
