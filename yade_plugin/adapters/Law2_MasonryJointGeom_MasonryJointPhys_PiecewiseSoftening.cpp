// SPDX-License-Identifier: GPL-2.0-or-later
#include "FunctorOfLaw.hpp"

namespace masonry {

class Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening
    : public FunctorOfLaw<Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening> {
public:
    static constexpr const char* className = "Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening";
    static constexpr const char* law = "softening";
    static constexpr const char* doc =
        "The joint law of the paper at every subcontact, one joint at a time: tension cut-off, Coulomb slip and "
        "elliptical cap with piecewise linear softening (paper §3). Its parameters are those of the MasonryJoint "
        "objects, whose law must be \"softening\" or which must be elastic. MasonryJointLoop is the fast way through "
        "the same law and the same "
        "columns.";
};

} // namespace masonry

MASONRY_FUNCTOR_OF_LAW(Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening)
