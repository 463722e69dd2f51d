# SPDX-License-Identifier: GPL-2.0-or-later
"""Convex solids with mortar between them grow until they meet in the middle of it."""

from collections import defaultdict, namedtuple

import numpy as np

from ..checks import components, where
from ..geometry import Solids, clip, measures

#: Cosine between outward normals of faces that look at each other across mortar: within 20°.
FACING = -np.cos(np.radians(20))

#: Two faces with mortar between: (solid, face) of each, common area [m²], and middle [m] and normal
#: of the mortar from the first to the second.
_Gap = namedtuple("_Gap", "one two area middle normal")


def closed(solids, mortar, problems):
    """Corners of the solids after all faces with mortar between them, and those in line with them,
    as of a bed joint, have moved to its middle plane.

    :param solids: corners of each
    :param mortar: largest thickness of a joint [m]
    :param problems: takes sentences on faces that fit no plane
    """
    found = Solids(solids)
    gaps = [
        gap
        for pair in zip(*found.nearPairs(np.full(found.count, mortar / 2)))
        for gap in _gaps(found, mortar, *map(int, pair))
    ]
    faces = sorted({face for gap in gaps for face in (gap.one, gap.two)})
    number = {face: n for n, face in enumerate(faces)}
    group = components(len(faces), [(number[g.one], number[g.two]) for g in gaps])
    together = defaultdict(list)
    for gap in gaps:
        together[group[number[gap.one]]].append(gap)
    planes = {}
    for members in together.values():
        first = members[0].normal
        areas = [g.area for g in members]
        normal = np.average(
            [g.normal * np.sign(g.normal @ first) for g in members], axis=0, weights=areas
        )
        normal /= np.linalg.norm(normal)
        offset = np.average([g.middle @ normal for g in members], weights=areas)
        for gap in members:
            for solid, face in (gap.one, gap.two):
                away = abs(found.face(solid, face) @ normal - offset).max()
                if away > mortar:
                    problems.append(
                        f"a face of solid {solid} at"
                        f" {where(found.face(solid, face).mean(axis=0))} is {away:.3g} m off the"
                        " plane that it shares with the faces across the mortar, more than"
                        f" {mortar:g} m"
                    )
                side = np.sign(_plane(found, solid, face)[0] @ normal)
                planes[solid, face] = side * normal, side * offset
    return [_grown(found, n, corners, planes) for n, corners in enumerate(solids)]


def _plane(solids, n, face):
    """Outward normal of a face, and its offset [m]."""
    group, row = solids.of(n)
    return group.normals[row, face], group.offsets[row, face]


def _gaps(solids, mortar, one, two):
    ours, theirs = (group.normals[row] for group, row in map(solids.of, (one, two)))
    for f, g in np.argwhere(ours @ theirs.T < FACING).tolist():
        normal = ours[f] - theirs[g]
        normal /= np.linalg.norm(normal)
        mine, other = solids.face(one, f), solids.face(two, g)
        flat = lambda polygon: polygon - np.outer(polygon @ normal, normal)
        shared = clip(flat(mine), flat(other), normal)
        if len(shared) < 3:
            continue
        area, _, spot = measures(shared, normal)
        if spot is None:
            continue
        # how high both planes are over the spot, along the common normal
        heights = [
            (d - n @ spot) / (n @ normal)
            for n, d in (_plane(solids, one, f), _plane(solids, two, g))
        ]
        if -mortar / 10 <= heights[1] - heights[0] <= mortar:
            yield _Gap((one, f), (two, g), area, np.array(spot) + sum(heights) / 2 * normal, normal)


def _grown(solids, n, corners, planes):
    count = len(solids.of(n)[0].faces)
    if not any((n, face) in planes for face in range(count)):
        return corners
    from scipy.spatial import HalfspaceIntersection

    middle = np.mean(corners, axis=0)
    half = [planes.get((n, face)) or _plane(solids, n, face) for face in range(count)]
    rows = np.array([[*normal, normal @ middle - offset] for normal, offset in half])
    size = solids.diagonal[n]
    points = HalfspaceIntersection(rows / [1, 1, 1, size], np.zeros(3)).intersections
    _, first = np.unique(np.round(points, 7), axis=0, return_index=True)
    return tuple(tuple(map(float, middle + size * points[k])) for k in sorted(first))
