# SPDX-License-Identifier: GPL-2.0-or-later
"""What every part of the package shares: gravity, how a run can end before its time, and what is
said on the terminal."""

import collections
import contextlib
import gc
import re
import sys
from typing import Callable, Iterator

GRAVITY = 9.81  # [m/s²]
#: Units in which accelerations may be given, in m/s².
ACCELERATION_UNITS = {"m/s²": 1.0, "g": GRAVITY, "cm/s²": 0.01}

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


@contextlib.contextmanager
def withoutCollector() -> Iterator[None]:
    """Let Python look for unused circles of objects only when a block is over. It may decorate a
    function, too.

    Each look goes through all objects of YADE and numpy. A block that makes many thousands of
    records starts dozens of looks, which find nothing and take half of its time.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def firstOf(problems, most=10):
    """The first sentences of a list, and how many more there are."""
    more = [f"and {len(problems) - most} more"] if len(problems) > most else []
    return [*problems[:most], *more]


# How a run can end before its time. Each of these ends it in order, and what was computed is kept.


class Refused(ValueError):
    """Input that cannot be run, with all problems at once. Nothing was changed."""


#: What is said of anything that cannot be done in a scene in a plane.
IN_PLANE = "the scene is in the x-z plane; Scene(..., plane=False) is in space"


def checkPlane(description, along, name):
    """Refuse what has a part along y in a scene in the x-z plane. Raises ValueError."""
    if description.plane and along[1]:
        raise ValueError(f"{name}: {IN_PLANE}")


def refuse(problems, begin="", between="\n"):
    """Raise :class:`Refused` with all problems, if there are any."""
    if problems:
        raise Refused(begin + between.join(problems))


class Held(Refused):
    """Another run is writing to the folder of the results."""


class NotResumed(Refused):
    """A checkpoint from which this run cannot go on."""


class NotAccurate(Refused):
    """A scene that cannot have ``--accuracy``."""


class Interrupted(Exception):
    """The user pressed Ctrl-C, or the system sent SIGTERM."""


class Unwritable(Exception):
    """A file of the results cannot be written, for example since the disk is full."""


class Collapsed(Exception):
    """The structure has fallen, as the message says; the run ends in order."""
