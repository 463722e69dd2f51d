# SPDX-License-Identifier: GPL-2.0-or-later
"""Debian's packages that only a part of the project needs: what is left out without each, and how
it is installed.

``scripts/setup.sh`` installs what a run needs, and with ``--tests`` also what studies and tests
need.
"""

import importlib
import importlib.util
import sys

from .errors import Refused

#: Module -> (its Debian package, what needs it).
NEEDED_FOR = {
    "ezdxf": ("python3-ezdxf", "DXF files need"),
    "jinja2": ("python3-jinja2", "reports and pages need"),
    "matplotlib": ("python3-matplotlib", "figures need"),
    "meshio": ("python3-meshio", "PLY files and a bound's mechanism for ParaView need"),
    "openturns": ("python3-openturns", "distributions and designs of studies need"),
    "scipy": ("python3-scipy", "bricks and bounds need"),
}


class Missing(Refused, ImportError):
    """A Python module is not installed; the text is one sentence with the command that installs
    it."""


def needed(name):
    """A Python module that may be missing.

    :param name: one of :data:`NEEDED_FOR`
    :returns: the module
    :raises Missing: if it is not installed
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
    raise _missing(name)


def promised(name):
    """Make sure that :func:`needed` will find a module, without the time that its import takes.

    :param name: one of :data:`NEEDED_FOR`
    :raises Missing: if it is not installed
    """
    try:
        found = name in sys.modules or importlib.util.find_spec(name)
    except ModuleNotFoundError:  # of a finder that forbids it
        found = None
    if not found:
        raise _missing(name) from None


def _missing(name):
    """The error that says how a module is installed."""
    package, what = NEEDED_FOR[name]
    return Missing(
        f"{what} the Python module {name}, which is not installed: "
        f"apt-get install --no-install-recommends {package}"
    )
