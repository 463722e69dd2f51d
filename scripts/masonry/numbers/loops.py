# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of loops of force over displacement, simulated or measured.

Displacements are in mm and forces in kN, so that their products are in J. Both are given as
one-dimensional sequences of the same length, in the order of time. Rows may be any distance apart
and may repeat. Wrong input raises ValueError.

``threshold`` is a displacement [mm] below which a reversal or an excursion is taken for noise. For
a measured history take several times the scatter of its displacements, and less than half its
smallest amplitude.

A *half cycle* is an excursion to one side: from one passage through zero displacement to the next.
A *cycle* is two half cycles in a row, one to either side. A place in a curve is given as a row
number with a fraction: 7.25 is a quarter of the way from row 7 to row 8, with straight lines
between rows.
"""

import math
from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from ..arguments import Numbers

#: An excursion to one side. ``start`` and ``end`` are its places in the curve; ``extreme`` is the
#: row of its largest displacement, the first of equal ones; ``side`` is 1 or -1; ``complete`` says
#: whether it both begins and ends at zero.
HalfCycle = namedtuple("HalfCycle", "start end extreme side complete")


class Cycle(NamedTuple):
    """A cycle and its numbers. What cannot be found is NaN."""

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
    """A sequence as an array of finite numbers, or ValueError."""
    values = np.asarray(values, float)
    if values.ndim != 1 or not len(values):
        raise ValueError(f"{name} must be a row of numbers, at least one")
    if not np.isfinite(values).all():
        first = int(np.isfinite(values).argmin())
        raise ValueError(f"{name} in row {first} is {values[first]}")
    return values


def _curve(displacement, force):
    """Both sequences as arrays of finite numbers, or ValueError."""
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
    once it has risen by more. The first row of the array is where the first swing begins: row 0, or
    one that is not more than the threshold away from it. The last one is where the last swing ends:
    the last row of the curve, or one from which the curve has turned back by no more than the
    threshold. A curve without such a swing has row 0 alone.
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
    """Excursions to either side that go beyond the threshold: a list of :class:`HalfCycle` that
    alternate in side.

    A half cycle ends at the last passage through zero before the displacement goes beyond the
    threshold on the other side. The first one is complete if the curve begins within the threshold
    of zero or passes through zero before it. The last one is complete if the curve ends within the
    threshold of zero; it then ends at the last passage through zero, or at the last row if there is
    none.

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
    """The last place at which displacements pass through zero or leave it, or None; at zero itself
    the last row."""
    if moved[-1] == 0:
        return float(len(moved) - 1)
    other = np.flatnonzero(np.sign(moved) != np.sign(moved[-1]))
    if not len(other):
        return None
    at = int(other[-1])
    return at + float(moved[at] / (moved[at] - moved[at + 1]))


def stretch(values: Numbers, start: float, end: float) -> np.ndarray:
    """The part of a sequence between two places: the values at both, and those of the rows
    between."""
    values = np.asarray(values, float)
    rows = np.arange(len(values))
    between = rows[(rows > start) & (rows < end)]
    return np.interp(np.concatenate([[start], between, [end]]), rows, values)


def area(force: Any, moved: Any) -> float:
    """Area under a curve of straight lines, for example the work of a force over its displacement.

    :param force: values; ``moved``: the places of these, of which the unit times that of the force
        is the unit of the area
    """
    force, moved = np.asarray(force, float), np.asarray(moved, float)
    return float(0.5 * (force[1:] + force[:-1]) @ np.diff(moved))


def work(
    displacement: Numbers, force: Numbers, start: float = 0.0, end: float | None = None
) -> float:
    """Integral of the force over the displacement between two places of a curve, from its first to
    its last row unless they are given [J]. Trapezoids between rows."""
    moved, force = _curve(displacement, force)
    end = len(moved) - 1 if end is None else end
    return area(stretch(force, start, end), stretch(moved, start, end))


def secantStiffness(displacement: Numbers, force: Numbers, high: int, low: int) -> float:
    """Slope of the line between two rows of a curve, the peak-to-peak stiffness if they are its
    extremes [kN/mm].

    It is NaN if both have the same displacement.
    """
    moved, force = _curve(displacement, force)
    far = moved[high] - moved[low]
    return float((force[high] - force[low]) / far) if far else math.nan


def equivalentDamping(work: float, stiffness: float, amplitude: float) -> float:
    """Ratio ξ of the viscous damping that takes as much work in a cycle, ξ = W / (4π·½·K·A²) [-].

    It is W over 4π times the elastic energy ½·K·A² at the amplitude, as Jacobsen defined it (1930).
    It is NaN if stiffness or amplitude are not above 0.

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
    """Displacement at which the force first vanishes after an extreme, on the way back, linear
    between rows [mm].

    It is NaN if the force at the extreme is zero already, or does not come to zero up to the end.

    :param extreme: row of the extreme displacement
    :param end: last row to look at; the last of the curve if it is not given
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
    """The cycles of a curve with their numbers: a list of :class:`Cycle`.

    Complete half cycles are joined in pairs from the first one on. One that is left over at the end
    is no cycle.

    :param zero: as in :func:`halfCycles`
    """
    moved, force = _curve(displacement, force)
    halves = [h for h in halfCycles(moved, threshold, zero) if h.complete]
    # where the next swing to the other side ends, up to which a residual displacement is looked for
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
    """Rows of the envelope: where the displacement is farther to its side than ever before.

    Drawn as lines over the displacement, they bridge what is within reach of earlier rows.

    :returns: two arrays of rows in order of time, of the positive and of the negative side
    """
    moved = _row(displacement) - zero
    before = lambda side: np.maximum.accumulate(np.append(0.0, side * moved))[:-1]
    return tuple(np.flatnonzero(side * moved > before(side)) for side in (1, -1))
