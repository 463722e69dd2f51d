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

import base64
import contextlib
import html
import io
import os

import numpy as np
from masonry.arguments import nearest, validated
from masonry.errors import Refused
from masonry.numbers import drawing, quantities
from masonry.numbers.files import filesOf, readCurve, readRun

from . import curve_figure, elevation

DPI, COLOURS = 72, 64  # of a picture, which then has 10 to 50 kB


def picture(draws):
    """The figure of matplotlib that a function gives, as an image in the HTML itself. Its palette
    of few colours makes it a third as large, and keeps those of thin lines."""
    from PIL import Image

    drawn, small = io.BytesIO(), io.BytesIO()
    with drawing.style():
        draws().savefig(drawn, dpi=DPI, format="png")
    image = Image.open(drawn).convert("RGB").quantize(COLOURS, Image.Quantize.FASTOCTREE)
    image.save(small, "png", optimize=True)
    data = base64.b64encode(small.getvalue()).decode()
    return f'<img src="data:image/png;base64,{data}"/>'


def table(rows, heads=()):
    """Rows of texts as a table in HTML; the first of each row is its head."""

    def cell(text, kind="td"):
        return f'<{kind} style="text-align:left">{html.escape(str(text))}</{kind}>'

    lines = ["".join(cell(head, "th") for head in heads)] * bool(heads)
    lines += [cell(first, "th") + "".join(map(cell, others)) for first, *others in rows]
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


def folded(title, inside):
    """What is seen after a click on its title."""
    return f"<details><summary>{html.escape(title)}</summary>{inside}</details>"


def titled(title, *parts):
    return f"<div><b>{html.escape(title)}</b>{''.join(parts)}</div>"


#: Units at the end of names of columns that a script adds, whose meaning need not have them.
UNITS = {"mm", "m", "s", "kN", "N", "MPa", "kPa", "Pa", "J", "g", "mrad", "rad", "kg"}


def unitOf(head, meaning):
    """The unit of a column: in the brackets at the end of its meaning, else at the end of its name,
    else ``"-"``."""
    unit = curve_figure.unitOf({"label": meaning, "column": head})
    return unit if meaning.endswith("]") or unit in UNITS else "-"


class Curve:
    """Columns of curve.csv: ``curve["base_shear_kN"]`` is an array of numpy. ``units`` and
    ``meanings`` are dicts by the names of the columns; iterating gives the names.

    :param meanings: what each means, with its unit in brackets
    :param draws: function that gives a figure of matplotlib, or None
    """

    def __init__(self, columns, meanings, draws=None):
        self._columns = {n: np.array(v, float) for n, v in columns.items()}
        self.meanings = {name: meanings.get(name, "") for name in columns}
        self.units = {name: unitOf(name, self.meanings[name]) for name in columns}
        self._draws = draws

    def __getitem__(self, name):
        if name not in self._columns:
            close = nearest(name, self._columns)
            raise KeyError(
                f"no column {name!r}{close or '; there are ' + ', '.join(self._columns)}"
            )
        return self._columns[name]

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        """How many rows there are."""
        return max(map(len, self._columns.values()), default=0)

    def keys(self):
        return self._columns.keys()

    def to_pandas(self):
        """The columns as a ``pandas.DataFrame``, whose ``attrs`` has ``units`` and ``meanings``.
        Raises ImportError."""
        try:
            import pandas
        except ModuleNotFoundError as error:
            raise ImportError(
                "to_pandas needs pandas, which is not installed (on Debian, apt-get install"
                " python3-pandas): the columns are arrays of numpy without it, as curve['time_s']",
                name=error.name,
            ) from None
        frame = pandas.DataFrame(self._columns)
        frame.attrs.update(units=self.units, meanings=self.meanings)
        return frame

    def __repr__(self):
        return f"curve of {len(self)} rows: {', '.join(self._columns)}"

    def _repr_html_(self):
        rows = []
        for name, values in self._columns.items():
            ends = [values[0], values[-1], values.min(), values.max()] if len(values) else []
            ends = [f"{end:.4g}" for end in ends] or [""] * 4
            meaning = curve_figure.bare(self.meanings[name])
            rows.append((name, self.units[name], *ends, meaning))
        heads = "column", "unit", "first", "last", "smallest", "largest", "meaning"
        title = f"{len(self)} rows, {len(self._columns)} columns"
        return titled(title, self.picture(), folded("columns", table(rows, heads)))

    def picture(self):
        """What curve.png shows as HTML; nothing where there are less than two rows, or no
        figure."""
        return picture(self._draws) if self._draws and len(self) > 1 else ""


def curveOf(columns, run, directory):
    """A :class:`Curve` of a run that draws itself as curve.png.

    :param run: entries of run.json: ``columns``, and ``figure`` and ``title`` if it is to be drawn
    :param directory: folder, for messages
    """
    draws = lambda: curve_figure.figureOf(run, columns, directory)
    return Curve(columns, run.get("columns", {}), draws if "figure" in run else None)


class RunFolder:
    """A folder of results, which shows itself in a notebook: cracks, curve and a table of results.
    Raises Refused."""

    @validated
    def __init__(self, directory):
        self.directory = os.fspath(directory)
        #: entries of run.json, as :mod:`masonry.run.results` lists them
        self.numbers = readRun(self.directory)

    def curve(self):
        """The columns of curve.csv: a :class:`Curve`. Raises Refused."""
        return curveOf(readCurve(self.directory), self.numbers, self.directory)

    def __repr__(self):
        return f"{self.numbers.get('scene')}: results in {self.directory}"

    def _repr_html_(self):
        run, pictures = self.numbers, []
        draws = lambda: elevation.cracksOfRun(run, self.directory)
        with filesOf(self.directory):
            title = f"{run['title']}: {run.get('ended') or 'no rows'}"
            for part in (lambda: picture(draws), lambda: self.curve().picture()):
                with contextlib.suppress(Refused):  # no frames with --no-vtk; a bound has no rows
                    pictures.append(part())
            return titled(title, *pictures, table(resultsOf(run)))


def resultsOf(run):
    """Rows of the table of results: what it is, its value and its unit."""
    named = {"collapsed": "collapse", "ended by": "error"}
    rows = [(what, run[key], "") for what, key in named.items() if run.get(key)]
    for one in run.get("answers", []):
        if one["name"].startswith("displacement_"):
            continue
        value = "not found" if one["value"] is None else f"{one['value']:.4g}"
        if one["uncertainty"] is not None:
            value += f" ± {one['uncertainty']:.2g}"
        rows.append((f"{one['stage']}: {one['name'].replace('_', ' ')}", value, one["unit"]))
    for one in quantities.shown(run, brief=True):
        value = one.value if isinstance(one.value, int) else f"{one.value:.4g}"
        rows.append((one.name, str(value), one.unit))
    return [(what, value, unit.removeprefix("-")) for what, value, unit in rows]
