# SPDX-License-Identifier: GPL-2.0-or-later
"""Accelerations in the columns of a text."""

import re
from decimal import Decimal
from typing import Any

from ...arguments import shown
from ...texts import TextFile, isNumber
from .unit_words import unitSaid

#: How far a time of a file may be off, over the time between samples; and in units of the last
#: digit of the times, which are rounded.
UNEVEN, ROUNDED = 1e-3, 1.01
FLOWING = 5  # numbers a line from which on they are samples one after the other
FEWEST = 10  # whole first numbers from which on they look like a count

#: Names of columns: a letter or two behind "a", "acc" or nothing.
_TIME = re.compile(r"t|time.*|zeit.*|temps.*|sec\w*|s")
_AXIS = re.compile(r"(?:a(?:cc?\w*?)?[_ ]?)?(x|y|z|e|n|u|ew|ns|ud|up|v|vert\w*|h1|h2)")
_VERTICAL = "z", "u", "ud", "up", "v", "vert"


def read(file: TextFile) -> tuple[list[Any], float | None, str | None, bool]:
    """Samples, the time between them [s], their unit, and whether lines have several samples.
    Raises Refused."""
    table = file.table()
    said = _Said(file, table)
    rows = [(row.line, row.cells) for row in table.rows]
    count, every = _count(rows)
    if count:
        del rows[0]
        said.every = said.every or every
    values = [[file.number(cell, line) for cell in cells] for line, cells in rows]
    if len(values) < 2 and not (values and len(values[0]) >= FLOWING):
        raise file.refused(
            "it must have two lines of samples at least, of one or two numbers each, and has"
            f" {len(values)}"
        )
    width = len(values[0])
    if width >= FLOWING and said.axes is None:
        wrong = [k for k, row in enumerate(values[:-1]) if len(row) != width]
        if wrong or len(values[-1]) > width:
            line = rows[wrong[0] if wrong else -1][0]
            raise file.refused(f"lines must have {width} numbers each but for the last one", line)
        return [sample for row in values for sample in row], said.every, said.unit, True
    for (line, cells), row in zip(rows, values):
        if len(row) != width or len(row) != (said.width or min(len(row), 2)):
            raise file.refused(
                f"{len(row)} numbers, and the lines must have one or two numbers each, all alike,"
                " or three below # components: x y z, or as many as a head of names has",
                line,
            )
    if count is None:
        _refuseCount(file, rows, values)
    if width in (2, 4):
        at = said.time or 0
        times = [row.pop(at) for row in values]
        every = _evenly(file, times, [(line, cells[at]) for line, cells in rows])
        if said.every is not None and abs(said.every - every) > UNEVEN * every:
            raise file.refused(
                f"its times are {every:g} s apart, and it says every: {said.every:g} s"
            )
        said.every = every
    samples: list[Any] = [row[0] for row in values]
    if width > 2:
        samples = [[row[k] for k in said.axes] for row in values]
    return samples, said.every, said.unit, False


