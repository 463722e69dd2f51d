# SPDX-License-Identifier: GPL-2.0-or-later
"""The rows of a study, read from its folder as :mod:`masonry.study.gathering` leaves it. This
module needs no YADE."""

import contextlib
import csv
import os

import numpy as np

from ..run import batch, presets
from ..basics import Refused, refuse
from ..read.files import readCurve, readText
from .gathering import CSV, TIMES, Folder


def _table(path):
    """A CSV file as a dict of column -> texts. Raises Refused."""
    head, *lines = [*csv.reader(readText(path).splitlines())] or [[]]
    if head[:1] != ["run"] or "status" not in head:
        raise Refused(f"{path}: this is no table of a study: it needs the columns run and status")
    wrong = [str(i) for i, line in enumerate(lines, 2) if len(line) != len(head)]
    if wrong:
        raise Refused(
            f"{path}: lines {', '.join(wrong[:10])} do not have {len(head)} cells, as the first has"
        )
    if not lines:
        raise Refused(f"{path}: there is no row yet")
    return dict(zip(head, map(list, zip(*lines))))


CURVE = (
    "displacement_mm",
    "base_shear_kN",
)  # columns of the curves that are usually compared
#: Measures of every run, which nobody studies.
IN_EVERY_RUN = {"collapsed", "ended", "energy_balance_error", "energy_made"}


class Record:
    """The rows of a study.

    :raises Refused: if there is no such table in it, or it is damaged
    """

    def __init__(self, directory):
        #: its path, and texts of every column by its name
        self.directory = directory
        self.cells = _table(os.path.join(directory, CSV))
        names = list(self.cells)
        #: names of what varied, and of the numbers of a run
        self.varied = names[1 : names.index("status")]
        self.measures = names[names.index("status") + 1 :]

    def __len__(self):
        return len(self.cells["run"])

    def measure(self, default):
        """The measure that is reported if none is named: the usual one, or else the first answer of
        a stage or script."""
        if default in self.cells:
            return default
        own = (m for m in self.measures if m not in IN_EVERY_RUN)
        return next((m for m in own if np.isfinite(self.numbers(m)).any()), default)

    def numbers(self, name):
        """A column as numbers, NaN where a cell has none. Raises Refused if there is no such
        column."""
        if name not in self.cells:
            raise Refused(f"{self.directory}: no column {name}; there are {', '.join(self.cells)}")
        return np.array([_number(text) for text in self.cells[name]])

    def complete(self, measure):
        """The rows that have this measure: which they are, the inputs by name, and the measure.

        Inputs are those that are numbers; the seed of a random field is not.

        :raises Refused: if no row has it
        """
        values = self.numbers(measure)
        rows = np.flatnonzero(np.isfinite(values))
        if not len(rows):
            raise Refused(f"{self.directory}: no row has a {measure}")
        drawn = (name for name in self.varied if not name.startswith(batch.FIELD))
        inputs = {name: self.numbers(name)[rows] for name in drawn}
        numbers = {k: v for k, v in inputs.items() if np.isfinite(v).all()}
        return rows, numbers, values[rows]

    def curves(self, rows, x, y):
        """Columns x and y of the curves of rows: a list of pairs. Rows without a curve are left
        out."""
        folder, found = Folder(self.directory), []
        for row in rows:
            with contextlib.suppress(Refused, KeyError):
                curve = readCurve(folder.row(int(self.cells["run"][row])))
                found.append((curve[x], curve[y]))
        return found

    def price(self, rows):
        """Mean time of the jobs of rows [s], from times.csv; NaN if none tells."""
        times = _table(os.path.join(self.directory, TIMES))["job_seconds"]
        known = [t for t in (_number(times[row]) for row in rows) if t > 0]
        return float(np.mean(known)) if known else np.nan


def paired(expensive, cheap, measure, other=None):
    """A measure of two studies that share rows: that of the shared rows of ``expensive``, and that
    of all rows of ``cheap``.

    Rows are shared if every varied property has the same text in both tables. Those of ``cheap``
    that are shared come first, in the order of ``expensive``.

    :param expensive: :class:`Record`, and ``cheap`` one
    :param measure: column of ``expensive``; ``other`` is that of ``cheap``, None: the same
    :returns: two arrays for :mod:`masonry.study.estimate`, and two lists: the rows of ``expensive``
        and those of ``cheap``
    :raises Refused: if their scenes or options differ in more than FIDELITY, if something else
        varies in both, or rows of one study are the same
    """
    rowsOf = lambda study: [*zip(*(study.cells.get(n, ()) for n in expensive.varied))]
    keys = {study: rowsOf(study) for study in (expensive, cheap)}
    refuse([*_unlike(expensive, cheap, keys)])
    y, x = expensive.numbers(measure), cheap.numbers(other or measure)
    place = {key: row for row, key in enumerate(keys[cheap]) if np.isfinite(x[row])}
    shared = [n for n, key in enumerate(keys[expensive]) if key in place and np.isfinite(y[n])]
    first = [place[keys[expensive][row]] for row in shared]
    others = sorted(set(place.values()) - set(first))
    return y[shared], x[first + others], shared, first + others


#: Options that decide how accurate and how dear a run is; studies of one wall may differ in them.
FIDELITY = {"preset", "density_scaling", "units", *presets.USUAL}


def _unlike(one, two, keys):
    """Why two studies share no rows. In what they differ beside FIDELITY their study.json tells, if
    there is one."""
    with contextlib.suppress(Refused):
        studies = [Folder(s.directory).description()["study"] for s in (one, two)]
        first, second = ({"scene": s["scene"], **s["options"]} for s in studies)
        for name in sorted({*first, *second} - FIDELITY):
            if first.get(name) != second.get(name):
                yield (
                    f"{one.directory} has {name} {first.get(name)!r}, and"
                    f" {two.directory} {second.get(name)!r}"
                )
    if sorted(one.varied) != sorted(two.varied):
        yield (
            f"{one.directory} varies {', '.join(one.varied)}, and"
            f" {two.directory} {', '.join(two.varied)}"
        )
        return
    for study, own in keys.items():
        if len(set(own)) < len(own):
            yield (
                f"{study.directory}: rows have the same properties, so that it cannot be told which"
                " are shared"
            )


def _number(text):
    try:
        return float(text)
    except ValueError:
        return np.nan
