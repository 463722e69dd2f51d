# SPDX-License-Identifier: GPL-2.0-or-later
"""Debian's packages that only a part of the project needs. ``scripts/setup.sh`` installs those of
a run, with ``--tests`` also those of studies and tests."""

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
    """A Python module is not installed; the text has the command that installs it."""


def needed(name):
    """Import a module of :data:`NEEDED_FOR`. Raises Missing."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
    raise _missing(name)


def promised(name):
    """Check that a module of :data:`NEEDED_FOR` is there, without importing it. Raises Missing."""
    try:
        found = name in sys.modules or importlib.util.find_spec(name)
    except ModuleNotFoundError:  # of a finder that forbids it
        found = None
    if not found:
        raise _missing(name) from None


def _missing(name):
    package, what = NEEDED_FOR[name]
    return Missing(
        f"{what} the Python module {name}, which is not installed: "
        f"apt-get install --no-install-recommends {package}"
    )
