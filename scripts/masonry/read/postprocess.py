# SPDX-License-Identifier: GPL-2.0-or-later
"""The program beside a run that draws its figures and writes its report when the run is over.

    python3 -P -m masonry.read.postprocess

A run starts it early: it loads what it needs while the run goes on. Then it reads the folder from
the standard input, up to a zero byte, when the files of the run are there. It draws curve.png and
cracks.png in a copy of the process, and makes the report meanwhile, but for these figures. When the
standard input ends, all figures that the run itself writes are there, too, and it writes
report.html. It ends without a word if it is given no folder. Errors that nobody expects go to the
standard output, as JSON: pairs of a note and a traceback.
"""

import contextlib
import gc
import io
import json
import math
import os
import sys

from ..common import memory
from ..common.auxiliary import Auxiliary, described
from ..common.background import Task
from ..basics import say
from ..common.folders import check
from ..common.packages import Missing, needed
from . import figures, report
from .drawing import empty, style
from .files import onFolder, readWhole

STDIN = 0
END = b"\0"  # of the name of the folder
#: Exit statuses beside 0: figures or the report cannot be written, since disk or memory is full.
NO_FIGURES, NO_REPORT = 3, 4


def _load():
    """Draw a figure that nobody sees: the first one of a process loads most of matplotlib."""
    with contextlib.suppress(Exception):  # what is wrong is said when something is drawn
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
    """Draw the figures. Returns what :func:`_tried` does."""
    with contextlib.suppress(OSError):  # it is said when it is drawn
        if len(readWhole(os.path.join(folder, "curve.csv")).splitlines()) < 2:
            return 0, []  # limit analysis alone has no curve
    try:
        needed("matplotlib")
    except Missing as missing:
        say(f"the figures are left out: {missing}", sys.stderr)
        return 0, []
    return _tried("the figures", figures.draw, folder)


def _tried(what, act, *words):
    """Let a function draw or write something.

    :returns: its exit status if disk or memory is full, else 0; and the notes and tracebacks of
        other errors
    """
    failures = []

    def acting(word):
        try:
            act(word)
        except (OSError, MemoryError):
            raise
        except Exception as error:
            failures.append(described(what, error))

    return onFolder(acting, words), failures


def main():
    """The program. Returns its exit status."""
    _load()
    folder = _folder()
    if not folder:
        return 0
    drawing = Task(lambda: [_draw(folder)])

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

    written, failures = _tried("the report", write, folder)
    drawn = 0
    with Auxiliary("the figures", lambda *failure: failures.append(failure)):
        drawn, lost = drawing.result()
        failures += lost
    json.dump(failures, sys.stdout)
    return NO_FIGURES if drawn else NO_REPORT if written else 0


if __name__ == "__main__":
    sys.exit(main())
