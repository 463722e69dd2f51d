# SPDX-License-Identifier: GPL-2.0-or-later
"""How a run can end before its time: in order, and what was computed is kept."""


class Refused(ValueError):
    """Input that cannot be run, with all problems at once. Nothing was changed."""


class ScriptRefused(Refused, SystemExit):
    """Refused input of a script, which the terminal shows already: where the script does not catch
    it, the program ends with status 2 and without a traceback."""

    code = 2


IN_PLANE = "the scene is in the x-z plane; Scene(..., plane=False) is in space"


def checkPlane(description, along, name):
    """Refuse a vector with a part along y in a scene in the x-z plane."""
    if description.plane and along[1]:
        raise Refused(f"{name}: {IN_PLANE}")


def refuse(problems, begin="", between="\n"):
    """Raise :class:`Refused` with all problems, if there are any."""
    if problems:
        raise Refused(begin + between.join(problems))


class FolderLocked(Refused):
    """Another run writes to the folder of the results."""


class NotResumed(Refused):
    """This run cannot go on from a checkpoint."""


class NotAccurate(Refused):
    """A scene that cannot have ``--accuracy``."""


class Interrupted(Exception):
    """The user pressed Ctrl-C, or the system sent SIGTERM."""


class Unwritable(Exception):
    """A file of the results cannot be written."""


class Collapsed(Exception):
    """The structure has fallen, as the message says; the run ends in order."""


def firstOf(problems, most=10):
    """The first sentences of a list, and how many more there are."""
    more = [f"and {len(problems) - most} more"] if len(problems) > most else []
    return [*problems[:most], *more]
