// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ip2_MasonryMat_MasonryMat_MasonryContactPhys.hpp"

template class masonry::Adapter<masonry::Ip2_MasonryMat_MasonryMat_MasonryContactPhys, yade::IPhysFunctor>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Ip2_MasonryMat_MasonryMat_MasonryContactPhys)

namespace masonry {

void Ip2_MasonryMat_MasonryMat_MasonryContactPhys::go(const shared_ptr<yade::Material>&,
                                                      const shared_ptr<yade::Material>&,
                                                      const shared_ptr<yade::Interaction>& interaction) {
    if (interaction->phys) return;
    const shared_ptr<MasonryContactPhys> phys(new MasonryContactPhys);
    static_cast<ContactProperties&>(*phys) = law();
    interaction->phys = phys;
}

double Ip2_MasonryMat_MasonryMat_MasonryContactPhys::timeStep() {
    const BetweenSteps still;
    if (const auto problem = missing(className); !problem.empty()) throw std::invalid_argument(problem);
    return timeStepOf(*this);
}

} // namespace masonry
