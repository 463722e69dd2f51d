# SPDX-License-Identifier: GPL-2.0-or-later
"""Masonry for YADE: joint laws on convex blocks.

A scene of one's own is bricks, materials and stages::

    from masonry import Scene, bricks, materials

    scene = Scene("pier", bricks.Wall(length=1.1, height=1.62), materials.calciumSilicate())
    base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
    scene.press(top, 0.3e6)          # [Pa]
    scene.settle()
    scene.push(top, 10)              # [mm]
    scene.finish()

``help()`` of its rooms names their modules:

- :mod:`masonry.bricks`: walls, openings, bonds, corners, arches, vaults, blocks from files
- :mod:`masonry.earth`: pressure of soil on a face
- :mod:`masonry.materials`: masonry of one's own, published parameter sets, random fields
- :mod:`masonry.scene`: ``Scene``, its platens, loads, records, options; :mod:`masonry.stages`: the
  stages of a test
- :mod:`masonry.run`: checkpoints, results, presets, rows of a table
- :mod:`masonry.numbers`: numbers of a run from its files
- :mod:`masonry.model`: ``addBlock``, ``engines``, ``connect``, for scenes that are built body by
  body; the 3-D view

Beside it lie four packages, the wings (:mod:`masonry.wings`):

- :mod:`masonry_view`: figures, report, the structure in 3-D
- :mod:`masonry_limit`: limit analysis, the bound beside every run
- :mod:`masonry_capacity`: bilinear curves, the demand of an earthquake, N-V domains
- :mod:`masonry_study`: one scene, run many times with values that vary

``masonry.numbers``, ``masonry.bricks``, and the wings but for ``masonry_limit`` work without YADE.
Import it from a script of ``yade``, of plain Python or from a notebook: YADE starts when something
needs it (:mod:`masonry.host`). The classes of the plugin (``masonry.classes``) are also in
``yade.wrapper``; ``help(masonry.MasonryJoint)`` and so on is their manual.
"""

import sys

# "python3 -m masonry_view.figures" would run a file csv.py or token.py of the present folder.
if sys.argv[:1] == ["-m"] and not sys.flags.safe_path:
    del sys.path[0]

import contextlib
import glob
import importlib
import importlib.util
import os
from typing import TYPE_CHECKING

# YADE ends without it, and cron jobs and containers may have none.
os.environ.setdefault("HOME", os.path.expanduser("~"))

# YADE does not search the folder of its script, which comes last so that it hides no module.
if hasattr(sys, "yade_argv") and sys.argv and os.path.isfile(sys.argv[0]):
    sys.path.append(os.path.dirname(os.path.abspath(sys.argv[0])))


def _hasPlugin(folder):
    return bool(glob.glob(os.path.join(glob.escape(folder), "_masonry*.so")))


# In plain Python the folder of a script comes first. Beside scripts of a clone lie its sources,
# which have no plugin: then the installed package is used, as in YADE.
if not _hasPlugin(__path__[0]):
    _others = (os.path.join(_entry, "masonry") for _entry in sys.path)
    __path__[:0] = [_folder for _folder in _others if _hasPlugin(_folder)][:1]

#: The version of the plugin, run.json, checkpoints and the Debian package.
__version__ = "3.0.0"

#: Short names of modules, and of what is in modules, which are loaded when they are first used.
_MODULES = {
    "bricks": "bricks",
    "fields": "materials.fields",
    "materials": "materials",
    "options": "scene.options",
    "window": "model.window",
}
_NAMES = {
    "AT_REST": "stages",
    "COLLAPSED": "stages",
    "DONE": "stages",
    "MOVING": "stages",
    "Scene": "scene.scene",
    "addBlock": "model.bodies",
    "advance": "model.engines",
    "connect": "model.connecting",
    "engine": "model.engines",
    "engines": "model.engines",
    "loadCheckpoint": "run.checkpoints",
    "rayleigh": "scene.ground",
    "readCheckpoint": "run.checkpoints",
    "saveCheckpoint": "run.checkpoints",
    "touchingPairs": "model.connecting",
}
#: What a registered plugin has beside its classes.
_OF_PLUGIN = ["classes", "commit", "criticalTimeStep"]
#: Rooms and modules of this package that work without YADE.
_WITHOUT_YADE = """
    arguments background bricks earth errors fields folders host materials memory moved notebook
    numbers packages terminal texts units wings
""".split()


