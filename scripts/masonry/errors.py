"""How a run can end before its time. Each of these ends it in order, and what was computed is kept."""


class Refused(ValueError):
    """Input that cannot be run, with all problems at once. Nothing was changed."""


class Interrupted(Exception):
    """The user pressed Ctrl-C, or the system sent SIGTERM."""


class Unwritable(Exception):
    """A file of the results cannot be written, for example since the disk is full."""


class Collapsed(Exception):
    """The structure has fallen, as the message says; the run ends in order."""
