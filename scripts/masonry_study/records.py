# SPDX-License-Identifier: GPL-2.0-or-later
"""The rows of a study, read from its folder as :mod:`masonry_study.gathering` leaves it."""

import contextlib
import csv
import os

import numpy as np

from masonry.run import batch
from masonry.errors import Refused
from masonry.numbers.files import readCurve, readText
from .gathering import CSV, Folder


def _table(path):
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


CURVE = "displacement_mm", "base_shear_kN"  # columns of the curves that are usually compared
#: Measures of every run, which nobody studies.
IN_EVERY_RUN = {"collapsed", "ended", "energy_balance_error", "energy_made"}


class Record:
    """The rows of a study. Raises Refused if its table is missing or damaged."""

    def __init__(self, directory):
        self.directory = directory
        #: texts of every column by its name
        self.cells = _table(os.path.join(directory, CSV))
        names = list(self.cells)
        #: names of what varied, and of the numbers of a run
        self.varied = names[1 : names.index("status")]
        self.measures = names[names.index("status") + 1 :]

    def __len__(self):
        return len(self.cells["run"])

    @property
    def correlation(self):
        """Rank correlations with which properties were drawn, by pairs of their columns; none
        without study.json."""
        with contextlib.suppress(Refused):
            study = Folder(self.directory).description()["study"]
            return {(one, two): rank for one, two, rank in study.get("correlation", ())}
        return {}

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
        """The rows that have this measure: which they are, the inputs that are numbers, by name and
        without seeds of random fields, and the measure. Raises Refused if there is no row.
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
        """Columns x and y of the curves of rows; those without a curve are left out."""
        folder, found = Folder(self.directory), []
        for row in rows:
            with contextlib.suppress(Refused, KeyError):
                curve = readCurve(folder.row(int(self.cells["run"][row])))
                found.append((curve[x], curve[y]))
        return found


def _number(text):
    try:
        return float(text)
    except ValueError:
        return np.nan
