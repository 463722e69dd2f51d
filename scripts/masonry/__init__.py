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

``help()`` of its rooms leads on, and each of them names its modules:

- :mod:`masonry.scene`: ``Scene``, its platens, loads, records and stages; materials, random fields, histories, options
- :mod:`masonry.bricks`: walls, openings, bonds, corners, arches, vaults, blocks from files
- :mod:`masonry.study`: one scene, run many times with values that vary
- :mod:`masonry.limit`: limit analysis, the bound beside every run
- :mod:`masonry.read`: what reads the files of a run: numbers, figures, pictures by ParaView
- :mod:`masonry.run`: a run: checkpoints, results, presets, rows of a table
- :mod:`masonry.assembly`: ``addBlock``, ``engines``, ``connect``, for scenes that are built body by body; the 3-D view
- :mod:`masonry.folders`: what is written in folders that others may have packed, and how
- :mod:`masonry.memory`: what numerical libraries take of the memory
- :mod:`masonry.packages`: libraries that come when they are first needed, and the Debian packages that have them
- :mod:`masonry.arguments`: how every word checks what it is given
- :mod:`masonry.basics`: gravity, how a run can end before its time, what is said on the terminal

``masonry.read``, ``masonry.study``, ``masonry.bricks`` and what they import work without YADE.

Import it from a YADE script (or after ``import yade``). The classes that it registers in YADE (``masonry.classes``) are
also in ``yade.wrapper``; their manual is ``help(masonry.MasonryJoint)``, ``help(masonry.MasonryMat)`` and so on, after
``import masonry``.
"""

import sys

# "python3 -m masonry.read.figures" searches the present folder first, and would run a file csv.py or token.py that lies
# there.
if sys.argv[:1] == ["-m"] and not sys.flags.safe_path:
    del sys.path[0]

import importlib
import os
from typing import TYPE_CHECKING

# YADE does not search the folder of its script for modules. It comes last, so that nothing in it hides another module.
if hasattr(sys, "yade_argv") and sys.argv and os.path.isfile(sys.argv[0]):
    sys.path.append(os.path.dirname(os.path.abspath(sys.argv[0])))

#: The version of the project, which the plugin, run.json, checkpoints and the Debian package have from this line.
__version__ = "3.0.0"

#: Modules and packages that the package hands on under a short name; they are loaded when they are used first.
_HANDED_ON = {
    "bricks": "bricks",
    "fields": "scene.fields",
    "limit": "limit",
    "materials": "scene.materials",
    "study": "study",
    "window": "assembly.window",
}


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
        MasonryEnergy,
        MasonryIntegrator,
        MasonryJoint,
        MasonryJointGeom,
        MasonryJointLoop,
        MasonryJointPhys,
        MasonryLoad,
        MasonryMat,
        MasonryVtkRecorder,
        MasonryZones,
    )

    from . import bricks, limit, study
    from .assembly import window
    from .scene import fields, materials
else:

    def __getattr__(name):
        if name in _HANDED_ON:
            return importlib.import_module(f"{__name__}.{_HANDED_ON[name]}")
        raise AttributeError(f"module 'masonry' has no attribute {name!r}")


def __dir__():
    return sorted({*globals(), *_HANDED_ON})


if "yade" in sys.modules:
    from . import memory
    from .basics import say as _say

    def _end(text):
        _say(text, sys.stderr)
        raise SystemExit(1)

    try:
        from ._masonry import classes, commit, criticalTimeStep
    except ImportError as error:
        if "failed to map" in str(error):
            _end(memory.FULL)
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
    try:
        memory.reserve()
    except MemoryError as _error:
        _end(_error)
    from .assembly import given, ports, threads
    from .scene import options
    from .run.checkpoints import loadCheckpoint, readCheckpoint, saveCheckpoint
    from .assembly.blocks import addBlock
    from .assembly.connecting import connect, touchingPairs
    from .assembly.engines import advance, engine, engines
    from .scene.ground import rayleigh
    from .scene.scene import Scene
    from .scene.stages import AT_REST, COLLAPSED, DONE, MOVING

    ports.close()
    threads.limit()
