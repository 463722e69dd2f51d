# SPDX-License-Identifier: GPL-2.0-or-later
"""Finds the YADE of this machine in plain Python, and starts it when it is first imported.

The program ``yade`` puts the folder of YADE's modules on ``sys.path``; ``/usr/bin/python3`` does
not. After ``import masonry`` this module does it as soon as anything imports ``yade``, so what
reads results stays as quick as without YADE. YADE starts without ports, without a change of
``sys.argv``, with one thread unless ``OMP_NUM_THREADS`` says another number, and without its lines
on the terminal. In copies of a process that has started it, scripts run as in one of their own,
without the price of its start (:func:`load`, :func:`runScript`).
"""

import builtins
import contextlib
import gc
import glob
import importlib
import importlib.machinery
import importlib.metadata
import io
import os
import re
import shutil
import sys
import sysconfig
import types
import warnings

from . import wings
from .terminal import say

YADE = "yade"
SHELL = "IPython"
#: The plugin, which is linked to YADE, and the room whose modules registering it needs.
PLUGIN, ASSEMBLY = "masonry._masonry", "masonry.model."
THREADS = "OMP_NUM_THREADS"
#: What every build of YADE has in the folder of its modules.
MARK = os.path.join(YADE, "__init__.py")
GREETING = f"Using python version: {sys.version}"  # which YADE prints
#: What a script of the program ``yade`` finds among its names.
NAMES = """
import os, sys, time, yade
from yade import geom, pack, utils
from yade.utils import *
from yade.pack import *
from math import *
"""
INSTALLED = "on Debian, apt-get install yade installs it"


class Finder:
    """Finder of YADE, which stands before the others and takes their answer first."""

    def __init__(self, started):
        self._started = started  # called when YADE has been imported

    def find_spec(self, name, path=None, target=None):
        """The spec of YADE. Raises ModuleNotFoundError with a sentence if there is none."""
        if name == YADE:
            found = self._byOthers() or _installed()
            found.loader = Loader(YADE, found.origin)
            found.loader.started = self._started
            return found
        needs = name == PLUGIN or name.startswith(ASSEMBLY)
        if needs and YADE not in sys.modules:
            importlib.import_module(YADE)
            if name in sys.modules:  # registering the plugin imported it
                return importlib.machinery.ModuleSpec(name, Imported())
        return None

    def _byOthers(self):
        """YADE as the other finders see it; a folder of this name that is not YADE is ignored."""
        for finder in sys.meta_path:
            find = getattr(finder, "find_spec", None)
            found = find(YADE, None) if find and finder is not self else None
            if found and found.origin and found.loader:
                return found
        return None


class Loader(importlib.machinery.SourceFileLoader):
    def exec_module(self, module):
        """Run the module quietly, with one thread unless the user wants more. Raises ImportError if
        this Python lacks what YADE needs."""
        printed, asked = io.StringIO(), THREADS in os.environ
        os.environ.setdefault(THREADS, "1")  # OpenMP reads it when it is loaded
        quietly = contextlib.redirect_stdout(printed)
        try:
            with warnings.catch_warnings(), quietly, _withoutShell():
                warnings.simplefilter("ignore", DeprecationWarning)
                super().exec_module(module)
        except ModuleNotFoundError as error:
            if not error.name or error.name.split(".")[0] == YADE:
                raise
            path = interpreter()[0] or "/usr/bin/python3"
            raise ImportError(
                (
                    f"YADE needs the Python module {error.name!r}, which {sys.executable} does not"
                    f" find: run the script with {path}, or make the virtual environment with"
                    f" {path} -m venv --system-site-packages"
                ),
                name=error.name,
            ) from error
        finally:
            if not asked:
                os.environ.pop(THREADS, None)
            found = printed.getvalue().replace(GREETING, "").strip()
            if found:
                say(found)
        # YADE puts the folder of its own modules before the standard library, where its config.py,
        # log.py or plot.py would hide modules of these names: it comes last.
        own = os.path.realpath(os.path.dirname(module.__file__))
        sys.path.sort(key=lambda folder: os.path.realpath(folder or ".") == own)
        self.started()


