# SPDX-License-Identifier: GPL-2.0-or-later
"""Convex solids given by their corners, many at a time: faces, volumes, gaps and overlaps. Solids
whose corners stand in the same order share the search for faces."""

import itertools
import math
from math import dist

import numpy as np

from ..arguments import Numbers, items, shown

#: Largest gap or overlap of faces that share a joint over the diagonal of the smaller block. This
#: and the next three bounds are the plugin's (yade_plugin/blocks/FaceContact.hpp).
COINCIDENT = 1e-4

#: Largest distance of a corner from the plane of its face over the diagonal of the block, as of
#: coordinates of six digits.
FLAT = 1e-5

#: Cosine between outward normals below which faces look at each other. Faces within 6° of that, and
#: a quarter of the thinner block, were probably meant to touch.
OPPOSITE = -np.cos(np.radians(0.5))
NEARLY_OPPOSITE = -np.cos(np.radians(6))
REACH = 0.25

#: Pairs of blocks that are compared at a time.
_CHUNK = 10_000


def hull(corners):
    """Faces of the convex solid around corners (n, 3) [m]: tuples of corner numbers,
    counter-clockwise from outside. Raises ValueError if they have no volume, or if one is no corner
    of the solid."""
    corners = np.asarray(corners, float)
    middle = corners.mean(axis=0)
    size = np.ptp(corners, axis=0).max()
    if not size > 0:
        raise ValueError("all its corners are one point")
    centred = (corners - middle) / size
    for n in range(1, len(corners)):
        if np.abs(centred[:n] - centred[n]).max(axis=1).min() < 1e-9:
            raise ValueError(f"corner {n} at {_place(corners[n])} m is given twice")
    # a run of a wall of boxes needs none
    from scipy.spatial import ConvexHull, QhullError

    try:
        found = ConvexHull(centred)
    except QhullError:
        raise ValueError(f"its {len(corners)} corners lie in one plane: no volume") from None
    triangles = centred[found.simplices]
    first, second = (triangles[:, n] - triangles[:, 0] for n in (1, 2))
    areas = np.linalg.norm(np.cross(first, second), axis=1)
    faces, left = [], np.ones(len(triangles), bool)
    # from the largest triangle on, whose plane is the surest
    for n in np.argsort(-areas, kind="stable"):
        if left[n]:
            normal, offset = found.equations[n][:3], found.equations[n][3]
            same = left & (np.abs(triangles @ normal + offset).max(axis=1) < FLAT)
            left &= ~same
            faces.append(_around(np.unique(found.simplices[same]), centred, normal))
    for n in range(len(corners)):
        if sum(n in face for face in faces) < 3:
            raise ValueError(
                f"corner {n} at {_place(corners[n])} m is no corner of the convex solid around all"
                " of them"
            )
    return tuple(faces)


def _around(members, corners, normal):
    """Corners of a face, counter-clockwise about its normal."""
    points = corners[members] - corners[members].mean(axis=0)
    first = points[0] / np.linalg.norm(points[0])
    angles = np.arctan2(points @ np.cross(normal, first), points @ first)
    return tuple(int(n) for n in members[np.argsort(angles)])


def _place(point):
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"


