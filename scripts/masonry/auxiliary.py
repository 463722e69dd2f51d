# SPDX-License-Identifier: GPL-2.0-or-later
"""What is computed beside a run (limit analysis, frames, figures, report, accuracy) never ends it:
an unexpected error is a note of the run, with its traceback in ``errors.log``. No YADE is
needed."""

import contextlib
import os
import traceback

from .errors import Collapsed, Interrupted, Refused, Unwritable
from .folders import inside

LOG = "errors.log"
#: Errors that end a run in order: of the user's input, or of the machine.
EXPECTED = (Refused, Interrupted, Unwritable, Collapsed, MemoryError)


class Auxiliary:
    """A ``with`` block that an unexpected error ends, without ending the run.

    :param what: is computed, in a few words
    :param fail: function of the note and the traceback of an error, both as text
    """

    def __init__(self, what, fail):
        self.what, self.fail = what, fail
        self.note = ""  # after the block: why it has failed

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if not isinstance(error, Exception) or isinstance(error, EXPECTED):
            return False
        self.note, text = described(self.what, error)
        self.fail(self.note, text)
        return True


def described(what, error):
    """The note of an unexpected error, and its traceback as text."""
    kind = "" if isinstance(error, Refused) else f"{type(error).__name__}: "
    note = f"{what}: {kind}{error}; {LOG} has the traceback"
    return note, "".join(traceback.format_exception(error))


def addToLog(folder, text):
    """Add a text to the log in a folder. A full disk is noticed by what the run itself writes."""
    with contextlib.suppress(OSError):
        with open(os.path.join(folder, LOG), "a", opener=inside, errors="backslashreplace") as log:
            log.write(text)
