# SPDX-License-Identifier: GPL-2.0-or-later
"""Bricks of any structure as plain records, without YADE.

A :class:`Bricks` is an immutable collection of :class:`Block` records: convex blocks that meet face
to face. These functions make one, and raise ValueError with all problems at once:

- :func:`Wall`: running, stack, header, English and Flemish bond, with :class:`Opening` and
  :class:`Lintel`;
- :func:`Corner`, :func:`Tee` and :func:`Room`: walls that meet, with interlocking courses;
- :class:`House`: storeys of four walls with floors and ring beams, from :class:`Storey`;
- :func:`StoneWall`: squared or irregular stones, whose interlocking :func:`leastTrace` measures;
- :func:`Arch`, :func:`BarrelVault`, :func:`CrossVault` and :func:`Dome`, from voussoirs;
- :func:`Beam` and :func:`Floor`: beams that bend and floors that shear, in pieces;
- :func:`stack` and :func:`block`: boxes;
- :func:`fromFile`: one block for each convex solid of a file; :func:`readCompas`: what a file of
  COMPAS says beside them;
- :func:`fromOutlines`: stones of a drawing, with mortar between them.

Collections are added with ``+``, moved, turned, named, cut by planes, and chosen from. Their
``problems()`` are gaps, overlaps, slivers, loose parts and joints of odd size::

    from masonry.bricks import Arch, Lintel, Opening, Wall, block

    lintel = Lintel(bearing=0.22, height=0.162)
    wall = Wall(3.08, 2.43, openings=[Opening(0.99, 0.81, 0.99, 0.81, lintel)])
    scene = wall + block((0, 0, -0.2), (3.08, 0.102, 0)).named("base")
    assert not scene.problems()

Lengths are in m and angles in degrees. Lengths of a unit contain its joint; with ``joint``, the
thickness of the mortar, ``unit`` is the brick without it.
"""

from ..packages import promised

promised("scipy")  # imported for convex solids that are no boxes

from .beams import Beam, Floor
from .blocks import Block, Bricks, summary
from .checks import Joint
from .block_files import fromFile
from .compas_files import readCompas
from .geometry import boxCorners
from .houses import House, Storey
from .openings import Lintel, Opening
from .stones.outlines import fromOutlines
from .stones.stone_wall import StoneWall, leastTrace
from .vaults import Arch, BarrelVault, CrossVault, Dome
from .walls import Corner, Room, Tee, Wall, block, stack

__all__ = [
    "Arch",
    "BarrelVault",
    "Beam",
    "Block",
    "Bricks",
    "Corner",
    "CrossVault",
    "Dome",
    "Floor",
    "House",
    "Joint",
    "Lintel",
    "Opening",
    "Room",
    "StoneWall",
    "Storey",
    "Tee",
    "Wall",
    "block",
    "boxCorners",
    "fromFile",
    "fromOutlines",
    "leastTrace",
    "readCompas",
    "stack",
    "summary",
]
