# SPDX-License-Identifier: GPL-2.0-or-later
"""curve.png: what the entry ``figure`` of run.json says, and the energies."""

import os
import re
from typing import Any

import numpy as np

from masonry.arguments import FilePath
from masonry.errors import Refused
from masonry.numbers import drawing, loops
from masonry.numbers.files import readCurve, readRun

LINES = ["black", "tab:orange", "tab:green", "tab:purple", "tab:brown", "tab:cyan"]
Entries = dict[str, Any]


def plan(run: Entries, data: Entries, directory: FilePath) -> Entries:
    """The entry ``figure`` of run.json, with all that may be left out, and the numbers of all its
    rows. Raises Refused if it cannot be drawn.

    :param run: what :func:`masonry.numbers.files.readRun` returns
    :param data: what :func:`masonry.numbers.files.readCurve` returns
    :param directory: folder, for messages
    """
    spec = run.get("figure")
    if spec is None:
        raise Refused(
            f'{directory}: run.json has no entry "figure", which says what to draw: an older'
            " version of the plugin made it"
        )
    spec = {"y_label": "", "looped": False, "marks": [], "bounds": [], **spec}
    for axis in (spec["x"], *spec["y"]):
        if axis["column"] not in data:
            raise Refused(
                f"{directory}: figure: curve.csv has no column {axis['column']}, it has"
                f" {', '.join(data)}"
            )
    if not spec["y"]:
        raise Refused(f'{directory}: figure: "y" must name one column at least')
    count = len(data[spec["x"]["column"]])
    spans = spec.get("rows", [[0, count]])
    if wrong := [row for span in spans for row in span if not 0 <= row <= count]:
        raise Refused(f"{directory}: figure: rows up to {max(wrong)}, and curve.csv has {count}")
    return {**spec, "rows": [n for first, end in spans for n in range(first, end)]}


def energies(data: Entries) -> tuple[Entries, Any]:
    """Energies to draw, since the first row: a dict of name -> values [J], and the work done, or
    None."""
    since = {k[:-2]: v - v[0] for k, v in data.items() if k[-2:] == "_J" and len(v) > 1}
    work = [since.pop(name) for name in ("external", "gravity") if name in since]
    elastic = [since.pop(name) for name in list(since) if name.startswith("elastic_")]
    stack = {"elastic": sum(elastic)} if elastic else {}
    for name in ("dissipated_tension", "dissipated_shear", "dissipated_compression"):
        if name in since:
            stack[name.split("_")[1]] = since.pop(name)
    if "damping" in since:
        stack["damping"] = since.pop("damping")
    kinetic = since.pop("kinetic", None)
    stack.update((name.replace("_", " "), values) for name, values in since.items())
    largest = max((np.abs(v).max() for v in (*stack.values(), *work)), default=0)
    if kinetic is not None and kinetic.max() > 0.02 * largest:
        stack["kinetic"] = kinetic
    return stack, sum(work) if work else None


def curve(directory: FilePath) -> None:
    run, data = readRun(directory), readCurve(directory)
    with drawing.style():
        figure = figureOf(run, data, directory)
        drawing.save(figure, os.path.join(directory, "curve.png"), 110)


def figureOf(run: Entries, data: Entries, directory: FilePath) -> Any:
    """The figure of curve.png, for use in :func:`masonry.numbers.drawing.style`. Raises Refused.

    Loops have axes through zero and their envelope in bold, and their energies are drawn over the
    length of the way. Parameters as in :func:`plan`.
    """
    data = {name: np.array(values) for name, values in data.items()}
    spec = plan(run, data, directory)
    data = {name: values[spec["rows"]] for name, values in data.items()}
    looped, x = spec["looped"], data[spec["x"]["column"]]
    used = {axis["column"] for axis in spec["y"]}
    stack, work = energies({k: v for k, v in data.items() if k not in used})
    if not stack:
        figure = panelOf(spec, data)
        figure.axes[0].set_title(run["title"])
        return figure
    figure = drawing.empty(7, 7)
    top, bottom = figure.subplots(2, 1, sharex=not looped, height_ratios=[3, 2])
    _curves(top, spec, data)
    top.set_title(run["title"])
    label = spec["x"]["label"]
    if looped:
        top.set_xlabel(label)
        x = np.append(0, np.cumsum(np.abs(np.diff(x))))
        label = f"length of the way there and back [{unitOf(spec['x'])}]"
    _energies(bottom, x, label, stack, work)
    figure.tight_layout()
    return figure


