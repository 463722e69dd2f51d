# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of natural stone, squared or irregular, with a surveyed interlocking."""

import math
from random import Random
from typing import Annotated, Any

import numpy as np

from ...arguments import isA, number, oneOf, validated, whole
from ...terminal import say
from ..blocks import Block, Bricks, Length, Sides, refuse
from ..geometry import prism

#: Walls that are drawn until one has the trace that is asked for, within this share [-].
DRAWS, NEAR = 30, 0.03

#: Largest scatter of joints over a stone's length or height, with stones still on beds [-].
MAX_SCATTER = 0.4

SHORTEST = 0.3  # piece of a squared stone, over the length of a stone [-]
SAME = 1e-9  # distance of vertices that are one, over the size of the wall [-]

#: Distance of the points of end stones from the ends of a wall, over the length of a stone [-]. The
#: same for all, it makes level joints between these stones, as masons dress them: a wedge would be
#: squeezed out.
END = 0.3

#: The least overlap of two head joints, and the shortest side of an irregular stone, over the size
#: of a stone [-]. Shorter ones are closed: so small a joint ends a run when its stones have slid
#: along it.
LEAST = 0.12

MAX_STONES = 20_000

Trace = Annotated[float, number("", 1, 10)]
Scatter = Annotated[float, number("", 0, MAX_SCATTER)]


@validated
def StoneWall(
    length: Length,
    height: Length,
    unit: Sides,
    pattern: Annotated[str, oneOf("squared", "irregular")] = "squared",
    scatter: Scatter | None = None,
    trace: Trace | None = None,
    seed: Annotated[int, whole(0, 2**31)] = 1,
    part: str = "wall",
) -> Bricks:
    """A wall of natural stone along x, its lower left front corner at the origin: a :class:`Bricks`
    of one leaf.

    ::

        StoneWall(1.0, 1.2, unit=(0.20, 0.20, 0.15), scatter=0.1)  # ashlar, nearly a running bond
        StoneWall(1.6, 1.6, unit=(0.30, 0.40, 0.10), pattern="irregular", trace=1.1, seed=7)

    Stones meet in the middle of the mortar. Squared stones lie in level courses. Irregular ones are
    the Voronoi cells of points, in lengths and heights of a stone. In both the mean is a running
    bond; ``scatter`` moves its head joints, or its points.

    :param length: [m]; ``height``: [m]. Courses and stones are stretched to fill the wall
    :param unit: mean length of a stone, thickness of the wall, and mean height of a stone [m]
    :param scatter: largest displacement of a head joint or a point, over the length and the height
        of a stone [-]. None: 0.2, and with ``trace`` another one in every draw
    :param trace: length of the line of minimum trace over the height of the wall [-], see
        :func:`leastTrace`. Of up to 30 walls, those of squared stones after the running bond itself
        with overlaps from none to half a stone, the first within 3 % is taken, else the nearest,
        and a note says how near it is
    :param seed: of the draws
    """
    problems = []
    for what, stone, wall in (("length", unit[0], length), ("height", unit[2], height)):
        if stone > wall:
            problems.append(
                f"{what} of a stone, {stone:g} m, must be at most that of the wall, {wall:g} m"
            )
    refuse("stone wall", problems)
    counts = length / unit[0], round(height / unit[2])
    if pattern == "irregular":
        counts = round(counts[0]), counts[1]
    if counts[0] * counts[1] > MAX_STONES:
        refuse(
            "stone wall",
            [
                f"{counts[0] * counts[1]:.3g} stones are more than {MAX_STONES}: are all lengths"
                " in m?"
            ],
        )
    lay = _squared if pattern == "squared" else _irregular
    draw, best = Random(seed), None
    for n in range(1 if trace is None else DRAWS):
        own, overlap = scatter, 0.5
        if own is None:
            own = MAX_SCATTER / 2 if trace is None else MAX_SCATTER * draw.random()
        if pattern == "squared" and trace is not None:
            # the running bond itself comes first
            own, overlap = (own, 0.5 * draw.random()) if n else (0.0, 0.5)
        stones = lay(counts, overlap, own, draw)
        wide, high = length / counts[0], height / counts[1]  # of a stone
        faces = ((n, [(float(x) * wide, float(z) * high) for x, z in ring]) for n, ring in stones)
        bricks = Bricks(
            Block(prism(face, 0.0, float(unit[1])), n, part, course)
            for n, (course, face) in enumerate(faces)
        )
        if trace is None:
            return bricks
        miss = abs(leastTrace(bricks) / trace - 1)
        if best is None or miss < best[0]:
            best = miss, bricks
        if miss <= NEAR:
            break
    if best[0] > NEAR:
        say(
            f"note: stone wall: the nearest of {DRAWS} walls has a trace of"
            f" {leastTrace(best[1]):.3g}, not {trace:g}"
        )
    return best[1]


