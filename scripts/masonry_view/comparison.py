# SPDX-License-Identifier: GPL-2.0-or-later
"""Curves of several runs and of measured CSV files over each other, in one picture."""

import argparse
import csv
import os
from typing import Any, Sequence

import numpy as np

from masonry.arguments import FilePath
from masonry.errors import Refused
from masonry.terminal import say
from masonry.numbers import curves, drawing, quantities
from masonry.numbers.files import program, readCurve, readRun
from masonry.numbers.run_data import BASE, MASONRY, MOVED, RunData
from masonry.texts import TextFile

#: Colours that differ in print, also for those who do not tell red from green (Okabe and Ito,
#: 2008), and dashes.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#555555"]
DASHES = ["-", (0, (6, 2)), (0, (4, 1.5, 1, 1.5)), (0, (1.2, 1.2))]
#: Columns of shear forces, and those of the base that the check of a test reads.
SHEARS = "base_shear_kN", "top_shear_kN", "base_V_x_kN"
N, V, M = "base_N_kN", "base_V_x_kN", "base_M_y_kNm"

#: Columns that are made of those of a run, with their labels.
RATIOS = {
    "drift_percent": "drift [%]",
    "displacement_over_height": "displacement over height [-]",
    "force_over_weight": "force over weight [-]",
}


def ratio(name: str, data: RunData, directory: FilePath) -> np.ndarray:
    """A column of ``RATIOS``: the displacement of the masonry at what is pushed over its height
    (``drift_height_m``, else ``recorded_height_m``), or the base shear over the vertical force at
    the base when the push begins. Raises Refused."""
    if name == "force_over_weight":
        force, normal = data.column(BASE), data.column(N)
        weight = -normal[data.rows[0] if data.isPush else 0] if normal is not None else 0.0
        if force is None or not weight > 0:
            raise Refused(f"{directory}: {name} needs {BASE} and a compression {N}")
        return np.array(force) / weight
    moved = next((v for v in map(data.column, (MASONRY, MOVED)) if v is not None), None)
    if moved is None or not data.height:
        raise Refused(f"{directory}: {name} needs {MOVED} and a drift_height_m in run.json")
    return np.array(moved) / data.height * (0.1 if name == "drift_percent" else 1e-3)


def readMeasured(text: str) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """A measured curve of ``FILE:X:Y``: its two columns as arrays, and their names.

    Columns, comments and decimal commas are as in :mod:`masonry.texts`; one of the lines before
    the numbers has the names of the columns. X and Y are such names, or numbers from 1. Rows with
    an empty cell or NaN are left out.

    :raises Refused: if the text, the file or a column is not as it must be
    """
    parts = text.rsplit(":", 2)
    if len(parts) != 3 or not all(parts):
        raise Refused(
            f"--csv: '{text}' must be FILE:X:Y, with the names of two columns, or their numbers"
            " from 1"
        )
    path, *wanted = parts
    file = TextFile(path)
    table = file.table()
    if not table.rows:
        raise Refused(f"{path}: there is no row of numbers")
    width = len(table.rows[0].cells)
    heads = [row.cells for row in table.heads if len(row.cells) == width]
    names = next((h for h in heads if set(wanted) & set(h)), heads[-1] if heads else [])
    numbered = {str(n + 1): n for n in range(width)}
    for name in wanted:
        if name not in names and name not in numbered:
            raise Refused(
                f"{path}: there is no column {name}, there are {', '.join(names or numbered)}"
            )
    places = [names.index(n) if n in names else numbered[n] for n in wanted]
    rows = []
    for row in table.rows:
        cells = [row.cells[p] if p < len(row.cells) else "" for p in places]
        if all(cell and cell.lower() != "nan" for cell in cells):
            rows.append([file.number(cell, row.line) for cell in cells])
    if len(rows) < 2:
        raise Refused(f"{path}: fewer than two rows have both columns")
    x, y = np.array(rows).T
    return x, y, [names[p] if names else str(p + 1) for p in places]


