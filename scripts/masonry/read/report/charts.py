# SPDX-License-Identifier: GPL-2.0-or-later
"""Charts of a report as SVG, which is sharp on paper and takes its colours from the page. This module needs no YADE."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Sequence

import numpy as np

from ..escaping import Html, joined, tag
from .pieces import written

WIDE, HIGH = 760, 400  # of a chart, in its own units
BEFORE, BEHIND, ABOVE, BELOW = 68, 18, 14, 50  # of the frame around the curves
NEAR = 0.35  # points of a line that lie so near to the one before are left out
MOST_TICKS = 8


@dataclass
class Line:
    """A line of a chart. ``kind`` is its class in the style: ``line0`` to ``line7``, ``thin0``, ``ideal``, ``envelope``."""

    x: Any
    y: Any
    label: str = ""
    kind: str = "line0"


@dataclass
class Chart:
    """A chart.

    :param title: and ``about``: what it shows, for those who do not see it
    :param marks: points with a text: x, y, text, and whether it stands below
    :param levels: horizontal lines with a text: y, text
    :param frames: places (x, y) of the frames of the 3-D picture; the place of the frame that is shown is marked
    """

    title: str
    about: str
    xLabel: str
    yLabel: str
    lines: list[Line]
    marks: list[tuple[float, float, str, bool]] = field(default_factory=list)
    levels: list[tuple[float, str]] = field(default_factory=list)
    low: float | None = None  # of y
    high: float | None = None
    frames: list[tuple[float, float]] = field(default_factory=list)
    zero: bool = False  # whether there is an axis through x = 0


def ticks(low: float, high: float) -> list[float]:
    """Round numbers between two others."""
    raw = (high - low) / (MOST_TICKS - 1)
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(s * power for s in (1, 2, 2.5, 5, 10) if s * power >= raw * (1 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [n * step for n in range(first, math.floor(high / step + 1e-9) + 1)]


def reach(values: Sequence[Any]) -> tuple[float, float]:
    """The smallest and the largest finite number of some arrays, never the same."""
    flat = [np.ravel(np.asarray(v, float)) for v in values]
    whole = np.concatenate([np.zeros(0), *flat])
    whole = whole[np.isfinite(whole)]
    if not len(whole):
        return 0.0, 1.0
    low, high = float(whole.min()), float(whole.max())
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        off = 0.5 * abs(low) or 1.0
        return low - off, high + off
    return low, high


def svg(chart: Chart) -> Html:
    """A chart as an element ``svg`` with a legend above it."""
    lowX, highX = reach([line.x for line in chart.lines])
    if chart.low is None or chart.high is None:
        low, high = reach([line.y for line in chart.lines] + [[y for y, _ in chart.levels]])  # fmt: skip
        low, high = min(low, 0.0), max(high, 0.0)
        low, high = low - 0.06 * (high - low) * (low < 0), high + 0.08 * (high - low)
    else:
        low, high = chart.low, chart.high
    wide, tall = WIDE - BEFORE - BEHIND, HIGH - ABOVE - BELOW
    across = lambda x: BEFORE + wide * (np.asarray(x, float) - lowX) / (highX - lowX)
    up = lambda y: ABOVE + tall * (high - np.asarray(y, float)) / (high - low)
    parts = [tag("title", chart.title), tag("desc", chart.about)]
    for x in ticks(lowX, highX):
        parts.append(tag("path", d=f"M{_n(across(x))} {ABOVE}v{tall}", class_="grid"))
        parts.append(_text(across(x), HIGH - BELOW + 18, _tick(x, highX - lowX), "middle"))  # fmt: skip
    for y in ticks(low, high):
        parts.append(tag("path", d=f"M{BEFORE} {_n(up(y))}h{wide}", class_="grid"))
        parts.append(_text(BEFORE - 8, up(y) + 4, _tick(y, high - low), "end"))
    if low < 0 < high:
        parts.append(tag("path", d=f"M{BEFORE} {_n(up(0))}h{wide}", class_="axis"))
    if chart.zero and lowX < 0 < highX:
        parts.append(tag("path", d=f"M{_n(across(0))} {ABOVE}v{tall}", class_="axis"))
    inside = [
        tag("path", d=f"M{BEFORE} {_n(up(y))}h{wide}", class_="level")
        for y, _ in chart.levels
    ] + [
        tag("path", d=path(across(line.x), up(line.y)), class_=line.kind)
        for line in sorted(chart.lines, key=_depth)
    ]
    # an svg in an svg is cut at its frame
    parts.append(tag("svg", *inside, x=BEFORE, y=ABOVE, width=wide, height=tall, viewBox=f"{BEFORE} {ABOVE} {wide} {tall}"))  # fmt: skip
    for y, text in chart.levels:
        parts.append(_text(BEFORE + 6, up(y) - 6, text, "start", "small"))
    for x, y, text, below in chart.marks:
        right = across(x) > BEFORE + 0.62 * wide
        parts.append(tag("circle", cx=_n(across(x)), cy=_n(up(y)), r=4, class_="mark"))
        at = (across(x) + (-7 if right else 7), up(y) + (18 if below else -9))
        parts.append(_text(*at, text, "end" if right else "start", "said"))
    if chart.frames:
        parts.append(tag("circle", cx=-99, cy=-99, r=6, class_="now"))
    parts.append(
        tag("rect", x=BEFORE, y=ABOVE, width=wide, height=tall, class_="frame")
    )
    parts.append(_text(BEFORE + wide / 2, HIGH - 10, chart.xLabel, "middle", "label"))
    turned = f"rotate(-90 16 {ABOVE + tall / 2:g})"
    parts.append(tag("text", chart.yLabel, x=16, y=f"{ABOVE + tall / 2:g}", transform=turned, text_anchor="middle", class_="label"))  # fmt: skip
    places = " ".join(f"{_n(across(x))},{_n(up(y))}" for x, y in chart.frames) or None
    drawn = tag("svg", *parts, viewBox=f"0 0 {WIDE} {HIGH}", role="img", aria_label=f"{chart.title}. {chart.about}", class_="chart", data_frames=places)  # fmt: skip
    named = [line for line in chart.lines if line.label]
    if len(named) < 2:
        return drawn
    key = [tag("span", _swatch(line.kind), line.label) for line in named]
    return joined(tag("div", *key, class_="legend"), drawn)


def _depth(line):
    """Lines of a lower class are drawn over others."""
    order = {"ideal": 2, "envelope": 1}
    return order[line.kind] if line.kind in order else -int(line.kind[-1])


def _swatch(kind):
    return tag("svg", tag("path", d="M1 6h24", class_=kind), viewBox="0 0 26 12", class_="swatch", aria_hidden="true")  # fmt: skip


def _text(x, y, text, anchor, kind="tick"):
    return tag("text", text, x=_n(x), y=_n(y), text_anchor=anchor, class_=kind)


def _tick(value, span):
    return "0" if abs(value) < 1e-9 * span else written(round(value, 12), 5)


def _n(value):
    """A coordinate in tenths."""
    return f"{float(value):.1f}".removesuffix(".0")


def path(x: Any, y: Any) -> str:
    """A line through points as the attribute ``d``; it is interrupted where a number is not finite, and points that nearly lie on
    the one before are left out."""
    found, last, pen = [], (math.inf, math.inf), "M"
    for a, b in zip(np.asarray(x, float).tolist(), np.asarray(y, float).tolist()):
        if not (math.isfinite(a) and math.isfinite(b)):
            pen = "M"
            continue
        if pen == "L" and abs(a - last[0]) < NEAR and abs(b - last[1]) < NEAR:
            continue
        # what lies far outside of the frame is cut there
        found.append(f"{pen}{_n(a)} {_n(min(max(b, -HIGH), 2 * HIGH))}")
        last, pen = (a, b), "L"
    return "".join(found)
