// SPDX-License-Identifier: GPL-2.0-or-later
// What the classes of adapters/ are for: each declares it, so that nothing in engine/ knows its name.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

enum class ClassRole {
    None,
    ForceResetter,
    Joints,
    Units,
    Connectors,
    Contacts,
    Load,
    Watch,
    Integrator,
    Recorder,
    Material,
};

// An engine of this plugin.
class EngineWithRole {
public:
    virtual ClassRole role() const = 0;

protected:
    ~EngineWithRole() = default;
};

bool isOurs(const yade::Engine&);
// The role of an engine, also of an engine of the host that has the role of one of ours.
ClassRole roleOf(const yade::Engine&);

// The name of the class that has declared a role, for messages.
const std::string& nameOf(ClassRole);
void declareRole(ClassRole, const char* className);

} // namespace masonry
