#include "Law.hpp"
#include "cyclic_softening/CyclicLaw.hpp"
#include "piecewise_softening/JointLaw.hpp"

namespace masonry {

std::shared_ptr<const Law> Law::of(const JointProperties& properties) {
    if (properties.cyclic && !properties.elastic) return std::make_shared<const CyclicLaw>(properties);
    return std::make_shared<const JointLaw>(properties);
}

} // namespace masonry
