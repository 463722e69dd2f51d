# SPDX-License-Identifier: GPL-2.0-or-later
"""Scripts in copies of a process that has imported YADE and the core: their start costs nothing,
and their results are those of processes of their own."""

import builtins
import gc
import importlib
import os
import sys
import types

#: What a script of the program ``yade`` finds in its names.
NAMES = """
import os, sys, time, yade
from yade import geom, pack, utils
from yade.utils import *
from yade.pack import *
from math import *
"""


def load() -> None:
    """Import what runs need, and take it out of the search for unused objects. The process must
    have no other threads: ``OMP_NUM_THREADS=1`` before it imports numpy."""
    import masonry
    from .. import wings

    masonry.Scene
    exec(NAMES, {})
    if wings.isInstalled("bound"):
        wings.find("bound")
    gc.freeze()


def runScript(path: str, words: list[str]) -> int:
    """Run a script in this :class:`masonry.background.Program`, on one thread, with the words of
    its command line. Returns the exit status."""
    import numpy as np

    from ..model import threads

    folder = os.path.dirname(os.path.abspath(path))
    for name, module in list(sys.modules.items()):  # what the process has run of the script's own
        if os.path.dirname(getattr(module, "__file__", None) or "") == folder:
            del sys.modules[name]
    if folder not in sys.path:
        sys.path.append(folder)
    sys.argv = [path, *words]
    np.random.seed()
    threads.limit(1)
    main = sys.modules["__main__"] = types.ModuleType("__main__")
    main.__dict__.update(__file__=path, __builtins__=builtins)
    exec(NAMES, main.__dict__)
    with open(path, "rb") as file:
        exec(compile(file.read(), path, "exec"), main.__dict__)
    return 0
