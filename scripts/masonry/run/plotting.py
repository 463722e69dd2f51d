# SPDX-License-Identifier: GPL-2.0-or-later
"""Rows of curve.csv for ``yade.plot``, for those who watch a curve grow.

The user asks for it as usual in YADE, before the run::

    from yade import plot
    plot.plots = {"displacement_mm": ("base_shear_kN",)}
    plot.plot()
"""

import math
import sys


def live(columns):
    """A function that adds a row to ``yade.plot.data``, or None if the user has not asked for it.

    The user has asked if he has imported ``yade.plot`` and if one of these columns stands in ``plot.plots``. Nothing is
    imported here, and nothing is spent if he has not.

    :param columns: names of the columns of curve.csv
    :returns: function of a row, a sequence with a number for each of these columns
    :raises ValueError: from that function, if a row has another length
    """
    plot = sys.modules.get("yade.plot")
    if plot is None or not _named(plot.plots).intersection(columns):
        return None
    columns = tuple(dict.fromkeys(columns))

    def add(row):
        if len(row) != len(columns):
            raise ValueError(
                f"yade.plot: a row of {len(row)} numbers for {len(columns)} columns"
            )
        data = plot.data
        ours = [data.get(name) for name in columns]
        lengths = set(map(len, data.values()))
        if None in ours or len(lengths) > 1 or plot.liveForceAlwaysUpdate:
            plot.addData(dict(zip(columns, row)))  # fills up what is missing
            return
        for values, number in zip(ours, row):  # the same, but quick
            values.append(number)
        if len(data) > len(columns):
            for name in data.keys() - columns:
                data[name].append(math.nan)

    return add


def _named(plots):
    """All columns that ``plot.plots`` names: x, and each y by its name or with its style behind it."""
    named = set()
    for x, wanted in plots.items():
        named.add(x.strip())
        wanted = [wanted] if isinstance(wanted, str) else wanted or ()
        for y in wanted:
            y = y[0] if isinstance(y, (tuple, list)) and y else y
            if isinstance(y, str):
                named.add(y)
    return named
