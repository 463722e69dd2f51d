// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law side by side with the vector units that every processor has.
#include "CyclicSideBySide.hpp"

void masonry::cyclic::advanceOnAny(const Numbers& numbers, TableRows* rows, const SideBySide& all) {
    advanceAs(numbers, rows, all);
}
