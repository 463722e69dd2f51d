// SPDX-License-Identifier: GPL-2.0-or-later
#include "adapters/FunctorOfLaw.hpp"

namespace masonry {

class Law2_MasonryJointGeom_MasonryJointPhys_CoulombFriction
    : public FunctorOfLaw<Law2_MasonryJointGeom_MasonryJointPhys_CoulombFriction> {
public:
    static constexpr const char* className = "Law2_MasonryJointGeom_MasonryJointPhys_CoulombFriction";
    static constexpr const char* law = "coulomb";
    static constexpr const char* doc = "Coulomb friction without bond and softening, for tests.";
};

} // namespace masonry

MASONRY_FUNCTOR_OF_LAW(Law2_MasonryJointGeom_MasonryJointPhys_CoulombFriction)
