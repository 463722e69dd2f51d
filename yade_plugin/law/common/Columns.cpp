// SPDX-License-Identifier: GPL-2.0-or-later
#include "Columns.hpp"

namespace masonry {

MASONRY_VECTORISED
void advanceElastic(double kn, double ks, const Columns& columns, int count, const Jumps& jumps, double* normalStress) {
    double* opening = columns[SharedColumn::Opening];
    double* shearStressA = columns[SharedColumn::ShearStressA];
    double* shearStressB = columns[SharedColumn::ShearStressB];
    const double* irreversible = columns[SharedColumn::Irreversible];
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i) {
        opening[i] += jumps.opening[i];
        normalStress[i] = kn * (opening[i] + irreversible[i]);
        shearStressA[i] += ks * jumps.slideA[i];
    }
    if (jumps.plane) return;
    MASONRY_INDEPENDENT
    for (int i = 0; i < count; ++i)
        shearStressB[i] += ks * jumps.slideB[i];
}

} // namespace masonry
