# SPDX-License-Identifier: GPL-2.0-or-later
"""Straight walls in five bonds, with openings and lintels; walls that meet; stacks of blocks.

A wall stands along x from the origin, its thickness along y, its height along z. All positions
along a wall are multiples of a quarter unit, except cuts at openings and junctions.
"""

import functools
import itertools
import math
from dataclasses import replace
from typing import Annotated, Iterable, Sequence

from ..arguments import isA, listOf, number, oneOf, validated, whole
from ..memory import withoutCollector
from .blocks import FARTHEST, Block, Bricks, Gap, Length, Point, Sides, refuse
from .bonds import layout
from .geometry import FLAT, boxCorners
from .openings import WHOLE, LaidBrick, Opening, blocksOf, opened

#: Calcium-silicate unit of the paper (yade_plugin/law/README.md): length, thickness and height [m].
UNIT = (0.220, 0.102, 0.081)

MAX_BRICKS = 100_000  # of a wall: lengths that need more are probably not in metres

BONDS = ("running", "stack", "header", "english", "flemish")

Courses = Annotated[Sequence[float], listOf(number("m", 0, FARTHEST, above=True))]
Openings = Annotated[Iterable[Opening], listOf(isA(Opening, "bricks.Opening"), 0)]


@validated
def Wall(
    length: Length,
    height: Length | None = None,
    unit: Sides = UNIT,
    bond: Annotated[str, oneOf(*BONDS)] = "running",
    wythes: Annotated[int, whole(1, 100)] = 1,
    openings: Openings = (),
    courses: Courses | None = None,
    halves: bool = True,
    collar: Gap | None = None,
    part: str = "wall",
    joint: Gap = 0.0,
) -> Bricks:
    """A straight wall, its lower left front corner at the origin: a :class:`Bricks`.

    ::

        Wall(2.2, 1.62)  # 10 units long, 20 courses, one brick thick
        Wall(3.08, 2.43, openings=[Opening(0.99, 0.81, 0.99, 0.81, Lintel(0.22, 0.162))])
        Wall(2.2, 1.62, bond="flemish", wythes=2)
        Wall(2.6, 1.5, unit=(0.25, 0.12, 0.065), joint=0.010)  # bricks without mortar, and joints

    Even courses, from 0, of a running bond start with a whole unit, odd ones with a half. English
    bond has courses of stretchers and of headers in turn, Flemish bond a header after every
    stretcher, header bond headers alone. Queen closers, half bats and three-quarter bats keep the
    bond at the ends.

    :param length: [m]; whole half units, in stack bond whole units
    :param height: [m]; whole courses. None: that of ``courses``
    :param unit: length, thickness and height of a unit, joints included [m]; with ``joint`` those
        of the brick without mortar
    :param joint: thickness of the mortar [m], which is added to length and height of every unit,
        and not across the wall, where headers are as long as the brick
    :param bond: "running", "stack", "header", "english" or "flemish"
    :param wythes: bricks across the wall. Header, English and Flemish bond need 2. Leaves of a
        running or stack bond are parts, "wall leaf 1" and so on, in running bond shifted by half a
        unit against each other
    :param openings: :class:`masonry.bricks.Opening` records
    :param courses: heights of the courses from below [m]; None: all have the height of a unit
    :param halves: whether every whole brick is two half bricks that may crack apart; cut bricks are
        one block
    :param collar: thickness of the joint between two wythes [m], which they share in halves. None:
        0, or the length of headers without two thicknesses
    :param part: name of the part
    """
    problems = []
    through = bond in ("header", "english", "flemish")
    if through and wythes != 2:
        problems.append(
            f"{bond} bond has headers that go through the wall and needs wythes=2, got {wythes}"
        )
    size = length, 1 if bond == "stack" else 0.5, 1
    unit, (quarters,), levels = _counted(
        "wall", unit, joint, height, courses, problems, wythes, length=size
    )
    thickness, deep = unit[1], unit[0] - joint  # of the wall, where headers go through
    if through:
        fitting = deep - 2 * thickness
        collar = max(fitting, 0.0) if collar is None else collar
        if abs(collar - fitting) > WHOLE * unit[0]:
            fits = f"collar {fitting:g} m" if fitting >= 0 else f"a thickness of {deep / 2:g} m"
            problems.append(
                f"headers of {deep:g} m do not fit through two wythes of {thickness:g} m with a"
                f" collar of {collar:g} m; {fits} fits"
            )
    if bond == "header" and quarters < 6:
        problems.append(
            f"header bond needs a length of at least 1.5 units, {1.5 * unit[0]:g} m, got"
            f" {length:g} m"
        )
    refuse("wall", problems)
    collar = collar or 0.0
    ys = [0.0] + [w * thickness + (w - 0.5) * collar for w in range(1, wythes)]
    ys.append(wythes * thickness + (wythes - 1) * collar)
    if through and collar:
        ys[2] = deep
    bricks = []
    for course in range(len(levels) - 1):
        for k0, k1, w0, w1 in layout(bond, wythes, quarters, course):
            low = (k0 * unit[0] / 4, ys[w0], levels[course])
            high = (k1 * unit[0] / 4, ys[w1], levels[course + 1])
            split = None
            if halves and k1 - k0 == 4:
                split = 0, (k0 + 2) * unit[0] / 4
            elif halves and through and k1 - k0 == 2 and w1 - w0 == 2:
                split = 1, ys[1]
            leaf = part if through or wythes == 1 else f"{part} leaf {w0 + 1}"
            bricks.append(LaidBrick(low, high, course, leaf, split, len(bricks)))
    ends = (0.0, quarters * unit[0] / 4), (ys[0], ys[-1])
    return _joined(opened(bricks, openings, unit, levels, *ends, part))


