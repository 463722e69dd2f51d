# SPDX-License-Identifier: GPL-2.0-or-later
"""Debian's packages that only a part of the project needs. ``scripts/setup.sh`` installs those of
a run, with ``--tests`` also those of studies and tests."""

import contextlib
import importlib
import importlib.util
import sys

from .errors import Refused

#: Module -> (its Debian package, what needs it).
NEEDED_FOR = {
    "ezdxf": ("python3-ezdxf", "DXF files need"),
    "jinja2": ("python3-jinja2", "reports and pages need"),
    "matplotlib": ("python3-matplotlib", "figures need"),
    "meshio": ("python3-meshio", "the mechanism of a bound for ParaView needs"),
    "openturns": ("python3-openturns", "distributions and designs of studies need"),
    "svgelements": ("python3-svgelements", "SVG files need"),
    "scipy": ("python3-scipy", "bricks and bounds need"),
}


class Missing(Refused, ImportError):
    """A Python module is not installed; the text has the command that installs it."""


def needed(name):
    """Import a module of :data:`NEEDED_FOR`. Raises Missing."""
    promised(name)
    return importlib.import_module(name)


def promised(name):
    """Check that a module of :data:`NEEDED_FOR` is there, without importing it. Raises Missing."""
    with contextlib.suppress(ModuleNotFoundError):  # of a finder that forbids it
        if sys.modules.get(name) or importlib.util.find_spec(name):
            return
    package, what = NEEDED_FOR[name]
    raise Missing(
        f"{what} the Python module {name}, which is not installed: "
        f"apt-get install --no-install-recommends {package}"
    )
