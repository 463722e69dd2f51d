# SPDX-License-Identifier: GPL-2.0-or-later
"""Ground motion: records of acceleration, and viscous damping for it. This module needs no YADE."""

from __future__ import annotations

import math
import os
from typing import Any

from ..arguments import FilePath, Numbers, listOf, number, path, takes
from ..basics import Refused


HERTZ = number("Hz", 0, 1e6, above=True)  # the kind of a frequency


@takes(ratio=number("", 0, 1, below=True), low=HERTZ, high=HERTZ)
def rayleigh(ratio: float, low: float, high: float) -> tuple[float, float]:
    """Viscous damping for :meth:`masonry.scene.scene.Scene.shake`: mass damping [1/s] and stiffness damping [s].

    :param ratio: share of critical damping at two frequencies [-]; between them it is less
    :param low: lower frequency [Hz]; ``high``: upper one
    """
    if not low < high:
        raise ValueError(f"rayleigh: low {low} Hz must be below high {high} Hz")
    one, two = 2 * math.pi * low, 2 * math.pi * high
    return 2 * ratio * one * two / (one + two), 2 * ratio / (one + two)


UNITS = {"m/s²": 1.0, "g": 9.81, "cm/s²": 0.01}  # [m/s²]
LOWEST_PEAK, HIGHEST_PEAK = (
    1.5,
    30.0,
)  # [m/s²] peaks beyond these may be in g, or in cm/s²


def record(value: Any, first: Any = None) -> Any:
    """The kind of a record: a list of accelerations, or the path of a file."""
    if isinstance(value, (str, os.PathLike)):
        return path(value)
    return listOf(number("m/s²", -1e6, 1e6), 2)(value)


def readRecord(
    accelerations: Numbers | FilePath,
    every: float | None,
    scale: float = 1.0,
    unit: str | None = None,
) -> tuple[list[float], float]:
    """Samples and the time between them [s] of a record.

    :param scale: factor on the samples
    :param unit: of the samples, a key of UNITS; None: m/s², if the peak does not look like another unit
    :returns: the samples [m/s²], without the scale, and the time between two of them
    :raises Refused: with what is wrong
    """
    if unit not in (None, *UNITS):
        raise Refused(f"shake: unit must be one of {', '.join(UNITS)}, got {unit!r}")
    if isinstance(accelerations, (str, os.PathLike)):
        rows, named, line = [], accelerations, 1
        try:
            with open(named) as f:
                for line, content in enumerate(f, start=1):
                    words = content.replace(",", " ").split()
                    if words and not words[0].startswith("#"):
                        rows.append([float(w) for w in words])
        except OSError as error:
            raise Refused(f"shake: cannot read {named}: {error.strerror}") from None
        except (ValueError, UnicodeDecodeError):
            raise Refused(f"shake: {named}, line {line}: not numbers") from None
        widths = {len(row) for row in rows}
        if widths not in ({1}, {2}) or len(rows) < 2:
            raise Refused(
                f"shake: {named} must have two lines at least, of one or two numbers each"
            )
        accelerations = [row[-1] for row in rows]
        if widths == {2}:
            times = [row[0] for row in rows]
            steps = [b - a for a, b in zip(times, times[1:])]
            mean = sum(steps) / len(steps)
            if not mean > 0 or max(abs(s - mean) for s in steps) > 1e-3 * mean:
                raise Refused(f"shake: {named}: its times are not evenly apart")
            if every is not None and abs(every - mean) > 1e-3 * mean:
                raise Refused(
                    f"shake: {named}: its times are {mean:g} s apart, not {every:g} s"
                )
            every = mean
    values: list[float] = [float(a) for a in accelerations]
    if len(values) < 2 or not all(map(math.isfinite, values)):
        raise Refused("shake: a record needs two finite accelerations at least")
    if not (isinstance(every, (int, float)) and 0 < every < math.inf):
        raise Refused(
            f"shake: every {every!r} s, the time between samples, must be above 0"
        )
    peak = abs(scale) * max(abs(v) for v in values)
    if unit is None and peak > 0 and not LOWEST_PEAK <= peak <= HIGHEST_PEAK:
        other = "g" if peak < LOWEST_PEAK else "cm/s²"
        raise Refused(
            f"shake: the peak of the record is {peak:g}, which is {peak / 9.81:.2g} g if it is in m/s²: is it in {other}? "
            f"Say unit='{other}', or unit='m/s²' if it is"
        )
    return [UNITS[unit or "m/s²"] * v for v in values], every
