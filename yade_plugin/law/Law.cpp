#include "Law.hpp"
#include "law/cyclic_softening/CyclicLaw.hpp"
#include "law/piecewise_softening/JointLaw.hpp"

namespace masonry {

std::shared_ptr<const Law> Law::of(const JointProperties& properties) {
    if (properties.cyclic && !properties.elastic) return std::make_shared<const CyclicLaw>(properties);
    return std::make_shared<const JointLaw>(properties);
}

} // namespace masonry
