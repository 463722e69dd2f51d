# SPDX-License-Identifier: GPL-2.0-or-later
"""Bricks while a wall is laid, openings in it, and its blocks."""

from dataclasses import dataclass, replace
from typing import Annotated

from ..arguments import isA, validated
from .blocks import Block, Bricks, Gap, Length, refuse
from .checks import components, where
from .geometry import boxCorners

#: Round-off of lengths that are whole units [-].
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
    """A rectangular hole through a wall; bricks at its edge are cut.

    :param x: of its left edge from the start of the wall [m]
    :param z: of its lower edge from the foot of the wall [m]; 0: a door
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
    """A brick or a cut one while a wall is laid: a box."""

    low: tuple
    high: tuple
    course: int
    part: str
    split: tuple | None  # axis and coordinate between its halves
    number: int
    cut: bool = False  # whether an opening has cut it
    kind: str = "brick"


def opened(bricks, openings, unit, levels, ends, ys, part, crossed=None):
    """The bricks that openings leave, and lintels.

    :param ends: from where to where openings may be [m]
    """
    if not openings:
        return bricks, []
    problems = []
    holes, lintels = _holes(openings, unit, levels, ends, crossed, problems)
    refuse(part, problems)
    for _, hole in holes + lintels:  # lintels take the place of bricks, too
        bricks = _without(bricks, hole, WHOLE * unit[0])
    refuse(part, _slivers(bricks, holes + lintels, unit, levels))
    made = []
    for number, (_, (x0, z0, x1, z1)) in enumerate(lintels, _unused(bricks)):
        course = max(c for c, z in enumerate(levels[:-1]) if z <= z0)
        box = (x0, ys[0], z0), (x1, ys[1], z1)
        made.append(LaidBrick(*box, course, part, None, number, kind="lintel"))
    _whole(bricks + made, part)
    return bricks, made


def _unused(bricks):
    return max((brick.number for brick in bricks), default=-1) + 1


def _holes(openings, unit, levels, ends, crossed, problems):
    """Boxes (x0, z0, x1, z1) of openings and of lintels, each with its name."""
    top, q = levels[-1], unit[0] / 4

    def at(value, places, size):
        """The nearest place, if a value is there but for round-off."""
        near = min(places, key=lambda place: abs(place - value))
        return near if abs(near - value) <= WHOLE * size else value

    alongWall = lambda x: at(x, [round(x / q) * q, *ends], unit[0])
    upWall = lambda z: at(z, levels, unit[2])
    holes, lintels = [], []
    for n, opening in enumerate(openings):
        x0, x1 = alongWall(opening.x), alongWall(opening.x + opening.width)
        z0, z1 = upWall(opening.z), upWall(opening.z + opening.height)
        holes.append((f"opening {n}", (x0, z0, x1, z1)))
        if x0 <= ends[0] and x1 >= ends[1]:
            problems.append(f"opening {n} is as wide as the wall and cuts it in two")
        if lintel := opening.lintel:
            a, b = alongWall(x0 - lintel.bearing), alongWall(x1 + lintel.bearing)
            box = (a, z1, b, upWall(z1 + lintel.height))
            lintels.append((f"the lintel of opening {n}", box))
    boxes = holes + lintels
    near = WHOLE * unit[0]
    for n, (name, box) in enumerate(boxes):
        x0, _, x1, z1 = box
        if x0 < ends[0] or x1 > ends[1]:
            problems.append(
                f"{name} reaches from x = {x0:g} to {x1:g} m, off the wall, where it may be from"
                f" {ends[0]:g} to {ends[1]:g} m"
            )
        if z1 > top:
            problems.append(f"{name} reaches up to {z1:g} m, off the wall of {top:g} m")
        for other, second in boxes[:n]:
            if _overlap(box, second, near):
                problems.append(f"{other} and {name} overlap")
        if crossed and x0 < crossed[1] - near and x1 > crossed[0] + near:
            problems.append(
                f"{name} reaches into the junction, from x = {crossed[0]:g} to {crossed[1]:g} m"
            )
    return holes, lintels


def _overlap(a, b, near):
    inside = lambda low, high: low + near < high
    return all(inside(a[i], b[i + 2]) and inside(b[i], a[i + 2]) for i in (0, 1))


def _without(bricks, hole, near):
    """The bricks outside a hole. A brick at its edge is cut, an L into pieces of it.

    :param near: distance of two edges that are one but for round-off [m]
    """
    found, spare = [], _unused(bricks)
    for brick in bricks:
        (a, ya, c), (b, yb, d) = brick.low, brick.high
        if not _overlap((a, c, b, d), hole, near):
            found.append(brick)
            continue
        edges = zip(hole, ((a, b), (c, d)) * 2)
        x0, z0, x1, z1 = (next((e for e in ends if abs(e - v) <= near), v) for v, ends in edges)
        low, high = max(c, z0), min(d, z1)
        beds = [(a, c, b, z0)] if c < z0 else []
        beds += [(a, z1, b, d)] if d > z1 else []
        sides = [(a, low, x0, high)] if a < x0 else []
        sides += [(x1, low, b, high)] if b > x1 else []
        # beds and sides touch; two beds alone, or two sides, are bricks of their own
        for n, (p, r, s, t) in enumerate(beds + sides):
            number = brick.number
            if n and not (beds and sides):
                number, spare = spare, spare + 1
            box = dict(low=(p, ya, r), high=(s, yb, t), split=None)
            found.append(replace(brick, **box, number=number, cut=True))
    return found


def _slivers(bricks, holes, unit, levels):
    slivers = []
    for brick in bricks:
        box = brick.low[0], brick.low[2], brick.high[0], brick.high[2]
        height = levels[brick.course + 1] - levels[brick.course]
        word, size, least = "long", box[2] - box[0], unit[0] / 4
        if size >= least * (1 - WHOLE):
            word, size, least = "high", box[3] - box[1], height / 4
        if brick.cut and size < least * (1 - WHOLE):
            name = next(name for name, hole in holes if _touch(box, hole))
            middle = [(p + q) / 2 for p, q in zip(brick.low, brick.high)]
            slivers.append(
                f"{name} leaves a sliver of brick {brick.number} in course {brick.course},"
                f" {size:.3g} m {word}, at {where(middle)}; a piece must have a quarter of the"
                f" unit, {least:.3g} m"
            )
    if slivers:
        hint = (
            f"edges at multiples of {unit[0] / 4:g} m along the wall, and at bed joints, leave no"
            " slivers"
        )
        slivers[-1] += f" ({hint})"
    return slivers


def _touch(a, b):
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


def _whole(bricks, part):
    boxes = Bricks(blocksOf(replace(b, split=None) for b in bricks))  # halves hold
    if not len(boxes):
        refuse(part, ["its openings leave nothing of it"])
    parts = components(len(boxes), boxes.joints())
    loose = [box for box, one in zip(boxes, parts) if one != parts[0]]
    if loose:
        one, count = loose[0], len({box.brick for box in loose})
        problem = (
            f"its openings cut it in parts: {count} bricks, such as brick {one.brick} at"
            f" {where(one.middle)}, have no joint with the rest"
        )
        refuse(part, [problem])


def blocksOf(bricks):
    for brick in bricks:
        pieces = [(brick.low, brick.high)]
        if brick.split:
            axis, at = brick.split
            middleHigh, middleLow = list(brick.high), list(brick.low)
            middleHigh[axis] = middleLow[axis] = at
            pieces = [(brick.low, middleHigh), (middleLow, brick.high)]
        names = brick.number, brick.part, brick.course, brick.kind
        for box in pieces:
            yield Block(boxCorners(*box), *names)
