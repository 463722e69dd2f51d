// SPDX-License-Identifier: GPL-2.0-or-later
// Colours of YADE's 3-D view and what they mean: chosen by the functors that draw, explained by the legend.
#pragma once
#include "host/Yade.hpp"
#include <array>
#include <string>
#include <vector>

namespace masonry {

using Colour = std::array<float, 3>; // red, green and blue, 0 to 1

// What a picture shows by colours: either a value from 0 to `most`, or one of several names.
struct ColourScale {
    std::string title;              // with the unit
    double most = 0;                // value of the last colour
    std::vector<std::string> names; // empty for a value
    std::vector<Colour> colours;    // one for each name, or from 0 to `most`

    Colour at(double value) const; // of a value
    Colour of(int number) const;   // of a name
    bool shown() const { return !colours.empty(); }
};

// What this picture has drawn so far: blocks and joints. Empty scales show nothing.
struct DrawnScales {
    ColourScale blocks, joints;
};
DrawnScales& drawnScales();

ColourScale scaleOf(const std::string& title, double most, bool joints);

// The regimes of joints as the law names them, with the colour of each.
ColourScale regimeScale();

} // namespace masonry
