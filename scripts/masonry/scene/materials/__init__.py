# SPDX-License-Identifier: GPL-2.0-or-later
"""Bricks and joints of a structure.

- :class:`Masonry`: bricks and joints of one's own, property by property
- :func:`masonry`: the same from what a data sheet and a test of the masonry say
- :func:`en1996`, :func:`ntc2018`: arguments for it from classes of units and mortar, by a code
- :func:`dry`: stones with dry joints that do not crush
- :func:`calciumSilicate`, :func:`dryGranite`: published parameter sets. Each names its source, and
  what is assumed

What was assumed because it was not given is printed once, and stands in run.json under ``assumed``.

The paper: see yade_plugin/law/README.md.
"""

from yade.wrapper import MasonryJoint, MasonryMat

from .assumptions import linesOf
from .codes import en1996, ntc2018
from .formulas import compressiveFractureEnergy, leastEnergy, masonry
from .kinds import Masonry, withResidual
from .published import DRY_GRANITE_MASONRY, calciumSilicate, calciumSilicateJoints
from .published import calciumSilicateUnit, dry, dryGranite, dryGraniteJoints
from .published import graniteUnit, loadingBlock

__all__ = """
    DRY_GRANITE_MASONRY Masonry MasonryJoint MasonryMat calciumSilicate
    calciumSilicateJoints calciumSilicateUnit compressiveFractureEnergy dry dryGranite
    dryGraniteJoints en1996 graniteUnit leastEnergy linesOf loadingBlock masonry ntc2018
    withResidual
""".split()
