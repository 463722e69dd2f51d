// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointProperties.hpp"
#include <type_traits>

namespace masonry {

namespace {

void checkTable(std::vector<Problem>& found, const char* property, const std::vector<TableRow>& rows) {
    if (rows.empty()) return;
    for (const auto& problem : SofteningTable::problems(rows))
        found.push_back({property, inWords(property) + ", " + problem, "table"});
}

} // namespace

WrongProperties wrongJoint(const std::string& name, std::vector<Problem> problems) {
    std::vector<std::string> texts;
    for (auto& problem : problems) {
        problem.text = "joint \"" + name + "\": " + problem.text;
        texts.push_back(problem.text);
    }
    return {joined(texts, "\n"), std::move(problems)};
}

std::vector<Problem> JointProperties::outOfBounds(const std::function<bool(const std::string&)>& acts) const {
    using P = JointProperties;
    std::vector<Problem> found;
    if (name.empty()) found.push_back({"name", "name must not be empty", "bounds"});
    describe([&](const char* called, auto member, const Property& description) {
        using Value = std::decay_t<decltype(this->*member)>;
        if constexpr (std::is_same_v<Value, double>) {
            const bool stiffness = member == &P::normalStiffness || member == &P::shearStiffness;
            if (!stiffness && (elastic || !acts(called))) return;
            const auto problem = description.problem(inWords(called), this->*member);
            if (!problem.empty()) found.push_back({called, problem, "bounds"});
        }
        if constexpr (std::is_same_v<Value, std::vector<TableRow>>)
            if (!elastic && acts(called)) checkTable(found, called, this->*member);
    });
    return found;
}

ElasticStiffness inSeriesWithUnits(const JointProperties& p, double normalCompliance, double shearCompliance) {
    return {1 / (1 / p.normalStiffness + normalCompliance), 1 / (1 / p.shearStiffness + shearCompliance)};
}

} // namespace masonry
