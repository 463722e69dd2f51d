# SPDX-License-Identifier: GPL-2.0-or-later
"""How far a run has come, on the terminal or in the output of a cell."""

import contextlib
import sys
import time

from .. import notebook


class Progress:
    """How far a stage has come: on a terminal and in a notebook one line, elsewhere a line every
    tenth."""

    def __init__(self, stream=None):
        self.line = None  # of the present stage, in a notebook
        self.inNotebook = stream is None and notebook.isHere()
        self.stream = stream or sys.stdout
        self.kept = self.inNotebook or self.stream.isatty()  # whether a line is
        self.last = self.stage = None
        self.began = self.first = self.lastTenth = 0

    def show(self, stage, fraction, detail, stepsPerSecond, final=False):
        """Show a stage, if it is time to.

        :param fraction: how much of the stage is done, 0 to 1 [-]
        :param detail: function that gives the text, if it is shown
        :param stepsPerSecond: time steps in a second of wall-clock time, or None
        :param final: whether the stage ends here; this is always shown
        """
        now = time.perf_counter()
        if stage != self.stage:
            self.stage, self.began, self.first = stage, now, fraction
            self.lastTenth, self.last = -1, 0
            self.line = notebook.Line() if self.inNotebook else None
        tenth = int(10 * fraction)
        early = now - self.last < 0.2 if self.kept else tenth == self.lastTenth
        if early and not final:
            return
        self.last, self.lastTenth = now, tenth
        done = fraction - self.first
        text = f"{stage:<12} {detail()}"
        if stepsPerSecond is not None:
            text += f"  {stepsPerSecond:,.0f} steps/s"
        if done > 0.01 and not final:
            left = int((now - self.began) * (1 - fraction) / done)
            text += f"  {left // 60}:{left % 60:02d} left"
        if self.line:
            self.line.show(text, 1.0 if final else fraction)
            return
        if self.kept:
            bar = "#" * int(24 * fraction)
            text = f"\r[{bar:<24}] {text}\x1b[K" + ("\n" if final else "")
        else:
            text += "\n"
        with contextlib.suppress(OSError):  # as in say()
            self.stream.write(text)
            self.stream.flush()
