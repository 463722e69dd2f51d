# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of ground accelerations: which formats are read, and whether a record drifts. This module
needs no YADE.

The format is found from the contents, not from the name of the file:

- **PEER NGA** (``.AT2``): some lines of header, of which one has the number of samples and the time
  between them, ``NPTS= 4000, DT= .0050 SEC`` or ``4000 .0050 NPTS, DT``, and one the unit,
  ``ACCELERATION TIME SERIES IN UNITS OF G``; then the samples, any number of them a line.
- **ESM**, the Engineering Strong-Motion database, and ITACA (DYNA, ``.ASC``): 64 lines of header,
  each a key, a colon and a value, among them ``SAMPLING_INTERVAL_S``, ``NDATA``, ``UNITS``
  (``cm/s^2``) and ``DATA_TYPE``. One sample a line follows.
- **Text**: one column, accelerations, or two, time [s] and acceleration, with blanks or commas
  between them. Lines that begin with # are comments, but for three that say what the numbers are:
  ``# unit: g``, ``# every: 0.005 s``, and ``# components: x y z`` above three columns, two
  horizontal accelerations and the vertical one.

g is 9.81 m/s². What a file says of itself is compared with what is in it: another number of
samples, times that are not evenly apart, and numbers that are not finite are refused with the file,
the line and the value.
"""

import math
import os
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arguments import FilePath, Numbers, shown
from ..units import ACCELERATION_UNITS as UNITS
from ..errors import Refused
from ..numbers.files import readWhole

#: How files write these units, in small letters.
WRITTEN = {
    **{f"{unit}{two}": f"{unit}²" for unit in ("m/s", "cm/s") for two in ("²", "2", "^2", "**2")},
    **{"g": "g", "gal": "cm/s²", "cm/s/s": "cm/s²", "cm/sec2": "cm/s²", "cm/sec/sec": "cm/s²"},
}

UNEVEN = 1e-3  # of the time between samples: how far a time of a file may be off
HEADER = 12  # lines at the beginning of a PEER file among which NPTS must be

#: Shares above which a record is said to drift: of its largest velocity at the end, and of its
#: largest displacement that a straight line through its displacements rises by. See :func:`drift`.
ENDS, RISES = 0.05, 0.5


@dataclass(frozen=True)
class Accelerogram:
    """What a file of accelerations holds.

    :param values: the samples, in the unit of the file: numbers, or lists of three components
    :param every: time between two samples [s]; None: the file does not say it
    :param unit: a key of UNITS; None: the file does not say it
    :param kind: its format: ``"PEER"``, ``"ESM"`` or ``"text"``
    """

    values: list[Any]
    every: float | None
    unit: str | None
    kind: str


def read(path: FilePath) -> Accelerogram:
    """Read a file of accelerations. Raises Refused with the file, the line and the value that is
    wrong."""
    try:
        data = readWhole(path)
    except OSError as error:
        raise Refused(f"cannot read {path}: {error.strerror}") from None
    lines = data.decode("utf-8-sig", errors="replace").splitlines()
    file = _File(path, lines)
    for line, text in enumerate(lines[:HEADER], 1):
        if re.search(r"\bNPTS\b", text, re.I) and not text.strip().startswith("#"):
            return file.peer(line)
    first = next(filter(str.strip, lines), "")
    return file.esm() if re.match(r"[A-Z][A-Z0-9_^/]*:", first) else file.text()


class _File:
    def __init__(self, path, lines):
        self.path, self.lines = os.fspath(path), lines

    def refused(self, text, line=None):
        at = f", line {line}" if line else ""
        return Refused(f"{self.path}{at}: {text}")

    def numbers(self, words, line):
        """The finite numbers that words of a line stand for."""
        found = []
        for word in words:
            try:
                found.append(float(word))
            except ValueError:
                raise self.refused(f"{shown(word)} is not a number", line) from None
            if not math.isfinite(found[-1]):
                raise self.refused(f"{shown(word)} is not a finite number", line)
        return found

    def unit(self, word, line):
        """The unit that a word of a line stands for."""
        found = WRITTEN.get(word.strip().lower().rstrip("."))
        if not found:
            named = shown(word.strip())
            raise self.refused(f"unit {named} must be one of {', '.join(UNITS)}", line)
        return found

    def interval(self, word, line):
        """The time between two samples that a word of a line stands for [s]."""
        [every] = self.numbers([word], line)
        if not every > 0:
            raise self.refused(f"the time between samples, {word} s, must be above 0", line)
        return every

    def counted(self, values, expected, key, line):
        """Values of which there are as many as the file says, and enough."""
        if len(values) != expected:
            raise self.refused(
                (
                    f"{key} is {expected}, and the file has {len(values)} values: is it cut off, or"
                    " were lines added?"
                ),
                line,
            )
        return self.enough(values)

    def enough(self, values):
        if len(values) < 2:
            raise self.refused(
                "it must have two lines of samples at least, of one or two numbers each, and has"
                f" {len(values)}"
            )
        return values

    def peer(self, at):
        """The record of a file of PEER, whose line ``at`` has NPTS."""
        unit, head = None, self.lines[at - 1]
        for line, text in enumerate(self.lines[:at], 1):
            if found := re.search(r"\bUNITS\s+OF\s+(\S+)", text, re.I):
                if not re.search(r"\bACC", text, re.I):
                    said = shown(text.strip())
                    raise self.refused(f"it must hold accelerations, and says {said}", line)
                unit = self.unit(found[1].rstrip(",;"), line)
        number = r"((?:\d+\.?\d*|\.\d+)(?:[ED][+-]?\d+)?)"
        count = re.search(r"\bNPTS\s*=\s*(\d+)", head, re.I)
        every = re.search(rf"\bDT\s*=\s*{number}", head, re.I)
        both = re.match(rf"\s*(\d+)\s*,?\s+{number}\s*,?\s+NPTS\s*,\s*DT\b", head, re.I)
        if count and every:
            both = ..., count[1], every[1]
        elif not both:
            raise self.refused(
                (
                    "the line must have NPTS and DT, as in NPTS= 4000, DT= .0050 SEC, and is"
                    f" {shown(head.strip())}"
                ),
                at,
            )
        every = self.interval(both[2].upper().replace("D", "E"), at)
        values = []
        for line, text in enumerate(self.lines[at:], at + 1):
            values += self.numbers(text.split(), line)
        values = self.counted(values, int(both[1]), "NPTS", at)
        return Accelerogram(values, every, unit, "PEER")

    def esm(self):
        known, values, begins = {}, [], None
        for line, text in enumerate(self.lines, 1):
            key, colon, value = text.partition(":")
            if begins is None and colon and key[:1].isalpha():
                known.setdefault(key, (value.strip(), line))
            elif words := text.split():
                begins = begins or line
                values += self.numbers(words, line)
                if len(words) != 1:
                    raise self.refused(f"{len(words)} numbers, there must be one a line", line)
        needed = ("SAMPLING_INTERVAL_S", "NDATA", "UNITS", "DATA_TYPE")
        missing = [key for key in needed if not known.get(key, ("", 0))[0]]
        if missing:
            raise self.refused(
                f"its header must have {', '.join(missing)}, and ends with line"
                f" {(begins or len(self.lines) + 1) - 1}"
            )
        kind, line = known["DATA_TYPE"]
        if kind.upper() != "ACCELERATION":
            raise self.refused(f"DATA_TYPE must be ACCELERATION, got {shown(kind)}", line)
        unit = self.unit(*known["UNITS"])
        every = self.interval(*known["SAMPLING_INTERVAL_S"])
        count, line = known["NDATA"]
        if not count.isdecimal():
            raise self.refused(f"NDATA {shown(count)} must be a whole number", line)
        values = self.counted(values, int(count), "NDATA", line)
        return Accelerogram(values, every, unit, "ESM")

    def text(self):
        rows, at, known = [], [], {}
        for line, text in enumerate(self.lines, 1):
            words = text.replace(",", " ").split()
            if words and words[0].startswith("#"):
                self._comment(text, line, known)
            elif words:
                rows.append(self.numbers(words, line))
                at.append(line)
                wrong = len(words) != 3 if "components" in known else len(words) > 2
                if wrong or len(words) != len(rows[0]):
                    raise self.refused(
                        (
                            f"{len(words)} numbers, and the lines must have one or two numbers"
                            " each, all alike, or three below # components: x y z"
                        ),
                        line,
                    )
        values = self.enough([row if len(row) == 3 else row[-1] for row in rows])
        every = known.get("every")
        if len(rows[0]) == 2:
            times = self._evenly([row[0] for row in rows], at)
            if every is not None and abs(every - times) > UNEVEN * times:
                raise self.refused(
                    f"its times are {times:g} s apart, and it says every: {every:g} s"
                )
            every = times
        return Accelerogram(values, every, known.get("unit"), "text")

    def _comment(self, text, line, known):
        keys = r"\s*#\s*(unit|every|components)\s*[:=]\s*(.*?)\s*"
        if not (found := re.fullmatch(keys, text, re.I)):
            return
        key, word = found[1].lower(), found[2]
        if key in known:
            raise self.refused(f"it says {key} twice", line)
        if key == "components" and word.split() != ["x", "y", "z"]:
            raise self.refused(f"components {shown(word)} must be x y z", line)
        if key == "unit":
            word = self.unit(word, line)
        elif key == "every":
            word = self.interval(re.sub(r"\s*s$", "", word), line)
        known[key] = word

    def _evenly(self, times, at):
        """The time between two of them [s]."""
        steps = [b - a for a, b in zip(times, times[1:])]
        mean = sum(steps) / len(steps)
        for step, one, line in zip(steps, times[1:], at[1:]):
            if not step > 0:
                why = f"must be after {one - step:g} s"
            elif abs(step - mean) > UNEVEN * mean:
                why = f"is {step:g} s after the one before, and the mean is {mean:g} s"
            else:
                continue
            raise self.refused(f"its times are not evenly apart: {one:g} s {why}", line)
        return mean


def components(values: Any) -> Any:
    """Samples as an array with a row a component, one or three."""
    return np.atleast_2d(np.asarray(values, float).T)


def written(values: Any, every: float, title: str) -> str:
    """A record as a text that :func:`read` gives back bit for bit.

    :param values: samples [m/s²], or lists of three components; ``every``: the time between two of
        them [s]
    :param title: one line of comment
    """
    head = f"# {title}\n# unit: m/s²\n# every: {float(every)!r} s\n"
    columns = components(values).tolist()
    head += "# components: x y z\n" if len(columns) == 3 else ""
    return head + "".join(" ".join(map(repr, row)) + "\n" for row in zip(*columns))


@dataclass(frozen=True)
class Drift:
    """How far a record is from a motion that ends at rest.

    :param endVelocity: of the ground at the end of the record [m/s]; ``peakVelocity``: the largest
        amount [m/s]
    :param rise: of a straight line of least squares through the displacements, over the whole
        record [m]
    :param peakDisplacement: the largest amount [m]
    :param lean: the constant acceleration with which the ground would have this velocity at the end
        [m/s²]
    """

    endVelocity: float
    peakVelocity: float
    rise: float
    peakDisplacement: float
    lean: float

    def sentence(self) -> str | None:
        """What is wrong with the record, with its numbers, or None."""
        found = []
        end, rise = abs(self.endVelocity), abs(self.rise)
        if end > ENDS * self.peakVelocity:
            found.append(
                f"its velocity at the end is {self.endVelocity:.3g} m/s,"
                f" {100 * end / self.peakVelocity:.0f} % of its largest (a record that ends at"
                f" rest: below {100 * ENDS:g} %), as under a constant acceleration of"
                f" {self.lean:.2g} m/s²"
            )
        if rise > RISES * self.peakDisplacement:
            found.append(
                f"a straight line through its displacements rises by {self.rise:.3g} m,"
                f" {100 * rise / self.peakDisplacement:.0f} % of the largest (a motion about one"
                f" place: below {100 * RISES:g} %)"
            )
        return " and ".join(found) or None


def drift(values: Numbers, every: float) -> Drift:
    """How far a record drifts: velocity and displacement, integrated from rest.

    A motion of the ground ends at rest, so the velocity at its end is 0; the criterion is 5 % of
    the largest velocity. A motion about one place has displacements to both sides, and a line of
    least squares through them hardly rises. An offset of the accelerations or of the velocity gives
    displacements whose line rises by all of the largest one, so the criterion is half of that. A
    record with a permanent displacement of the ground, near a fault, exceeds it rightly. Nothing is
    corrected: processed records of both databases need none, and what is right for another one
    depends on why it drifts.

    The integrals are exact for accelerations that change evenly between samples.

    :param values: samples, in m/s² for the units of the result; ``every``: the time between two of
        them [s]
    """
    a = np.asarray(values, float)
    v = np.concatenate([[0.0], np.cumsum(0.5 * every * (a[:-1] + a[1:]))])
    steps = every * v[:-1] + every**2 / 6 * (2 * a[:-1] + a[1:])
    d = np.concatenate([[0.0], np.cumsum(steps)])
    t = np.arange(len(a)) - 0.5 * (len(a) - 1)
    rise = float(t @ d / (t @ t) * (len(a) - 1))
    lean = float(v[-1] / (every * (len(a) - 1)))
    return Drift(float(v[-1]), float(abs(v).max()), rise, float(abs(d).max()), lean)
