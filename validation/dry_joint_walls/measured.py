# SPDX-License-Identifier: GPL-2.0-or-later
"""The measured loops of the ten dry-joint walls: reading, repairing, and the numbers of their
cycles.

/usr/bin/python3 validation/dry_joint_walls/measured.py          # a table of all cycles
/usr/bin/python3 validation/dry_joint_walls/measured.py --write  # writes reference/history_*.csv

The files of the database are kept as they are, in ``reference/FD_*.csv``. Each consists of pieces,
separated by rows that are not numbers. A piece usually is a whole cycle, from a negative turning
point over the positive one back to the negative side. Between two pieces the wall was pushed on to
the next negative turning point, and these rows are missing. Single stray rows are found by
:func:`strays`. What else is wrong with the files stands in ``REPAIRS``, and :func:`pieces` repairs
it.
"""

import argparse
import csv
import functools
import glob
import os
from collections import namedtuple

import numpy as np
from masonry.numbers import loops

HERE = os.path.dirname(os.path.abspath(__file__))
REFERENCE = os.path.join(HERE, "reference")
MORTAR = os.path.join(REFERENCE, "mortar")  # loops of other walls of the database
LEVELS = (100, 175, 250)  # [kN]

#: A reversal of less than this is scatter of the digitised curves [mm]. The scatter is 0.1 mm, in
#: WS2.100 up to 0.3 mm; the smallest cycle has an amplitude of 1.6 mm.
THRESHOLD = 0.5

#: How far a stray row lies off both rows beside it: displacement [mm], force [kN].
STRAY = (0.5, 4.0)

#: What is done to the pieces of a file, in this order. Pieces and rows count from 0.
#:
#: - ("drop", piece, first, last, why): these rows of a piece are left out
#: - ("swap", piece, why): this piece and the next one change places
#: - ("hole", piece, why): after this piece rows are missing on a curved stretch, so that no work
#: can be found there
_ARTEFACT = (
    "the last row of the first piece is about (-1.6 mm, -16.4 kN) in eight of the ten files, at all"
    " three vertical loads and far from the row before: it belongs to none of these curves"
)
_TAIL = "the piece is the end of the next one, which stops where it begins"
REPAIRS = {
    "WS1100": [
        (
            "hole",
            7,
            (
                "the cycle stops at 0.4 mm and -18.8 kN on its way down, and the next piece begins"
                " at -23.8 mm"
            ),
        )
    ],
    "WS1175": [("drop", 0, -1, None, _ARTEFACT)],
    "WS1250": [
        ("drop", 0, -1, None, _ARTEFACT),
        (
            "drop",
            9,
            0,
            37,
            (
                "down to -27.9 mm the piece repeats the end of the one before; from there on it is"
                " the push to the next turning point"
            ),
        ),
        (
            "drop",
            11,
            0,
            14,
            (
                "12 rows at -33.7 mm and -102 kN and the two that lead back: 6 kN within half a"
                " millimetre, above the peak of -95.7 kN that the database gives"
            ),
        ),
    ],
    "WS2100": [("drop", 0, -1, None, _ARTEFACT)],
    "WS2175": [
        ("drop", 0, -1, None, _ARTEFACT),
        ("swap", 11, _TAIL),
        ("swap", 13, _TAIL),
    ],
    "WS2250": [("drop", 0, -1, None, _ARTEFACT)],
    "WS3100": [("drop", 0, -1, None, _ARTEFACT)],
    "WS3175": [
        ("drop", 0, -1, None, _ARTEFACT),
        ("swap", 11, _TAIL),
        ("swap", 13, _TAIL),
    ],
    "WS3250": [("drop", 0, -1, None, _ARTEFACT)],
    "WS4100": [],
}