def readRuns(
    directories: Sequence[FilePath], x: str | None = None, y: str | None = None
) -> tuple[list[Any], list[str] | None]:
    """Curves of runs: a list of (x, y) arrays, and the labels of both axes. Raises Refused if a
    column is not there, or if none is named.

    :param directories: folders of runs
    :param x: column of curve.csv, or one of ``RATIOS``; None: that of the entry ``figure`` in
        run.json of the first run
    :param y: as ``x``; None: the first one of this entry
    """
    pairs, labels = [], None
    for directory in directories:
        data, spec = readCurve(directory), readRun(directory).get("figure")
        if not spec and not (x and y):
            raise Refused(
                f'{directory}: run.json has no entry "figure": name the columns by --x and --y'
            )
        if labels is None:
            x, y = x or spec["x"]["column"], y or spec["y"][0]["column"]
            labels = [_label(name, spec) for name in (x, y)]
        for name in (x, y):
            if name in RATIOS and name not in data:
                data[name] = [*ratio(name, RunData(readRun(directory), data.get), directory)]
            if name not in data:
                raise Refused(
                    f"{directory}: curve.csv has no column {name}, it has {', '.join(data)}"
                )
        pairs.append((np.array(data[x]), np.array(data[y])))
    return pairs, labels


def _label(column, spec):
    """Label of an axis: that of curve.png if it has the column, else what the column is called."""
    if column in RATIOS:
        return RATIOS[column]
    if spec and spec["x"]["column"] == column:
        return spec["x"]["label"]
    if spec and spec["y"][0]["column"] == column and spec.get("y_label"):
        return spec["y_label"]
    words, _, unit = column.replace("_", " ").rpartition(" ")
    return f"{words} [{unit}]" if words else column


def compare(
    directories: Sequence[FilePath],
    measured: Sequence[str] = (),
    x: str | None = None,
    y: str | None = None,
    labels: Sequence[str] = (),
    out: FilePath = "plot.png",
    title: str = "",
) -> FilePath:
    """Draw curves over each other, measured ones black and behind, runs in colours. Returns the
    path. Raises Refused if something cannot be read or drawn.

    :param directories: folders of runs
    :param measured: texts ``FILE:X:Y``, as in :func:`readMeasured`
    :param x: column of curve.csv, as ``y``; None: as curve.png has it
    :param labels: names for the legend, of all runs and then of all measured curves; what is
        missing is named after its folder or file
    :param out: path of the picture, .png, .pdf or .svg
    """
    if os.path.splitext(out)[1].lower() not in (".png", ".pdf", ".svg"):
        raise Refused(f"--out: {out} must end in .png, .pdf or .svg")
    count = len(directories) + len(measured)
    if not count:
        raise Refused("name one folder of results at least, or one --csv")
    if len(labels) > count:
        raise Refused(f"--label: {len(labels)} labels for {count} curves")
    names = [*labels, *_names(directories, measured)[len(labels) :]]
    runs, axesLabels = readRuns(directories, x, y)
    tests = [readMeasured(text) for text in measured]
    if axesLabels is None:
        axesLabels = tests[0][2]
    for text, (_, forces, _) in zip(measured, tests):
        for directory in directories:
            _warnOfRocking(directory, text, float(np.abs(forces).max()), y)
    try:
        _draw(out, tests, runs, names, axesLabels, title)
    except OSError as error:
        raise Refused(f"cannot write {out}: {error.strerror}") from None
    return out


def differences(directories: Sequence[FilePath]) -> list[list[Any]]:
    """The numbers of runs beside each other, as of a structure before and after it is strengthened:
    rows of a name, a unit, the value of each run, and the change of each but the first over the
    first [%]; None where a run has none. They are those of the terminal, and the answers of
    stages.

    :param directories: folders of runs
    """
    groups, runs = [name for name in quantities.GROUPS if name != "cost"], []
    for directory in directories:
        data = RunData.read(directory)
        shown = quantities.shown(quantities.known(data), *groups, brief=True)
        found = {(one.name, one.unit): one.value for one in shown}
        for one in data.run.get("answers") or []:
            name = f"{one['stage']}: {one['name'].replace('_', ' ')}"
            found[name, one["unit"]] = one["value"]
        runs.append(found)
    rows: list[list[Any]] = []
    for key in dict.fromkeys(key for found in runs for key in found):
        first, *others = values = [found.get(key) for found in runs]
        changes = [100 * (v / first - 1) if first and v is not None else None for v in others]
        rows.append([*key, *values, *changes])
    return rows


