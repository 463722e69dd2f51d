# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a run, made from the files in its folder and nothing else.

``/usr/bin/python3 -m masonry.read.figures results/wall_comp4`` draws curve.png and, if there are
ParaView files, cracks.png. From a script, also one of YADE, ``masonry.read.figures.draw(folder)``
does the same. This module needs no YADE, and loads neither VTK nor a display, so it does no harm to
the process that calls it.

What curve.png shows is said by the entry ``figure`` of run.json, and what the panels of cracks.png
are by ``parts``; see
:mod:`masonry.run.results`.
"""

import glob
import os
import sys

from ..common import folders, memory
from ..common.arguments import FilePath
from .elevation import cracks
from .curve_figure import curve
from .files import filesOf, onFolder


def draw(directory: FilePath) -> None:
    """Draw all figures that the files of a run allow. Raises Refused if something is wrong with
    them, or with the folder."""
    memory.reserve()
    folders.check(directory)
    with filesOf(directory):
        curve(directory)
        if glob.glob(os.path.join(glob.escape(os.fspath(directory)), "joints_*.vtp")):
            cracks(directory)


if __name__ == "__main__":
    sys.exit(onFolder(draw, sys.argv[1:]))
