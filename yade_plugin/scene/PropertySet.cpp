#include "PropertySet.hpp"
#include "Changes.hpp"

namespace masonry {

void PropertySet::makeLaw() {
    const auto wrong = fixed_.problems({"normalStiffness", "shearStiffness"}, {normalStiffness, shearStiffness});
    if (!wrong.empty()) throw std::invalid_argument("joint \"" + name + "\": " + joined(wrong, "; "));
    law_ = Law::of(*this);
    ++changes;
}

} // namespace masonry
