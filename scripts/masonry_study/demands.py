# SPDX-License-Identifier: GPL-2.0-or-later
"""What came out of an incremental dynamic analysis: demands over intensity, and the intensities
that a limit needs.

The demand of a row is the amount of one of its measures, for example the largest displacement of a
point. Where the structure falls the demand is infinite, and it stays so at all higher levels, which
are not run. Quantiles over the records at a level count infinite demands like others. Between two
levels of a record the demand is interpolated, from zero at zero on; between the highest level at
which the structure stood and that at which it fell it counts as infinite, which is on the safe side
and matters only where records have other levels than each other.

Rows that failed or are missing are left out, and at a level with fewer than three known records
there is no quantile.
"""

import copy
import math
import re

import numpy as np

from masonry.errors import Refused
from . import fragility
from .gathering import Folder

QUANTILES = (0.16, 0.5, 0.84)


class Demands:
    """The rows of an incremental dynamic analysis.

    :param measure: the column whose amount is the demand; None: the usual one
    """

    def __init__(self, record, measure=None):
        chains = Folder(record.directory).chains
        if len(record) != chains.runs:
            raise Refused(
                f"{record.directory}: study.csv has {len(record)} rows, and the study"
                f" {chains.runs}: --gather writes it anew"
            )
        self.intensityName = chains.plan["measure"]
        self.directory = record.directory
        self.names = [one["name"] for one in chains.plan["records"]]
        byRecord = lambda values: np.reshape(values, (len(self.names), chains.each))
        status = byRecord(record.cells["status"])
        fallen = byRecord(record.cells.get("collapsed", [""] * len(record))) == "True"
        ended, above = status == "ended", status == "above collapse"
        fell, stood = ended & fallen, ended & ~fallen
        self.measure = measure or _usual(record)
        found = np.full(len(record), np.nan)
        if self.measure:
            found = abs(record.numbers(self.measure))
        found = np.where(stood, byRecord(found), np.where(fell | above, math.inf, np.nan))
        levels = byRecord([chains.intensity(n + 1) for n in range(len(record))])
        #: of every record its rows, the lowest level first: intensity and demand, NaN where it is
        #: not known
        self.rows = [*zip(levels.tolist(), found.tolist())]
        #: of every record the level at which the structure fell; infinite: it stood
        self.fell = np.where(fell, levels, math.inf).min(axis=1).tolist()
        #: of every record the intensities at which the structure stood, also where nothing was
        #: watched
        self.stood = [row[own].tolist() for row, own in zip(levels, stood)]

    def apart(self, record, column):
        """The records by what a column says of them, as the class of damage with which a shake
        begins: Demands by the texts of the column, in their order. Records for which it says
        nothing are left out. Raises Refused if it is not the same in all rows of a record."""
        order, groups, each = np.nan_to_num(record.numbers(column)), {}, len(self.rows[0][0])
        cells = record.cells[column]
        for n, name in enumerate(self.names):
            rows = [r for r in range(n * each, (n + 1) * each) if cells[r]]
            if len({cells[r] for r in rows}) > 1:
                raise Refused(f"--by {column}: it changes with the levels of record {name}")
            for r in rows[:1]:
                groups.setdefault((order[r], cells[r]), []).append(n)
        found = {}
        for key, own in sorted(groups.items()):
            one = found[key[1]] = copy.copy(self)
            for part in ("names", "rows", "fell", "stood"):
                setattr(one, part, [getattr(self, part)[n] for n in own])
        return found

    @property
    def levels(self):
        return sorted({i for intensities, _ in self.rows for i in intensities})

    def at(self, intensity):
        return np.array([_between(*rows, intensity) for rows in self.rows])

    def quantiles(self, intensity, shares=QUANTILES):
        """Quantiles of the demand over the records at an intensity, or NaN."""
        values = self.at(intensity)
        values = np.sort(values[~np.isnan(values)])
        known = len(values) >= fragility.MIN_RECORDS
        return [_quantile(values, share) if known else math.nan for share in shares]

    def intervals(self, limit=None):
        """Of every record that has a row: the highest intensity below the first at which a limit of
        the demand is reached (0: none), and that first one (infinite: none). None: the structure
        falls.
        """
        ends, most = [], math.inf if limit is None else limit
        for (intensities, demands), stood in zip(self.rows, self.stood):
            found = [*zip(intensities, demands)]
            first = min((i for i, d in found if d >= most), default=math.inf)
            below = stood if limit is None else [i for i, d in found if d < limit]
            last = max((i for i in below if i < first), default=0.0)
            if last or first < math.inf:
                ends.append((last, first))
        return tuple(np.reshape(ends, (-1, 2)).T)

    def counts(self, limit=None):
        """Of every level: the intensity, how many records have reached a limit at or below it, and
        of how many it is known."""
        low, high = self.intervals(limit)
        return [
            (level, int((high <= level).sum()), int(((high <= level) | (low >= level)).sum()))
            for level in self.levels
        ]

    def fragility(self, limit=None):
        """:class:`masonry_study.fragility.Fit` of reaching a limit of the demand; None: of
        collapse. Raises Refused."""
        if limit is not None and not self.measure:
            raise Refused("no fragility of a limit: no row has a demand; scene.watch() records one")
        return fragility.fit(*self.intervals(limit))


def _usual(record):
    """The largest displacement that the shake of a scene found, of the point and along the axis
    where it is largest; None if nothing was watched."""
    names = [m for m in record.measures if re.match(r"shake_\d+_largest_.*_mm$", m)]
    values = ((np.abs(record.numbers(name)), name) for name in names)
    sizes = [(v[np.isfinite(v)].max(initial=-1), name) for v, name in values]
    size, name = max(sizes, default=(-1, None))
    return name if size >= 0 else None


def _between(intensities, demands, at):
    upTo = int(np.searchsorted(intensities, at)) + 1
    if math.inf in demands[:upTo]:  # it falls at a lower intensity, or at the next one
        return math.inf
    return np.interp(at, [0.0, *intensities], [0.0, *demands], right=math.nan)


def _quantile(values, share):
    """A quantile of sorted numbers, of which some may be infinite: even between two of them."""
    place = share * (len(values) - 1)
    low, high = (float(values[end(place)]) for end in (math.floor, math.ceil))
    return high if math.isinf(high) else low + (place % 1) * (high - low)
