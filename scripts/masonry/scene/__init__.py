# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene: what is built, how it is held and loaded, what is recorded, and what comes out.

- :mod:`masonry.scene.scene`: ``Scene``
- :mod:`masonry.scene.description`: what a scene describes, by the commands of
  :mod:`masonry.scene.platens`, :mod:`masonry.scene.loads`, :mod:`masonry.scene.connections` and
  :mod:`masonry.scene.records`
- :mod:`masonry.scene.targets`: what is recorded;
  :mod:`masonry.scene.ties`: ties, springs and fibre layers; :mod:`masonry.scene.pressures`:
  pressures as forces on faces; :mod:`masonry.scene.contact`: what blocks do that have lost their
  joints
- :mod:`masonry.scene.history`: displacements there and back; :mod:`masonry.scene.ground`: ground
  motion and Rayleigh damping; :mod:`masonry.scene.accelerograms`: files of records
- :mod:`masonry.scene.options`: the options of the command line, which :mod:`masonry.scene.parsing`
  reads, with those that the script gives to ``Scene``
- :mod:`masonry.scene.outcome`: what comes out, and what curve.png shows;
  :mod:`masonry.scene.summary`: what a scene is, in words
- :mod:`masonry.scene.script`: the commands of a script, as data; :mod:`masonry.scene.resuming`:
  what a resumed run finds in place of the stages that were over
- :mod:`masonry.scene.compas_problems`: problems of compas_dem as bricks, masonry, supports and
  loads; :mod:`masonry.scene.compas_results`: their results
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .scene import Scene
else:

    def __getattr__(name):
        if name == "Scene":
            return importlib.import_module(f"{__name__}.scene").Scene
        raise AttributeError(f"module 'masonry.scene' has no attribute {name!r}")
