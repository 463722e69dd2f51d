# SPDX-License-Identifier: GPL-2.0-or-later
"""Displacement histories: what ``--history`` may say, and the points that the drive goes to. No
YADE is needed.

A history is a dict that JSON can hold. ``text`` is what the user wrote, and ``points_mm`` are
displacements [mm] that are reached in turn, from 0 on, in straight lines; and there are

- ``amplitudes_mm`` of a list of amplitudes: pairs of an amplitude [mm] and its number of cycles; or
- ``file`` and ``sha256`` of a file: its path, and the fingerprint of its contents.
"""

import hashlib
import os
from collections import namedtuple

from ..errors import firstOf
from ..texts import TextFile, finite

MIN_AMPLITUDE, MAX_DISPLACEMENT = 0.02, 1000.0  # [mm]; a row of curve.csv is 0.01 mm
# [mm] within which a wall is at zero: more than a history misses, less than any amplitude
AT_ZERO = 0.015
# of the largest displacement of a file: smaller excursions may be noise of the measurement
NOISE = 0.01
CYCLES = 10000  # that a list of amplitudes may have
COLUMN = "displacement_mm"  # of a file

#: A point of a history: its displacement [mm]; the direction to it, 1 or -1; and the displacement
#: at which the drive turns or stops next, for which it brakes, or None if it does not [mm].
PathPoint = namedtuple("PathPoint", "displacement direction brake")


def parse(text):
    """The history that a text stands for: amplitudes as in ``1,2x3,4``, of which A is one cycle 0 →
    +A → -A → 0 and ``Ax3`` three of them, or the path of a CSV file with a column
    ``displacement_mm``. Raises ValueError with all problems."""
    if not text.strip():
        raise ValueError("must be amplitudes in mm such as 1,2x3,4, or the path of a CSV file")
    named = os.sep in text or text.lower().endswith(".csv")
    return _readFile(text) if named or os.path.isfile(text) else _readList(text)


def _refuse(problems):
    if problems:
        raise ValueError("; ".join(firstOf(problems)))


def _readList(text):
    problems, amplitudes = [], []
    for piece in text.split(","):
        number, times, count = piece.strip().partition("x")
        try:
            amplitude = finite(number)
        except ValueError:
            other = ", and no file has this name" if piece == text else ""
            problems.append(f"'{piece}' is no amplitude in mm such as 2 or 2x3{other}")
            continue
        if not MIN_AMPLITUDE <= amplitude <= MAX_DISPLACEMENT:
            problems.append(
                f"'{piece}': the amplitude must be from {MIN_AMPLITUDE:g} to"
                f" {MAX_DISPLACEMENT:g} mm"
            )
        if times and not (count.isdecimal() and count.isascii() and int(count) >= 1):
            problems.append(f"'{piece}': the number of cycles must be a whole number, at least 1")
        elif not problems:
            amplitudes.append([amplitude, int(count) if times else 1])
    whole = sum(repeats for _, repeats in amplitudes)
    if whole > CYCLES:
        problems.append(f"{whole} cycles are more than {CYCLES}")
    _refuse(problems)
    points = [p for a, repeats in amplitudes for p in repeats * (a, -a, 0.0)]
    return {"text": text, "amplitudes_mm": amplitudes, "points_mm": points}


def _readFile(path):
    file = TextFile(path)
    return {
        "text": path,
        "file": os.path.abspath(path),
        "sha256": hashlib.sha256(file.content).hexdigest(),
        "points_mm": _column(file),
    }


def _column(file):
    table, path = file.table(), file.path
    named = [k for k, row in enumerate(table.heads) if row.cells.count(COLUMN) == 1]
    if not named:
        found = ", ".join(table.heads[-1].cells) if table.heads else "no names"
        raise ValueError(
            f"{path}: a line before its numbers must name one column {COLUMN}, it has {found}"
        )
    at = table.heads[named[0]].cells.index(COLUMN)
    problems, points = [], []
    for row in table.heads[named[0] + 1 :] + table.rows:
        text, where = "".join(row.cells[at : at + 1]), f"{path}, line {row.line}"
        try:
            points.append(finite(text))
        except ValueError as error:
            problems.append(f"{where}: {error}")
            continue
        if not abs(points[-1]) <= MAX_DISPLACEMENT:
            problems.append(
                f"{where}: {text} mm must be from {-MAX_DISPLACEMENT:g} to {MAX_DISPLACEMENT:g} mm"
            )
    _refuse(problems)
    if len(points) < 2:
        raise ValueError(
            f"{path}: it has {len(points)} displacements, a history needs two at least"
        )
    if max(map(abs, points)) < MIN_AMPLITUDE:
        raise ValueError(f"{path}: no displacement is {MIN_AMPLITUDE:g} mm or more")
    return points


def targets(points, stops=False, start=0.0):
    """The points of a history as the drive sees them: a list of :class:`PathPoint`. A repeated one
    lies in the same direction as the one before.

    :param points: displacements [mm]
    :param stops: whether the drive brakes for the last point
    :param start: where the path begins [mm]
    """
    directions = [1]
    for last, point in zip([start, *points], points):
        same = directions[-1]
        directions.append(1 if point > last else -1 if point < last else same)
    found, brake, after = [], points[-1] if stops else None, directions[-1]
    for point, direction in zip(reversed(points), reversed(directions)):
        if direction != after:
            brake = point
        found.append(PathPoint(point, direction, brake))
        after = direction
    return found[::-1]


def pathLength(points, start=0.0):
    """Length of the path through some points from a start on [mm]."""
    return sum(abs(b - a) for a, b in zip([start, *points], points))


def aim(args, start=0.0):
    """The targets of a run: those of ``--history``, or one at ``--until``.

    The drive stops at the end of a file. At the end of amplitudes and of a push it does not brake,
    because both go on in the same direction if the run is resumed and extended.

    :param args: the options of :func:`masonry.scene.options.parser`
    :param start: where the path begins [mm]
    """
    if args.history:
        return targets(args.history["points_mm"], "file" in args.history, start)
    return targets([args.until], start=start)


def turns(points):
    directions = [target.direction for target in targets(points)]
    return sum(one != other for one, other in zip(directions, directions[1:]))


def noise(history):
    """Displacement [mm] up to which an excursion does not count: the threshold of
    :mod:`masonry.numbers.loops` for the wall's curve."""
    if "file" not in history:
        return AT_ZERO
    return max(AT_ZERO, NOISE * max(map(abs, history["points_mm"])))


def extends(new, old):
    return new["points_mm"][: len(old["points_mm"])] == old["points_mm"]


def describe(history):
    """What run.json says of a history: its entries with number of points and length of the path in
    place of the points."""
    points = history["points_mm"]
    found = {name: value for name, value in history.items() if name != "points_mm"}
    more = dict(points=len(points), turning_points=turns(points))
    return dict(found, **more, path_mm=pathLength(points), noise_mm=noise(history))
