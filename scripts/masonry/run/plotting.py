# SPDX-License-Identifier: GPL-2.0-or-later
"""Rows of curve.csv for ``yade.plot``, for those who watch a curve grow.

The user asks for it as usual in YADE, before the run::

    from yade import plot
    plot.plots = {"displacement_mm": ("base_shear_kN",)}
    plot.plot()
"""

import sys


def live(columns):
    """A function that adds a row to ``yade.plot.data``, or None if the user has not asked for it.

    The user has asked if he has imported ``yade.plot`` and if one of these columns stands in
    ``plot.plots``.

    :param columns: names of the columns of curve.csv
    :returns: function of a row, which raises ValueError if it has another length
    """
    plot = sys.modules.get("yade.plot")
    if plot is None or not _named(plot.plots).intersection(columns):
        return None

    def add(row):
        if len(row) != len(columns):
            raise ValueError(f"yade.plot: a row of {len(row)} numbers for {len(columns)} columns")
        plot.addData(dict(zip(columns, row)))

    return add


def _named(plots):
    """All columns that ``plot.plots`` names: x, and each y by its name or with its style behind
    it."""
    named = {x.strip() for x in plots}
    for wanted in plots.values():
        for y in [wanted] if isinstance(wanted, str) else wanted or ():
            y = y[0] if isinstance(y, (tuple, list)) and y else y
            named |= {y} if isinstance(y, str) else set()
    return named
