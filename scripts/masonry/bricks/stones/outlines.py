# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of drawn stones, which meet in the middle of the mortar between them.

Closely spaced points a little inside the outlines are those of a Voronoi diagram, whose cells make
up the stones. The joints between two stones are straightened.
"""

import math
from collections import namedtuple
from typing import Annotated, Any

import numpy as np

from ...arguments import FilePath, number, validated
from ...terminal import say
from ..blocks import Block, Bricks, Length, refuse
from ..checks import where
from ..geometry import prism
from .polygons import area, convexParts, crossing, inside, withoutStraight
from .drawings import read
from .joint_lines import straightened

SPACING = 0.25  # of points along an outline, over the tolerance [-]
VOID = -1  # label outside stones
MAX_POINTS = 2_000_000
MAX_STONE = 1000  # length or height of a stone over the mortar; such a one takes a minute
FAR = 10  # sizes of a drawing that it may be away from its origin without a note
SKEWED = 1e-9  # third moment of the stones, over the size, from which on a drawing is one-sided


class DrawnWall(Bricks):
    """The wall of :func:`fromOutlines`, which knows its mortar.

    :ivar mortar: mean thickness of the mortar, by length of joint [m]
    :ivar unit: mean length of the drawn stones, thickness of the wall, and their mean height [m]
    """

    def __init__(self, blocks: Any, mortar: float, unit: Any, points: Any) -> None:
        from scipy.spatial import cKDTree

        super().__init__(blocks)
        self.mortar, self.unit, self._step = mortar, unit, points.step
        own = [points.stones == n for n in range(points.stones.max() + 1)]
        self._trees = [cKDTree(points.places[n]) for n in own]
        self._normals = [points.normals[n] for n in own]
        self._boxes = np.array([(tree.mins, tree.maxes) for tree in self._trees])

    def thickness(self, x: float, y: float, z: float) -> float:
        """Thickness of the mortar at a place of a joint [m]: the sum of the distances of the two
        nearest stones, at least a quarter of the tolerance."""
        place = x, z
        beyond = np.maximum(self._boxes[:, 0] - place, place - self._boxes[:, 1])
        near = np.argsort(np.linalg.norm(np.maximum(beyond, 0), axis=1))[:8]
        return max(sum(sorted(self._distance(n, place) for n in near)[:2]), self._step)

    def _distance(self, stone, place):
        """Distance from an outline, of which a piece lies along each point."""
        k = self._trees[stone].query(place)[1]
        arm, normal = place - self._trees[stone].data[k], self._normals[stone][k]
        beside = abs(float(np.cross(normal, arm)))
        return math.hypot(float(arm @ normal), max(beside - self._step / 2, 0.0))

    def withMortar(self, masonry: Any) -> Any:
        """Scale the joints of a :class:`masonry.materials.Masonry`, which are those of the mean
        thickness, by their thickness t, and return it: stiffness by mean/t, compressive fracture
        energy by t/mean, so that strengths and strains are the same."""
        thinner = lambda *place: self.mortar / self.thickness(*place)
        for name in (n for n in ("bed", "head") if n in masonry.joints):
            masonry.vary([f"{name}.normalStiffness", f"{name}.shearStiffness"], thinner)
            if masonry.joints[name].cap:
                masonry.vary(
                    f"{name}.compressiveFractureEnergy", lambda *place: 1 / thinner(*place)
                )
        return masonry


@validated
def fromOutlines(
    path: FilePath,
    thickness: Length,
    mortar: Annotated[float, number("m", 1e-4, 1)],
    scale: Annotated[float, number("m", 0, 1e6, above=True)] | None = None,
    tolerance: Annotated[float, number("m", 1e-5, 1)] | None = None,
    layer: str | None = None,
    mend: bool = False,
    part: str = "wall",
) -> DrawnWall:
    """A wall of the stones of a drawing or an orthophoto, its lower left front corner at the
    origin: a :class:`Bricks`.

    Formats: ``.dxf`` (every closed curve, filled areas, and lines and arcs that close to one; in
    blocks too; not on hidden layers), ``.svg`` (all shapes, also of ``use``), ``.geojson``
    (polygons), and ``.csv`` with rows of name, x, z. The second axis of a drawing is upwards; one
    in a plane in space is turned into it. Texts and the like are left out with a note, anything
    else that cannot be read is an error. Stones meet in the middle of the mortar, and reach to the
    sides of the box around all of them within twice ``mortar``. Where a ball of the radius
    ``mortar`` has space there is a window, a door, or the air around the wall. At a step of the
    box, as of a gable, stones get tongues of up to ``mortar``. Concave stones are several blocks of
    one brick, whose joint is ``crack``. A mirrored drawing gives the mirrored wall.

    :param thickness: of the wall [m]
    :param mortar: largest thickness of a joint [m]; a stone is at most 1000 times as large
    :param scale: metres in one unit of the file; None: what the file says (``$INSUNITS`` of DXF,
        the width of SVG in mm or the like), else 1
    :param tolerance: largest distance by which a joint moves when short ones are closed, lines
        straightened, and stones made convex, each [m]; None: a quarter of ``mortar``
    :param layer: layer of a DXF file, or id or label of a group of an SVG file; None: all
    :param mend: whether to close open outlines, to leave out stones thinner than two tolerances,
        and to share overlaps in halves, with notes
    :raises ValueError: with all problems and their places
    """
    fine = mortar / 4 if tolerance is None else tolerance
    drawing = read(str(path), layer)
    scale = _scale(scale, drawing.unit)
    drawn = drawing.outlines
    corner = np.min([o.ring.min(axis=0) for o in drawn], axis=0)
    for outline in drawn:
        outline.ring = (outline.ring - corner) * scale
    if (far := abs(corner).max() * scale) > FAR * np.max([o.ring.max() for o in drawn]):
        say(f"note: fromOutlines: the drawing is {far:.6g} m from its origin; it is moved there")
    _limit(drawn, SPACING * fine, mortar)
    stones = _checked(str(path), drawn, fine, mend)
    back = _mirrored(stones)
    points = _sampled(stones, SPACING * fine)
    cells = _grown(points, stones, mortar)
    rings, places, holes = straightened(cells, fine)
    for hole in holes:
        size, hole = " x ".join(f"{a:.3g}" for a in np.ptp(hole, axis=0)), back(hole)
        say(
            f"note: fromOutlines: a hole of {size} m near {_at(hole)}; one in the mortar closes"
            " with a larger mortar="
        )
    blocks, problems = [], []
    for n, stone in enumerate(stones):
        ring = withoutStraight(places[rings[n]]) if n in rings else []
        if len(ring) < 3 or crossing(ring) is not None:
            problems.append(
                f"{stone.name} near {_at(back(stone.ring))}: nothing is left of it, or it crosses"
                f" itself, at a tolerance of {fine:g} m"
            )
            continue
        for face in convexParts(ring):
            blocks.append(Block(prism(back(face).tolist(), 0.0, thickness), n, part))
    refuse(str(path), problems)
    sizes = np.mean([np.ptp(s.ring, axis=0) for s in stones], axis=0)
    unit = float(sizes[0]), thickness, float(sizes[1])
    normals = back(points.normals) - back(0 * points.normals)
    points = points._replace(places=back(points.places), normals=normals)
    return DrawnWall(blocks, cells.mortar, unit, points)


def _scale(scale, unit):
    """Metres in one unit of a file. What the user says counts."""
    if scale is None:
        if unit:
            say(f"note: fromOutlines: one unit of the file is {unit:g} m, as it says")
        return unit or 1.0
    if unit and abs(scale / unit - 1) > 0.01:
        say(f"note: fromOutlines: the file says {unit:g} m for its unit; scale={scale:g} counts")
    return scale


def _mirrored(stones):
    """Mirror stones so that most of them are near the left and the lower side, in place, and begin
    each outline at its leftmost corner: what follows then gives a drawing and its mirror image the
    same wall. Returns the function that mirrors points back, in their order."""
    size = np.max([stone.ring.max(axis=0) for stone in stones], axis=0)
    areas = np.array([area(stone.ring) for stone in stones])
    middles = np.array([(stone.ring.min(axis=0) + stone.ring.max(axis=0)) / 2 for stone in stones])
    away = middles - np.average(middles, axis=0, weights=areas)
    turned = np.average(away**3, axis=0, weights=areas) < -SKEWED * size**3

    def back(points):
        return np.where(turned, size - points, points)

    for stone in stones:
        ring = back(stone.ring)
        if turned.sum() == 1:
            ring = ring[::-1]
        stone.ring = np.roll(ring, -np.lexsort(ring.T[::-1])[0], axis=0)
    return back


def _at(ring):
    return where(ring.mean(axis=0))


def _checked(path, drawn, fine, mend):
    """The outlines of stones, counter-clockwise. Raises ValueError, or prints what was mended."""
    fatal, found, kept = [], [], []
    for outline in drawn:
        ring = outline.ring
        spot = crossing(ring) if len(ring) > 2 else None
        if spot is not None:
            fatal.append(f"{outline.name} crosses itself near {where(spot)}")
            continue
        if not outline.closed:
            found.append(
                f"{outline.name} is open between {where(ring[-1])} and {where(ring[0])}: close it"
            )
        size = area(ring)
        thin = abs(size) / max(np.linalg.norm(np.ptp(ring, axis=0)), 1e-300)
        if thin < 2 * fine:
            found.append(
                f"{outline.name} near {_at(ring)} is a sliver, {thin:.3g} m thin, below two"
                f" tolerances of {fine:g} m: leave it out"
            )
            continue
        outline.ring = ring if size > 0 else ring[::-1]
        kept.append(outline)
    stones = [s for s in kept if not _overlapping(s, kept, fine, found)]
    if not stones:
        fatal.append(f"no stones are left at a tolerance of {fine:g} m")
    refuse(path, fatal + ([] if mend else [*found, *["mend=True does so"] * bool(found)]))
    for one in found:
        say(f"note: fromOutlines: {one}")
    return stones


def _overlapping(stone, others, fine, found):
    """Add sentences on overlaps of a stone; returns whether it lies within another one."""
    ring = stone.ring
    points, normals = _along(ring, fine)
    points = points - fine / 2 * normals  # two equal outlines lie within each other
    for other in others:
        if (
            other is stone
            or (ring.min(0) > other.ring.max(0)).any()
            or (ring.max(0) < other.ring.min(0)).any()
        ):
            continue
        shared = points[inside(points, other.ring)]
        if not len(shared):
            continue
        edge, _ = _along(other.ring, fine)
        away = np.linalg.norm(shared[:, None] - edge, axis=2)
        depths = fine / 2 + away.min(axis=1)
        first = others.index(stone) < others.index(other)
        both = f"{stone.name} and {other.name}"
        # of two equal ones the second goes
        if len(shared) > 0.9 * len(points) and (np.ptp(ring, 0).prod(), first) <= (
            np.ptp(other.ring, 0).prod(),
            False,
        ):
            found.append(f"{stone.name} near {_at(ring)} lies within {other.name}: leave it out")
            return True
        if depths.max() > fine:
            found.append(
                f"{both} overlap by {depths.max():.3g} m near {where(shared[depths.argmax()])}:"
                " share it"
            )
    return False


#: Points on outlines (n, 2), outward normals, numbers of stones, and distance [m].
_Points = namedtuple("_Points", "places normals stones step")

#: Sides of cells between two labels: numbers of the places at their ends (n, 2), labels left and
#: right, and mean thickness of the mortar [m].
_Cells = namedtuple("_Cells", "places ends labels mortar")


def _along(ring, step):
    """Points along an outline, and outward normals."""
    places, normals = [], []
    for a, b in zip(ring, np.roll(ring, -1, axis=0)):
        count = int(np.ceil(np.hypot(*(b - a)) / step))
        places.append(a + (np.arange(count)[:, None] + 0.5) / count * (b - a))
        normal = np.array([b[1] - a[1], a[0] - b[0]]) / np.hypot(*(b - a))
        normals.append(np.tile(normal, (count, 1)))
    return np.concatenate(places), np.concatenate(normals)


def _limit(stones, step, mortar):
    problems = []
    largest = max(np.ptp(stone.ring, axis=0).max() for stone in stones)
    if largest > MAX_STONE * mortar:
        problems.append(
            f"a stone of {largest:.3g} m must be at most {MAX_STONE} times mortar, {mortar:g} m"
        )
    length = sum(np.linalg.norm(s.ring - np.roll(s.ring, 1, axis=0), axis=1).sum() for s in stones)
    if not length / step <= MAX_POINTS:
        problems.append(
            f"outlines of {length:.3g} m and a tolerance of {step / SPACING:g} m need more than"
            f" {MAX_POINTS} points"
        )
    right = "is scale, metres in one unit of the file, right?"
    refuse("fromOutlines", [f"{problem}: {right}" for problem in problems])


def _sampled(stones, step):
    found = [_along(stone.ring, step) for stone in stones]
    numbers = np.repeat(np.arange(len(stones)), [len(p) for p, _ in found])
    return _Points(*map(np.concatenate, zip(*found)), numbers, step)


def _within(places, ring):
    near = np.flatnonzero(((places >= ring.min(0)) & (places <= ring.max(0))).all(1))
    return near[inside(places[near], ring)]


def _grown(points, stones, radius):
    """Cells of the stones, which are at the air where a ball that rolls along them finds space."""
    from scipy.spatial import Voronoi, cKDTree

    places, normals, _, inset = points
    low, high = places.min(axis=0), places.max(axis=0)
    ball = places + radius * normals
    free = cKDTree(places).query(ball)[0] > radius * (1 - 1e-3)
    free &= (ball - radius > low).all(axis=1) & (ball + radius < high).all(axis=1)
    sites = places - inset * normals
    good, alone = np.zeros(len(sites), bool), np.ones(len(sites), bool)
    for n, stone in enumerate(stones):
        # in a stone that touches another one a ball would roll along its own inside
        free[_within(ball, stone.ring)] = False
        within = _within(sites, stone.ring)
        own = points.stones[within] == n
        good[within[own]] = True
        alone[within[~own]] = False  # in an overlap
    good &= alone
    voids = [places[free & alone] + inset * normals[free & alone]]
    for axis, side in ((0, low), (0, high), (1, low), (1, high)):
        mirrored = sites[good & (abs(sites[:, axis] - side[axis]) < 2 * radius)]
        mirrored[:, axis] = 2 * side[axis] - mirrored[:, axis]
        voids.append(mirrored)
    turn = np.arange(64)[:, None] * np.pi / 32
    far = np.linalg.norm(high - low) + 4 * radius
    voids.append((low + high) / 2 + far * np.hstack([np.cos(turn), np.sin(turn)]))
    voids = np.concatenate(voids)
    sites = np.concatenate([sites[good], voids])
    labels = np.concatenate([points.stones[good], np.full(len(voids), VOID)])
    diagram = Voronoi(sites)
    pairs, ends = diagram.ridge_points, np.array(diagram.ridge_vertices)
    parts = (labels[pairs[:, 0]] != labels[pairs[:, 1]]) & (ends >= 0).all(axis=1)
    pairs, ends = pairs[parts], ends[parts]
    along = diagram.vertices[ends[:, 1]] - diagram.vertices[ends[:, 0]]
    # the first label is that of the left side
    turned = np.cross(along, sites[pairs[:, 0]] - diagram.vertices[ends[:, 0]]) < 0
    ends[turned] = ends[turned, ::-1]
    both = (labels[pairs] >= 0).all(axis=1)
    gaps = np.linalg.norm(sites[pairs[:, 0]] - sites[pairs[:, 1]], axis=1) - 2 * inset
    lengths = np.linalg.norm(along, axis=1)
    mean = np.average(np.maximum(gaps[both], inset), weights=lengths[both]) if both.any() else inset
    return _Cells(diagram.vertices, ends, labels[pairs], float(mean))