def panelOf(spec: Entries, data: Entries, ideal: Any = None) -> Any:
    """A figure of the curve alone.

    :param spec: as :func:`plan` completes it
    :param data: dict of column name -> array, of the rows that are shown
    :param ideal: points of an idealised curve, x and y
    """
    figure = drawing.empty(7, 4.2)
    axes = figure.subplots()
    _curves(axes, spec, data, ideal)
    axes.set_xlabel(spec["x"]["label"])
    figure.tight_layout()
    return figure


def energiesOf(x: Any, label: str, stack: Entries, work: Any) -> Any:
    """A figure of the energies alone, over x; ``stack`` and ``work`` as in :func:`energies`."""
    figure = drawing.empty(7, 3.4)
    _energies(figure.subplots(), x, label, stack, work)
    figure.tight_layout()
    return figure


def _energies(axes, x, label, stack, work):
    for name, values in stack.items():
        axes.plot(x, values, lw=1, label=name)
    if work is not None:
        axes.plot(x, work, color="black", lw=1, ls="--", label="work done")
    drawing.finish(axes, label, "energy since the first row [J]", fontsize=8)


def _curves(axes, spec, data, ideal=None):
    looped, x = spec["looped"], data[spec["x"]["column"]]
    first = data[spec["y"][0]["column"]]
    for n, axis in enumerate(spec["y"]):
        wide = (0.7, 0.4) if looped else (1.2, 0.6)
        look = dict(color=LINES[n % len(LINES)], lw=wide[n > 0], zorder=1 if n else 2)
        look["marker"] = "o" if len(x) == 1 else None  # one row is no line
        axes.plot(x, data[axis["column"]], **look, label=axis["label"])
    if ideal:
        axes.plot(*ideal, color="tab:blue", lw=1.6, ls=(0, (5, 3)), label="bilinear")
    if looped:
        for rows, label in zip(loops.envelope(x), ("envelope", None)):
            axes.plot(x[rows], first[rows], color="tab:blue", lw=1.8, label=label)
        axes.axvline(0, color="0.3", lw=0.8, zorder=0)
        axes.margins(y=0.12)
    else:
        axes.set_ylim(*limits(spec, data))
    low, high = axes.get_ylim()
    if low < 0 < high:
        axes.axhline(0, color="0.3", lw=0.8, zorder=0)
    for mark in spec["marks"]:
        at, value = mark["x"], mark["y"]
        left = (at > 0) if looped else at > 0.7 * x.max() + 0.3 * x.min()
        axes.plot(at, value, "o", color="tab:red", ms=5)
        away = (-6 if left and not looped else 6, 8) if value >= 0 else (-6, -14)
        place = dict(textcoords="offset points", ha="right" if left else "left")
        away = (6, -14) if mark.get("below") else away
        axes.annotate(mark["text"], (at, value), xytext=away, **place)
    for bound in spec["bounds"]:
        axes.axhline(bound["y"], color="0.35", lw=0.9, ls=(0, (6, 3)), zorder=0)
        place = dict(xycoords=("axes fraction", "data"), textcoords="offset points")
        text = bound["text"], (0.01, bound["y"]), (0, 3)
        axes.annotate(*text, **place, fontsize=8, color="0.25")
    axes.set_ylabel(spec["y_label"])
    if weight := spec.get("weight_kN"):
        ratio = axes.secondary_yaxis(
            "right", functions=(lambda v: v / weight, lambda v: v * weight)
        )
        ratio.set_ylabel("force over weight [-]")
    if len(spec["y"]) > 1 or looped or ideal:
        axes.legend(loc="lower right")
    axes.grid(alpha=0.3)


def limits(spec: Entries, data: Entries) -> tuple[float, float]:
    """Range of the upper panel, which has all of the first curve, and of the others all but single
    swings."""
    columns = [data[axis["column"]] for axis in spec["y"]]
    marks = [thing["y"] for key in ("marks", "bounds") for thing in spec[key]]
    low = min([np.nanmin(columns[0]), *(np.nanquantile(c, 0.01) for c in columns), *marks])
    high = max([np.nanmax(columns[0]), *(np.nanquantile(c, 0.99) for c in columns), *marks])
    reach = max(high, 0) - min(low, 0) or 1.0
    if low >= -0.02 * reach:
        return 0, 1.15 * reach
    if high <= 0.02 * reach:
        return -1.15 * reach, 0
    return low - 0.15 * reach, high + 0.15 * reach


def unitOf(axis: Entries) -> str:
    """Unit of an axis: in the brackets of its label, else at the end of the name of its column."""
    found = re.search(r"\[([^\]]*)\]\s*$", axis["label"])
    return found[1] if found else axis["column"].rsplit("_", 1)[-1]


def bare(text: Any) -> str:
    """What an axis or column is, without its unit in brackets at the end."""
    return re.sub(r" *\[[^\[\]]+\]$", "", str(text))
