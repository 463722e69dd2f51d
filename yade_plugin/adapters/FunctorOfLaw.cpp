// SPDX-License-Identifier: GPL-2.0-or-later
#include "FunctorOfLaw.hpp"

namespace masonry {

std::vector<Enrolment>& enrolmentsOfFunctors() {
    static std::vector<Enrolment> all;
    return all;
}

} // namespace masonry
