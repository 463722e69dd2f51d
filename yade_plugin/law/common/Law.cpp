// SPDX-License-Identifier: GPL-2.0-or-later
#include "Law.hpp"
#include "common/Text.hpp"

namespace masonry {

Law::Law(const JointProperties& properties, const std::vector<std::string>& problems) : properties_(properties) {
    if (problems.empty()) return;
    const auto kind = "joint \"" + properties.name + "\": ";
    throw WrongProperties(kind + joined(problems, ("\n" + kind).c_str()));
}

const SofteningTable& Law::tension() const {
    static const SofteningTable none;
    return none;
}
const SofteningTable& Law::shear() const { return Law::tension(); }
const CompressionCurve& Law::compression() const {
    static const CompressionCurve none;
    return none;
}

std::vector<std::string> Law::snapsBack(const ElasticStiffness&, double) const { return {}; }

} // namespace masonry
