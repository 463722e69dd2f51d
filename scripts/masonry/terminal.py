# SPDX-License-Identifier: GPL-2.0-or-later
"""What is said on the terminal, and who keeps the notes of it."""

import collections
import contextlib
import re
import sys
from typing import Callable

# A terminal or a log that has no ³ or µ shows their numbers; that is no reason to stop a run
# either.
for _stream in (sys.stdout, sys.stderr):
    with contextlib.suppress(AttributeError, ValueError, OSError):
        if _stream.errors in ("strict", "surrogateescape"):
            getattr(_stream, "reconfigure")(errors="backslashreplace")


#: What a terminal obeys and does not show: control characters but for the ends of lines and tabs,
#: and marks that turn the direction of a text.
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def plain(text):
    """A text in which control characters are written out, as ``\\x1b``: what comes from a file must
    not steer a terminal."""
    return _CONTROL.sub(lambda found: ascii(found[0])[1:-1], str(text))


NOTED = ("note: ", "warning: ")  # how texts begin that a run keeps
_pending = collections.deque(maxlen=100)  # notes since the last run ended
_listeners = []  # of the present run


def say(text, stream=None, noted=True):
    """Print a text, as :func:`plain` writes it. A terminal that is gone or a log that is full is no
    reason to stop a run.

    Notes and warnings are kept: the run that hears them writes them to run.json, also those that
    were said before it began.

    :param noted: False: a note that is kept elsewhere
    """
    text = plain(text)
    if noted and text.startswith(NOTED):
        for listener in _listeners or [_pending.append]:
            listener(text)
    with contextlib.suppress(OSError):
        print(text, file=stream, flush=True)


def listen(listener: Callable[[str], None]) -> None:
    """From now on a function gets all notes, first those that nobody has heard. Another listener
    hears no more."""
    _listeners[:] = [listener]
    while _pending:
        listener(_pending.popleft())


def stopListening(listener: Callable[[str], None]) -> None:
    """A function gets no more notes."""
    _listeners[:] = [one for one in _listeners if one != listener]
