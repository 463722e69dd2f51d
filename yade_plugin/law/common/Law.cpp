// SPDX-License-Identifier: GPL-2.0-or-later
#include "Law.hpp"

namespace masonry {

Law::Law(const JointProperties& properties, std::vector<Problem> problems) : properties_(properties) {
    if (!problems.empty()) throw wrongJoint(properties.name, std::move(problems));
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