@validated
def Corner(
    length: Length,
    length2: Length,
    height: Length | None = None,
    unit: Sides = UNIT,
    openings: Openings = (),
    openings2: Openings = (),
    courses: Courses | None = None,
    halves: bool = True,
    joint: Gap = 0.0,
) -> Bricks:
    """Two walls of one wythe in running bond that interlock at a right angle at the origin: part
    "wall" along x and part "return" along y.

    Even courses of the wall and odd ones of the return go through to the corner. Bricks beside the
    corner are cut or stretched by the difference of the thickness from half the length of the unit.

    :param length: of the wall, measured outside [m]; whole half units, at least 1.5 units.
        ``length2``: of the return
    :param openings: of the wall, ``openings2``: of the return; x is measured from the outer edge of
        the corner

    Others are as for :func:`Wall`.
    """
    sizes = dict(length=(length, 0.5, 1.5), length2=(length2, 0.5, 1.5))
    unit, (one, two), levels = _counted("corner", unit, joint, height, courses, [], 1, **sizes)
    lay = functools.partial(_leaf, levels, unit, halves, ys=(0.0, unit[1]))
    return _joined(
        lay(one, "wall", openings, meets=(0, None)),
        _along(lay(two, "return", openings2, meets=(1, None))),
    )


@validated
def Tee(
    length: Length,
    length2: Length,
    at: Length,
    height: Length | None = None,
    unit: Sides = UNIT,
    openings: Openings = (),
    openings2: Openings = (),
    courses: Courses | None = None,
    halves: bool = True,
    joint: Gap = 0.0,
) -> Bricks:
    """A wall of one wythe in running bond along x, part "wall", and another from behind, part
    "stem", whose odd courses go through the wall.

    :param length: of the wall [m]; whole half units
    :param length2: of the stem along y, measured from the outer face of the wall [m]; whole half
        units, at least 1.5 units
    :param at: of the axis of the stem from the start of the wall [m]: half a unit more than whole
        units
    :param openings: of the wall, ``openings2``: of the stem; there x is measured from the outer
        face of the wall

    Others are as for :func:`Wall`.
    """
    problems, long = [], unit[0] + joint
    if unit[1] > 0.75 * long:
        problems.append(
            f"a junction needs a unit no thicker than 0.75 of its length, got {unit[1]:g} m and"
            f" {long:g} m"
        )
    sizes = dict(length=(length, 0.5, 2), length2=(length2, 0.5, 1.5))
    unit, (one, two), levels = _counted("tee", unit, joint, height, courses, problems, 1, **sizes)
    middle, most = at / unit[0] - 0.5, one // 4 - 1
    nearest = round(middle)
    nearest = min(max(nearest, 1), most - 1) if most > 1 else nearest
    if abs(middle - nearest) > WHOLE:
        raise ValueError(
            f"tee: at {at:g} m: the stem must stand over the middle of a brick of the even courses,"
            f" with a brick on each side; nearest: {(nearest + 0.5) * unit[0]:g} m"
        )
    axis = (4 * nearest + 2) * unit[0] / 4
    across = (axis - unit[1] / 2, axis + unit[1] / 2)
    lay = functools.partial(_leaf, levels, unit, halves)
    return _joined(
        lay(one, "wall", openings, (0.0, unit[1]), crossed=across),
        _along(lay(two, "stem", openings2, across, meets=(1, None))),
    )


