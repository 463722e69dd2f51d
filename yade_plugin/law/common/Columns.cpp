// SPDX-License-Identifier: GPL-2.0-or-later
#include "Columns.hpp"

namespace masonry {

MASONRY_VECTORISED
void advanceElastic(double kn, double ks, const Columns& columns, std::size_t at, int count, const Jumps& jumps,
                    double* normalStress) {
    double* opening = columns[SharedColumn::Opening] + at;
    double* shearStressA = columns[SharedColumn::ShearStressA] + at;
    double* shearStressB = columns[SharedColumn::ShearStressB] + at;
    const double* irreversible = columns[SharedColumn::Irreversible] + at;
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
