// SPDX-License-Identifier: GPL-2.0-or-later
#include "Colours.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

Colour ColourScale::at(double value) const {
    const double share = most > 0 && std::isfinite(value) ? std::clamp(value / most, 0.0, 1.0) : 0;
    const double place = share * double(colours.size() - 1);
    const auto low = std::min(std::size_t(place), colours.size() - 2);
    const auto part = float(place - double(low));
    Colour mixed;
    for (int c = 0; c < 3; ++c)
        mixed[c] = (1 - part) * colours[low][c] + part * colours[low + 1][c];
    return mixed;
}

Colour ColourScale::of(int number) const { return colours[number % colours.size()]; }

DrawnScales& drawnScales() {
    static DrawnScales scales;
    return scales;
}

ColourScale scaleOf(const std::string& title, double most, bool joints) {
    ColourScale scale{title, most, {}, {}};
    if (joints) // from grey to dark red
        scale.colours = {{0.75f, 0.75f, 0.75f}, {1.0f, 0.75f, 0.2f}, {0.9f, 0.25f, 0.1f}, {0.45f, 0.0f, 0.05f}};
    else // from sand to dark blue
        scale.colours = {{0.93f, 0.88f, 0.78f}, {0.55f, 0.78f, 0.78f}, {0.2f, 0.5f, 0.75f}, {0.1f, 0.15f, 0.45f}};
    return scale;
}

ColourScale regimeScale() {
    return {"regime of joints",
            0,
            {"elastic", "opening", "slipping", "crushing"},
            {{0.75f, 0.75f, 0.75f}, {0.1f, 0.45f, 0.8f}, {0.95f, 0.6f, 0.1f}, {0.75f, 0.05f, 0.1f}}};
}

} // namespace masonry
