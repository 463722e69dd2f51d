# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks as plain records, and collections of them."""

from __future__ import annotations

import contextlib
import functools
import math
from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from typing import Annotated, Any, Callable, Iterable, Iterator, get_args

import numpy as np

from ..arguments import (
    Direction,
    Numbers,
    isA,
    items,
    isNumber,
    number,
    oneOf,
    shown,
    text,
    validated,
    vector,
    whole,
)
from .. import errors
from ..errors import firstOf
from . import checks
from .geometry import COINCIDENT, Solids, cosSin, cutCorners, joinedCorners

#: Largest distance of a corner from the origin [m].
FARTHEST = 1e6

Length = Annotated[float, number("m", 0, FARTHEST, above=True)]
Gap = Annotated[float, number("m", 0, FARTHEST)]
Coordinate = Annotated[float, number("m", -FARTHEST, FARTHEST)]
Point = Annotated[Numbers, vector("m", FARTHEST)]


def sides(value: Any, context: Any = None) -> tuple[float, ...]:
    """Validator of the length, thickness and height of a block."""
    with contextlib.suppress(TypeError, ValueError):
        length, thickness, height = map(get_args(Length)[1], items(value))
        return length, thickness, height
    raise ValueError(
        f"{shown(value)} must be a length, thickness and height above 0 and at most {FARTHEST:g} m"
    )


def corner(value: Any, context: Any = None) -> tuple[float, ...]:
    found = items(value) or ()
    if len(found) != 3 or not all(isNumber(v) and v == v for v in found):
        raise ValueError(f"{shown(value)} must be three numbers [m]")
    return tuple(found)


Sides = Annotated[Numbers, sides]
_integer = whole(-(10**9), 10**9)

#: Kinds of blocks that are of the unit of a masonry unless that says otherwise.
KINDS = "brick", "lintel", "voussoir", "block"


@dataclass(frozen=True)
class Block:
    """One convex block, rigid or deformable: a brick, or a piece of one.

    :param corners: tuple of (x, y, z) [m]: all corners of the convex solid, in any order, at least
        four
    :param brick: number of the brick. Faces between pieces of one brick are crack surfaces of it,
        not mortar joints
    :param part: name of the part of the structure, such as "wall" or "arch", as figures draw it
    :param course: number of the course, or of the voussoir, from 0; -1: none
    :param kind: one of :data:`KINDS`, or another one that the materials know
    """

    corners: tuple
    brick: int
    part: str = "wall"
    course: int = -1
    kind: str = "brick"

    def __post_init__(self):
        problems = []
        try:
            corners = tuple(map(tuple, self.corners))
        except TypeError:
            corners = ()
        if len(corners) < 4:
            problems.append(f"corners must be at least 4 points, got {shown(self.corners)}")
        for n, corner in enumerate(corners):
            fine = all(type(x) is float or isNumber(x) for x in corner)
            if len(corner) != 3 or not fine:
                problems.append(f"corner {n} must be three numbers [m], got {shown(corner)}")
            elif not all(abs(x) <= FARTHEST for x in corner):
                problems.append(
                    f"corner {n} [m] must be finite, and at most {FARTHEST:g} m from the origin,"
                    f" got {shown(corner)}"
                )
        for what in ("brick", "course", "part", "kind"):
            try:
                (_integer if what in ("brick", "course") else text)(getattr(self, what))
            except ValueError as error:
                problems.append(f"{what} {error}")
        refuse("block", problems)
        object.__setattr__(self, "corners", corners)

    @property
    def low(self) -> tuple[float, ...]:
        """Lowest x, y and z [m]."""
        return tuple(map(min, zip(*self.corners)))

    @property
    def high(self) -> tuple[float, ...]:
        """Highest x, y and z [m]."""
        return tuple(map(max, zip(*self.corners)))

    @property
    def middle(self) -> tuple[float, ...]:
        """Mean of the corners [m]."""
        return tuple(math.fsum(c) / len(self.corners) for c in zip(*self.corners))