@contextlib.contextmanager
def _withoutShell():
    """Let YADE find the version of IPython, all that it needs in plain Python, without importing
    it, which takes a third of the start."""
    standIn = types.ModuleType(SHELL)
    with contextlib.suppress(importlib.metadata.PackageNotFoundError):
        standIn.__version__ = importlib.metadata.version(SHELL)
        sys.modules.setdefault(SHELL, standIn)
    try:
        yield  # without IPython YADE says what it misses
    finally:
        if sys.modules.get(SHELL) is standIn:
            del sys.modules[SHELL]


class Imported:
    """The loader of a module that was imported while it was looked for."""

    def create_module(self, spec):
        self._spec = sys.modules[spec.name].__spec__
        return sys.modules[spec.name]

    def exec_module(self, module):
        """Leave the module as it is."""
        module.__spec__ = self._spec


def folders():
    """Folders where YADE's modules can lie, the likeliest first: those that the program ``yade``
    adds to ``sys.path``, and those of a library folder of Debian."""
    text = _program()
    named = re.findall(r"^sys\.path\.insert\(\d+, *'([^']+)'\)", text, re.MULTILINE)
    prefix = os.environ.get("YADE_PREFIX", "/usr")
    libraries = os.path.join(prefix, "lib", sysconfig.get_config_var("MULTIARCH") or "")
    # a build of another precision is of no use to the plugin
    beside = [os.path.join(libraries, one, "py") for one in ("yade", "yade-double")]
    others = glob.glob(os.path.join(glob.escape(prefix), "lib", "*", "yade-double", "py"))
    return list(dict.fromkeys([*named, *beside, *sorted(others)]))


def _program():
    with contextlib.suppress(OSError, UnicodeDecodeError, TypeError):
        with open(shutil.which(YADE), encoding="utf-8") as file:
            return file.read(1 << 20)
    return ""


def interpreter():
    """The interpreter that the installed YADE was built for, and its version as a pair of numbers;
    None where unknown."""
    found = re.match(r"#! *(/\S*python\S*)", _program())
    if not found:
        return None, None
    whole = os.path.basename(os.path.realpath(found[1]))
    version = re.fullmatch(r"python(\d+)\.(\d+)", whole)
    return found[1], tuple(map(int, version.groups())) if version else None


def _installed():
    """The spec of the installed YADE. Raises ImportError if there is none, or for another
    Python."""
    path, version = interpreter()
    if version and version != sys.version_info[:2]:
        raise ImportError(
            (
                f"the YADE of this machine is built for Python {version[0]}.{version[1]}, and this"
                f" is {sys.executable}, Python {sys.version_info[0]}.{sys.version_info[1]}: run the"
                f" script with {path}"
            ),
            name=YADE,
        )
    places = folders()
    for folder in places:
        if os.path.isfile(os.path.join(folder, MARK)):
            sys.path.append(folder)
            return importlib.machinery.PathFinder.find_spec(YADE, [folder])
    raise ModuleNotFoundError(
        (
            f"masonry runs in YADE, which is not installed: {INSTALLED} (looked for {MARK} in"
            f" {', '.join(places)})"
        ),
        name=YADE,
    )


def install(started):
    """Add the finder; ``started()`` is called each time that YADE has been imported."""
    if not any(isinstance(finder, Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, Finder(started))


def load() -> None:
    """Import what all runs need. ``OMP_NUM_THREADS`` must be 1 before NumPy is imported, so that
    there are no threads, which copies of the process would not have."""
    importlib.import_module("masonry.scene.scene")
    exec(NAMES, {})
    if wings.isInstalled("bound"):
        wings.find("bound")
    gc.freeze()


def runScript(path: str, words: list[str]) -> int:
    """Run a script in this copy of a process, on one thread.

    :param words: of its command line
    :returns: exit status of a script that comes to its end
    """
    import numpy as np

    folder = os.path.dirname(os.path.abspath(path))
    for name, module in list(sys.modules.items()):  # the process may have run the script's own
        if os.path.dirname(getattr(module, "__file__", None) or "") == folder:
            del sys.modules[name]
    if folder not in sys.path:
        sys.path.append(folder)
    sys.argv = [path, *words]
    np.random.seed()
    importlib.import_module(ASSEMBLY + "threads").limit(1)
    main = sys.modules["__main__"] = types.ModuleType("__main__")
    main.__dict__.update(__file__=path, __builtins__=builtins)
    exec(NAMES, main.__dict__)
    with open(path, "rb") as file:
        exec(compile(file.read(), path, "exec"), main.__dict__)
    return 0
