# SPDX-License-Identifier: GPL-2.0-or-later
"""Ground motion: records of acceleration, and viscous damping for it. This module needs no YADE."""

import math
import os
from typing import Annotated, Any

import numpy as np

from ..arguments import listOf, number, path, validated
from ..errors import Refused
from . import accelerograms
from .accelerograms import UNEVEN, UNITS


Frequency = Annotated[float, number("Hz", 0, 1e6, above=True)]


@validated
def rayleigh(
    ratio: Annotated[float, number("", 0, 1, below=True)],
    low: Frequency,
    high: Frequency,
) -> tuple[float, float]:
    """Viscous damping for :meth:`masonry.scene.scene.Scene.shake`: mass damping [1/s] and stiffness
    damping [s].

    :param ratio: share of critical damping at two frequencies [-]; between them it is less
    :param low: lower frequency [Hz]; ``high``: upper one
    """
    if not low < high:
        raise ValueError(f"rayleigh: low {low} Hz must be below high {high} Hz")
    one, two = 2 * math.pi * low, 2 * math.pi * high
    return 2 * ratio * one * two / (one + two), 2 * ratio / (one + two)


#: Peaks beyond these may be in g, or in cm/s² [m/s²].
LOWEST_PEAK, HIGHEST_PEAK = 1.5, 30.0
#: No record has a larger peak [m/s²], several times the largest that was measured; and none has its
#: samples farther apart [s].
LARGEST_PEAK, COARSEST = 200.0, 0.5
#: What stands for a sample that is missing, in any unit.
MISSING = [-999.0, -9999.0, -99999.0]


def isThree(value: Any) -> bool:
    """Whether a record is three files: two horizontal components and the vertical one."""
    three = isinstance(value, (list, tuple)) and len(value) == 3
    return three and all(isinstance(one, (str, os.PathLike)) for one in value)


def record(value: Any, context: Any = None) -> Any:
    """Validator of a record: a list of accelerations, the path of a file, or a list of three
    paths."""
    if isinstance(value, (str, os.PathLike)):
        return path(value)
    if isThree(value):
        return [path(one) for one in value]
    return listOf(number("m/s²", -1e6, 1e6), 2)(value)


def readRecord(
    accelerations: Any,
    every: float | None,
    scale: float = 1.0,
    unit: str | None = None,
) -> tuple[list[Any], float]:
    """Samples and the time between them [s] of a record.

    :param accelerations: what :func:`record` takes
    :param scale: factor on the samples
    :param unit: of the samples, a key of UNITS; None: m/s², if the peak does not look like another
        unit
    :returns: the samples [m/s²], or lists of their three components, without the scale, and the
        time between two of them
    :raises Refused: with what is wrong
    """
    if unit not in (None, *UNITS):
        raise Refused(f"unit must be one of {', '.join(UNITS)}, got {unit!r}")
    if isThree(accelerations):
        parts = [readRecord(one, every, scale, unit) for one in accelerations]
        if len({(len(values), step) for values, step in parts}) > 1:
            sizes = ", ".join(f"{len(values)} samples every {step:g} s" for values, step in parts)
            raise Refused(
                f"{', '.join(map(str, accelerations))}: components of a record must be alike, not"
                f" {sizes}"
            )
        return np.transpose([values for values, _ in parts]).tolist(), parts[0][1]
    if isinstance(accelerations, (str, os.PathLike)):
        named, found = accelerations, accelerograms.read(accelerations)
        of = found.every
        if None not in (every, of) and abs(every - of) > UNEVEN * of:
            raise Refused(f"{named}: its samples are {of:g} s apart, not {every:g} s")
        if None not in (unit, found.unit) and unit != found.unit:
            raise Refused(f"{named}: it is in {found.unit}, not in {unit}")
        every, unit = of or every, found.unit or unit
        accelerations = found.values
    values = np.asarray(accelerations, float)
    if len(values) < 2 or not np.isfinite(values).all():
        raise Refused("a record needs two finite accelerations at least")
    if not (isinstance(every, (int, float)) and 0 < every < math.inf):
        raise Refused(f"every {every!r} s, the time between samples, must be above 0")
    if every > COARSEST:
        raise Refused(
            f"every {every:g} s, the time between samples, must be at most {COARSEST:g} s: is it in"
            " s, not ms?"
        )
    missing = np.argwhere(np.isin(values, MISSING))
    if len(missing):
        first = tuple(missing[0])
        raise Refused(
            f"{len(missing)} samples stand for missing values, the first is number {first[0]},"
            f" {values[first]:g}"
        )
    peak = abs(scale) * float(abs(values).max())
    if unit is None and peak > 0 and not LOWEST_PEAK <= peak <= HIGHEST_PEAK:
        other = "g" if peak < LOWEST_PEAK else "cm/s²"
        raise Refused(
            f"the peak of the record is {peak:g}, which is {peak / 9.81:.2g} g if it is in m/s²: is"
            f" it in {other}? Say unit='{other}', or unit='m/s²' if it is"
        )
    unit = unit or "m/s²"
    strongest = UNITS[unit] * peak
    if strongest > LARGEST_PEAK:
        raise Refused(
            f"the peak of the record, {strongest / 9.81:.3g} g in {unit}, must be at most"
            f" {LARGEST_PEAK / 9.81:.2g} g: is it in another unit?"
        )
    return (UNITS[unit] * values).tolist(), every
