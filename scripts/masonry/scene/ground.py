# SPDX-License-Identifier: GPL-2.0-or-later
"""Ground motion: records of acceleration, and viscous damping for it. No YADE is needed."""

import glob
import math
import os
from typing import Annotated, Any

import numpy as np

from ..arguments import listOf, number, path, validated
from ..errors import Refused
from ..terminal import say
from . import accelerograms
from .accelerograms.text_columns import UNEVEN
from .accelerograms.unit_words import UNITS


Frequency = Annotated[float, number("Hz", 0, 1e6, above=True)]


@validated
def rayleigh(
    ratio: Annotated[float, number("", 0, 1, below=True)],
    low: Frequency,
    high: Frequency,
) -> tuple[float, float]:
    """Rayleigh damping for ``scene.shake``: mass damping [1/s] and stiffness damping [s].

    :param ratio: share of critical damping at two frequencies [-]; between them it is less
    :param low: lower frequency [Hz]; ``high``: upper one
    """
    if not low < high:
        raise ValueError(f"rayleigh: low {low} Hz must be below high {high} Hz")
    one, two = 2 * math.pi * low, 2 * math.pi * high
    return 2 * ratio * one * two / (one + two), 2 * ratio / (one + two)


#: Peaks beyond these may be in g, or in cm/s² [m/s²].
LOWEST_PEAK, HIGHEST_PEAK = 1.5, 30.0
#: Bounds of a peak [m/s²], several times the largest that was measured, and of the time between
#: samples [s].
LARGEST_PEAK, COARSEST = 200.0, 0.5
#: How much longer the longest component of a record may be than the shortest one [-].
LONGER = 0.05
#: Values that stand for a missing sample, in any unit.
MISSING = [-999.0, -9999.0, -99999.0]


def isThree(value: Any) -> bool:
    """Whether a record is three files: two horizontal components and the vertical one."""
    three = isinstance(value, (list, tuple)) and len(value) == 3
    return three and all(isinstance(one, (str, os.PathLike)) for one in value)


def record(value: Any, context: Any = None) -> Any:
    """Validator of a record: a list of accelerations, the path of a file, three paths, or a pattern
    of three files, as in :func:`threeFiles`."""
    if isinstance(value, (str, os.PathLike)):
        return path(value)
    if isThree(value):
        return [path(one) for one in value]
    return listOf(number("m/s²", -1e6, 1e6), 2)(value)


def threeFiles(pattern: str) -> list[str]:
    """The three components that a pattern such as ``"AKT0131103111446.*"`` finds, by their names:
    two horizontal ones in the order of the alphabet (EW before NS), then the vertical one, whose
    name goes on with U, V, Z or D behind what all have in common. Raises Refused."""
    found = sorted(glob.glob(pattern))
    start = len(os.path.commonprefix(found))
    vertical = [one for one in found if one[start : start + 1].upper() in tuple("UVZD")]
    if len(found) != 3 or len(vertical) != 1:
        raise Refused(
            f"{pattern}: {len(found)} files, {len(vertical)} of them vertical (U, V, Z or D behind"
            " the common part of their names): there must be three with one vertical"
        )
    return [one for one in found if one not in vertical] + vertical


def _joined(paths, parts):
    """Three components (samples, time between them) as samples of three. Those of one station may
    differ by a few samples; the shorter ones go on with zeros."""
    lengths = [len(values) for values, _ in parts]
    steps = {step for _, step in parts}
    alike = all(np.ndim(values) == 1 for values, _ in parts) and len(steps) == 1
    if not alike or max(lengths) > (1 + LONGER) * min(lengths):
        sizes = ", ".join(f"{len(values)} samples every {step:g} s" for values, step in parts)
        raise Refused(
            f"{', '.join(map(str, paths))}: components of a record must be alike, not {sizes}"
        )
    if min(lengths) < max(lengths):
        counts = ", ".join(map(str, lengths))
        say(f"note: record: components of {counts} samples; the shorter ones end with zeros")
    columns = [values + [0.0] * (max(lengths) - len(values)) for values, _ in parts]
    return [list(sample) for sample in zip(*columns)], steps.pop()


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
        time between two of them [s]
    :raises Refused: with what is wrong
    """
    if unit not in (None, *UNITS):
        raise Refused(f"unit must be one of {', '.join(UNITS)}, got {unit!r}")
    if isinstance(accelerations, (str, os.PathLike)) and not os.path.exists(accelerations):
        if glob.has_magic(os.fspath(accelerations)):
            accelerations = threeFiles(os.fspath(accelerations))
    if isThree(accelerations):
        parts = [readRecord(one, every, scale, unit) for one in accelerations]
        return _joined(accelerations, parts)
    if isinstance(accelerations, (str, os.PathLike)):
        named, found = accelerations, accelerograms.read(accelerations)
        of = found.every
        if None not in (every, of) and abs(every - of) > UNEVEN * of:
            raise Refused(f"{named}: its samples are {of:g} s apart, not {every:g} s")
        if None not in (unit, found.unit) and unit != found.unit:
            raise Refused(f"{named}: it is in {found.unit}, not in {unit}")
        every, unit = of or every, found.unit or unit
        if found.flowing and (every is None or unit is None):
            raise Refused(
                f"{named}: its lines have several samples, and nothing says that they are"
                " accelerations one after the other: say every= and unit="
            )
        accelerations = found.values
    values: Any = np.asarray(accelerations, float)
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
