# SPDX-License-Identifier: GPL-2.0-or-later
"""The curve and the folder of a run as objects that show themselves in a notebook.

    from masonry_view.notebook import RunFolder

    run = RunFolder("results/wall_comp4")
    run                                      # picture, curve and table of results
    run.numbers["peak_base_shear_kN"]        # entries of run.json
    curve = run.curve()                      # columns of curve.csv
    curve["base_shear_kN"].max(), curve.units["base_shear_kN"]
    curve.to_pandas()                        # where pandas is installed

``scene.curve()`` gives the same of a scene between its stages, or after its end.
"""

import os
import re

import numpy as np

from masonry.arguments import nearest, validated
from masonry.errors import Refused
from . import cells, curve_figure, elevation
from masonry.numbers import drawing, quantities
from masonry.numbers.files import filesOf, readCurve, readRun

DPI = 72  # of pictures in a notebook, for 10 to 50 kB each


def unitOf(head, meaning):
    """The unit of a column: in the brackets at the end of its meaning, else at the end of its name,
    else ``"-"``.

    :param head: its name in curve.csv; ``meaning``: its line in the entry ``columns`` of run.json
    """
    found, last = re.search(r"\[([^\[\]]+)\]$", meaning), head.rpartition("_")[2]
    return found[1] if found else last if last in UNITS else "-"


def bare(meaning):
    """The meaning of a column without its unit."""
    return re.sub(r" *\[[^\[\]]+\]$", "", str(meaning))


#: Units at the end of names of columns that a script adds, whose meaning need not have them.
UNITS = {"mm", "m", "s", "kN", "N", "MPa", "kPa", "Pa", "J", "g", "mrad", "rad", "kg"}


class Curve:
    """Columns of curve.csv: ``curve["base_shear_kN"]`` is an array of numpy.

    ``units`` and ``meanings`` are dicts by the names of the columns; iterating gives the names, as
    with a dict.

    :param columns: dict of name -> numbers; ``meanings``: dict of name -> what it means, with its
        unit in brackets
    :param draws: function without arguments that gives a figure of matplotlib, or None
    """

    def __init__(self, columns, meanings, draws=None):
        self._columns = {n: np.array(v, float) for n, v in columns.items()}
        self.meanings = {name: meanings.get(name, "") for name in columns}
        self.units = {name: unitOf(name, self.meanings[name]) for name in columns}
        self._draws = draws

    def __getitem__(self, name):
        if name not in self._columns:
            close = nearest(name, self._columns)
            others = close or f"; there are {', '.join(self._columns)}"
            raise KeyError(f"no column {name!r}{others}")
        return self._columns[name]

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        """How many rows there are."""
        return max(map(len, self._columns.values()), default=0)

    def keys(self):
        """The names of the columns."""
        return self._columns.keys()

    def to_pandas(self):
        """The columns as a ``pandas.DataFrame``, whose ``attrs`` has ``units`` and ``meanings``.

        :raises ImportError: if pandas is not installed
        """
        try:
            import pandas
        except ModuleNotFoundError as error:
            raise ImportError(
                (
                    "to_pandas needs pandas, which is not installed (on Debian, apt-get install"
                    " python3-pandas): the columns are arrays of numpy without it, as"
                    " curve['time_s']"
                ),
                name=error.name,
            ) from None
        frame = pandas.DataFrame(self._columns)
        frame.attrs.update(units=self.units, meanings=self.meanings)
        return frame

    def __repr__(self):
        return f"curve of {len(self)} rows: {', '.join(self._columns)}"

    def _repr_html_(self):
        title = f"{len(self)} rows, {len(self._columns)} columns"
        ends = lambda v: (
            [f"{x:.4g}" for x in (v[0], v[-1], v.min(), v.max())] if len(v) else [""] * 4
        )
        rows = [
            (n, self.units[n], *ends(v), bare(self.meanings[n])) for n, v in self._columns.items()
        ]
        heads = "column", "unit", "first", "last", "smallest", "largest", "meaning"
        table = cells.table(rows, heads)
        return cells.titled(title, self.picture(), cells.folded("columns", table))

    def picture(self):
        """What curve.png shows as HTML; nothing where there are less than two rows, or no
        figure."""
        return _drawn(self._draws) if len(self) > 1 else ""


def _drawn(draws):
    """A picture of a figure as HTML, or nothing if there is none."""
    if not draws:
        return ""
    with drawing.style():
        figure = draws()
        return cells.picture(figure, DPI) if figure else ""


def curveOf(columns, run, directory):
    """A :class:`Curve` of a run that draws itself as curve.png.

    :param columns: dict of name -> numbers
    :param run: entries of run.json: ``columns``, and ``figure`` and ``title`` if it is to be drawn
    :param directory: folder, for messages
    """
    draws = lambda: curve_figure.figureOf(run, columns, directory)
    return Curve(columns, run.get("columns", {}), draws if "figure" in run else None)


def cracksOf(run, blocks, joints, when, directory):
    """The picture of cracks.png as HTML; parameters as in
    :func:`masonry_view.elevation.cracksOf`."""
    return _drawn(lambda: elevation.cracksOf(run, blocks, joints, when, directory))


class RunFolder:
    """A folder of results, which shows itself in a notebook: cracks, curve and a table of results.

    :param directory: folder of a run that has ended
    :raises Refused: if there are no files of a run
    """

    @validated
    def __init__(self, directory):
        self.directory = os.fspath(directory)
        #: entries of run.json, as :mod:`masonry.run.results` lists them
        self.numbers = readRun(self.directory)

    def curve(self):
        """The columns of curve.csv: a :class:`Curve`. Raises Refused."""
        return curveOf(readCurve(self.directory), self.numbers, self.directory)

    def _cracks(self):
        try:
            return _drawn(lambda: elevation.cracksOfFrame(self.numbers, self.directory))
        except Refused:  # there are none with --no-vtk
            return ""

    def __repr__(self):
        return f"{self.numbers.get('scene')}: results in {self.directory}"

    def _repr_html_(self):
        run = self.numbers
        with filesOf(self.directory):
            title = f"{run['title']}: {run.get('ended') or 'no rows'}"
            results = cells.table(resultsOf(run))
            try:
                curve = self.curve().picture()
            except Refused:  # a bound alone has no rows
                curve = ""
            return cells.titled(title, self._cracks(), curve, results)


def resultsOf(run):
    """Rows of the table of results, from the entries of run.json: what it is, its value and its
    unit."""
    rows = []
    if run.get("collapse"):
        rows.append(("collapsed", run["collapse"], ""))
    if run.get("error"):
        rows.append(("ended by", run["error"], ""))
    for one in run.get("answers", []):
        if one["name"].startswith("displacement_"):
            continue
        value = "not found" if one["value"] is None else f"{one['value']:.4g}"
        if one["uncertainty"] is not None:
            value += f" ± {one['uncertainty']:.2g}"
        what = f"{one['stage']}: {one['name'].replace('_', ' ')}"
        rows.append((what, value, "" if one["unit"] == "-" else one["unit"]))
    for one in quantities.shown(run, brief=True):
        value = one.value if isinstance(one.value, int) else f"{one.value:.4g}"
        rows.append((one.name, str(value), "" if one.unit == "-" else one.unit))
    return rows