#: Cycles that no run is held against, by the piece from which on, and why. The wall is driven
#: through them all the same.
DOUBTFUL = {
    "WS2100": (
        4,
        (
            "from here on the forces are no longer those of the wall before: on the way up the"
            " force falls from 31 to 6 kN within a millimetre, afterwards the wall carries 26 to 31"
            " kN in the negative direction where it carried 41, and its cycles take two to five"
            " times the work of those of the other three walls at 100 kN"
        ),
    ),
    "WS3175": (
        11,
        (
            "from here on the curve is that of WS2.175: mean distance 0.03 mm, against 0.1 to 0.4"
            " mm in the cycles before. The same loops stand in both files, and count once"
        ),
    ),
}

DRIVEN = "WI2175"  # the wall in mortar that rig.py drives through its history

#: A cycle of a curve with its numbers: those of :class:`masonry.numbers.loops.Cycle`, and why it is
#: ``doubtful`` (None if not).
Measured = namedtuple("Measured", "cycle doubtful")


def walls(level=None):
    """Names of the walls, of one vertical load [kN] or of all."""
    return [w for w in _namesIn(REFERENCE) if level is None or levelOf(w) == level]


def mortarWalls():
    """Names of the walls in mortar."""
    return _namesIn(MORTAR)


def _namesIn(folder):
    paths = glob.glob(os.path.join(folder, "FD_*.csv"))
    return sorted(os.path.basename(path).split("_")[1] for path in paths)


def levelOf(wall):
    """Vertical load of a wall [kN], from its name: WS1175 is wall 1 at 175 kN."""
    return int(wall[3:])


def rawPieces(path):
    """Pieces of a file of the database as they stand there, and how many rows were no numbers.

    :returns: a list of arrays of displacement [mm] and force [kN], a row a point, and the number of
        rows left out
    """
    with open(path, encoding="latin-1", newline="") as f:
        rows = [row for row in list(csv.reader(f))[4:] if row]
    pieces, left = [[]], 0
    for row in rows:
        try:
            point = [float(row[0]), float(row[1])]
        except (ValueError, IndexError):
            point = [np.nan, np.nan]
        if np.isfinite(point).all():
            pieces[-1].append(point)
        else:
            left += 1
            pieces.append([])
    return [np.array(piece) for piece in pieces if piece], left


def strays(points):
    """Rows of a piece that lie off the curve on their own, as letters of a figure do that were
    digitised with it.

    Where the displacement goes on, the force turns back and forth by more than ``STRAY``; or the
    displacement does where the force goes on. The latter also happens at a true turning point,
    therefore only rows count whose force is below 0.8 of the largest of the piece. The farthest row
    is found first, and the others without it.

    :param points: array of displacement [mm] and force [kN]
    :returns: their numbers, a list
    """
    rows, found = np.arange(len(points)), []
    steep = abs(points[:, 1]) < 0.8 * abs(points[:, 1]).max()
    while True:
        steps = np.diff(points[rows], axis=0)
        before, after = steps[:-1], steps[1:]
        turns = before * after < 0
        far = np.minimum(abs(before), abs(after)) / STRAY
        follows = before * after > 0
        off = np.maximum(
            far[:, 1] * (turns[:, 1] & ~turns[:, 0]),
            far[:, 0] * (turns[:, 0] & follows[:, 1] & steep[rows[1:-1]]),
        )
        worst = int(np.argmax(off))
        if off[worst] <= 1:
            return sorted(found)
        found.append(int(rows[1 + worst]))
        rows = np.delete(rows, 1 + worst)


def pieces(wall):
    """Pieces of a wall, repaired and in the order of time.

    :returns: a list of (number of the piece in the file, array of displacement [mm] and force [kN])
    """
    (path,) = glob.glob(os.path.join(folderOf(wall), f"FD_{wall}_*.csv"))
    numbered = list(enumerate(rawPieces(path)[0]))
    for action, piece, *rest in REPAIRS.get(wall, ()):
        if action == "drop":
            first, last, _ = rest
            number, points = numbered[piece]
            kept = np.ones(len(points), bool)
            kept[first:last] = False
            numbered[piece] = number, points[kept]
        elif action == "swap":
            numbered[piece : piece + 2] = numbered[piece : piece + 2][::-1]
    return [(number, np.delete(points, strays(points), axis=0)) for number, points in numbered]


