# SPDX-License-Identifier: GPL-2.0-or-later
"""The program beside a run that draws its figures and writes its report when the run is over.

    python3 -P -m masonry.read.postprocess

A run starts it early: it loads what it needs while the run goes on. Then it reads the folder from
the standard input, up to a zero byte, when the files of the run are there. It draws curve.png and
cracks.png in a copy of the process, and makes the report meanwhile, but for these figures. When the
standard input ends, all figures that the run itself writes are there, too, and it writes
report.html. It ends without a word if it is given no folder.
"""

import contextlib
import gc
import io
import math
import os
import sys

from ..common import memory
from ..common.background import Failed, Task
from ..basics import say
from ..common.folders import check
from ..common.packages import Missing, needed
from . import figures, report
from .drawing import empty, style
from .files import onFolder, readWhole

STDIN = 0
END = b"\0"  # of the name of the folder
#: Exit statuses beside 0 and those of figures: there is no report, and there are figures.
NO_REPORT = 3


def _load():
    """Draw a figure that nobody sees: the first one of a process loads most of matplotlib."""
    # what is missing is said when something is drawn
    with contextlib.suppress(ImportError, Missing):
        with style():
            figure = empty(1, 1)
            figure.add_subplot().plot([0, 1], label="line")
            figure.axes[0].legend()
            for kind in ("png", "svg"):
                figure.savefig(io.BytesIO(), format=kind)
        import jinja2, scipy.spatial  # noqa: F401, E401
    gc.freeze()  # garbage is no longer looked for among what has been loaded


def _folder():
    """The folder from the standard input, or an empty text if it ends before."""
    name = b""
    for byte in iter(lambda: os.read(STDIN, 1), b""):
        if byte == END:
            return os.fsdecode(name)
        name += byte
    return ""


def _draw(folder):
    """Draw the figures. Returns the exit status."""
    with contextlib.suppress(OSError):  # it is said when it is drawn
        if len(readWhole(os.path.join(folder, "curve.csv")).splitlines()) < 2:
            return 0  # limit analysis alone has no curve
    try:
        needed("matplotlib")
    except Missing as missing:
        say(f"the figures are left out: {missing}", sys.stderr)
        return 0
    return onFolder(figures.draw, [folder])


def main():
    """The program. Returns its exit status."""
    _load()
    folder = _folder()
    if not folder:
        return 0
    drawing = Task(lambda: [_draw(folder)])
    written = NO_REPORT

    def ready():
        drawing.ready(seconds=math.inf)
        while os.read(STDIN, 1):  # at its end the run has written its own figures
            pass

    def write(directory):
        memory.reserve()
        check(directory)
        record = report.read(directory)
        record.ready = ready
        report.write(record, os.path.join(directory, report.NAME))

    try:
        written = onFolder(write, [folder]) and NO_REPORT
    except Exception as problem:  # the figures shall be there all the same
        say(f"the report cannot be made: {type(problem).__name__}: {problem}", sys.stderr)
    try:
        return drawing.result() or written
    except Failed:
        return 1


if __name__ == "__main__":
    sys.exit(main())
