# SPDX-License-Identifier: GPL-2.0-or-later
"""Bricks while a wall is laid, the openings that are cut out of it, and the blocks that come of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from ..common.arguments import isA, validated
from ..basics import withoutCollector
from .blocks import Block, Bricks, Gap, Length, refuse
from .checks import components, where
from .geometry import boxCorners

#: Lengths are whole units if they are by this share of a quarter unit.
WHOLE = 1e-6


@validated
@dataclass(frozen=True)
class Lintel:
    """One block over an opening.

    :param bearing: how far it lies on the wall on each side of the opening [m]
    :param height: [m]
    """

    bearing: Length
    height: Length


@validated
@dataclass(frozen=True)
class Opening:
    """A rectangular hole through a wall. Bricks inside are left out, those at its edge are cut.

    :param x: distance of its left edge from the start of the wall [m]
    :param z: height of its lower edge above the foot of the wall [m]; 0: a door
    :param width: [m]
    :param height: [m]
    :param lintel: :class:`Lintel`; None: none
    """

    x: Gap
    z: Gap
    width: Length
    height: Length
    lintel: Annotated[Lintel, isA(Lintel)] | None = None


@dataclass(frozen=True)
class LaidBrick:
    """A brick or a cut one while a wall is laid: a box, and where it is in two halves."""

    low: tuple
    high: tuple
    course: int
    part: str
    split: tuple | None = None  # (axis, coordinate)
    number: int = -1
    cut: bool = False  # whether an opening has cut it


# -- openings ---------------------------------------------------------------------------------------------------------


def numbered(bricks):
    return [replace(brick, number=n) for n, brick in enumerate(bricks)]


def opened(bricks, openings, unit, levels, ends, ys, part, crossed=None):
    """The bricks that openings leave, and the lintels over these.

    :param bricks: a number each
    :param ends: from where to where openings may be [m]
    """
    if not openings:
        return bricks, []
    problems = []
    holes, lintels = _holes(openings, unit, levels, ends, crossed, problems)
    refuse(part, problems)
    for _, hole in holes + lintels:  # lintels take the place of bricks, too
        bricks = _without(bricks, hole)
    slivers = _slivers(bricks, holes + lintels, unit, levels)
    refuse(part, slivers)
    made = []
    for n, (name, (x0, z0, x1, z1)) in enumerate(lintels):
        course = max(c for c, z in enumerate(levels[:-1]) if z <= z0)
        number = max((b.number for b in bricks), default=-1) + 1 + n
        box = (x0, ys[0], z0), (x1, ys[1], z1)
        made.append(LaidBrick(*box, course, part, None, number, None))
    _whole(bricks + made, part)
    return bricks, made


def _holes(openings, unit, levels, ends, crossed, problems):
    """Boxes (x0, z0, x1, z1) of openings and of lintels, each with its name."""
    top, q = levels[-1], unit[0] / 4

    def alongWall(x):
        """A place on the lattice of quarter units, if it is there but for round-off."""
        near = round(x / q) * q
        near = min([near, *ends], key=lambda line: abs(line - x))
        return near if abs(near - x) <= WHOLE * unit[0] else x

    def upWall(z):
        near = min(levels, key=lambda level: abs(level - z))
        return near if abs(near - z) <= WHOLE * unit[2] else z

    holes, lintels = [], []
    for n, opening in enumerate(openings):
        name = f"opening {n}"
        lintel = opening.lintel
        x0, x1 = alongWall(opening.x), alongWall(opening.x + opening.width)
        z0, z1 = upWall(opening.z), upWall(opening.z + opening.height)
        if x0 < ends[0] or x1 > ends[1]:
            problems.append(
                f"{name} reaches from x = {x0:g} to {x1:g} m, off the wall, where it may be from {ends[0]:g} to {ends[1]:g} m"
            )
        if z1 > top:
            problems.append(f"{name} reaches up to {z1:g} m, off the wall of {top:g} m")
        if x0 <= ends[0] and x1 >= ends[1]:
            problems.append(f"{name} is as wide as the wall and cuts it in two")
        holes.append((name, (x0, z0, x1, z1)))
        if lintel is not None:
            a, b = alongWall(x0 - lintel.bearing), alongWall(x1 + lintel.bearing)
            z2 = upWall(z1 + lintel.height)
            if a < ends[0] or b > ends[1]:
                problems.append(
                    f"{name}: its lintel bears from x = {a:g} to {b:g} m, off the wall, where it may be from {ends[0]:g} to "
                    f"{ends[1]:g} m"
                )
            if z2 > top:
                problems.append(
                    f"{name}: its lintel reaches up to {z2:g} m, off the wall of {top:g} m"
                )
            lintels.append((f"the lintel of {name}", (a, z1, b, z2)))
    boxes = holes + lintels
    for n, (name, box) in enumerate(boxes):
        for other, second in boxes[:n]:
            if _overlap(box, second):
                problems.append(f"{other} and {name} overlap")
        if crossed and box[0] < crossed[1] and box[2] > crossed[0]:
            problems.append(
                f"{name} reaches into the junction, from x = {crossed[0]:g} to {crossed[1]:g} m"
            )
    return holes, lintels


def _overlap(a, b):
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def _without(bricks, hole):
    """The bricks outside a hole. A brick at its edge is cut; what is left of it in an L is two or more pieces of it."""
    x0, z0, x1, z1 = hole
    found, spare = [], max(b.number for b in bricks) + 1 if bricks else 0
    for brick in bricks:
        (a, ya, c), (b, yb, d) = brick.low, brick.high
        if not _overlap((a, c, b, d), hole):
            found.append(brick)
            continue
        low, high = max(c, z0), min(d, z1)
        beds = [(a, c, b, z0)] if c < z0 else []
        beds += [(a, z1, b, d)] if d > z1 else []
        sides = [(a, low, x0, high)] if a < x0 else []
        sides += [(x1, low, b, high)] if b > x1 else []
        # Beds and sides touch. Two beds alone, or two sides alone, are apart, and bricks of their own.
        for n, (p, r, s, t) in enumerate(beds + sides):
            number = brick.number
            if n and not (beds and sides):
                number, spare = spare, spare + 1
            box = dict(low=(p, ya, r), high=(s, yb, t), split=None)
            found.append(replace(brick, **box, number=number, cut=True))
    return found


def _slivers(bricks, holes, unit, levels):
    """Sentences about pieces of bricks, cut by openings or lintels, that are shorter or lower than a quarter."""
    slivers = []
    for brick in bricks:
        if not brick.cut:
            continue
        length = brick.high[0] - brick.low[0]
        height = brick.high[2] - brick.low[2]
        least = unit[0] / 4, (levels[brick.course + 1] - levels[brick.course]) / 4
        if length >= least[0] * (1 - WHOLE) and height >= least[1] * (1 - WHOLE):
            continue
        box = brick.low[0], brick.low[2], brick.high[0], brick.high[2]
        name = next((name for name, hole in holes if _touch(box, hole)), "an opening")
        long = length < least[0] * (1 - WHOLE)
        size = f"{length:.3g} m long" if long else f"{height:.3g} m high"
        bound = f"{least[0]:.3g} m" if long else f"{least[1]:.3g} m"
        middle = [(p + q) / 2 for p, q in zip(brick.low, brick.high)]
        slivers.append(
            f"{name} leaves a sliver of brick {brick.number} in course {brick.course}, {size}, at {where(middle)}; a piece "
            f"must have a quarter of the unit, {bound}"
        )
    if slivers:
        slivers[
            -1
        ] += f" (edges at multiples of {unit[0] / 4:g} m along the wall, and at bed joints, leave no slivers)"
    return slivers


def _touch(a, b):
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


def _whole(bricks, part):
    """Refuse a wall of which openings have cut something off."""
    boxes = Bricks(_blocks(replace(b, split=None) for b in bricks))  # halves hold
    parts = components(len(boxes), boxes.joints())
    loose = sorted({b.brick for b, p in zip(boxes, parts) if p != parts[0]})
    if not len(boxes):
        raise ValueError(f"{part}: its openings leave nothing of it")
    if loose:
        first = next(b for b, p in zip(boxes, parts) if p != parts[0])
        raise ValueError(
            f"{part}: its openings cut it in parts: {len(loose)} bricks, such as brick {first.brick} at "
            f"{where(first.middle)}, have no joint with the rest"
        )


# -- records ----------------------------------------------------------------------------------------------------------


def _blocks(bricks):
    """The blocks of the bricks, in their order. A lintel is what has no mark whether it is cut."""
    for brick in bricks:
        kind = "lintel" if brick.cut is None else "brick"
        pieces = [(brick.low, brick.high)]
        if brick.split:
            axis, at = brick.split
            middleHigh, middleLow = list(brick.high), list(brick.low)
            middleHigh[axis] = middleLow[axis] = at
            pieces = [(brick.low, tuple(middleHigh)), (tuple(middleLow), brick.high)]
        for low, high in pieces:
            number = brick.number if brick.number >= 0 else 0
            yield Block(boxCorners(low, high), number, brick.part, brick.course, kind)


@withoutCollector()
def finished(bricks):
    """A collection of blocks whose bricks are numbered in their order, from 0."""
    return Bricks(Bricks(_blocks(bricks))._renumbered(0))
