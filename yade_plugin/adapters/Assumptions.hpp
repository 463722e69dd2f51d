// SPDX-License-Identifier: GPL-2.0-or-later
// What nobody has given of an object, and where each of these values is from. A class that derives from it beside
// Adapter notes its defaults when Python makes an object, and forgets those that are set. Of an object from a file
// everything counts as given.
#pragma once
#include "Attribute.hpp"
#include <map>

namespace masonry {

class Assumptions {
public:
    // Source of each value that was not given, by the name of its attribute.
    std::map<std::string, std::string> assumed;

    py::dict sources() const {
        py::dict all;
        for (const auto& [name, source] : assumed)
            all[name] = source;
        return all;
    }
    // Notes that these values are assumed, with the source of each, and that all others are given.
    void assume(const py::dict& sources) {
        std::map<std::string, std::string> all;
        const py::list names = sources.keys();
        for (py::ssize_t i = 0; i < py::len(names); ++i)
            all[py::extract<std::string>(names[i])] = py::extract<std::string>(sources[names[i]]);
        assumed = all;
    }
    void noteGiven(const py::dict& values) {
        const py::list names = values.keys();
        for (py::ssize_t i = 0; i < py::len(names); ++i)
            assumed.erase(py::extract<std::string>(names[i]));
    }
};

} // namespace masonry
