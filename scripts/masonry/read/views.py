# SPDX-License-Identifier: GPL-2.0-or-later
"""From where a structure is seen in a picture, and how much its displacements are magnified. This module needs no YADE."""

from __future__ import annotations

from collections import namedtuple
from typing import Any

import numpy as np

MAGNIFICATION = 30  # of displacements in cracks.png, as in figure 6 of the paper (see yade_plugin/law/README.md)

#: Smallest and largest size of the drawn displacements over the size of the structure with the usual magnification. Outside
#: these limits another magnification is chosen, so that they are about as large as :data:`SHOWN`.
SEEN = 0.002, 0.6
SHOWN = 0.06
REACH = 1.5  # how far what moved is in a picture, over the size of what was built
#: How a part is seen. ``right`` and ``up`` are unit vectors of the picture, ``towards`` is that to the viewer; ``labels``
#: are those of the axes, and ``name`` says where the viewer stands. A point p lies at ((p - start)·right, (p - start)·up).
View = namedtuple("View", "right up towards start labels name")


def viewOf(points, normals, areas, sight=None):
    """The view of a part: a :class:`View`, chosen by its shape.

    If all joints stand across one horizontal direction, as those of a wall of one wythe at any angle in plan and those of
    an arch do, the part is seen along this direction. Else it is seen along the short side of the smallest rectangle
    around its plan, or from above if it is wider than high, as a dome or a vault is. What is up stays up; from above, x
    is to the right and y is up.

    :param points: corners of its blocks, an array of (x, y, z) [m]
    :param normals: unit normals of its joints, an array
    :param areas: areas of these joints [m²]
    :param sight: direction of sight (x, y, z), if the user gave one
    """
    flat, height = points[:, :2], np.ptp(points[:, 2])
    corners = hull(flat)
    edges = np.roll(corners, -1, axis=0) - corners
    best = None
    for edge in edges[np.linalg.norm(edges, axis=1) > 1e-9]:
        along = edge / np.linalg.norm(edge)
        across = np.array([-along[1], along[0]])
        sides = np.ptp(flat @ along), np.ptp(flat @ across)
        if best is None or sides[0] * sides[1] < best[0] * best[1] * (1 - 1e-9):
            best = (*sides, along, across)
    first, second, along, across = best
    towardsX = abs(across[0]) > abs(along[0])
    if second > 1.05 * first or second > first / 1.05 and towardsX:
        first, second, along, across = second, first, across, along
    if sight is not None:
        away = -np.array(sight, float) / np.linalg.norm(sight)
    else:
        away = np.array([0, 0, 1.0])
        total = areas.sum()
        stands = lambda side: areas @ (normals[:, :2] @ side) ** 2 < 1e-6 * total
        standing = [side for side in (across, along) if total and stands(side)]
        if standing or second <= height:
            away = np.append(standing[0] if standing else across, 0)
    return _viewFrom(away, points, sight is None)


def _viewFrom(away, points, either):
    """The view of points by a viewer in this direction; ``either``: or opposite, if that turns x or y to the right."""
    if abs(away[2]) > 1 - 1e-6:
        right, up = np.eye(3)[:2]
        name = "from above"
    else:
        up = np.array([0, 0, 1]) - away[2] * away
        up /= np.linalg.norm(up)
        right = np.cross(up, away)
        if either and (right[0] < -1e-3 or (abs(right[0]) <= 1e-3 and right[1] < 0)):
            right = -right
        name = ""
    towards = np.cross(right, up)
    start, labels = np.zeros(3), []
    for direction in (right, up):
        axis = int(np.argmax(np.abs(direction)))
        if direction[axis] > 1 - 1e-5:
            labels.append("xyz"[axis] + " [m]")
            continue
        start = start + (points @ direction).min() * direction
        angle = np.degrees(np.arctan2(direction[1], direction[0]))
        level = f"along the part, {angle:.0f}° from x [m]"
        labels.append(level if abs(direction[2]) < 1e-6 else "upwards in the picture [m]")  # fmt: skip
    return View(right, up, towards, start, labels, name)


def hull(points):
    """Corners of the convex hull of points in a plane, counter-clockwise: an array of (x, y)."""
    points = np.unique(np.asarray(points, float).round(12), axis=0)
    if len(points) < 3:
        return points

    def half(ordered):
        chain = []
        for p in ordered:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2], chain[-1]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0:
                    break
                chain.pop()
            chain.append(p)
        return chain[:-1]

    ordered = points.tolist()
    return np.array(half(ordered) + half(ordered[::-1]))


def outline(flat, depth):
    """Numbers of the points that lie on the outline of a block, in order around it.

    Of points behind each other the one next to the viewer is taken. Points between corners are kept, since the side of a
    deformable block can bend.
    """
    corners = hull(flat)
    near = 1e-6 * np.ptp(flat, axis=0).max()
    order, place = [], []
    behind = np.argsort(-depth, kind="stable")
    for n, (a, b) in enumerate(zip(corners, np.roll(corners, -1, axis=0))):
        length = np.linalg.norm(b - a)
        if length <= near:
            continue
        along = (b - a) / length
        off = flat[behind] - a
        s = off @ along
        on = np.abs(off[:, 0] * along[1] - off[:, 1] * along[0]) < near
        on &= (s > -near) & (s < length - near)
        order += behind[on].tolist()
        place += (n + s[on] / length).tolist()
    order, place = np.array(order, int), np.array(place)
    ranks = np.argsort(place, kind="stable")
    keep = np.append(True, np.diff(place[ranks]) > 1e-6)
    return order[ranks][keep]


def magnificationOf(size: float, moved: Any) -> int:
    """How much displacements are magnified: as usual, or by 1, 2 or 5 times a power of ten if that would be absurd.

    :param size: largest extent of the structure [m]
    :param moved: displacements of the corners of its blocks [m]. If some are far too large, as those of bricks that fell,
        one in fifty is left out of consideration
    """
    far = max(moved, default=0.0)
    if MAGNIFICATION * far > SEEN[1] * size:
        most = float(np.quantile(moved, 0.98))
        if MAGNIFICATION * most >= SEEN[0] * size:
            far = most
    if not far or SEEN[0] * size <= MAGNIFICATION * far <= SEEN[1] * size:
        return MAGNIFICATION
    wanted = SHOWN * size / far
    power = 10 ** np.floor(np.log10(wanted))
    nice = max(step * power for step in (1, 2, 5) if step * power <= wanted)
    return max(1, int(nice))
