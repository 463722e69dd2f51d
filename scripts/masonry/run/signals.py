# SPDX-License-Identifier: GPL-2.0-or-later
"""Ctrl-C and SIGTERM during a run: obeyed between steps, or at once in a block that allows it."""

import contextlib
import signal

from .. import notebook
from ..errors import Interrupted


class Signals:
    """What a run does when the user interrupts it: in a script from its beginning to its end, in a
    notebook while one of its commands is carried out."""

    def __init__(self):
        self.interrupted = False  # whether the user has interrupted the run
        self._handlers = {}  # of signals, as they were before
        self._begun = False  # whether the run obeys them
        self._breaks = False  # whether these end at once what is done

    def begin(self):
        self._begun = True
        for number in (signal.SIGINT, signal.SIGTERM):
            self._handlers[number] = signal.signal(number, self._interrupt)

    def end(self):
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        self._handlers = {}

    @contextlib.contextmanager
    def breakable(self):
        """Let Ctrl-C and SIGTERM end a block at once, by Interrupted. It must change nothing that a
        checkpoint keeps."""
        self._breaks = True
        try:
            if self.interrupted:
                raise Interrupted()
            yield
        finally:
            self._breaks = False

    @contextlib.contextmanager
    def listening(self):
        """Obey Ctrl-C and SIGTERM in a block that carries out a command, in order."""
        if self._begun and not self._handlers and notebook.isHere():
            self.begin()
        try:
            yield
        finally:
            if notebook.isHere():
                self.end()

    def _interrupt(self, number, frame):
        self.interrupted = True
        if self._breaks:
            self._breaks = False
            raise Interrupted()
