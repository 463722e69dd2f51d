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

import importlib
from typing import TYPE_CHECKING

#: Public names with the module that has them, loaded when they are used first: fields and settings
#: need no YADE.
_NAMES = {
    "linesOf": "assumptions",
    "en1996": "codes",
    "ntc2018": "codes",
    "compressiveFractureEnergy": "formulas",
    "leastEnergy": "formulas",
    "masonry": "formulas",
    "Masonry": "kinds",
    "MasonryJoint": "kinds",
    "MasonryMat": "kinds",
    "withResidual": "kinds",
    "DRY_GRANITE_MASONRY": "sources",
    "calciumSilicate": "sources",
    "calciumSilicateJoints": "sources",
    "calciumSilicateUnit": "sources",
    "dry": "sources",
    "dryGranite": "sources",
    "dryGraniteJoints": "sources",
    "graniteUnit": "sources",
    "loadingBlock": "sources",
}
__all__ = [*_NAMES]


if TYPE_CHECKING:
    from yade.wrapper import MasonryJoint, MasonryMat

    from .assumptions import linesOf
    from .codes import en1996, ntc2018
    from .formulas import compressiveFractureEnergy, leastEnergy, masonry
    from .kinds import Masonry, withResidual
    from .sources import DRY_GRANITE_MASONRY, calciumSilicate, calciumSilicateJoints
    from .sources import calciumSilicateUnit, dry, dryGranite, dryGraniteJoints
    from .sources import graniteUnit, loadingBlock
else:

    def __getattr__(name):
        if name not in _NAMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        found = getattr(importlib.import_module(f"{__name__}.{_NAMES[name]}"), name)
        return globals().setdefault(name, found)


def __dir__():
    return sorted({*globals(), *__all__})
