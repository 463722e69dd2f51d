# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of loops of force over displacement, simulated or measured.

Displacements [mm] and forces [kN], whose products are in J, are sequences of the same length in the
order of time. Rows may be any distance apart and may repeat. Wrong input raises ValueError.

``threshold`` is a displacement [mm] below which a reversal or an excursion is taken for noise: for
a measured history several times the scatter of its displacements, and less than half its smallest
amplitude.

A *half cycle* is an excursion to one side, between passages through zero displacement. A *cycle* is
two half cycles in a row, one to either side. A place in a curve is a row number with a fraction:
7.25 is a quarter of the straight line from row 7 to row 8.
"""

import math
from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from ..arguments import Numbers

#: An excursion to one side (1 or -1): its places in the curve, the row of its largest displacement
#: (the first of equal ones), and whether it both begins and ends at zero.
HalfCycle = namedtuple("HalfCycle", "start end extreme side complete")


class Cycle(NamedTuple):
    """A cycle and its numbers, NaN where there is none."""

    start: float  #: its place in the curve
    end: float
    largest_mm: float  #: its extreme displacements
    smallest_mm: float
    amplitude_mm: float  #: half of their difference
    work_J: float  #: integral of the force over the displacement from start to end
    largest_kN: float  #: its extreme forces, wherever they are
    smallest_kN: float
    stiffness_kN_per_mm: float  #: :func:`secantStiffness` between these displacements
    damping: float  #: :func:`equivalentDamping` [-]
    residual_positive_mm: float  #: :func:`residualDisplacement` after the largest
    residual_negative_mm: float  #: and after the smallest displacement


def _row(values, name="displacement"):
    values = np.asarray(values, float)
    if values.ndim != 1 or not len(values):
        raise ValueError(f"{name} must be a row of numbers, at least one")
    if not np.isfinite(values).all():
        first = int(np.isfinite(values).argmin())
        raise ValueError(f"{name} in row {first} is {values[first]}")
    return values


def _curve(displacement, force):
    moved, force = _row(displacement), _row(force, "force")
    if len(moved) != len(force):
        raise ValueError(f"there are {len(moved)} displacements and {len(force)} forces")
    return moved, force


def _noise(threshold):
    if not 0 <= threshold < math.inf:
        raise ValueError(f"threshold {threshold} mm must be at least 0 and finite")


def turningPoints(displacement: Numbers, threshold: float = 0.0) -> np.ndarray:
    """Rows at which a curve turns: an array, between whose rows the displacement changes by more
    than the threshold.

    A maximum counts once the displacement has fallen by more than the threshold below it, a minimum
    once it has risen by more. The first row is 0, or one within the threshold of it; the last is
    that of the curve, or one from which the curve has turned back by no more than the threshold. A
    curve without such a swing has row 0 alone.
    """
    moved = _row(displacement)
    _noise(threshold)
    rows: list[int] = []
    high, low, upwards, downwards = 0, 0, True, True
    for row, x in enumerate(moved):
        if upwards and x > moved[high]:
            high = row
        if downwards and x < moved[low]:
            low = row
        if upwards and moved[high] - x > threshold:
            rows.append(high)
            upwards, downwards, low = False, True, row
        elif downwards and x - moved[low] > threshold:
            rows.append(low)
            upwards, downwards, high = True, False, row
    if upwards != downwards:
        rows.append(high if upwards else low)
    return np.array(rows or [0])


def halfCycles(displacement: Numbers, threshold: float, zero: float = 0.0) -> list[HalfCycle]:
    """Excursions to alternate sides that go beyond the threshold.

    A half cycle ends at the last passage through zero before the displacement goes beyond the
    threshold on the other side. The first one is complete if the curve begins within the threshold
    of zero or passes through zero before it; the last one if the curve ends within the threshold of
    zero: then it ends at the last passage through zero, or at the last row if there is none.

    :param zero: the displacement from which excursions are counted [mm]
    """
    moved = _row(displacement) - zero
    _noise(threshold)
    last = len(moved) - 1
    beyond = np.flatnonzero(np.abs(moved) > threshold)
    turned = beyond[np.diff(np.sign(moved[beyond]), prepend=0) != 0]
    starts = [_lastPassage(moved[: row + 1]) for row in turned]
    passage, ends = _lastPassage(moved), abs(moved[last]) <= threshold
    if not ends or passage is None or not len(beyond) or passage <= beyond[-1]:
        passage = float(last)
    found = []
    for row, start, end in zip(turned, starts, [*starts[1:], None]):
        begins = start is not None or abs(moved[0]) <= threshold
        complete = bool(begins and (end is not None or ends))
        start, end = start or 0.0, passage if end is None else end
        rows = slice(math.ceil(start), math.floor(end) + 1)
        side = int(np.sign(moved[row]))
        extreme = rows.start + int(np.argmax(side * moved[rows]))
        found.append(HalfCycle(start, end, extreme, side, complete))
    return found


def _lastPassage(moved):
    """The last place at which displacements pass through zero or leave it, or None."""
    if moved[-1] == 0:
        return float(len(moved) - 1)
    other = np.flatnonzero(np.sign(moved) != np.sign(moved[-1]))
    if not len(other):
        return None
    at = int(other[-1])
    return at + float(moved[at] / (moved[at] - moved[at + 1]))


def stretch(values: Numbers, start: float, end: float) -> np.ndarray:
    """Values of a sequence at two places and in the rows between."""
    values = np.asarray(values, float)
    rows = np.arange(len(values))
    between = rows[(rows > start) & (rows < end)]
    return np.interp(np.concatenate([[start], between, [end]]), rows, values)


def area(force: Any, moved: Any) -> float:
    """Area under a curve of straight lines, as the work of a force over its displacement; its unit
    is the product of theirs."""
    force, moved = np.asarray(force, float), np.asarray(moved, float)
    return float(0.5 * (force[1:] + force[:-1]) @ np.diff(moved))


def work(
    displacement: Numbers, force: Numbers, start: float = 0.0, end: float | None = None
) -> float:
    """Integral of the force over the displacement between two places of a curve [J], by default of
    all rows. Trapezoids between rows."""
    moved, force = _curve(displacement, force)
    end = len(moved) - 1 if end is None else end
    return area(stretch(force, start, end), stretch(moved, start, end))


def secantStiffness(displacement: Numbers, force: Numbers, high: int, low: int) -> float:
    """Slope of the line between two rows of a curve, the peak-to-peak stiffness of its extremes
    [kN/mm]; NaN if both have the same displacement."""
    moved, force = _curve(displacement, force)
    far = moved[high] - moved[low]
    return float((force[high] - force[low]) / far) if far else math.nan


def equivalentDamping(work: float, stiffness: float, amplitude: float) -> float:
    """Ratio of the viscous damping that takes as much work in a cycle, ξ = W / (4π·½·K·A²) [-]
    (Jacobsen 1930); NaN if stiffness or amplitude are not above 0.

    :param work: W of the cycle [J]
    :param stiffness: K, secant from peak to peak [kN/mm]
    :param amplitude: A, half of the displacement from peak to peak [mm]
    """
    if not (stiffness > 0 and amplitude > 0):
        return math.nan
    return work / (4 * math.pi * 0.5 * stiffness * amplitude**2)


def residualDisplacement(
    displacement: Numbers, force: Numbers, extreme: int, end: int | None = None
) -> float:
    """Displacement at which the force first vanishes after an extreme [mm], linear between rows;
    NaN if the force is zero at the extreme, or does not come to zero.

    :param extreme: row of the extreme displacement
    :param end: last row to look at; None: that of the curve
    """
    moved, force = _curve(displacement, force)
    end = len(moved) - 1 if end is None else end
    side = np.sign(force[extreme])
    gone = np.flatnonzero(side * force[extreme : end + 1] <= 0)
    if not side or not len(gone):
        return math.nan
    at = extreme + int(gone[0]) - 1
    share = force[at] / (force[at] - force[at + 1])
    return float(moved[at] + share * (moved[at + 1] - moved[at]))


def cycles(
    displacement: Numbers, force: Numbers, threshold: float, zero: float = 0.0
) -> list[Cycle]:
    """The cycles of a curve: pairs of complete half cycles from the first one on."""
    moved, force = _curve(displacement, force)
    halves = [h for h in halfCycles(moved, threshold, zero) if h.complete]
    # a residual displacement is looked for up to the end of the next swing to the other side
    ends = [h.extreme for h in halves[1:]] + [len(moved) - 1]
    found = []
    for n in range(0, len(halves) - 1, 2):
        pair, until = halves[n : n + 2], ends[n : n + 2]
        rising = 0 if pair[0].side > 0 else 1
        high, low = pair[rising].extreme, pair[1 - rising].extreme
        start, end = pair[0].start, pair[1].end
        amplitude = float(moved[high] - moved[low]) / 2
        lost = work(moved, force, start, end)
        stiffness = secantStiffness(moved, force, high, low)
        forces = stretch(force, start, end)
        residuals = [
            residualDisplacement(moved, force, half.extreme, last)
            for half, last in zip(pair, until)
        ]
        found.append(
            Cycle(
                start=start,
                end=end,
                largest_mm=float(moved[high]),
                smallest_mm=float(moved[low]),
                amplitude_mm=amplitude,
                work_J=lost,
                largest_kN=float(forces.max()),
                smallest_kN=float(forces.min()),
                stiffness_kN_per_mm=stiffness,
                damping=equivalentDamping(lost, stiffness, amplitude),
                residual_positive_mm=residuals[rising],
                residual_negative_mm=residuals[1 - rising],
            )
        )
    return found


def envelope(displacement: Numbers, zero: float = 0.0) -> tuple[np.ndarray, ...]:
    """Rows of the envelope, where the displacement is farther to its side than ever before: two
    arrays, of the positive and of the negative side."""
    moved = _row(displacement) - zero
    before = lambda side: np.maximum.accumulate(np.append(0.0, side * moved))[:-1]
    return tuple(np.flatnonzero(side * moved > before(side)) for side in (1, -1))