@functools.lru_cache(None)
def curve(wall):
    """Whole measured curve: displacements [mm], forces [kN], and the number of the piece of every
    row.

    The first row is the wall at rest, (0, 0) of piece -1. The files begin at the first negative
    turning point.
    """
    found = [(-1, np.zeros((1, 2))), *pieces(wall)]
    points = np.concatenate([points for _, points in found])
    numbers = np.concatenate([np.full(len(p), number) for number, p in found])
    return points[:, 0], points[:, 1], numbers


def history(wall):
    """Displacements between which a wall was driven to and fro, in order of time [mm].

    These are the turning points of the measured curve, reversals of less than ``THRESHOLD`` left
    out, and its last row. The rows between are not needed: they lie on the way from one turning
    point to the next.
    """
    moved = curve(wall)[0]
    points = moved[loops.turningPoints(moved, THRESHOLD)][1:]
    return points if points[-1] == moved[-1] else np.append(points, moved[-1])


@functools.lru_cache(None)
def cycles(wall):
    """Cycles of a wall with their numbers: a list of :class:`Measured`.

    The work of a cycle in which rows are missing on a curved stretch is NaN, and so is its damping.
    """
    moved, force, number = curve(wall)
    holes = [
        int(np.flatnonzero(number == piece)[-1])
        for action, piece, *_ in REPAIRS.get(wall, ())
        if action == "hole"
    ]
    first, why = DOUBTFUL.get(wall, (None, None))
    found = []
    for cycle in loops.cycles(moved, force, THRESHOLD):
        if any(cycle.start < hole + 1 and cycle.end > hole for hole in holes):
            cycle = cycle._replace(work_J=np.nan, damping=np.nan)
        doubtful = first is not None and number[int(cycle.end)] in _since(wall, first)
        found.append(Measured(cycle, why if doubtful else None))
    return found


def _since(wall, first):
    """Numbers of the pieces of a wall from one on, in order of time."""
    order = [number for number, _ in pieces(wall)]
    starts = min(order.index(n) for n in order if n >= first)
    return set(order[starts:])


def peaks(level):
    """Measured peaks of the walls of a level [kN]: dict of wall -> (positive, negative), both above
    0."""
    with open(os.path.join(REFERENCE, "peaks.csv"), newline="") as f:
        return {
            row["wall"]: (
                float(row["peak_positive_kN"]),
                float(row["peak_negative_kN"]),
            )
            for row in csv.DictReader(f)
            if int(row["level_kN"]) == level
        }


def folderOf(wall):
    return MORTAR if wall in mortarWalls() else REFERENCE


def historyPath(wall):
    return os.path.join(folderOf(wall), f"history_{wall}.csv")


def historyText(wall):
    """Contents of the file of a wall's history: what a scene's ``--history`` reads."""
    rows = "".join(f"{x:.2f}\n" for x in history(wall))
    return "displacement_mm\n" + rows


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="write the histories")
    if parser.parse_args(words).write:
        for wall in (*walls(), DRIVEN):
            with open(historyPath(wall), "w") as f:
                f.write(historyText(wall))
        return
    print(
        "| wall | amplitude mm | from, to mm | V−, V+ kN | work J | damping | stiffness kN/mm |"
        " residual after +, − mm |"
    )
    print("|" + " --- |" * 8)
    for wall in walls():
        for c, doubtful in cycles(wall):
            print(
                f"| {wall}{' (doubtful)' if doubtful else ''} | {c.amplitude_mm:.1f} |"
                f" {c.smallest_mm:.1f}, {c.largest_mm:.1f} | {c.smallest_kN:.1f},"
                f" {c.largest_kN:.1f} | {c.work_J:.0f} | {c.damping:.3f} |"
                f" {c.stiffness_kN_per_mm:.2f} | {c.residual_positive_mm:.2f},"
                f" {c.residual_negative_mm:.2f} |"
            )


if __name__ == "__main__":
    main()
