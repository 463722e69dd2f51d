// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointProperties.hpp"
#include <type_traits>

namespace masonry {

namespace {

using Problems = std::vector<std::string>;

void checkTable(Problems& found, const std::string& what, const std::vector<TableRow>& rows) {
    if (rows.empty()) return;
    for (const auto& problem : SofteningTable::problems(rows))
        found.push_back(what + ", " + problem);
}

} // namespace

std::vector<std::string> JointProperties::outOfBounds(const std::function<bool(const std::string&)>& acts) const {
    using P = JointProperties;
    Problems found;
    if (name.empty()) found.push_back("name must not be empty");
    describe([&](const char* called, auto member, const Property& description) {
        using Value = std::decay_t<decltype(this->*member)>;
        if constexpr (std::is_same_v<Value, double>) {
            const bool stiffness = member == &P::normalStiffness || member == &P::shearStiffness;
            if (!stiffness && (elastic || !acts(called))) return;
            const auto problem = description.problem(inWords(called), this->*member);
            if (!problem.empty()) found.push_back(problem);
        }
        if constexpr (std::is_same_v<Value, std::vector<TableRow>>)
            if (!elastic && acts(called)) checkTable(found, inWords(called), this->*member);
    });
    return found;
}

ElasticStiffness inSeriesWithUnits(const JointProperties& p, double normalCompliance, double shearCompliance) {
    return {1 / (1 / p.normalStiffness + normalCompliance), 1 / (1 / p.shearStiffness + shearCompliance)};
}

} // namespace masonry
