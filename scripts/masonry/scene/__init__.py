# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene: what is built, how it is held and loaded, and the stages of its test.

- :mod:`masonry.scene.scene`: ``Scene``
- :mod:`masonry.scene.description`: what a scene describes, by the words of
  :mod:`masonry.scene.supports`,
  :mod:`masonry.scene.loads`, :mod:`masonry.scene.connections` and :mod:`masonry.scene.records`;
  :mod:`masonry.scene.pressures`: pressures as forces on faces;
  :mod:`masonry.scene.targets`, :mod:`masonry.scene.sections`: what is recorded;
  :mod:`masonry.scene.ties`: ties, springs and fibre layers
- :mod:`masonry.scene.stages`: the stages of a test; :mod:`masonry.scene.contact`: what blocks do
  that have lost their joints
- :mod:`masonry.scene.materials`: masonry of one's own, published parameter sets, properties that
  vary from place to place, and what of all this was assumed
- :mod:`masonry.scene.fields`: random fields; :mod:`masonry.scene.history`: displacements there and
  back;
  :mod:`masonry.scene.ground`: ground motion and Rayleigh damping;
      :mod:`masonry.scene.accelerograms`: files of records;
  :mod:`masonry.scene.spectrum`: spectral acceleration
- :mod:`masonry.scene.options`: the options of the command line, which :mod:`masonry.scene.parsing`
  reads, with those that the script gives to ``Scene``; :mod:`masonry.scene.settings`: ``--set``
- :mod:`masonry.scene.bounds`: limit analysis beside a run, with :mod:`masonry.scene.limit_loads`;
  :mod:`masonry.scene.bounding`: the commands that ask for it
- :mod:`masonry.scene.outcome`: what comes out, and what curve.png shows;
  :mod:`masonry.scene.drawing_program`: the program that draws it; :mod:`masonry.scene.facts`: what
  a scene is, in words and in a notebook, and its curve as arrays
- :mod:`masonry.scene.words`: the words of a script, as data; :mod:`masonry.scene.resuming`: what a
  resumed run finds in place of the stages that were over
- :mod:`masonry.scene.probing`: what a study must know of a scene
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
