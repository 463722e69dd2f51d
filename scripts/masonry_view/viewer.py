# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in 3-D in any browser: the program ``scripts/view.py``. No YADE is needed."""

import argparse
import re
from typing import Sequence

import numpy as np

from masonry.arguments import FilePath
from masonry.errors import Refused
from . import page, pages
from masonry.numbers.files import filesOf, program, readCurve, readRun
from masonry.numbers.frames import frameAt, frameTimes
from .curve_figure import unitOf


def frameNear(directory: FilePath, at: str) -> int:
    """Number of the frame next to a place in a run, from 0.

    :param at: text: a number with ``s``, a time, or a number with or without the unit of x of
        curve.png
    :raises Refused: if the text is no such place, or if the run never comes there
    """
    times = frameTimes(directory)
    found = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^\d\s]*)\s*", at)
    if not found:
        raise Refused(f"--at: '{at}' must be a number, with mm or s behind it")
    value, unit = float(found[1]), found[2]
    if unit != "s":
        axis = readRun(directory).get("figure", {}).get("x")
        if axis is None:
            raise Refused(f"{directory}: its x is not known; give --at a time as 0.5s")
        data = readCurve(directory)
        x = np.array(data[axis["column"]])
        own = unitOf(axis)
        if unit not in ("", own):
            raise Refused(f"--at: '{at}' must be in {own} or in s")
        reached = np.flatnonzero(x >= value if value >= x[0] else x <= value)
        if not len(reached):
            raise Refused(
                f"--at: {directory} never comes to {value:g} {own}; it goes from {x.min():g} to"
                f" {x.max():g} {own}"
            )
        value = data["time_s"][reached[0]]
    elif not min(times) * (1 - 1e-9) <= value <= max(times) * (1 + 1e-9):
        raise Refused(
            f"--at: {directory} has frames from {min(times):g} to {max(times):g} s, not at"
            f" {value:g} s"
        )
    return frameAt(directory, value)


@program
def main(words: Sequence[str] | None = None) -> None:
    """The program ``scripts/view.py``."""
    parser = argparse.ArgumentParser(
        description="Write a run as a page that any browser shows in 3-D, without a network."
    )
    parser.add_argument("result", help="folder of results")
    parser.add_argument(
        "--html", metavar="FILE", nargs="?", help="the page (view.html in the folder of results)"
    )
    parser.add_argument(
        "--at", metavar="PLACE", help="frame to show first: 12, 12mm or 0.5s; else the last one"
    )
    parser.add_argument(
        "--magnify", type=float, help="magnification of displacements; else chosen for the run"
    )
    args = parser.parse_args(words)
    if args.magnify is not None and not 0 <= args.magnify < float("inf"):
        raise Refused(f"--magnify: {args.magnify:g} must be at least 0")
    directory = args.result
    readRun(directory)
    with filesOf(directory):
        number = args.at and frameNear(directory, args.at)
        make = lambda: page.page(directory, number, args.magnify)
        pages.save(make, args.html, directory, "view.html")
