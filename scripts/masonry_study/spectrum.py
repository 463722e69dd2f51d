# SPDX-License-Identifier: GPL-2.0-or-later
"""The response of a linear oscillator to a record: spectral acceleration.

An oscillator with the angular frequency ω = 2π/T and the share ζ of critical damping, whose base
moves with the acceleration a(t), has the displacement u against its base with

    u'' + 2ζω u' + ω² u = -a(t),   u(0) = u'(0) = 0.

With s = -ζω + iω√(1-ζ²) its solution is u = Im(y)/(ω√(1-ζ²)) with y' = s y - a. Where a changes
evenly between two samples, y at the next of them follows in closed form from y at this one, with no
error of a time step: N. C. Nigam and P. C. Jennings, "Calculation of response spectra from
strong-motion earthquake records", Bulletin of the Seismological Society of America 59 (1969), in
complex numbers.
"""

import cmath
import math
from typing import Annotated

import numpy as np

from masonry.arguments import Numbers, listOf, number, validated

DAMPING = 0.05  # share of critical damping of the usual spectra [-]
#: Points of a period at least at which the displacement is looked at: its largest is missed by less
#: than 1 - cos(π/100).
POINTS = 100
SHORTEST, LONGEST = 0.01, 100.0  # periods [s]

Period = Annotated[float, number("s", SHORTEST, LONGEST)]
Ratio = Annotated[float, number("", 0, 1, below=True)]


@validated
def spectralAcceleration(
    values: Annotated[Numbers, listOf(number("m/s²", -1e6, 1e6), 2)],
    every: Annotated[float, number("s", 0, 86400, above=True)],
    period: Period,
    damping: Ratio = DAMPING,
) -> float:
    """The pseudo spectral acceleration of a record [m/s²]: ω² times the largest displacement.

    This is looked for during the record and a period of free vibration after it, at a hundred
    points of a period or more, so it is too small by 0.05 % at most.

    :param values: samples of the acceleration [m/s²], between which it is interpolated; ``every``:
        the time between them [s]
    :param period: of the oscillator [s]
    :param damping: share of critical damping [-]
    :raises Refused: if something is out of its bounds
    """
    from scipy.signal import lfilter

    a = np.asarray(values, float)
    parts = max(1, math.ceil(POINTS * every / period))
    step = every / parts
    if parts > 1:
        a = np.interp(np.arange((len(a) - 1) * parts + 1) / parts, np.arange(len(a)), a)
    omega = 2 * math.pi / period
    swing = omega * math.sqrt(1 - damping**2)
    s = complex(-damping * omega, swing)
    over = cmath.exp(s * step)
    whole = (over - 1) / s  # ∫ exp(s(step - t)) dt over a step
    late = (over - 1 - s * step) / (s * s * step)  # ∫ exp(s(step - t)) t/step dt
    drive = -((whole - late) * a[:-1] + late * a[1:])
    y = lfilter([1.0], [1.0, -over], drive)
    free = y[-1] * np.exp(s * np.arange(period / step + 1) * step)
    largest = max(abs(y.imag).max(), abs(free.imag).max())
    return float(omega**2 * largest / swing)
