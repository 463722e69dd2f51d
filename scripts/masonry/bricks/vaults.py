# SPDX-License-Identifier: GPL-2.0-or-later
"""Arches, vaults and domes from voussoirs whose plane faces fit corner by corner."""

import math

from typing import Annotated

from ..arguments import number, validated, whole
from .blocks import Block, Bricks, Length, refuse
from .geometry import cosSin, prism

MAX_STONES = 100_000

Stones = Annotated[int, whole(1, MAX_STONES)]
CentreAngle = Annotated[float, number("°", 1, 180)]


@validated
def Arch(
    thickness: Length,
    depth: Length,
    stones: Stones,
    span: Length | None = None,
    radius: Length | None = None,
    angle: CentreAngle = 180.0,
    skewback: Length | None = None,
    part: str = "arch",
    rise: Length | None = None,
) -> Bricks:
    """A circular or pointed arch from voussoirs of one angle, from left to right: a :class:`Bricks`
    of kind "voussoir".

    ::

        Arch(thickness=0.3, depth=0.5, stones=27, radius=2.0)                        # half a circle
        Arch(thickness=0.2, depth=0.3, stones=15, span=3.0, angle=90, skewback=0.3)  # segmental
        Arch(thickness=0.2, depth=0.3, stones=16, span=3.0, rise=2.0)                # pointed

    The inner springings lie at (0, 0, 0) and (span, 0, 0). Corners of the voussoirs lie on the
    inner and outer circle; their edges are straight.

    :param thickness: of the ring, between inner and outer circle [m]
    :param depth: along y [m]
    :param stones: number of voussoirs
    :param span: clear span between the inner springings [m]; give this or ``radius``
    :param radius: of the inner circle [m]
    :param angle: at the centre, between the springings [°], up to 180: a half circle, the default
    :param skewback: width behind the outer springings of two blocks, kind "block", part "skewback",
        on which the arch springs [m]. Their bottom is level with the inner springings, so that an
        arch of less than 180° can stand on level supports. An arch of 180° stands on two blocks as
        wide as the ring and so high. None: none
    :param rise: of the inner circle over ``span``, in place of ``angle`` [m]. Above half the span
        the arch is pointed: two arcs about centres level with the springings, which meet in a
        joint at the crown, so ``stones`` are even
    """
    depth = float(depth)
    points = _ring("arch", stones, span, radius, angle, thickness, rise, [])
    voussoirs = [
        Block(prism(points[n] + points[n + 1], 0.0, depth), n, part, n, "voussoir")
        for n in range(stones)
    ]
    if skewback is not None:
        for end, sign in ((points[0], -1), (points[-1], 1)):
            (x, z), (u, v) = end
            if v == z:
                section = [(x, z), (u, z), (u, z - skewback), (x, z - skewback)]
            else:
                outer = u + sign * skewback
                section = [(x, z), (u, v), (outer, v), (outer, z)]
            corners = prism(section, 0.0, depth)
            voussoirs.append(Block(corners, len(voussoirs), "skewback", -1, "block"))
    return Bricks(voussoirs)


@validated
def BarrelVault(
    thickness: Length,
    length: Length,
    stones: Stones,
    rows: Stones,
    span: Length | None = None,
    radius: Length | None = None,
    angle: CentreAngle = 180.0,
    staggered: bool = True,
    part: str = "vault",
    rise: Length | None = None,
) -> Bricks:
    """A barrel vault: an :func:`Arch` stretched along y, whose courses run along it, numbered from
    left to right.

    :param thickness: of the shell [m]
    :param length: along y [m]
    :param stones: number of courses; ``rows``: of stones along a course
    :param span: clear span [m]; give this or ``radius`` of the inner surface
    :param angle: at the centre [°], up to 180
    :param staggered: whether odd courses are shifted by half a stone, with half stones at their
        ends
    :param rise: as of an :func:`Arch`; above half the span the vault is pointed
    """
    points = _ring("vault", stones, span, radius, angle, thickness, rise, _few(stones * rows))
    blocks = []
    for course in range(stones):
        shifted = 1 if staggered and course % 2 else 2
        ends = [0, *range(shifted, 2 * rows, 2), 2 * rows]
        for low, high in zip(ends, ends[1:]):
            low, high = (length * k / (2 * rows) for k in (low, high))
            corners = prism(points[course] + points[course + 1], low, high)
            blocks.append(Block(corners, len(blocks), part, course, "voussoir"))
    return Bricks(blocks)