@validated
def Room(
    length: Length,
    width: Length,
    height: Length | None = None,
    unit: Sides = UNIT,
    front: Openings = (),
    right: Openings = (),
    back: Openings | None = (),
    left: Openings = (),
    courses: Courses | None = None,
    halves: bool = True,
    joint: Gap = 0.0,
) -> Bricks:
    """Four walls of one wythe in running bond that interlock around a rectangle: parts "front" and
    "back" along x, whose even courses go through to the corners, "left" and "right" along y.

    :param length: along x, ``width``: along y, measured outside [m]; whole units, at least 3
    :param front: openings of this wall, as ``right``, ``back`` and ``left``; x is measured along x
        or y from the outer edge of the corner nearer to the origin. ``back=None``: no wall, so that
        three make a U

    Others are as for :func:`Wall`.
    """
    problems, long = [], unit[0] + joint
    if unit[1] > long:
        problems.append(
            f"a room needs a unit no thicker than its length, got {unit[1]:g} m and {long:g} m"
        )
    sizes = dict(length=(length, 1, 3), width=(width, 1, 3))
    unit, (one, two), levels = _counted("room", unit, joint, height, courses, problems, 2, **sizes)
    near = (0.0, unit[1])
    far = [(end - unit[1], end) for end in (one * unit[0] / 4, two * unit[0] / 4)]
    lay = functools.partial(_leaf, levels, unit, halves)
    ends = (1, 1) if back is not None else (1, None)
    return _joined(
        lay(one, "front", front, near, meets=(0, 0)),
        _along(lay(two, "right", right, far[0], meets=ends)),
        *([] if back is None else [lay(one, "back", back, far[1], meets=(0, 0))]),
        _along(lay(two, "left", left, near, meets=ends)),
    )


@validated
def stack(count: Annotated[int, whole(1, MAX_BRICKS)], size: Sides, part: str = "stack") -> Bricks:
    """Blocks on top of each other, from the origin: a :class:`Bricks`.

    :param size: length, thickness and height of a block [m]
    """
    wide, deep, high = size
    box = lambda n: boxCorners((0.0, 0.0, n * high), (wide, deep, (n + 1) * high))
    return Bricks(Block(box(n), n, part, n, "block") for n in range(count))


@validated
def block(low: Point, high: Point, part: str = "block", kind: str = "block") -> Bricks:
    """One block, a box between two opposite corners [m]: a :class:`Bricks`."""
    if not all(a < b for a, b in zip(low, high)):
        raise ValueError(
            f"block: low corner {tuple(low)} m must lie below high corner {tuple(high)} m on every"
            " axis"
        )
    return Bricks([Block(boxCorners(low, high), 0, part, -1, kind)])


# -- checks of what a user gives -------------------------------------------------------------------


def _counted(name, unit, joint, height, courses, problems, times, **sizes):
    """Sides of a unit with its joints, lengths in quarter units, and heights of bed joints. Raises
    ValueError with all problems, also given ones.

    :param times: walls of all these lengths
    :param sizes: by name the length [m], the multiple of units that it must be, and the least
        number of units
    """
    if joint >= min(unit[0], unit[2]):
        raise ValueError(
            f"{name}: joint {joint:g} m must be below length and height of the unit {unit} m"
        )
    unit = unit[0] + joint, unit[1], unit[2] + joint
    units = [
        _multiple(what, size, unit[0], "units", *bounds, problems)
        for what, (size, *bounds) in sizes.items()
    ]
    levels = _levels(height, courses, unit, problems)
    refuse(name, problems)
    bricks = times * sum(units) * (len(levels) - 1)
    if bricks > MAX_BRICKS:
        raise ValueError(
            f"{name}: {bricks:.3g} bricks are more than {MAX_BRICKS}: are all lengths in m?"
        )
    return unit, [round(4 * n) for n in units], levels


def _multiple(what, size, one, word, share, least, problems):
    """How many units or courses a size is; None, and one more problem, if they are not whole.

    :param one: size of a unit or a course [m]; ``word``: what it is
    :param share: of one that is needed in whole numbers; ``least``: number of ones [-]
    """
    count = size / one / share
    if not size / one < MAX_BRICKS:
        problems.append(f"{what} {size:g} m is {size / one:.3g} {word}: is it in m?")
        return None
    nearest = round(count)
    if abs(count - nearest) > WHOLE * max(1, nearest) or nearest * share < least:
        below = max(math.floor(count + WHOLE), math.ceil(least / share))
        above = max(math.ceil(count - WHOLE), below)
        choices = (n * share for n in sorted({below, above}))
        choices = " or ".join(f"{n * one:.6g} m ({n:g})" for n in choices)
        problems.append(
            f"{what} {size:g} m is {size / one:.6g} {word} of {one:g} m; it must be whole"
            f" {'half ' * (share < 1)}{word}, at least {least:g}; nearest: {choices}"
        )
        return None
    return nearest * share