@validated
def leastTrace(bricks: Annotated[Any, isA(Bricks)]) -> float:
    """The line of minimum trace of a wall along x, the shortest line through its joints from foot
    to top, over its height [-]: 1 if a straight vertical joint goes through, more with interlocking
    stones, inf if a course is one stone."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra
    from scipy.spatial import cKDTree

    near = 4 * SAME * max(bricks.length, bricks.height)
    points = _joints(bricks).reshape(-1, 2)
    start = np.flatnonzero(points[:, 1] < bricks.low[2] + near)
    end = np.flatnonzero(points[:, 1] > bricks.high[2] - near)
    if not (len(start) and len(end)):
        return math.inf
    # ends that lie together are the first of them
    ends = np.array([min(n) for n in cKDTree(points).query_ball_point(points, near)])
    pairs, one = np.unique(ends.reshape(-1, 2), axis=0, return_index=True)
    lengths = np.hypot(*(points[2 * one] - points[2 * one + 1]).T)
    graph = csr_array((lengths, pairs.T), [len(points)] * 2)
    found = dijkstra(graph, directed=False, indices=start, min_only=True)[end]
    return float(found.min() / bricks.height)


def _joints(bricks):
    """Ends (x, z) of the joints between bricks of a wall along x, (n, 2, 2) [m]."""
    found = []
    for joint in bricks.joints():
        x, y, z = joint.normal
        if bricks[joint.first].brick != bricks[joint.second].brick and abs(y) < 0.5:
            points = np.array(joint.polygon)[:, [0, 2]]
            order = np.argsort(points @ (z, -x))
            found.append(points[order[[0, -1]]])
    return np.reshape(found, (-1, 2, 2))


def _squared(counts, overlap, scatter, draw):
    """Squared stones: (course, corners) of each, in lengths and heights of a stone."""
    columns, courses = counts
    below = np.array([0.0, columns])
    for course in range(courses):
        ends = [0.0]
        for k in range(math.ceil(columns) + 1):
            at = k + overlap * (course % 2) + scatter * (2 * draw.random() - 1)
            nearest = below[np.argmin(np.abs(below - at))]
            at = nearest if abs(nearest - at) < LEAST else at
            if ends[-1] + SHORTEST <= at <= columns - SHORTEST:
                ends.append(at)
        ends.append(float(columns))
        below = np.array(ends)
        for a, b in zip(ends, ends[1:]):
            yield course, [(a, course), (b, course), (b, course + 1), (a, course + 1)]


def _irregular(counts, overlap, scatter, draw):
    from scipy.spatial import Voronoi

    columns, courses = counts
    points, rows = [], []
    for row in range(courses):
        # at the ends of a course is what the overlap leaves of a stone
        shift = overlap * (row % 2)
        ends = [0.0, *(k + shift for k in range(0 if shift else 1, columns)), columns]
        inner = [(a + b) / 2 for a, b in zip(ends[1:], ends[2:-1])]
        whole = (END, *inner, columns - END) if len(ends) > 2 else (columns / 2,)
        for x in whole:
            across, up = (scatter * (2 * draw.random() - 1) for _ in "xz")
            at = x + across * (END < x < columns - END), row + 0.5 + up
            points.append([min(max(a, 0.1), most - 0.1) for a, most in zip(at, counts)])
            rows.append(row)
    points = np.array(points)
    # mirrored points make the cells end at the sides of the wall
    sides = [(axis, at) for axis in (0, 1) for at in (0, counts[axis])]
    sites = [points]
    for axis, at in sides:
        sites.append(points.copy())
        sites[-1][:, axis] = 2 * at - points[:, axis]
    diagram = Voronoi(np.concatenate(sites))
    corners = np.clip(diagram.vertices, 0, counts)
    for axis, at in sides:
        corners[np.isclose(corners[:, axis], at, atol=1e-9), axis] = at
    rings = [diagram.regions[diagram.point_region[n]] for n in range(len(rows))]
    return zip(rows, _withoutShort(rings, corners, counts))


def _withoutShort(rings, corners, counts):
    """Stones whose short sides are closed, where all stones stay convex.

    :param rings: corners of each stone, by number in ``corners`` (x, z), in lengths and heights of
        a stone
    """
    edges = {tuple(sorted(pair)) for ring in rings for pair in zip(ring, ring[1:] + ring[:1])}
    long = lambda edge: math.dist(corners[edge[0]], corners[edge[1]])
    fixed = (corners == 0) | (corners == np.array(counts))  # on a side of the wall
    for one, two in sorted(edges, key=long):
        if not 0 < long((one, two)) < LEAST:
            continue
        before = corners[[one, two]].copy()
        if (fixed[one] & fixed[two]).sum() < min(fixed[one].sum(), fixed[two].sum()):
            continue  # they lie on two sides of the wall
        middle = before.mean(axis=0)
        place = np.where(fixed[one], before[0], np.where(fixed[two], before[1], middle))
        corners[[one, two]] = place
        touched = [ring for ring in rings if one in ring or two in ring]
        if all(_convex(corners[ring]) for ring in touched):
            fixed[[one, two]] = fixed[one] | fixed[two]
        else:
            corners[[one, two]] = before
    return [_distinct(corners[ring]) for ring in rings]


def _distinct(ring):
    return ring[np.any(ring != np.roll(ring, 1, axis=0), axis=1)]


def _convex(ring):
    ring = _distinct(ring)
    along = ring - np.roll(ring, 1, axis=0)
    turns = np.cross(along, np.roll(along, -1, axis=0))
    return len(turns) > 2 and (np.all(turns > 1e-6) or np.all(turns < -1e-6))
