# SPDX-License-Identifier: GPL-2.0-or-later
"""The report of a run: one file, report.html, that any browser opens without a server or a network. No YADE is needed.

    /usr/bin/python3 -m masonry.read.report results/wall_comp4               # writes report.html there
    /usr/bin/python3 -m masonry.read.report results/wall_comp4 -o wall.html

A run writes it at its end, but with ``--lean`` and when it is interrupted. From a script::

    from masonry.read import report

    report.write(report.read("results/wall_comp4"), "wall.html")

What stands in it comes from curve.csv, run.json, the frames for ParaView, cracks.png and mechanism.png of the folder; every number
has its unit, what it is, and its source. What the files do not have is said to be missing, with the reason. The turning picture is
that of :mod:`masonry.read.page`, and needs the Debian package libjs-three; without it the report has a sentence in its place.
"""

from __future__ import annotations

import os
from typing import Any, Callable, Iterable

from ...arguments import FilePath
from ...basics import Refused
from ...folders import replaced
from ..escaping import escaped, joined, tag
from ..page import POLICY, asScript, assets
from . import response, structure, trust
from .pieces import note
from .record import Record

NAME = "report.html"  # in the folder of a run

#: The parts of a report in their order: the name of the place, the heading, and a function of the record.
PARTS: tuple[tuple[str, str, Callable[[Record], Iterable[Any]]], ...] = (
    ("built", "What was built", structure.built),
    ("loaded", "How it was held and loaded", structure.loaded),
    ("curve", "The curve", response.curve),
    ("found", "Drifts and other numbers", response.found),
    ("bound", "The bound by limit analysis", response.bound),
    ("energy", "Where the work went", response.energy),
    ("cycles", "Equivalent damping of cycles", response.cycles),
    ("base", "Forces at the base", response.base),
    ("picture", "The structure in 3-D", trust.pictures),
    ("trust", "How far to trust it", trust.trust),
)


def read(directory: FilePath) -> Record:
    """Read the files of a run.

    :param directory: folder of results
    :raises Refused: if it has no run.json
    """
    return Record(directory)


def page(record: Record) -> str:
    """The report of a run as a whole page.

    :param record: what :func:`read` gave
    """
    library = _library(record)
    parts = []
    for place, heading, part in PARTS:
        named = f"{place}-heading"
        inside = tag("h2", heading, id=named), *_made(part, record)
        parts.append(tag("section", *inside, id=place, aria_labelledby=named))
    links = [tag("a", heading, href=f"#{place}") for place, heading, _ in PARTS]
    title = escaped(record.title)
    # the script of the report comes first: the picture tells it which frame is shown
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        '<link rel="icon" href="data:,">\n'
        f"<title>{title}: report</title>\n<style>{_own('report.css')}</style>\n"
        f"<script>{asScript(_own('report.js'))}</script>\n{library}</head>\n"
        f'<body class="masonry-report">\n<header>{joined(*_made(structure.head, record))}</header>\n'
        f"{tag('nav', *links, aria_label='parts of the report')}\n"
        f"<main>\n{joined(*parts)}</main>\n</body>\n</html>\n"
    )


def _own(name):
    with open(os.path.join(os.path.dirname(__file__), name), encoding="utf-8") as file:
        return file.read()


def _library(record):
    """What the 3-D picture needs in the page. Where it is missing, the record has no picture, and says why."""
    if not record.picture:
        return ""
    try:
        return assets()
    except Refused as missing:
        record.picture, record.missing = None, (
            "three.js is not installed, which draws it. The Debian package is libjs-three; then python3 -m masonry.read.report "
            f"writes the report again. {missing}"
        )
        return ""


def _made(part, record):
    """The pieces of a part; a sentence if the files do not have what it needs."""
    found = []
    try:
        for piece in part(record):
            found.append(escaped(piece))
    except (LookupError, AttributeError, TypeError, ValueError, ArithmeticError) as problem:  # fmt: skip
        found.append(
            note(f"This part is not whole, because run.json is damaged or of another version ({type(problem).__name__}: {problem}).", kind="missing")
        )  # fmt: skip
    return found


def write(record: Record, path: FilePath) -> None:
    """Write :func:`page` to a file, whole or not at all.

    :param record: what :func:`read` gave
    :raises OSError: if the file cannot be written, or if its name is that of a symbolic link
    """
    text = page(record)
    with replaced(path, encoding="utf-8") as file:
        file.write(text)