class _Said:
    """What comments and heads say.

    :ivar width: number of columns; None: one or two
    :ivar time: which column is the time; None: not said
    :ivar axes: which of the other columns are x, y and z; None: they are one
    """

    def __init__(self, file, table):
        self.every = self.unit = self.width = self.time = self.axes = None
        self._known, self._file = {}, file
        for row in table.comments:
            self._comment(row)
        for row in table.heads:
            self._takeUnit(" ".join(row.cells), row.line)
        if table.heads and table.rows:
            self._columns(table.heads[-1], len(table.rows[0].cells))
        vars(self).update(self._known)

    def _take(self, key, value, line):
        if value is None:
            return
        if key in self._known:
            raise self._file.refused(f"it says {key} twice", line)
        self._known[key] = value

    def _takeUnit(self, text, line):
        self._take("unit", self._file.read(unitSaid, text, line), line)

    def _comment(self, row):
        [text] = row.cells
        self._takeUnit(text, row.line)
        found = re.fullmatch(r"(every|components)\s*[:=]\s*(.*?)", text, re.I)
        if found and found[1].lower() == "every":
            word = re.sub(r"\s*s$", "", found[2])
            self._take("every", interval(self._file, word, row.line), row.line)
        elif found:
            if found[2].split() != ["x", "y", "z"]:
                raise self._file.refused(f"components {shown(found[2])} must be x y z", row.line)
            self._take("axes", [0, 1, 2], row.line)
            self._take("width", 3, row.line)

    def _columns(self, head, width):
        text = re.sub(r"\s*[\[(][^\])]*[\])]", "", "\t".join(head.cells)).lower()
        names = [re.sub(r"_(?:s|ms2|g|cms2|m/s2)$", "", name.strip()) for name in text.split("\t")]
        names = [name for name in names if name]
        if len(names) != width:
            return
        times = [k for k, name in enumerate(names) if _TIME.fullmatch(name)]
        if width == 2 and len(times) != 1:
            if not times and not any(map(_AXIS.fullmatch, names)):
                return  # names of another language: time first
            raise self._file.refused(
                f"two columns must be time and acceleration, not {' and '.join(names)}", head.line
            )
        if times:
            self._take("time", times[0], head.line)
        rest = [name for k, name in enumerate(names) if k not in times]
        found = [_AXIS.fullmatch(name) for name in rest]
        if width > 2 and len(rest) == 3 and all(found):
            axes = [match[1] for match in found]
            vertical = [k for k, axis in enumerate(axes) if axis.startswith(_VERTICAL)]
            if len(set(axes)) == 3 and len(vertical) == 1:
                order = sorted(set(range(3)) - set(vertical), key=lambda k: _horizontal(axes[k]))
                self._take("axes", order + vertical, head.line)
                self._take("width", width, head.line)


def _horizontal(axis):
    """The order of horizontal components: x before y, east before north."""
    return ("x", "e", "ew", "h1", "y", "n", "ns", "h2").index(axis)


def _count(rows):
    """The number of samples that the first line says, and the time between them; else None."""
    if len(rows) < 2 or not rows[0][1][0].isdigit():
        return None, None
    first, others = rows[0][1], [cells for _, cells in rows[1:]]
    count, width = int(first[0]), len(others[0])
    samples = len(others) if width < FLOWING else sum(map(len, others))
    if count != samples or count < 2 or len(first) > 2 or len(first) == width == 2:
        return None, None
    if len(first) == 1:
        return count, None
    return (count, float(first[1])) if isNumber(first[1]) else (None, None)


def _refuseCount(file, rows, values):
    line, cells = rows[0]
    whole = [len(c) == 1 and c[0].isdigit() for _, c in rows]
    if whole[0] and not any(whole[1:]) and values[0][0] >= FEWEST:
        raise file.refused(
            f"it begins with the whole number {cells[0]}, and {len(rows) - 1} samples follow: is it"
            " their number, and the file cut off? Else write it with a point",
            line,
        )


def interval(file, word, line):
    """The time between two samples that a word of a line stands for [s]."""
    every = file.number(word, line)
    if not every > 0:
        raise file.refused(f"the time between samples, {word} s, must be above 0", line)
    return every


def _evenly(file, times, words):
    """The time between two of them [s].

    :param words: of each the line, and the time as it is written there
    """
    mean = (times[-1] - times[0]) / (len(times) - 1)
    # the last digit of the time that is written with most of them
    plain = (re.sub("[Dd]", "e", word) for _, word in words)
    last = min(Decimal(word).as_tuple().exponent for word in plain)
    digit = float(Decimal(1).scaleb(last))
    allowed = max(UNEVEN * mean, ROUNDED * digit)
    for before, time, (line, _) in zip(times, times[1:], words[1:]):
        step = time - before
        if not step > 0:
            why = f"must be after {before:g} s"
        elif abs(step - mean) > allowed:
            why = f"is {step:g} s after the one before, and the mean is {mean:g} s"
        else:
            continue
        raise file.refused(f"its times are not evenly apart: {time:g} s {why}", line)
    return mean