class SameTopologyBatch:
    """Convex solids whose corners stand in the same order.

    :ivar index: numbers of the solids, (n,)
    :ivar corners: (n, corners, 3) [m]
    :ivar faces: as of :func:`hull`
    :ivar normals: outward unit normals, (n, faces, 3)
    :ivar offsets: normal times a point of the face, (n, faces) [m]
    :ivar fit: whether these faces are those of the solid, (n,)
    """

    def __init__(self, index, corners, faces):
        self.index, self.corners, self.faces = index, corners, faces
        size = np.linalg.norm(np.ptp(corners, axis=1), axis=1)
        centres, normals = [], []
        for face in faces:
            centres.append(corners[:, face].mean(axis=1))
            arms = corners[:, face] - centres[-1][:, None]
            # Newell: half the sum of the products of neighbouring corners
            normals.append(np.cross(arms, np.roll(arms, -1, axis=1)).sum(axis=1) / 2)
        self._areaVectors = np.stack(normals, axis=1)
        self._centres = np.stack(centres, axis=1)
        self.areas = np.linalg.norm(self._areaVectors, axis=2)
        with np.errstate(invalid="ignore", divide="ignore"):
            self.normals = self._areaVectors / self.areas[..., None]
        self.offsets = np.einsum("nfk,nfk->nf", self.normals, self._centres)
        heights = np.einsum("nfk,nck->nfc", self.normals, corners)
        heights -= self.offsets[..., None]
        on = [[n in face for n in range(corners.shape[1])] for face in faces]
        limit = (FLAT * size)[:, None, None]
        with np.errstate(invalid="ignore"):
            fit = np.where(on, np.abs(heights) <= limit, heights < -limit)
        self.fit = fit.all(axis=(1, 2))
        self.thickness = -heights.min(axis=2).max(axis=1)  # along the thinnest normal

    def volumes(self):
        """[m³]"""
        arms = self._centres - self.corners.mean(axis=1)[:, None]
        return np.einsum("nfk,nfk->n", self._areaVectors, arms) / 3


