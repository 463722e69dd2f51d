# SPDX-License-Identifier: GPL-2.0-or-later
"""The program beside a run that draws its figures and writes its report when the run is over.

    python3 -P -m masonry_view.postprocess

A run starts it early, so that it loads what it needs while the run goes on. When the files of the
run are there, it reads the folder from the standard input, up to a zero byte, draws the figures,
and writes report.html. Errors that nobody expects go to the standard output, as JSON: pairs of a
note and a traceback.
"""

import contextlib
import gc
import io
import json
import os
import sys

from masonry import memory
from masonry.auxiliary import described
from masonry.folders import check
from masonry.numbers.drawing import empty, style
from masonry.numbers.files import onFolder
from masonry.packages import Missing, needed
from masonry.run.drawing_program import END, NO_FIGURES, NO_REPORT
from masonry.terminal import say

from . import figures, mechanism, report

STDIN = 0


def _load():
    """Draw a figure that nobody sees, which loads most of matplotlib."""
    with contextlib.suppress(Exception):  # what is wrong is said when something is drawn
        with style():
            figure = empty(1, 1)
            figure.add_subplot().plot([0, 1], label="line")
            figure.axes[0].legend()
            for kind in ("png", "svg"):
                figure.savefig(io.BytesIO(), format=kind)
        import jinja2, scipy.spatial  # noqa: F401, E401
    gc.freeze()  # no garbage is looked for among what has been loaded


def _folder():
    """The folder from the standard input, or an empty text if it ends before."""
    name = b""
    for byte in iter(lambda: os.read(STDIN, 1), b""):
        if byte == END:
            return os.fsdecode(name)
        name += byte
    return ""


def _draws(folder):
    """The functions that draw the figures of a folder."""
    try:
        needed("matplotlib")
    except Missing as missing:
        say(f"the figures are left out: {missing}", sys.stderr)
        return []
    return [figures.drawRun] + [mechanism.draw] * mechanism.isThere(folder)


def _tried(what, act, *words):
    """Let a function draw or write something. Returns its exit status if disk or memory is full,
    else 0; and the notes and tracebacks of other errors."""
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
    _load()
    folder = _folder()
    if not folder:
        return 0

    def write(directory):
        memory.reserve()
        check(directory)
        report.write(report.read(directory), os.path.join(directory, report.NAME))

    done = [_tried("the figures", draw, folder) for draw in _draws(folder)]
    written, failures = _tried("the report", write, folder)
    drawn = max([status for status, _ in done], default=0)
    json.dump([one for _, lost in done for one in lost] + failures, sys.stdout)
    return NO_FIGURES if drawn else NO_REPORT if written else 0


if __name__ == "__main__":
    sys.exit(main())
