// SPDX-License-Identifier: GPL-2.0-or-later
#include "PropertySet.hpp"
#include "engine/bodies/Changes.hpp"
#include "law/Laws.hpp"

namespace masonry {

void PropertySet::makeLaw() {
    const auto wrong = fixed_.problems({"normalStiffness", "shearStiffness"}, {normalStiffness, shearStiffness});
    if (!wrong.empty()) throw std::invalid_argument("joint \"" + name + "\": " + joined(wrong, "; "));
    ownLaw_ = lawOf(*this);
    ++changes;
}

} // namespace masonry
