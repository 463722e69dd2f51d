# SPDX-License-Identifier: GPL-2.0-or-later
"""What is said on the terminal, and who keeps the notes of it."""

import collections
import contextlib
import re
import sys
from typing import Callable

# A terminal or a log that has no ³ or µ shows their numbers.
for _stream in (sys.stdout, sys.stderr):
    with contextlib.suppress(AttributeError, ValueError, OSError):
        if _stream.errors in ("strict", "surrogateescape"):
            getattr(_stream, "reconfigure")(errors="backslashreplace")


#: Control characters but for the ends of lines and tabs, and marks of the direction of a text.
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def escapeControls(text):
    """Write out the control characters of a text, as ``\\x1b``: a file must not steer a
    terminal."""
    return _CONTROL.sub(lambda found: ascii(found[0])[1:-1], str(text))


NOTED = ("note: ", "warning: ")  # how texts begin that a run keeps
_pending = collections.deque(maxlen=100)  # notes since the last run ended
_listeners = []  # of the present run


def say(text, stream=None, noted=True):
    """Print a text, as :func:`escapeControls` writes it. A terminal that is gone or a log that is
    full is no reason to stop a run, which writes notes and warnings to run.json, also those from
    before it began.

    :param noted: False: a note that is kept elsewhere
    """
    text = escapeControls(text)
    if noted and text.startswith(NOTED):
        for listener in _listeners or [_pending.append]:
            listener(text)
    with contextlib.suppress(OSError):
        print(text, file=stream, flush=True)


def listen(listener: Callable[[str], None]) -> None:
    """Give a function, in place of any other, all notes, the pending ones first."""
    _listeners[:] = [listener]
    while _pending:
        listener(_pending.popleft())


def stopListening(listener: Callable[[str], None]) -> None:
    _listeners[:] = [one for one in _listeners if one != listener]


def forgetNotes() -> None:
    """Forget notes that wait for a run, and who listens: in a copy of the process."""
    _listeners.clear()
    _pending.clear()
