# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a run, made from the files in its folder and nothing else.

``/usr/bin/python3 -m masonry_view.figures results/wall_comp4`` draws curve.png, if there are
ParaView files cracks.png, and if there is a mechanism of limit analysis mechanism.png. From a
script, also one of YADE, ``masonry_view.figures.draw(folder)`` does the same. The entries
``figure`` and ``parts`` of run.json say what they show; see :mod:`masonry.run.results`.
"""

import glob
import os
import sys

from masonry import folders, memory
from masonry.arguments import FilePath
from . import mechanism
from .elevation import cracks
from .curve_figure import curve
from masonry.numbers.files import filesOf, onFolder, readWhole


def hasRows(directory: FilePath) -> bool:
    """Whether a run has rows; limit analysis alone has none."""
    try:
        return len(readWhole(os.path.join(directory, "curve.csv")).splitlines()) > 1
    except OSError:
        return True  # what is wrong is said when the curve is drawn


def drawRun(directory: FilePath) -> None:
    """Draw curve.png and cracks.png, as far as there are files for them. Raises Refused if
    something is wrong with them, or with the folder."""
    memory.reserve()
    folders.check(directory)
    with filesOf(directory):
        if hasRows(directory):
            curve(directory)
        if glob.glob(os.path.join(glob.escape(os.fspath(directory)), "joints_*.vtp")):
            cracks(directory)


def draw(directory: FilePath) -> None:
    """Draw all figures of a run, mechanism.png among them. Raises Refused as :func:`drawRun`."""
    drawRun(directory)
    if mechanism.isThere(directory):
        mechanism.draw(directory)


if __name__ == "__main__":
    sys.exit(onFolder(draw, sys.argv[1:]))
