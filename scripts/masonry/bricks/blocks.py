# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks as plain records, and collections of them."""

from __future__ import annotations

import contextlib
import functools
import math
from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from typing import Annotated, Any, Callable, Iterable, Iterator, get_args

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

#: No corner of masonry is farther from the origin [m].
FARTHEST = 1e6

#: A length, one that may be 0, a coordinate, and a point [m].
Length = Annotated[float, number("m", 0, FARTHEST, above=True)]
Gap = Annotated[float, number("m", 0, FARTHEST)]
Coordinate = Annotated[float, number("m", -FARTHEST, FARTHEST)]
Point = Annotated[Numbers, vector("m", FARTHEST)]


def sides(value: Any, first: Any = None) -> tuple[float, ...]:
    """The kind of the length, thickness and height of a block."""
    with contextlib.suppress(TypeError, ValueError):
        length, thickness, height = map(get_args(Length)[1], items(value))
        return length, thickness, height
    raise ValueError(
        f"{shown(value)} must be a length, thickness and height above 0 and at most {FARTHEST:g} m"
    )


def corner(value: Any, first: Any = None) -> tuple[float, ...]:
    """The kind of a corner of a box, which may be infinitely far away."""
    found = items(value) or ()
    if len(found) != 3 or not all(isNumber(v) and v == v for v in found):
        raise ValueError(f"{shown(value)} must be three numbers [m]")
    return tuple(found)


Sides = Annotated[Numbers, sides]
_integer = whole(-(10**9), 10**9)

#: Kinds of blocks that every masonry has: they are of its unit unless it says otherwise.
KINDS = "brick", "lintel", "voussoir", "block"


@dataclass(frozen=True)
class Block:
    """One convex block, rigid or deformable: a brick, or a piece of one.

    :param corners: tuple of (x, y, z) [m]: all corners of the convex solid, in any order, at least
        four
    :param brick: number of the brick that it is, or is a piece of. Pieces of one brick share the
        number, and what they share is a crack surface of the brick, not a mortar joint
    :param part: name of the part of the structure, such as "wall" or "arch". Figures draw part by
        part
    :param course: number of the course, or of the voussoir, from 0; -1: none
    :param kind: one of :data:`KINDS`, or another one for which the materials have something of its
        own
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
    """An immutable collection of blocks. Whatever changes something returns a new collection.

    ``bricks[3]`` is a :class:`Block`, ``bricks[2:5]`` a collection; ``len()`` and iteration are
    those of a tuple. The sum of two collections renumbers the bricks of the second so that numbers
    stay unique.

    :param blocks: the :class:`Block` records
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
        """The blocks with bricks numbered from `first`, in the order of their first appearance."""
        numbers = {}
        for block in self._blocks:
            number = numbers.setdefault(block.brick, first + len(numbers))
            yield block if number == block.brick else replace(block, brick=number)

    # -- size --------------------------------------------------------------------------------------

    @functools.cached_property
    def low(self) -> tuple[float, ...]:
        """Lowest x, y and z of all blocks [m]."""
        return self._extreme(min, "low")

    @functools.cached_property
    def high(self) -> tuple[float, ...]:
        """Highest x, y and z of all blocks [m]."""
        return self._extreme(max, "high")

    def _extreme(self, choose, name):
        if not self._blocks:
            raise ValueError("no blocks, so no size")
        return tuple(map(choose, zip(*(getattr(b, name) for b in self._blocks))))

    @property
    def length(self) -> float:
        """Extent along x [m]."""
        return self.high[0] - self.low[0]

    @property
    def height(self) -> float:
        """Extent along z [m]."""
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
        """The blocks turned about an axis through a point, by the right-hand rule. Quarter turns
        are exact.

        :param degrees: angle [°]
        :param axis: "x", "y" or "z"
        :param about: point of the axis [m]
        """
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
        """The blocks as a part of this name."""
        return Bricks(replace(b, part=part) for b in self._blocks)

    @validated
    def ofKind(self, kind: str) -> Bricks:
        """The blocks as blocks of this kind."""
        return Bricks(replace(b, kind=kind) for b in self._blocks)

    def _mapped(self, function):
        return Bricks(replace(b, corners=tuple(map(function, b.corners))) for b in self._blocks)

    # -- choosing ----------------------------------------------------------------------------------

    @validated
    def where(self, function: Callable[[Block], bool]) -> Bricks:
        """The blocks for which a function of the :class:`Block` is true, with their numbers of
        bricks."""
        return Bricks([b for b in self._blocks if function(b)])

    @validated
    def within(self, low: Annotated[Numbers, corner], high: Annotated[Numbers, corner]) -> Bricks:
        """The blocks whose middle lies in a box, its sides included.

        :param low: opposite corners of the box [m]; ``math.inf`` is allowed
        :param high:
        """
        if not all(a <= b for a, b in zip(low, high)):
            refuse("within", [f"low corner {low} m must lie below high corner {high} m"])
        return self.where(lambda b: all(p <= x <= q for p, x, q in zip(low, b.middle, high)))

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
        """The blocks, with every one that a plane crosses cut in two. Order and numbers of bricks
        stay.

        :param point: a point of the plane [m]
        :param normal: its normal, of any length
        :param own: whether the part beyond the plane (along the normal) becomes a brick of its own,
            together with the other parts of its brick there, so that the cut is a mortar joint;
            else the parts stay pieces of one brick and the cut is a crack surface
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
        """The solids of the blocks. Refuses a purpose for which some of them are not convex."""
        problems = sorted(self._solids.problems.items())
        refuse(
            purpose, [f"block {n} of brick {self._blocks[n].brick}: {what}" for n, what in problems]
        )
        return self._solids

    def whole(self) -> Bricks:
        """The blocks with the pieces of every brick joined, where the first of them stands.

        :raises ValueError: if the pieces of a brick do not make up a convex solid
        """
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
        """Joints of all blocks that share a face: a list of :class:`masonry.bricks.Joint`.

        Two faces coincide as they do for the plugin: within 1e-4 of the diagonal of the smaller
        block.
        """
        return list(self._pairs[0])

    @validated
    def freeFaces(
        self,
        direction: Direction,
        least: Annotated[float, number("", -1, 1)] = checks.LOOKING,
    ) -> list[checks.FreePart]:
        """Faces that look in a direction, with what no joint covers of them: a list of
        :class:`masonry.bricks.checks.FreePart`.

        :param direction: three numbers, of any length
        :param least: cosine of the largest angle between direction and normal [-]; by default that
            of 45 degrees
        """
        solids = self._convex("freeFaces")
        return checks.freeParts(solids, self.joints(), direction, least)

    @functools.cached_property
    def _pairs(self):
        return checks.findJoints(self._solids)

    def problems(self) -> list[str]:
        """What is wrong with the blocks: a list of sentences, empty if nothing is.

        Each names the blocks (their numbers in this collection), the bricks, and the place:

        - a block whose corners are not those of a convex solid, or lie in one plane;
        - an overlap deeper than 1e-4 of the diagonal of the smaller block;
        - a gap between two faces that nearly coincide: within 6°, and within a quarter of the
          thinner block;
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
    """Counts and sizes of a collection of blocks: a dict with units in its names."""
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
