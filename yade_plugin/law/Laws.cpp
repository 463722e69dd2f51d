// SPDX-License-Identifier: GPL-2.0-or-later
#include "Laws.hpp"
#include "common/Text.hpp"
#include "law/cyclic_softening/CyclicLaw.hpp"
#include "law/piecewise_softening/PiecewiseLaw.hpp"
#ifdef MASONRY_FURTHER_LAW_HEADER // a build for tests adds a law that does not belong to the plugin
#include MASONRY_FURTHER_LAW_HEADER
#else
#define MASONRY_FURTHER_LAW
#endif

namespace masonry {

namespace {

template <class LawType> LawEntry entry() {
    return {LawType::name,
            LawType::meaning,
            [](const JointProperties& p) -> std::shared_ptr<const Law> { return std::make_shared<const LawType>(p); },
            &LawType::reads,
            [](const JointProperties& p) { return LawType::problems(p); },
            [](const ShowField& show) { LawType::show({}, {}, show); }};
}

} // namespace

const std::vector<LawEntry>& laws() {
    static const std::vector<LawEntry> all{
        entry<PiecewiseLaw>(), entry<CyclicLaw>(),
        MASONRY_FURTHER_LAW //
    };
    return all;
}

namespace {

const LawEntry* find(const std::string& name) {
    for (const auto& law : laws())
        if (law.name == name) return &law;
    return nullptr;
}

} // namespace

std::vector<Problem> problemsOf(const JointProperties& properties) {
    if (const auto* law = find(properties.law)) return law->problems(properties);
    std::vector<std::string> names;
    for (const auto& law : laws())
        names.push_back(law.name);
    auto found = properties.outOfBounds([](const std::string&) { return false; });
    found.push_back({"law", "law \"" + properties.law + "\" must be one of: " + joined(names, ", "), "law"});
    return found;
}

std::shared_ptr<const Law> lawOf(const JointProperties& properties) {
    if (const auto* law = find(properties.law)) return law->make(properties);
    throw wrongJoint(properties.name, problemsOf(properties));
}

} // namespace masonry
