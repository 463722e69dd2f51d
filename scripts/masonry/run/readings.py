# SPDX-License-Identifier: GPL-2.0-or-later
"""Readings of the model, which become rows of curve.csv some at a time."""

import time

from ..numbers.columns import Reading
from ..terminal import say

FLUSH_EVERY = 0.2  # [s] of wall-clock time: rows are on the disk after it


class Readings:
    """Readings that are not in curve.csv yet, for FLUSH_EVERY or up to a checkpoint or the end. A
    run that is resumed after a kill makes those again that were lost.

    :param live: function that adds a row to yade.plot, or None
    """

    def __init__(self, columns, results, live):
        self._values = [column.value for column in columns]
        self._results, self._live = results, live
        self.waiting = []  # rows
        self.time = None  # in the scene, of the last one [s]
        self._written = self._read = time.perf_counter()  # [s]

    @property
    def count(self):
        """How many rows there are, with those that wait."""
        return len(self._results.rows) + len(self.waiting)

    def add(self, model):
        """Read the model. Returns the reading."""
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
        for row in rows if self._live else []:
            self._live(row)
        self._written = time.perf_counter()
