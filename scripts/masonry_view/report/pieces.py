# SPDX-License-Identifier: GPL-2.0-or-later
"""Pieces of a report, which its template turns into HTML, and numbers as people write them."""

import math
from typing import Any, NamedTuple

from masonry import arguments

UNKNOWN = "not known"
DIGITS = 4
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def isNumber(value):
    return arguments.isNumber(value) and math.isfinite(value)


def written(value, digits=DIGITS):
    """A number in so many significant digits; what is no finite number is "not known"."""
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


def withUnit(value, unit, digits=DIGITS):
    """A number with its unit; a text as it is."""
    if isinstance(value, str):
        return value
    text = written(value, digits)
    return text if unit == "-" or text == UNKNOWN else f"{text}\u00a0{unit}"


class Badged(NamedTuple):
    """A text in a table with a word beside it in a frame, as "assumed"."""

    text: Any
    badge: str


class Piece(NamedTuple):
    """What stands in a part of a report: a macro of ``report.html`` and its arguments, of which the
    macro says what they are."""

    form: str
    given: tuple[Any, ...]
    named: dict[str, Any]


def _form(name):
    return lambda *given, **named: Piece(name, given, named)


facts, figure, listed, note, table, turning = map(
    _form, ("facts", "figure", "listed", "note", "table", "turning")
)


def folded(title, *inside, **named):
    return Piece("folded", (title, inside), named)


def missing(text):
    """A sentence in place of what a report would have and the run has not."""
    return note(text, "missing")


def numbers(rows, caption):
    """A table of numbers: what, value, definition and source."""
    lines = []
    for row in rows:
        value = withUnit(row.value, row.unit)
        if value == UNKNOWN and row.note:
            value = "none"
        lines.append((row.name, value, f"{row.meaning} {row.note}".strip(), row.source))
    return table(("quantity", "value", "what it is", "source"), lines, caption, "numbers")
