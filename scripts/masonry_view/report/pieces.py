# SPDX-License-Identifier: GPL-2.0-or-later
"""Pieces of a report, which its template turns into HTML, and numbers as a person writes them."""

import math
from typing import Any, NamedTuple

from masonry import arguments

UNKNOWN = "not known"
DIGITS = 4
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def isNumber(value):
    """Whether a value is a finite number."""
    return arguments.isNumber(value) and math.isfinite(value)


def written(value, digits=DIGITS):
    """A number as a person writes it, with so many significant digits; what is no finite number is
    "not known"."""
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
    """What stands in a part of a report: ``form`` names a macro of ``report.html``, and ``about``
    are its arguments."""

    form: str
    about: dict[str, Any]


def numbers(rows, caption):
    """A table of numbers: what, value, definition and source."""
    lines = []
    for row in rows:
        value = withUnit(row.value, row.unit)
        if value == UNKNOWN and row.note:
            value = "none"
        lines.append((row.name, value, f"{row.meaning} {row.note}".strip(), row.source))
    head = ("quantity", "value", "what it is", "source")
    return table(head, lines, caption, "numbers")


def table(heads, lines, caption, kind=""):
    """A table with a caption; lines are sequences of cells, texts or :class:`Badged`, the first of
    which is the head of its line."""
    return Piece(
        "table",
        {"heads": heads, "lines": list(map(tuple, lines)), "caption": caption, "kind": kind},
    )


def note(text, kind="note", strong=""):
    """A paragraph; ``kind`` is ``note``, ``lead``, ``warning`` or ``missing``.

    :param strong: what stands before the text in bold
    """
    return Piece("note", {"text": text, "kind": kind, "strong": strong})


def missing(text):
    """A sentence in place of what a report would have and the run has not."""
    return note(text, "missing")


def figure(picture, caption, alt="", frames=""):
    """A picture, SVG or the name of a figure of the folder, with its caption. If there is no such
    figure, the page has neither.

    :param alt: what it shows, for those who do not see it
    :param frames: places of the frames of the 3-D picture on it, "x,y x,y"
    """
    return Piece(
        "figure", {"picture": picture, "caption": caption, "alt": alt or caption, "frames": frames}
    )


def folded(title, *inside, kind="", opened=False):
    """What is seen after a click on its title, and on paper; of the kind ``screen`` not on paper.
    ``opened``: it is seen at once, and a click hides it."""
    return Piece("folded", {"title": title, "inside": inside, "kind": kind, "opened": opened})


def listed(texts, title="", kind=""):
    """A list with bullets below a title; of the kind ``script`` code without bullets, and
    ``warning``."""
    return Piece("listed", {"texts": list(texts), "title": title, "kind": kind})
