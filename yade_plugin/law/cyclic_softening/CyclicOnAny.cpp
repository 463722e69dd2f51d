// SPDX-License-Identifier: GPL-2.0-or-later
// The cyclic law side by side with the vector units that every processor has.
#include "CyclicSideBySide.hpp"

void masonry::cyclic::advanceOnAny(const Numbers& numbers, const Columns& columns, TableRows* rows, Regime* regime,
                                   const Jumps& jumps, const Mask* pending, int count, double* normalStress) {
    advanceAs(numbers, columns, rows, regime, jumps, pending, count, normalStress);
}
