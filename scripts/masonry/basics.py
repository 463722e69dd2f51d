# SPDX-License-Identifier: GPL-2.0-or-later
"""What every part of the package shares: gravity, how a run can end before its time, and what is said on the terminal."""

import contextlib
import sys

GRAVITY = 9.81  # [m/s²]

# A terminal or a log that has no ³ or µ shows their numbers; that is no reason to stop a run either.
for _stream in (sys.stdout, sys.stderr):
    with contextlib.suppress(AttributeError, ValueError, OSError):
        if _stream.errors in ("strict", "surrogateescape"):
            _stream.reconfigure(errors="backslashreplace")


def say(text, stream=None):
    """Print a text. A terminal that is gone or a log that is full is no reason to stop a run."""
    with contextlib.suppress(OSError):
        print(text, file=stream, flush=True)


# How a run can end before its time. Each of these ends it in order, and what was computed is kept.


class Refused(ValueError):
    """Input that cannot be run, with all problems at once. Nothing was changed."""


class Interrupted(Exception):
    """The user pressed Ctrl-C, or the system sent SIGTERM."""


class Unwritable(Exception):
    """A file of the results cannot be written, for example since the disk is full."""


class Collapsed(Exception):
    """The structure has fallen, as the message says; the run ends in order."""