if TYPE_CHECKING:  # what is loaded later, for those that check types
    from yade.wrapper import (
        Gl1_MasonryBlock,
        Gl1_MasonryJointPhys,
        GlExtra_MasonryLegend,
        Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom,
        Ig2_MasonryBlock_Polyhedra_MasonryJointGeom,
        Ig2_Polyhedra_Polyhedra_MasonryJointGeom,
        Ip2_MasonryMat_MasonryMat_MasonryJointPhys,
        Law2_MasonryJointGeom_MasonryJointPhys_CyclicSoftening,
        Law2_MasonryJointGeom_MasonryJointPhys_PiecewiseSoftening,
        MasonryBlock,
        MasonryContacts,
        MasonryEnergy,
        MasonryIntegrator,
        MasonryJoint,
        MasonryJointGeom,
        MasonryJointLoop,
        MasonryJointPhys,
        MasonryLoad,
        MasonryMat,
        MasonrySprings,
        MasonryTies,
        MasonryVtkRecorder,
        MasonryZones,
    )

    from . import bricks
    from ._masonry import classes, commit, criticalTimeStep
    from . import materials
    from .materials import fields
    from .model import window
    from .model.bodies import addBlock
    from .model.connecting import connect, touchingPairs
    from .model.engines import advance, engine, engines
    from .run.checkpoints import loadCheckpoint, readCheckpoint, saveCheckpoint
    from .scene import options
    from .scene.ground import rayleigh
    from .scene.scene import Scene
    from .stages import AT_REST, COLLAPSED, DONE, MOVING
else:

    def __getattr__(name):
        if name.startswith("_") and name != "__all__":
            raise AttributeError(f"module 'masonry' has no attribute {name!r}")
        if name not in _WITHOUT_YADE:
            _start()
        if name == "__all__":
            return sorted({*_MODULES, *_NAMES, *_OF_PLUGIN, *globals()["classes"]})
        if name in _NAMES:
            found = getattr(importlib.import_module(f"{__name__}.{_NAMES[name]}"), name)
            return globals().setdefault(name, found)
        if name in globals():
            return globals()[name]
        module = f"{__name__}.{_MODULES.get(name, name)}"
        if name in _MODULES or importlib.util.find_spec(module):
            return importlib.import_module(module)
        raise AttributeError(f"module 'masonry' has no attribute {name!r}")


def __dir__():
    return sorted({*globals(), *_MODULES, *_NAMES})


def _start():
    importlib.import_module("yade")
    if _OF_PLUGIN[0] not in globals():
        _register()


def _register():
    from . import memory
    from .terminal import say

    def end(text):
        say(text, sys.stderr)
        raise SystemExit(1)

    try:
        from . import _masonry
    except ImportError as error:
        if not any(map(_hasPlugin, __path__)):
            raise ImportError(
                f"the masonry plugin is not built for {sys.executable}: bash scripts/setup.sh"
                " builds and installs it"
            ) from None
        if "failed to map" in str(error):
            end(memory.FULL)
        if "undefined symbol" not in str(error):
            raise
        from yade.config import suffix, version
        from yade.math import getDigits10

        raise ImportError(
            f"yade{suffix} {version}, of {getDigits10(1)} digits, does not fit the masonry plugin,"
            " built for another one, of 15 (bash scripts/setup.sh builds it for the YADE of this"
            f" machine): {error}"
        ) from None
    import yade.wrapper

    own = globals()
    own.update({name: getattr(yade.wrapper, name) for name in _masonry.classes})
    try:
        memory.reserve()
    except MemoryError as error:
        end(error)
    from .model import ports, threads

    ports.close()
    threads.limit()
    own.update({name: getattr(_masonry, name) for name in _OF_PLUGIN})


def _started():
    """Register the plugin after an import of YADE. The error of one that does not fit comes when
    it is used."""
    with contextlib.suppress(ImportError):
        _register()


from . import moved

moved.install()
if "yade" in sys.modules:
    _register()
else:
    from . import host

    host.install(_started)
