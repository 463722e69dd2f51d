// SPDX-License-Identifier: GPL-2.0-or-later
#include "FunctorOfLaw.hpp"

namespace masonry {

class Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening
    : public FunctorOfLaw<Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening> {
public:
    static constexpr const char* className = "Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening";
    static constexpr const char* law = "cyclic";
    static constexpr const char* doc =
        "The cyclic law at every subcontact, one joint at a time: the strengths of the paper's law, with softening by "
        "rate, stiffness that degrades and dilatancy that turns back. Its parameters are those of the MasonryJoint "
        "objects, whose law must be \"cyclic\" or which must be elastic. MasonryJointLoop is the fast way through the "
        "same law.";
};

} // namespace masonry

MASONRY_FUNCTOR_OF_LAW(Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening)
