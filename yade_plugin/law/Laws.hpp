// SPDX-License-Identifier: GPL-2.0-or-later
// The list of the joint laws. A program finds here every law by its name.
#pragma once
#include "law/common/JointField.hpp"
#include "law/common/Law.hpp"
#include <memory>
#include <string>
#include <vector>

namespace masonry {

struct LawEntry {
    const char* name;    // value of the property `law` of a joint
    const char* meaning; // in words that continue "joints follow ..."
    std::shared_ptr<const Law> (*make)(const JointProperties&);
    bool (*reads)(const std::string& property); // whether the law ever reads a property of joints
    std::vector<Problem> (*problems)(const JointProperties&);
    void (*show)(const ShowField&); // calls a function with every field that the law shows, of a fresh joint
};
const std::vector<LawEntry>& laws();

// The law that properties name. Throws WrongProperties with all their problems at once.
std::shared_ptr<const Law> lawOf(const JointProperties&);

// Everything that is wrong with the properties that act; empty if all is well.
std::vector<Problem> problemsOf(const JointProperties&);

} // namespace masonry