@validated
def CrossVault(
    span: Length,
    thickness: Length,
    stones: Stones,
    rows: Annotated[int, whole(2, MAX_STONES)],
    length: Length | None = None,
    angle: CentreAngle = 180.0,
    rise: Length | None = None,
    cloister: bool = False,
    pier: Length | None = None,
    part: str = "vault",
) -> Bricks:
    """A groin vault, where two barrel vaults of one rise cross, over a rectangle about the z axis;
    or a cloister vault, whose four webs rise from its sides.

    Vertical planes through the diagonals cut the stones. The two parts of a stone at a diagonal are
    one brick, with a crack surface between them, which bonds the webs; so are the parts of a
    keystone. Courses are numbered from below, inner springings lie at z = 0.

    :param span: clear span along x [m]; ``length``: along y, None: as along x. The barrel over
        ``length`` is stretched in plan, with its thickness
    :param stones: number of courses of a barrel; if it is odd there is a keystone
    :param rows: of stones along a course of half a barrel, at the crown of a groin vault and at the
        springing of a cloister vault. Odd courses are shifted by half a stone
    :param angle: at the centre of a barrel [°], up to 180
    :param rise: as of an :func:`Arch`; above half the span the vault is pointed
    :param cloister: whether it is a cloister vault
    :param pier: width of the corners, from the inner springings to the outer edges of a groin
        vault, at least ``thickness`` [m]; None: twice that
    """
    points = _ring("vault", stones, span, None, angle, thickness, rise, _few(4 * stones * rows))
    edge = span / 2 + (2 * thickness if pier is None else pier)
    if pier is not None and pier < thickness:
        refuse("vault", [f"pier {pier:g} m must be at least the thickness, {thickness:g} m"])
    width = (span / 2 if cloister else edge) / rows
    pieces = []  # of one web: course, diagonal at its end, corners
    for course in range(stones // 2 if cloister else 0, stones):
        section = [(x - span / 2, z) for x, z in points[course] + points[course + 1]]
        level, keyed = min(course, stones - 1 - course), 2 * course == stones - 1
        if keyed:  # half of it in a cloister vault
            section[2 * (not cloister) : 2] = [(0.0, z) for _, z in section[:2]]
        near, far = (f(abs(x) for x, _ in section) for f in (min, max))
        shift = 0.5 * (level % 2)
        if cloister:
            heads = [width * (n + shift) for n in range(-rows, rows)]
            heads = [y for y in heads if abs(y) < near - width / 4] or [0.0] * (not keyed)
            ends = [-far, *heads, far]
        else:
            heads = [edge - width * (rows - n - shift) for n in range(rows)]
            ends = [0.0, *(y for y in heads if far + width / 4 < y < edge), edge]
        for n, (low, high) in enumerate(zip(ends, ends[1:])):
            found = {}
            for x, z in section:
                for y in (low, high):
                    y = min(max(y, -abs(x)), abs(x)) if cloister else max(y, abs(x))
                    if x or not (keyed and y):
                        found[x, y, z] = None
            # counted from that of x and y > 0 on
            diagonal = None
            if cloister and n in (0, len(ends) - 2):
                diagonal = 3 if n == 0 else 0
            elif n == 0:
                diagonal = int(2 * course < stones)
            pieces.append((level, diagonal, keyed, tuple(found)))
    bricks, blocks, stretch = {}, [], (length or span) / span
    for turn in range(4):
        cos, sin = cosSin(turn, 0.0)
        for n, (level, diagonal, keyed, corners) in enumerate(pieces):
            key = n, turn, False
            if diagonal is not None:
                key = level, 0 if keyed else (diagonal + turn) % 4, True
            number = bricks.setdefault(key, len(bricks))
            turned = ((cos * x - sin * y, (sin * x + cos * y) * stretch, z) for x, y, z in corners)
            blocks.append(Block(tuple(turned), number, part, level, "voussoir"))
    return Bricks(blocks)


@validated
def Dome(
    radius: Length,
    thickness: Length,
    courses: Stones,
    stones: Stones,
    oculus: Length | None = None,
    angle: CentreAngle = 180.0,
    staggered: bool = False,
    part: str = "dome",
    lantern: Length | None = None,
) -> Bricks:
    """A dome whose horizontal courses are regular polygons: a :class:`Bricks` of kind "voussoir".

    Its axis is the z axis, and the lowest inner corners lie at z = 0. Corners lie on two concentric
    spheres. Vertical planes through the axis part the stones of a course, and planes part the
    courses. Courses are numbered from below.

    :param radius: of the inner sphere [m]
    :param thickness: [m]
    :param courses: number of courses, without the keystone
    :param stones: number of stones in each course, at least 3; with ``staggered`` at least 2
    :param oculus: radius of the hole at the crown, to its inner corners [m]. None: a keystone as
        wide as a course is high
    :param angle: at the centre, from springing to springing [°], up to 180: half a sphere, the
        default
    :param staggered: whether odd courses are turned by half a stone. Every stone is then two pieces
        of one brick, with a crack surface between them
    :param lantern: height of a round wall above the outer edge of an ``oculus``, on whose bed it
        stands as a keystone does [m]. Wall and lid are as thick as the dome, part "lantern"; None:
        none
    """
    problems = _few(2 * courses * stones)
    least = 2 if staggered else 3
    if stones < least:
        problems.append(f"stones {stones} must be at least {least}")
    lowest = math.radians(angle / 2)
    most = radius * math.sin(lowest)
    if oculus is not None and oculus >= most:
        problems.append(
            f"oculus {oculus:g} m must be smaller than the springing's radius, {most:g} m"
        )
    if lantern is not None and not (oculus and oculus * (1 + thickness / radius) > thickness):
        problems.append("a lantern needs an oculus that is wider than its wall")
    refuse("dome", problems)
    # polar angles of the bed joints, from below
    highest = lowest / (2 * courses + 1)
    if oculus is not None:
        highest = math.asin(oculus / radius)
    polar = [lowest + (highest - lowest) * n / courses for n in range(courses + 1)]
    sectors = 2 * stones if staggered else stones
    turns = [cosSin(4 * n / sectors, 2 * math.pi * n / sectors) for n in range(sectors)]
    level = radius * math.cos(lowest)

    def corner(turn, polarAngle, r):
        out = r * math.sin(polarAngle)
        return out * turn[0], out * turn[1], r * math.cos(polarAngle) - level

    radii = radius, radius + thickness
    blocks, brick = [], 0
    for course in range(courses):
        beds = polar[course : course + 2]
        shift = course % 2 if staggered else 0
        for k in range(sectors):
            pair = [turns[(k + n + shift) % sectors] for n in (0, 1)]
            corners = tuple(corner(t, p, r) for t in pair for p in beds for r in radii)
            number = brick + (k // 2 if staggered else k)
            blocks.append(Block(corners, number, part, course, "voussoir"))
        brick += stones
    if lantern is not None:
        foot, edge = ((r * math.sin(highest), r * math.cos(highest) - level) for r in radii)
        inner, top = edge[0] - thickness, edge[1] + lantern
        ring = [foot, edge, (edge[0], top), (inner, top), (inner, foot[1])]
        shift = courses % 2 if staggered else 0
        for k in range(sectors):
            pair = [turns[(k + n + shift) % sectors] for n in (0, 1)]
            corners = tuple((out * x, out * y, z) for x, y in pair for out, z in ring)
            number = brick + (k // 2 if staggered else k)
            blocks.append(Block(corners, number, "lantern", courses, "voussoir"))
        levels = top, top + thickness
        lid = tuple((edge[0] * x, edge[0] * y, z) for x, y in turns for z in levels)
        blocks.append(Block(lid, brick + stones, "lantern", courses + 1, "voussoir"))
    if oculus is None:
        key = tuple(corner(t, polar[-1], r) for t in turns for r in radii)
        blocks.append(Block(key, brick, part, courses, "voussoir"))
    return Bricks(blocks)


def _few(count):
    return [f"{count} stones are more than {MAX_STONES}"] * (count > MAX_STONES)


def _ring(what, stones, span, radius, angle, thickness, rise, problems):
    """Inner and outer point (x, z) of each joint of a ring, from left to right. Raises ValueError
    with all problems, also given ones."""
    if rise is not None:
        if span is None or radius is not None or angle != 180:
            problems = [*problems, "rise [m] needs span, without radius and angle"]
        elif rise > span / 2:
            return _pointed(what, stones, span, thickness, rise, problems)
        elif rise < span / 2:
            angle = math.degrees(4 * math.atan(2 * rise / span))
    half, quarters = math.radians(angle / 2), angle / 180
    if (span is None) == (radius is None):
        problems = [*problems, "either span or radius [m] must be given"]
    elif half / stones > math.pi / 4:
        problems = [
            *problems,
            f"{stones} voussoirs are too few for {angle:g}°: each may take 90° at most",
        ]
    refuse(what, problems)
    if radius is None:
        radius = span / 2 / math.sin(half)
    cos, sin = cosSin(quarters, half)
    across, up = radius * sin, radius * cos
    points = []
    for n in range(stones + 1):
        share = 2 * n / stones - 1
        cos, sin = cosSin(quarters * share, half * share)
        inner, outer = ((across + r * sin, r * cos - up) for r in (radius, radius + thickness))
        if n in (0, stones):  # the inner springings
            inner = (0.0 if n == 0 else 2 * across), 0.0
        points.append((inner, outer))
    return points


def _pointed(what, stones, span, thickness, rise, problems):
    """:func:`_ring` of a pointed arch."""
    radius, half = (span**2 / 4 + rise**2) / span, stones // 2
    beside = radius - span / 2  # of the centre of an arc from the crown
    left = []
    for n in range(half):
        at = math.acos(beside / radius) * n / half
        cos, sin = math.cos(at), math.sin(at)
        left.append(tuple((radius - r * cos, r * sin) for r in (radius, radius + thickness)))
    if stones % 2:
        problems = [
            *problems,
            f"a pointed one has a joint at its crown, so stones {stones} must be even",
        ]
    refuse(what, problems)
    outer = math.sqrt((radius + thickness) ** 2 - beside**2)
    right = [tuple((span - x, z) for x, z in pair) for pair in reversed(left)]
    return [*left, ((span / 2, rise), (span / 2, outer)), *right]
