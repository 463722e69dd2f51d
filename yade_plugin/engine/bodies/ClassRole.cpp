// SPDX-License-Identifier: GPL-2.0-or-later
#include "ClassRole.hpp"

namespace masonry {

namespace {

std::string& declaredName(ClassRole role) {
    static std::string names[int(ClassRole::Material) + 1];
    return names[int(role)];
}

} // namespace

bool isOurs(const yade::Engine& engine) { return dynamic_cast<const EngineWithRole*>(&engine) != nullptr; }

ClassRole roleOf(const yade::Engine& engine) {
    if (const auto* ours = dynamic_cast<const EngineWithRole*>(&engine)) return ours->role();
    const auto name = engine.getClassName();
    if (name == "ForceResetter") return ClassRole::ForceResetter;
    if (name == "InteractionLoop") return ClassRole::Joints;
    return name == "NewtonIntegrator" ? ClassRole::Integrator : ClassRole::None;
}

const std::string& nameOf(ClassRole role) { return declaredName(role); }

void declareRole(ClassRole role, const char* className) { declaredName(role) = className; }

} // namespace masonry
