"""Masonry for YADE: joint laws on convex blocks.

A scene of one's own is bricks, materials and stages::

    from masonry import Scene, bricks, materials

    scene = Scene("pier", bricks.Wall(length=1.1, height=1.62), materials.calciumSilicate())
    base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
    scene.press(top, 0.3e6)          # [Pa]
    scene.settle()
    scene.push(top, 10)              # [mm]
    scene.finish()

``help()`` of these leads on:

- :mod:`masonry.stages`: ``Scene``, its platens, loads, stages and records
- :mod:`masonry.bricks`: walls, openings, bonds, corners, arches, vaults, blocks from files
- :mod:`masonry.materials`: published parameter sets, and properties that vary from place to place
- :mod:`masonry.scene`: ``addBlock``, ``engines``, ``connect``, for scenes that are built body by body
- :mod:`masonry.window`: the scene in YADE's own 3-D view while it runs
- :mod:`masonry.limit`: limit analysis, the bound beside every run
- :mod:`masonry.study`: one scene, run many times with values that vary
- :mod:`masonry.results`, :mod:`masonry.figures`, :mod:`masonry.measure`, :mod:`masonry.loops`: what a run leaves, and
  how to read it; these, :mod:`masonry.study`, :mod:`masonry.bricks` and :mod:`masonry.presets` work without YADE

Import it from a YADE script (or after ``import yade``). The classes that it registers in YADE (``masonry.classes``) are
also in ``yade.wrapper``; ``help(MasonryJoint)`` and the others are their manual.
"""

import sys

# "python3 -m masonry.figures" searches the present folder first, and would run a file csv.py or token.py that lies there.
if sys.argv[:1] == ["-m"] and not sys.flags.safe_path:
    del sys.path[0]

import importlib

#: The version of the project, which the plugin, run.json, checkpoints and the Debian package have from this line.
__version__ = "3.0.0"

#: Modules that are loaded when they are used first.
_MODULES = (
    "batch bounds bricks checkpoints columns comparison curves described errors fields figures frames ground history "
    "limit loading loops materials measure model options plotting ports presets probing progress results run scene "
    "stages structure study viewer window"
).split()


def __getattr__(name):
    if name in _MODULES:
        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module 'masonry' has no attribute {name!r}")


def __dir__():
    return sorted({*globals(), *_MODULES})


if "yade" in sys.modules:
    try:
        from ._masonry import classes, commit, criticalTimeStep, touchingPairs
    except ImportError as error:
        if "undefined symbol" not in str(error):
            raise
        from yade.config import version as _version

        raise ImportError(
            f"this YADE ({_version}) does not fit the masonry plugin, which was built for another one: expected a "
            "function or table, found none (bash scripts/setup.sh builds it for the YADE of this machine): "
            + str(error)
        ) from None
    import yade.wrapper as _wrapper

    globals().update({_name: getattr(_wrapper, _name) for _name in classes})
    from . import options, ports
    from .checkpoints import loadCheckpoint, readCheckpoint, saveCheckpoint
    from .scene import addBlock, advance, connect, engine, engines
    from .ground import rayleigh
    from .stages import AT_REST, COLLAPSED, DONE, MOVING, Scene

    ports.close()
