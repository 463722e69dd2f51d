# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a run, made from the files in its folder and nothing else.

``/usr/bin/python3 -m masonry.read.figures results/wall_comp4`` draws curve.png and, if there are ParaView files, cracks.png.
From a script, also one of YADE, ``masonry.read.figures.draw(folder)`` does the same. This module needs no YADE, and loads
neither VTK nor a display, so it does no harm to the process that calls it.

What curve.png shows is said by the entry ``figure`` of run.json, and what the panels of cracks.png are by ``parts``; see
:mod:`masonry.run.results`.
"""

from __future__ import annotations

import contextlib
import glob
import os
import sys

from .. import folders, memory
from ..arguments import FilePath
from ..basics import say
from ..packages import Missing, needed
from .crack_figure import cracks
from .curve_figure import curve
from .files import filesOf, onFolder


def draw(directory: FilePath) -> None:
    """Draw all figures that the files of a run allow. Raises Refused if something is wrong with them, or with the folder."""
    memory.reserve()
    folders.check(directory)
    with filesOf(directory):
        curve(directory)
        if glob.glob(os.path.join(glob.escape(os.fspath(directory)), "joints_*.vtp")):
            cracks(directory)


#: In place of a folder: load what drawing needs, and then read the folder from the standard input. A run starts this early.
WAIT = "--folder-from-input"


def _waitForFolder() -> list[str]:
    """The folder that a run names when its files are there; the program ends if it names none."""
    with contextlib.suppress(ImportError):  # it is said when something is drawn
        import matplotlib.backends.backend_agg  # noqa: F401
        import matplotlib.style  # noqa: F401
    folder = sys.stdin.buffer.read()
    if not folder:
        sys.exit(0)
    try:
        needed("matplotlib")
    except Missing as missing:
        say(f"the figures are left out: {missing}", sys.stderr)
        sys.exit(0)
    return [os.fsdecode(folder)]


if __name__ == "__main__":
    words = sys.argv[1:]
    sys.exit(onFolder(draw, _waitForFolder() if words == [WAIT] else words))
