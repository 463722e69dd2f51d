# SPDX-License-Identifier: GPL-2.0-or-later
"""Arches, barrel vaults and domes from voussoirs whose plane faces fit corner by corner."""

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
) -> Bricks:
    """A circular arch from equal voussoirs, from left to right: a :class:`Bricks` of kind
    "voussoir".

    ::

        Arch(thickness=0.3, depth=0.5, stones=27, radius=2.0)                        # half a circle
        Arch(thickness=0.2, depth=0.3, stones=15, span=3.0, angle=90, skewback=0.3)  # segmental

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
    """
    depth = float(depth)
    points = _ring("arch", stones, span, radius, angle, thickness, [])
    voussoirs = [
        Block(prism(points[n] + points[n + 1], 0.0, depth), n, part, n, "voussoir")
        for n in range(stones)
    ]
    if skewback is not None:
        for end, sign in ((points[0], -1), (points[-1], 1)):
            (x, z), (u, v) = end
            if angle == 180:
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
    """
    points = _ring("vault", stones, span, radius, angle, thickness, _few(stones * rows))
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
def Dome(
    radius: Length,
    thickness: Length,
    courses: Stones,
    stones: Stones,
    oculus: Length | None = None,
    angle: CentreAngle = 180.0,
    staggered: bool = False,
    part: str = "dome",
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
    if oculus is None:
        key = tuple(corner(t, polar[-1], r) for t in turns for r in radii)
        blocks.append(Block(key, brick, part, courses, "voussoir"))
    return Bricks(blocks)


def _few(count):
    return [f"{count} stones are more than {MAX_STONES}"] * (count > MAX_STONES)


def _ring(what, stones, span, radius, angle, thickness, problems):
    """Inner and outer point (x, z) of each joint of a ring, from left to right. Raises ValueError
    with all problems, also given ones."""
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