class Solids:
    """Convex solids, given by the corners (corners, 3) of each [m].

    :ivar problems: what is wrong with solids, by number; they have no faces here
    """

    def __init__(self, solids):
        self.count = len(solids)
        self.low, self.high = np.zeros((2, self.count, 3))
        self.problems, self.groups = {}, []
        byCorners = {}
        for n, corners in enumerate(solids):
            byCorners.setdefault(len(corners), []).append(n)
        for members in byCorners.values():
            index = np.array(members)
            corners = np.array([solids[n] for n in members], float)
            self.low[index], self.high[index] = corners.min(axis=1), corners.max(axis=1)
            self._sort(index, corners)
        self.groupOf, self.rowOf = np.full((2, self.count), -1)
        for g, group in enumerate(self.groups):
            self.groupOf[group.index] = g
            self.rowOf[group.index] = np.arange(len(group.index))
        self.diagonal = np.linalg.norm(self.high - self.low, axis=1)

    def _sort(self, index, corners):
        while len(index):
            try:
                batch = SameTopologyBatch(index, corners, hull(corners[0]))
                if not batch.fit[0]:
                    raise ValueError(
                        "its corners lie so near to one another, or to one plane, that its faces"
                        " cannot be found"
                    )
                fit = batch.fit
                self.groups.append(
                    batch if fit.all() else SameTopologyBatch(index[fit], corners[fit], batch.faces)
                )
            except ValueError as error:
                self.problems[int(index[0])] = str(error)
                fit = np.arange(len(index)) == 0
            index, corners = index[~fit], corners[~fit]

    def volumes(self):
        """[m³], (n,); NaN for a solid with problems."""
        return self._each(SameTopologyBatch.volumes)

    def thicknesses(self):
        """Smallest extent along a normal [m], (n,); NaN for a solid with problems."""
        return self._each(lambda group: group.thickness)

    def _each(self, measure):
        found = np.full(self.count, np.nan)
        for group in self.groups:
            found[group.index] = measure(group)
        return found

    def padded(self, name):
        """``corners``, ``normals`` or ``offsets`` of all in one array, in which the last one of a
        solid is repeated."""
        values = [getattr(group, name) for group in self.groups]
        numbers = np.arange(max(own.shape[1] for own in values))
        found = np.zeros((self.count, len(numbers), *values[0].shape[2:]))
        for group, own in zip(self.groups, values):
            found[group.index] = own[:, np.minimum(numbers, own.shape[1] - 1)]
        return found

    def of(self, solid):
        """The group of a solid, and its row there."""
        return self.groups[self.groupOf[solid]], self.rowOf[solid]

    def face(self, solid, number):
        """Corners of a face, (corners, 3) [m]."""
        group, row = self.of(solid)
        return group.corners[row][list(group.faces[number])]

    # -- pairs -------------------------------------------------------------------------------------

    def nearPairs(self, reach):
        """Pairs of solids whose bounding boxes are no further apart than the sum of their ``reach``
        [m]: arrays of numbers."""
        good = np.flatnonzero(self.groupOf >= 0)
        if len(good) < 2:
            return np.zeros((2, 0), int)
        low = self.low[good] - reach[good, None]
        high = self.high[good] + reach[good, None]
        # along the axis on which they overlap least
        extent = high.max(axis=0) - low.min(axis=0)
        axis = np.argmin((high - low).mean(axis=0) / np.maximum(extent, 1e-300))
        order = np.argsort(low[:, axis], kind="stable")
        good, low, high = good[order], low[order], high[order]
        last = np.searchsorted(low[:, axis], high[:, axis], side="right")
        pairs = []
        for n, end in enumerate(last):
            near = (low[n + 1 : end] <= high[n]) & (low[n] <= high[n + 1 : end])
            other = good[n + 1 : end][near.all(axis=1)]
            pairs.append((np.full_like(other, good[n]), other))
        return np.sort(np.concatenate(pairs, axis=1), axis=0)

    def compare(self, one, two):
        """Distances of pairs of solids along the normal of the face that parts them best [m],
        negative for an overlap; numbers of the faces of both that look at each other; and the
        cosines between these."""
        pairs = np.array([one, two])
        beyond, normals = self.beyond(pairs), self.padded("normals")
        mine, theirs = beyond.max(axis=2)
        first = mine >= theirs
        face = np.where(first, *beyond.argmax(axis=2))
        here, there = np.where(first, pairs, pairs[::-1])
        # the face of the other solid that looks at this one
        cosines = np.einsum("nk,ngk->ng", normals[here, face], normals[there])
        faces = np.array([face, cosines.argmin(axis=1)])
        return np.maximum(mine, theirs), np.where(first, faces, faces[::-1]), cosines.min(axis=1)

    def beyond(self, pairs):
        """How far solids of pairs (2, n) are beyond each face of the other [m]: (2, n, faces), the
        faces of the first one first."""
        corners, normals, offsets = map(self.padded, ("corners", "normals", "offsets"))
        parts = np.array_split(pairs, pairs.shape[1] // _CHUNK + 1, axis=1)
        heights = [
            np.einsum("pnfk,pnck->pnfc", normals[p], corners[p[::-1]]).min(axis=3) for p in parts
        ]
        return np.concatenate(heights, axis=1) - offsets[pairs]

    def separation(self, one, two):
        """Distance of two solids by the separating axis theorem [m], negative for an overlap."""
        corners, sides, axes = [], [], []
        for solid in (one, two):
            group, row = self.of(solid)
            corners.append(group.corners[row])
            axes.append(group.normals[row])
            ends = group.corners[row][np.array(sorted(edges(group.faces)))]
            along = ends[:, 1] - ends[:, 0]
            sides.append(along / np.linalg.norm(along, axis=1)[:, None])
        across = np.cross(sides[0][:, None], sides[1][None]).reshape(-1, 3)
        length = np.linalg.norm(across, axis=1)
        across = across[length > 1e-6] / length[length > 1e-6, None]
        a, b = (c @ np.concatenate([*axes, across]).T for c in corners)
        gaps = np.maximum(b.min(axis=0) - a.max(axis=0), a.min(axis=0) - b.max(axis=0))
        return gaps.max()


def edges(faces):
    """Edges of a solid: pairs of corner numbers, the smaller first."""
    pairs = (pair for face in faces for pair in zip(face, face[1:] + face[:1]))
    return {(min(pair), max(pair)) for pair in pairs}


def cosSin(quarters, angle):
    """Cosine and sine of an angle [rad], exact if it is a whole number of quarter turns."""
    if quarters == round(quarters):
        return [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][round(quarters) % 4]
    return math.cos(angle), math.sin(angle)


def clip(polygon, other, normal):
    """Common part of two convex polygons in a plane, the first counter-clockwise about the normal,
    the other clockwise: a list of points."""
    px, py, pz = normal
    kept = [tuple(p) for p in polygon]
    others = [tuple(p) for p in other]
    for (ax, ay, az), (bx, by, bz) in zip(others, others[1:] + others[:1]):
        ex, ey, ez = bx - ax, by - ay, bz - az
        # inward: the edge turned by the normal
        ix, iy, iz = ey * pz - ez * py, ez * px - ex * pz, ex * py - ey * px
        level = ax * ix + ay * iy + az * iz
        sides = [x * ix + y * iy + z * iz - level for x, y, z in kept]
        if min(sides) >= 0:
            continue
        cut = []
        for k, (p, s) in enumerate(zip(kept, sides)):
            q, t = kept[k - 1], sides[k - 1]
            if (s < 0) != (t < 0):
                share = t / (t - s)
                cut.append(tuple(u + share * (v - u) for u, v in zip(q, p)))
            if s >= 0:
                cut.append(p)
        kept = cut
        if len(kept) < 3:
            return []
    return kept


def measures(polygon, normal):
    """Area [m²], perimeter [m] and centroid [m] (None without an area) of a convex polygon."""
    x0, y0, z0 = polygon[0]
    nx, ny, nz = normal
    twice = mx = my = mz = 0.0
    for (ax, ay, az), (bx, by, bz) in zip(polygon[1:], polygon[2:]):
        ax, ay, az, bx, by, bz = ax - x0, ay - y0, az - z0, bx - x0, by - y0, bz - z0
        part = (ay * bz - az * by) * nx + (az * bx - ax * bz) * ny
        part += (ax * by - ay * bx) * nz
        twice += part
        mx, my, mz = mx + part * (ax + bx), my + part * (ay + by), mz + part * (az + bz)
    perimeter = sum(map(dist, polygon, polygon[1:] + polygon[:1]))
    if not twice > 0:
        return 0.0, perimeter, None
    k = 3 * twice
    return twice / 2, perimeter, (x0 + mx / k, y0 + my / k, z0 + mz / k)


def cutCorners(corners, faces, point, normal, width):
    """Corners of the parts of a convex solid beyond a plane and below; None for a part without
    volume. A corner within ``width`` of the plane [m] counts as in it."""
    corners = [tuple(map(float, c)) for c in corners]
    heights = [sum((x - p) * n for x, p, n in zip(c, point, normal)) for c in corners]
    above = [c for c, h in zip(corners, heights) if h >= -width]
    below = [c for c, h in zip(corners, heights) if h <= width]
    for a, b in sorted(edges(faces)):
        ends = heights[a], heights[b]
        if min(ends) < -width and max(ends) > width:
            share = heights[a] / (heights[a] - heights[b])
            new = tuple(u + share * (v - u) for u, v in zip(corners[a], corners[b]))
            above, below = [*above, new], [*below, new]
    return (
        tuple(above) if max(heights) > width else None,
        tuple(below) if min(heights) < -width else None,
    )


def joinedCorners(pieces):
    """Corners of the convex solid that pieces make up, or None."""
    volume = math.fsum(Solids(pieces).volumes())
    points = list(dict.fromkeys(corner for piece in pieces for corner in piece))
    low, high = (tuple(map(end, zip(*points))) for end in (min, max))
    size = math.prod(b - a for a, b in zip(low, high))
    if abs(size - volume) < COINCIDENT * size:
        return boxCorners(low, high)
    from scipy.spatial import ConvexHull  # as in hull()

    found = ConvexHull(points)
    if abs(found.volume - volume) < COINCIDENT * volume:
        return tuple(points[n] for n in sorted(found.vertices))
    return None


def prism(section, low, high):
    """Corners of a section (x, z) stretched along y [m]."""
    return tuple((x, y, z) for y in (low, high) for x, z in section)


def boxCorners(low: Numbers, high: Numbers) -> tuple[tuple[float, float, float], ...]:
    """The eight corners of an axis-parallel box, x slowest and z fastest."""
    for corner, what in ((low, "low"), (high, "high")):
        if len(items(corner) or ()) != 3:
            raise ValueError(f"boxCorners: {what} [m] must be three numbers, got {shown(corner)}")
    return tuple(itertools.product(*zip(low, high)))
