# SPDX-License-Identifier: GPL-2.0-or-later
"""Pieces of a report: numbers with their units, tables of them, sections and notes. This module needs no YADE."""

from __future__ import annotations

import math
from typing import Any, Iterable, Sequence

from ..escaping import Html, escaped, joined, tag
from ..quantities import Number

UNKNOWN = "not known"
DIGITS = 4
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def isNumber(value: Any) -> bool:
    """Whether a value is a finite number."""
    return (
        isinstance(value, (int, float))
        and not isinstance(value, bool)
        and math.isfinite(value)
    )


def written(value: Any, digits: int = DIGITS) -> str:
    """A number as a person writes it, with so many significant digits; what is no finite number is "not known"."""
    if not isNumber(value):
        return UNKNOWN
    if isinstance(value, int) and abs(value) < 1e15:
        return f"{value:,}".replace("-", "−")
    rounded = float(f"{value:.{digits}g}")
    if rounded == 0:
        return "0"
    power = math.floor(math.log10(abs(rounded)))
    if -4 <= power < 7:
        text = f"{rounded:,.{max(digits - 1 - power, 0)}f}"
        if "." in text and abs(rounded - value) <= 1e-9 * abs(value):  # it was round
            text = text.rstrip("0").rstrip(".")
        return text.replace("-", "−")
    text = f"{rounded / 10.0**power:.{digits - 1}f}".rstrip("0").rstrip(".")
    return f"{text}\u202f·\u202f10{str(power).translate(_RAISED)}".replace("-", "−")


def withUnit(value: Any, unit: str, digits: int = DIGITS) -> str:
    """A number with its unit; a text as it is."""
    if isinstance(value, str):
        return value
    text = written(value, digits)
    return text if unit == "-" or text == UNKNOWN else f"{text}\u00a0{unit}"


def share(value: Any, digits: int = 2) -> str:
    """A share as a percentage."""
    return withUnit(100 * value if isNumber(value) else None, "%", digits)


def numbers(rows: Iterable[Number], caption: str) -> Html:
    """A table of numbers: what, value, definition and source."""
    lines = []
    for row in rows:
        value = withUnit(row.value, row.unit)
        if value == UNKNOWN and row.note:
            value = "none"
        note = tag("span", " " + row.note, class_="note") if row.note else None
        lines.append(
            tag("tr", tag("th", row.name, scope="row"), tag("td", value, class_="value"),
                tag("td", row.meaning, note), tag("td", row.source, class_="source"))
        )  # fmt: skip
    head = ("quantity", "value", "what it is", "source")
    return table(head, lines, caption, "numbers")


def table(
    heads: Sequence[Any], lines: Iterable[Any], caption: str, kind: str | None = None
) -> Html:
    """A table with a caption; lines are elements ``tr``, or sequences of cells, the first of which is the head of its line."""
    rows = [line if isinstance(line, Html) else row(line) for line in lines]
    head = tag("tr", *(tag("th", h, scope="col") for h in heads))
    inside = joined(tag("caption", caption), tag("thead", head), tag("tbody", *rows))
    return tag("div", tag("table", inside, class_=kind), class_="wide")


def row(cells: Sequence[Any]) -> Html:
    """A line of a table, from texts and HTML."""
    first, *others = cells
    return tag("tr", tag("th", first, scope="row"), *(tag("td", cell) for cell in others))  # fmt: skip


def note(*inside: Any, kind: str = "note") -> Html:
    """A paragraph; ``kind`` is ``note``, ``warning``, or ``missing`` for what a report would have and the run has not."""
    return tag("p", *inside, class_=kind)


def figure(picture: Html, caption: Any, kind: str | None = None) -> Html:
    """A picture with its caption."""
    return tag("figure", picture, tag("figcaption", caption), class_=kind)


def folded(
    title: str, *inside: Any, kind: str | None = None, opened: bool = False
) -> Html:
    """What is seen after a click on its title, and on paper; of the kind ``screen`` not on paper. ``opened``: it is seen at once,
    and a click hides it."""
    return tag("details", tag("summary", title), *inside, class_=kind, open="" if opened else None)  # fmt: skip


def listed(texts: Iterable[Any], kind: str | None = None) -> Html:
    """A list with bullets."""
    return tag("ul", *(tag("li", text) for text in texts), class_=kind)


__all__ = ["Html", "Number", "UNKNOWN", "escaped", "figure", "folded", "isNumber", "joined", "listed", "note", "numbers", "row", "share", "table", "tag", "withUnit", "written"]  # fmt: skip
