// SPDX-License-Identifier: GPL-2.0-or-later
// A number with a relative tolerance.
#pragma once
#include <doctest/doctest.h>

namespace masonry {

// doctest's Approx takes 1 plus the size of the numbers as their scale unless another is set. Areas and lengths in
// metres of a brick, which are much smaller than 1, would then never differ.
inline doctest::Approx within(double value, double relative) {
    return doctest::Approx(value).epsilon(relative).scale(value == 0 ? 1 : 0);
}

} // namespace masonry