def writeTable(path: FilePath, directories: Sequence[FilePath], names: Sequence[str]) -> None:
    """Print :func:`differences` and write them as CSV. Raises Refused."""
    heads = ["number", "unit", *names, *(f"{name} change %" for name in names[1:])]
    rows = differences(directories)
    text = lambda value: "" if value is None else f"{value:.4g}"
    lines = [[*row[:2], *map(text, row[2:])] for row in rows]
    widths = [max(map(len, column)) for column in zip(heads, *lines)]
    for name, *cells in [heads, *lines]:
        say("  ".join([name.ljust(widths[0]), *map(str.rjust, cells, widths[1:])]))
    try:
        with open(path, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([heads, *lines])
    except OSError as error:
        raise Refused(f"cannot write {path}: {error.strerror}") from None


def _warnOfRocking(directory, text, peak, y=None):
    """Warn if a test carried more than blocks without tension can under the vertical load of a
    run of a wall: N L/(2 H0), with N and H0 = M/V of the base where the run has its peak.

    :param text: name of the test
    :param peak: measured [kN]
    :param y: column of the curve of the run; None: that of its figure
    """
    run, data = readRun(directory), readCurve(directory)
    wall, spec = run.get("wall"), run.get("figure")
    shown = y or spec["y"][0]["column"]
    if not wall or shown not in SHEARS or not {N, V, M} <= set(data) or not any(data[V]):
        return
    at = int(np.abs(data[V]).argmax())
    normal, arm = abs(data[N][at]), abs(data[M][at] / data[V][at])
    most = curves.rocking(normal, wall["length_m"], arm)
    if peak > (1 + curves.TOLERANCE) * most:
        say(
            f"warning: {text} reaches {peak:.4g} kN, more than the vertical load of {directory}"
            f" can give: blocks without tension carry at most N L/(2 H0) = {most:.4g} kN with N ="
            f" {normal:.4g} kN, L = {wall['length_m']:.4g} m and H0 = {arm:.4g} m. Bond carried"
            " the rest, or the vertical load or the support of the test is another one"
        )


def _draw(out, tests, runs, names, labels, title):
    with drawing.picture(out, 7, 4.6, 150) as figure:
        axes = figure.subplots()
        for n, (a, b, _) in enumerate(tests):
            look = dict(color="0.15", lw=1.0, ls=DASHES[n % len(DASHES)], zorder=1.5)
            axes.plot(a, b, **look, label=names[len(runs) + n])
        for n, (a, b) in enumerate(runs):
            colour, dash = COLOURS[n % len(COLOURS)], DASHES[n // len(COLOURS) % len(DASHES)]
            axes.plot(a, b, color=colour, lw=1.3, ls=dash, label=names[n], zorder=2)
        for low, high, line in ((*axes.get_xlim(), axes.axvline), (*axes.get_ylim(), axes.axhline)):
            if low < -0.05 * high < 0:  # both sides are more than a margin
                line(0, color="0.4", lw=0.8, zorder=0)
        axes.set_title(title)
        drawing.finish(axes, *labels, fontsize=9, framealpha=0.9)


def _names(directories, measured):
    """Names of runs and measured curves: as much of the ends of their paths as tells them apart,
    and for measured curves of one file their second column."""
    files = [text.rsplit(":", 2) for text in measured]
    paths = [*directories, *(f[0] for f in files)]
    parts = [os.path.abspath(path).split(os.sep) for path in paths]
    names = []
    for own in parts:
        depth = 1
        while any(own[-depth:] == p[-depth:] for p in parts if p != own):
            depth += 1
        names.append("/".join(own[-depth:]))
    for n, f in enumerate(files, len(directories)):
        if paths.count(f[0]) > 1:
            names[n] += ", " + f[-1]
    return names


@program
def main(words: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description="Draw curves of runs and of measured CSV files over each other."
    )
    parser.add_argument("result", nargs="*", help="folder of results")
    parser.add_argument(
        "--csv",
        action="append",
        default=[],
        metavar="FILE:X:Y",
        help="a measured curve: a file and the names of its two columns, or their numbers from 1;"
        " may be repeated",
    )
    ratios = f"column of curve.csv, or {', '.join(RATIOS)}"
    parser.add_argument("--x", metavar="COLUMN", help=f"{ratios}; else that of curve.png")
    parser.add_argument("--y", metavar="COLUMN", help="as --x; else the first one of curve.png")
    parser.add_argument(
        "--label",
        action="append",
        default=[],
        help="name of a curve, in the order of the folders and then of the CSV files; may be"
        " repeated",
    )
    parser.add_argument("--title", default="", help="of the picture")
    parser.add_argument(
        "--table",
        metavar="FILE",
        help="also print the numbers of all folders, with their changes over the first one, and"
        " write them to this CSV file",
    )
    parser.add_argument(
        "--out", default="plot.png", help=".png, .pdf or .svg file (default plot.png)"
    )
    args = parser.parse_args(words)
    say(compare(args.result, args.csv, args.x, args.y, args.label, args.out, args.title))
    if args.table:
        if len(args.result) < 2:
            raise Refused("--table: name two folders of results at least")
        names = [*args.label, *_names(args.result, [])[len(args.label) :]][: len(args.result)]
        writeTable(args.table, args.result, names)
