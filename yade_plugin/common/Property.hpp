// SPDX-License-Identifier: GPL-2.0-or-later
// The description of a property: unit, bounds, meaning, source. Checks, Python's documentation, hints about units,
// files and run.json all read it.
#pragma once
#include "common/Text.hpp"
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace masonry {

// How an attribute is treated. Flags can be combined.
enum Flags {
    Plain = 0,
    ReadOnly = 1, // Python reads it, but cannot set it
    Hidden = 2,   // saved and in checkpoints, but not shown to Python
    Given = 4,    // set by the script that builds the scene; not part of the state, so checkpoints do not hold it
    Shown = 8,    // Python reads it, but cannot set it; not saved by itself, because another attribute holds its value
    OfHost = 16,  // a value of the host's class, which saves it
};

struct Property {
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    const char* meaning = "";
    const char* unit = nullptr; // null: the property is not a number; "-": a number without a unit
    const char* from = "";      // where the default or the equation comes from
    double low = -infinity, high = infinity;
    bool lowExcluded = false, highExcluded = false;
    double usualLow = -infinity, usualHigh = infinity; // a value outside of these is probably in `otherUnit`
    const char* otherUnit = "";

    constexpr Property atLeast(double bound) const {
        Property p = *this;
        p.low = bound;
        return p;
    }
    constexpr Property above(double bound) const {
        Property p = atLeast(bound);
        p.lowExcluded = true;
        return p;
    }
    constexpr Property atMost(double bound) const {
        Property p = *this;
        p.high = bound;
        return p;
    }
    constexpr Property below(double bound) const {
        Property p = atMost(bound);
        p.highExcluded = true;
        return p;
    }
    constexpr Property source(const char* where) const {
        Property p = *this;
        p.from = where;
        return p;
    }
    constexpr Property usually(double lowest, double highest, const char* unitOtherwise) const {
        Property p = *this;
        p.usualLow = lowest;
        p.usualHigh = highest;
        p.otherUnit = unitOtherwise;
        return p;
    }

    bool isNumber() const { return unit != nullptr; }

    // The bounds in words: "0 to 0.99", "above 0 and at most 1"; empty without bounds.
    std::string bounds() const {
        const bool both = low > -infinity && high < infinity;
        if (both && !lowExcluded && !highExcluded) return text(low) + " to " + text(high);
        std::vector<std::string> parts;
        if (low > -infinity) parts.push_back((lowExcluded ? "above " : "at least ") + text(low));
        if (high < infinity) parts.push_back((highExcluded ? "below " : "at most ") + text(high));
        return joined(parts, " and ");
    }

    // One sentence for Python's documentation: "Young's modulus of the unit [Pa], above 0 (paper table 2)."
    std::string documentation() const {
        std::string all = meaning;
        if (isNumber()) all += std::string(" [") + unit + "]";
        if (const auto within = bounds(); !within.empty()) all += ", " + within;
        if (*from) all += std::string(" (") + from + ")";
        return all + ".";
    }

    // What is wrong with a value of the property called `name`; empty if nothing is.
    std::string problem(const std::string& name, double value) const {
        const bool bare = !unit || !*unit || std::string(unit) == "-";
        const auto shown = name + " " + text(value) + (bare ? "" : std::string(" ") + unit) + " must be ";
        const bool range = std::isdigit(static_cast<unsigned char>(bounds()[0])) != 0;
        if (!std::isfinite(value))
            return shown + "a finite number" + (bounds().empty() ? "" : (range ? ", " : " ") + bounds());
        const bool tooLow = value < low || (lowExcluded && value == low);
        const bool tooHigh = value > high || (highExcluded && value == high);
        return tooLow || tooHigh ? shown + bounds() : "";
    }
};

// What is wrong with a property, or with some that do not go together.
struct Problem {
    std::string property;              // as the code names it
    std::string text;                  // a sentence in the user's words
    const char* code = "incompatible"; // or "bounds", "table", "law" or "smallEnergy"
};

// Properties that a law cannot have. Python finds `problems` as an attribute of the error.
struct WrongProperties : std::invalid_argument {
    std::vector<Problem> problems;

    WrongProperties(const std::string& message, std::vector<Problem> problems)
        : std::invalid_argument(message), problems(std::move(problems)) {}
};

// For what is not a number: a text, a switch, a list or an object.
constexpr Property described(const char* meaning) {
    Property p;
    p.meaning = meaning;
    return p;
}
constexpr Property number(const char* unit, const char* meaning) {
    Property p = described(meaning);
    p.unit = unit;
    return p;
}

// A name of the code as words: "modeIFractureEnergy" is "mode I fracture energy".
inline std::string inWords(const std::string& name) {
    std::string words;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool capital = std::isupper(static_cast<unsigned char>(name[i])) != 0;
        const bool numeral = name[i] == 'I'; // mode I, mode II
        if (capital && !(numeral && i > 0 && name[i - 1] == 'I')) words += ' ';
        words += capital && !numeral ? char(std::tolower(static_cast<unsigned char>(name[i]))) : name[i];
    }
    return words;
}

// A problem whose sentence begins with the name of the property.
inline Problem about(const std::string& property, const std::string& rest, const char* code = "incompatible") {
    return {property, inWords(property) + " " + rest, code};
}

// The name that differs in the fewest letters from a misspelt one; empty if more than a third of its letters, and more
// than two, differ.
inline std::string nearestName(const std::string& wrong, const std::vector<std::string>& names) {
    std::string best;
    std::size_t least = std::max<std::size_t>(2, wrong.size() / 3) + 1;
    for (const auto& name : names) {
        std::vector<std::size_t> row(name.size() + 1); // of the table of Levenshtein's distance
        std::iota(row.begin(), row.end(), std::size_t(0));
        for (std::size_t i = 0; i < wrong.size(); ++i) {
            std::size_t diagonal = row[0]++;
            for (std::size_t j = 0; j < name.size(); ++j) {
                const bool same = std::tolower(static_cast<unsigned char>(wrong[i])) ==
                                  std::tolower(static_cast<unsigned char>(name[j]));
                const std::size_t next = std::min({row[j + 1] + 1, row[j] + 1, diagonal + (same ? 0 : 1)});
                diagonal = row[j + 1];
                row[j + 1] = next;
            }
        }
        if (row.back() < least) {
            least = row.back();
            best = name;
        }
    }
    return best;
}

} // namespace masonry