def _levels(height, courses, unit, problems):
    """Heights of all bed joints, from 0 to the top [m]; None with one more problem."""
    if courses is not None:
        # a block as flat as corners may lie off their face's plane has no volume
        least = FLAT * max(unit)
        for n, flat in enumerate(courses):
            if flat <= least:
                problems.append(f"course {n}: {flat:g} m is too flat, it must be above {least:g} m")
                return None
        levels = [0.0, *itertools.accumulate(courses)]
        if height is not None and abs(height - levels[-1]) > WHOLE * levels[-1]:
            problems.append(
                f"height {height:g} m differs from the sum of all courses, {levels[-1]:g} m"
            )
        return levels
    if height is None:
        problems.append("height [m] or courses must be given")
        return None
    count = _multiple("height", height, unit[2], "courses", 1, 1, problems)
    return count and [course * unit[2] for course in range(count + 1)]


# -- leaves that meet others -----------------------------------------------------------------------


def _leaf(levels, unit, halves, quarters, part, openings, ys, meets=(None, None), crossed=None):
    """A leaf in running bond along x between two ``ys``: bricks and lintels.

    :param meets: for both ends the parity of the courses that go through to the end; the others
        begin beside the wall that meets this one. None: no wall there
    :param crossed: from where to where another wall goes through the odd courses [m]
    """
    joined = [end is not None for end in meets]
    free = unit[1] * joined[0], quarters * unit[0] / 4 - unit[1] * joined[1]
    bricks = []
    for course, (z0, z1) in enumerate(zip(levels, levels[1:])):
        shifted = course % 2 != (meets[0] or 0)
        for x0, x1, at in _course(quarters, unit, shifted, free, joined):
            pieces = [(x0, x1)]
            if crossed and course % 2 and x0 < crossed[1] and x1 > crossed[0]:
                pieces, at = [(x0, crossed[0]), (crossed[1], x1)], None
            split = (0, at) if halves and at is not None else None
            for a, b in pieces:
                box, n = ((a, ys[0], z0), (b, ys[1], z1)), len(bricks)
                if a < b:
                    bricks.append(LaidBrick(*box, course, part, split, n))
    return opened(bricks, openings, unit, levels, free, ys, part, crossed)


def _course(quarters, unit, shifted, free, joined):
    """Bricks of a course in running bond: start, end, and where two halves meet or None.

    :param shifted: whether the head joints stand half a unit off
    :param free: where a shifted course starts and ends [m]
    :param joined: whether another wall meets this one there
    """
    q, whole, (joinedStart, joinedEnd) = unit[0] / 4, unit[0], joined
    if not shifted:
        for k0 in range(0, quarters, 4):
            k1 = min(k0 + 4, quarters)
            at = (k0 + 2) * q if k1 - k0 == 4 else None
            if at is not None and q < unit[1] < 3 * q:
                # an end in the other wall is split at the face of that
                at = free[0] if joinedStart and k0 == 0 else at
                at = free[1] if joinedEnd and k1 == quarters else at
            yield k0 * q, k1 * q, at
        return
    low, high = free
    near = q * (1 - WHOLE)  # least length of a piece
    joints = [k * q for k in range(2, quarters, 4)]
    joints = [x for x in joints if x - low >= near and high - x >= near]
    ends = [low, *joints, high]
    # a piece beside a corner much longer than a unit is cut at three quarters of a unit
    if joinedStart and ends[1] - ends[0] > 1.1 * whole:
        ends.insert(1, ends[1] - 0.75 * whole)
    if joinedEnd and ends[-1] - ends[-2] > 1.1 * whole:
        ends.insert(-1, ends[-2] + 0.75 * whole)
    for n, (a, b) in enumerate(zip(ends, ends[1:])):
        last = n and n == len(ends) - 2 and joinedEnd
        isWhole = abs(b - a - whole) <= 0.1 * whole * (1 + WHOLE)
        yield a, b, (a + whole / 2 if last else b - whole / 2) if isWhole else None


def _along(leaf):
    """A leaf along y: x and y change places, so that all coordinates stay exact."""
    swap = lambda p: (p[1], p[0], p[2])
    split = lambda cut: cut and (1 - cut[0], cut[1])
    turn = lambda b: replace(b, low=swap(b.low), high=swap(b.high), split=split(b.split))
    return tuple(list(map(turn, bricks)) for bricks in leaf)


@withoutCollector()
def _joined(*leaves):
    """Blocks of leaves, course by course, then of lintels, with bricks numbered in this order."""
    bricks, lintels = [], []
    for n, (laid, over) in enumerate(leaves):
        own = lambda brick: replace(brick, number=brick.number * len(leaves) + n)
        bricks += map(own, laid)
        lintels += map(own, over)
    bricks.sort(key=lambda brick: brick.course)
    return Bricks(Bricks(blocksOf(bricks + lintels))._renumbered(0))
