# SPDX-License-Identifier: GPL-2.0-or-later
"""Readings of the model, which become rows of curve.csv, and of ``yade.plot``, some at a time."""

import sys
import time

from ..numbers.columns import Reading
from ..terminal import say

FLUSH_EVERY = 0.2  # [s] of wall-clock time: rows are on the disk after it


def plotted(columns):
    """``yade.plot``, if the user has imported it and x of one of its ``plots`` is among columns of
    curve.csv, as in ``plot.plots = {"displacement_mm": ("base_shear_kN",)}`` before the run; else
    None."""
    plot = sys.modules.get("yade.plot")
    return plot if plot and {x.strip() for x in plot.plots} & {*columns} else None


class Readings:
    """Readings that are not in curve.csv yet, for FLUSH_EVERY or up to a checkpoint or the end. A
    run that is resumed after a kill makes those again that were lost."""

    def __init__(self, columns, results):
        self._values = [column.value for column in columns]
        self._results, self._plot = results, plotted(results.columns)
        self.waiting = []  # rows
        self.time = None  # in the scene, of the last one [s]
        self._written = self._read = time.perf_counter()  # [s]

    @property
    def count(self):
        return len(self._results.rows) + len(self.waiting)

    def add(self, model):
        reading = Reading(model)
        for sentence in model.connectors.news():
            say(f"note: {sentence}")
        self.waiting.append([value(reading) for value in self._values])
        self.time = reading.time
        return reading

    def isDue(self):
        """Whether the rows should be written, if the next one takes as long as the last."""
        before, self._read = self._read, time.perf_counter()
        return 2 * self._read - self._written - before > FLUSH_EVERY

    def write(self):
        """Write the rows that wait. Raises as :meth:`masonry.run.results.Results.append` does."""
        rows, self.waiting = self.waiting, []
        self._results.append(rows)
        for row in rows if self._plot else []:
            self._plot.addData(dict(zip(self._results.columns, row)))
        self._written = time.perf_counter()