class Bricks:
    """An immutable collection of :class:`Block` records. All changes return a new collection.

    ``bricks[3]`` is a block, ``bricks[2:5]`` a collection. A sum renumbers the bricks of the second
    collection, so that numbers stay unique.
    """

    @validated
    def __init__(
        self, blocks: Annotated[Iterable[Any], isA(Iterable, "list of blocks")] = ()
    ) -> None:
        self._blocks = tuple(blocks)
        odd = [(n, b) for n, b in enumerate(self._blocks) if not isinstance(b, Block)]
        refuse("Bricks", [f"item {n} is {shown(b)}, not a Block" for n, b in odd])

    def __len__(self) -> int:
        return len(self._blocks)

    def __iter__(self) -> Iterator[Block]:
        return iter(self._blocks)

    def __getitem__(self, key: Any) -> Any:
        found = self._blocks[key]
        return Bricks(found) if isinstance(key, slice) else found

    def __eq__(self, other):
        return isinstance(other, Bricks) and self._blocks == other._blocks

    def __hash__(self):
        return hash(self._blocks)

    def __repr__(self):
        if not self._blocks:
            return "Bricks: none"
        size = " x ".join(f"{b - a:.4g}" for a, b in zip(self.low, self.high))
        bricks = len({b.brick for b in self._blocks})
        parts = ", ".join(dict.fromkeys(b.part for b in self._blocks))
        return f"Bricks: {len(self)} blocks of {bricks} bricks ({parts}), {size} m"

    def __add__(self, other: Bricks) -> Bricks:
        if not isinstance(other, Bricks):
            return NotImplemented
        return Bricks(self._blocks + tuple(other._renumbered(self._nextBrick())))

    def __radd__(self, other):
        return self if other == 0 else NotImplemented  # so that sum() works

    def _nextBrick(self):
        return max((b.brick for b in self._blocks), default=-1) + 1

    def _renumbered(self, first):
        numbers = {}
        for block in self._blocks:
            number = numbers.setdefault(block.brick, first + len(numbers))
            yield block if number == block.brick else replace(block, brick=number)

    # -- size --------------------------------------------------------------------------------------

    @functools.cached_property
    def low(self) -> tuple[float, ...]:
        """Lowest x, y and z [m]."""
        return self._extreme(min, "low")

    @functools.cached_property
    def high(self) -> tuple[float, ...]:
        """Highest x, y and z [m]."""
        return self._extreme(max, "high")

    def _extreme(self, choose, name):
        if not self._blocks:
            raise ValueError("no blocks, so no size")
        return tuple(map(choose, zip(*(getattr(b, name) for b in self._blocks))))

    @property
    def length(self) -> float:
        """Along x [m]."""
        return self.high[0] - self.low[0]

    @property
    def height(self) -> float:
        """Along z [m]."""
        return self.high[2] - self.low[2]

    @property
    def volume(self) -> float:
        """[m³]"""
        return float(self._solids.volumes().sum())

    @functools.cached_property
    def _solids(self):
        return Solids([b.corners for b in self._blocks])

    # -- moving and naming -------------------------------------------------------------------------

    @validated
    def moved(self, dx: Coordinate = 0.0, dy: Coordinate = 0.0, dz: Coordinate = 0.0) -> Bricks:
        """The blocks moved along the axes [m]."""
        return self._mapped(lambda c: tuple(x + d for x, d in zip(c, (dx, dy, dz))))

    @validated
    def turned(
        self,
        degrees: Annotated[float, number("°", -FARTHEST, FARTHEST)],
        axis: Annotated[str, oneOf("x", "y", "z")] = "z",
        about: Point = (0, 0, 0),
    ) -> Bricks:
        """The blocks turned about an axis through a point [m] by the right-hand rule. Quarter turns
        are exact."""
        cos, sin = cosSin(degrees / 90, math.radians(degrees))
        k = "xyz".index(axis)
        i, j = (k + 1) % 3, (k + 2) % 3

        def turn(corner):
            u, v = corner[i] - about[i], corner[j] - about[j]
            new = list(corner)
            new[i], new[j] = about[i] + cos * u - sin * v, about[j] + sin * u + cos * v
            return tuple(new)

        return self._mapped(turn)

    @validated
    def named(self, part: str) -> Bricks:
        return Bricks(replace(b, part=part) for b in self._blocks)

    @validated
    def ofKind(self, kind: str) -> Bricks:
        return Bricks(replace(b, kind=kind) for b in self._blocks)

    def _mapped(self, function):
        return Bricks(replace(b, corners=tuple(map(function, b.corners))) for b in self._blocks)

    # -- choosing ----------------------------------------------------------------------------------

    @validated
    def where(self, function: Callable[[Block], bool]) -> Bricks:
        """The blocks for which a function is true."""
        return Bricks([b for b in self._blocks if function(b)])

    @validated
    def within(self, low: Annotated[Numbers, corner], high: Annotated[Numbers, corner]) -> Bricks:
        """The blocks whose middle lies in a box between two corners [m], which may be infinite."""
        if not all(a <= b for a, b in zip(low, high)):
            refuse("within", [f"low corner {low} m must lie below high corner {high} m"])
        return self.where(lambda b: all(p <= x <= q for p, x, q in zip(low, b.middle, high)))

    @validated
    def alongLine(self, begin: Point, end: Point) -> list[tuple[int, Any, float]]:
        """The blocks that have a part of a line in them or on them: triples of the number of a
        block, both ends of its part [m], and its least thickness [m].

        :param begin: of the line [m], as ``end``
        """
        solids, found = self._convex("alongLine"), []
        begin, along = np.array(begin), np.subtract(end, begin)
        length = np.linalg.norm(along)
        for n, thickness in enumerate(solids.thicknesses()):
            group, row = solids.of(n)
            width = COINCIDENT * solids.diagonal[n]
            inside = group.offsets[row] + width - group.normals[row] @ begin
            slope = group.normals[row] @ along
            enters, leaves = slope < -1e-9 * length, slope > 1e-9 * length
            low = (inside[enters] / slope[enters]).max(initial=0.0)
            high = (inside[leaves] / slope[leaves]).min(initial=1.0)
            beside = (inside[~(enters | leaves)] < 0).any()
            if not beside and (high - low) * length > 10 * width:
                ends = tuple(tuple(map(float, begin + t * along)) for t in (low, high))
                found.append((n, ends, float(thickness)))
        return found

    def top(self) -> Bricks:
        """The blocks with a face in the highest horizontal plane."""
        return self._inPlane(self.high[2])

    def bottom(self) -> Bricks:
        """The blocks with a face in the lowest horizontal plane."""
        return self._inPlane(self.low[2])

    def _inPlane(self, z):
        def hasFace(block):
            width = COINCIDENT * math.dist(block.low, block.high)
            return sum(abs(c[2] - z) <= width for c in block.corners) >= 3

        return self.where(hasFace)

    # -- cutting -----------------------------------------------------------------------------------

    @validated
    def cut(self, point: Point, normal: Direction, own: bool = False) -> Bricks:
        """The blocks, those that a plane crosses cut in two, in their order.

        :param point: of the plane [m]
        :param normal: of the plane, of any length
        :param own: whether the parts of a brick beyond the plane (along the normal) become a brick
            of their own, so that the cut is a mortar joint and not a crack surface
        """
        length = math.hypot(*normal)
        normal = tuple(n / length for n in normal)
        solids = self._convex("cut")
        blocks, beyond = [], []
        for n, block in enumerate(self._blocks):
            faces, width = solids.of(n)[0].faces, COINCIDENT * solids.diagonal[n]
            above, below = cutCorners(block.corners, faces, point, normal, width)
            for corners, far in ((below, False), (above, True)):
                if corners:
                    blocks.append(replace(block, corners=corners))
                    beyond.append(far)
        if own:
            here = {b.brick for b, far in zip(blocks, beyond) if not far}
            numbers, first = {}, self._nextBrick()
            for k, (block, far) in enumerate(zip(blocks, beyond)):
                if far and block.brick in here:
                    number = numbers.setdefault(block.brick, first + len(numbers))
                    blocks[k] = replace(block, brick=number)
        return Bricks(blocks)

    def _convex(self, purpose):
        """The solids of the blocks. Raises ValueError if some are not convex."""
        problems = sorted(self._solids.problems.items())
        refuse(
            purpose, [f"block {n} of brick {self._blocks[n].brick}: {what}" for n, what in problems]
        )
        return self._solids

    def whole(self) -> Bricks:
        """The blocks with the pieces of every brick joined, in the order of the first ones. Raises
        ValueError if pieces make up no convex solid."""
        pieces, problems, joined = defaultdict(list), [], []
        for block in self._blocks:
            pieces[block.brick].append(block)
        for number, blocks in pieces.items():
            corners = blocks[0].corners
            if len(blocks) > 1:
                corners = joinedCorners([b.corners for b in blocks])
            if corners:
                joined.append(replace(blocks[0], corners=corners))
            else:
                problems.append(
                    f"the {len(blocks)} pieces of brick {number} make up no convex solid"
                )
        refuse("whole", problems)
        return Bricks(joined)

    # -- checking ----------------------------------------------------------------------------------

    def joints(self) -> list[checks.Joint]:
        """Joints of blocks that share a face, within 1e-4 of the diagonal of the smaller block as
        for the plugin."""
        return list(self._pairs[0])

    @validated
    def freeFaces(
        self,
        direction: Direction,
        least: Annotated[float, number("", -1, 1)] = checks.LOOKING,
    ) -> list[checks.FreePart]:
        """What no joint covers of faces that look in a direction.

        :param least: cosine of the largest angle between direction and normal [-]; by default that
            of 45°
        """
        solids = self._convex("freeFaces")
        return checks.freeParts(solids, self.joints(), direction, least)

    @functools.cached_property
    def _pairs(self):
        return checks.findJoints(self._solids)

    def problems(self) -> list[str]:
        """What is wrong with the blocks: sentences with their numbers in this collection, bricks
        and places:

        - a block whose corners are not those of a convex solid;
        - an overlap deeper than 1e-4 of the diagonal of the smaller block;
        - a gap between faces that nearly coincide: within 6° and a quarter of the thinner block;
        - a sliver: thinner than a quarter of what is usual for its kind;
        - a joint of odd size: narrower than a tenth of the thinner block;
        - blocks that have no joint with the rest.
        """
        return list(self._problems)

    @functools.cached_property
    def _problems(self):
        return checks.findProblems(self._blocks, self._solids, *self._pairs)


@validated
def summary(bricks: Annotated[Bricks, isA(Bricks)]) -> dict[str, Any]:
    """Counts and sizes of a collection, with units in the names."""
    count = lambda what: dict(Counter(getattr(b, what) for b in bricks))
    return dict(
        blocks=len(bricks),
        bricks=len({b.brick for b in bricks}),
        courses=len({b.course for b in bricks if b.course >= 0}),
        parts=count("part"),
        kinds=count("kind"),
        volume_m3=bricks.volume,
        low_m=bricks.low if len(bricks) else None,
        high_m=bricks.high if len(bricks) else None,
    )


# -- what the generators share ---------------------------------------------------------------------


def refuse(what: str, problems: list[str]) -> None:
    """Raise ValueError with the first problems of a list, if there are any."""
    errors.refuse(firstOf(problems), f"{what}: ", "; ")
