# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of ground accelerations: which formats are read, and whether a record drifts. No YADE is
needed.

The format is found from the contents, not from the name of the file:

- **PEER NGA** (``.AT2``), **ESM** and ITACA (DYNA, ``.ASC``), **K-NET** and **KiK-net** (``.NS``,
  ``.EW``, ``.UD``, and with 1 below and 2 at the ground), **COSMOS** V1 and V2, the older form of
  **CSMIP**, and **GeoNet** V1A and V2A, three components in one file: see
  :mod:`masonry.scene.accelerograms.databases`.
- **Text** in columns (:mod:`masonry.texts`): one column, accelerations; or two, time [s] and
  acceleration; or three, two horizontal accelerations and the vertical one, below a head or a
  comment that names them (``# components: x y z``); or four, with a head that names the time too.
  Five and more numbers a line are samples one after the other, as are lines of the number of
  samples, with or without the time between them, before the samples. Comments and heads may say the
  unit, as in ``# unit: g`` or ``acceleration [cm/s2]``, and the time between samples, ``# every:
  0.005 s``.

g is 9.81 m/s². What a file says of itself is compared with what is in it: another number of
samples, times that are not evenly apart, and numbers that are not finite are refused with the file,
the line and the value.
"""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arguments import FilePath, Numbers
from ...texts import TextFile
from . import databases, text_columns

#: Shares above which a record is said to drift: of its largest velocity at the end, and of its
#: largest displacement that a straight line through its displacements rises by. See :func:`drift`.
ENDS, RISES = 0.05, 0.5


@dataclass(frozen=True)
class Accelerogram:
    """What a file of accelerations holds.

    :param values: the samples, in the unit of the file: numbers, or lists of three components
    :param every: time between two samples [s]; None: the file does not say it
    :param unit: a key of UNITS; None: the file does not say it
    :param kind: its format, such as ``"PEER"`` or ``"text"``
    :param flowing: whether its lines have several samples, and no format says so
    """

    values: list[Any]
    every: float | None
    unit: str | None
    kind: str
    flowing: bool = False


def read(path: FilePath) -> Accelerogram:
    """Read a file of accelerations. Raises Refused with the file, the line and the value that is
    wrong."""
    file = TextFile(path)
    lines = [(line, text) for line, text in enumerate(file.lines, 1) if text.strip()]
    for kind, (begins, most, reader) in databases.READERS.items():
        for line, text in lines[:most]:
            # names of ESM are in capitals, the others in any letters
            flags = 0 if kind == "ESM" else re.I
            if re.search(begins, text, flags) and not text.lstrip().startswith("#"):
                values, every, unit = reader(file, line)
                return Accelerogram(values, every, unit, kind)
    values, every, unit, flowing = text_columns.read(file)
    return Accelerogram(values, every, unit, "text", flowing)


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
    :param lean: the constant acceleration that gives the ground this velocity at the end [m/s²]
    """

    endVelocity: float
    peakVelocity: float
    rise: float
    peakDisplacement: float
    lean: float

    def sentence(self) -> str | None:
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
    """How far a record drifts: velocity and displacement, integrated from rest, exactly for
    accelerations that change evenly between samples.

    A motion of the ground ends at rest, so the velocity at its end is 0; the criterion is 5 % of
    the largest velocity. A motion about one place has displacements to both sides, and a line of
    least squares through them hardly rises. An offset of the accelerations or of the velocity gives
    displacements whose line rises by all of the largest one, so the criterion is half of that. A
    record with a permanent displacement of the ground, near a fault, exceeds it rightly. Nothing is
    corrected: what is right depends on why a record drifts.

    :param values: samples [m/s²]; ``every``: the time between two of them [s]
    """
    a = np.asarray(values, float)
    v = np.concatenate([[0.0], np.cumsum(0.5 * every * (a[:-1] + a[1:]))])
    steps = every * v[:-1] + every**2 / 6 * (2 * a[:-1] + a[1:])
    d = np.concatenate([[0.0], np.cumsum(steps)])
    t = np.arange(len(a)) - 0.5 * (len(a) - 1)
    rise = float(t @ d / (t @ t) * (len(a) - 1))
    lean = float(v[-1] / (every * (len(a) - 1)))
    return Drift(float(v[-1]), float(abs(v).max()), rise, float(abs(d).max()), lean)
