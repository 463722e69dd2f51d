# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressures on faces of bricks as forces at points of them. This module needs no YADE."""

import itertools
import math
from collections import Counter
from typing import Any, NamedTuple

import numpy as np

from ..arguments import number
from ..errors import Refused, checkPlane
from ..bricks import Bricks
from ..bricks.checks import LOOKING

GRAZING = 0.01  # least cosine between a face and the pressure on it [-]
PARTS = 4  # of each side of a triangle, which is integrated in PARTS² triangles
LEAST = 1e-9  # forces below this share of the largest one are round-off [-]
FIELD = number("Pa", -1e9, 1e9)


class FaceForce(NamedTuple):
    """A force on a face: the number of its brick, the force [N] and its point [m]."""

    brick: int
    force: Any
    point: Any


def facesAgainst(description, towards, part, name, least=LOOKING):
    """Faces that look against a direction, without what joints cover:
    :class:`masonry.bricks.checks.FreePart`.

    :param least: cosine of the largest angle between both [-]
    :raises ValueError: if there are none
    """
    checkPlane(description, towards, name)
    if description.deformable:
        raise Refused(f"{name}: it loads rigid bricks; choose --blocks rigid")
    faces = [
        face
        for face in Bricks(description.bricks).freeFaces([-v for v in towards], least)
        if part in (None, description.bricks[face.block].part)
    ]
    if not faces:
        raise ValueError(f"{name}: no free face looks against {tuple(towards)}")
    return faces


def pressures(description, value, towards, part, normal, friction=0.0):
    """The forces of a pressure: on each face at its middle and at one more point, or at two more in
    space. Parameters as in :func:`masonry.scene.loads.pressure`. Raises ValueError."""
    if friction and not normal:
        raise ValueError("pressure: friction is of a pressure along the normals (normal=True)")
    forces, along = [], np.array(towards, float) / np.linalg.norm(towards)
    for face in facesAgainst(description, towards, part, "pressure", GRAZING):
        outward, arm = np.array(face.normal), face.area**0.5 / 4
        # two directions in the face; the first is in the plane of a scene in a plane
        side = np.cross(outward, (0, 1, 0) if abs(outward[1]) < 0.9 else (0, 0, 1))
        side /= np.linalg.norm(side)
        axes = arm * np.array([side, np.cross(outward, side)])
        total, *moments = _integral(face, value, axes[: 1 if description.plane else 2])
        unit = -(outward @ along) * along
        if normal:
            down = outward[2] * outward - (0, 0, 1)
            steepness = max(GRAZING, np.linalg.norm(down))
            unit = math.tan(math.radians(friction)) / steepness * down - outward
        ends = [face.middle, *(face.middle + axis for axis in axes)]
        for point, size in zip(ends, [total - sum(moments), *moments]):
            forces.append(FaceForce(face.block, list(size * unit), tuple(point)))
    return forces


def _corners():
    """The middles of the sides of parts of a triangle, as shares of its corners, and their weights:
    exact for polynomials of degree two."""
    found = Counter()
    for i, j in itertools.product(range(PARTS), repeat=2):
        one = [(i, j), (i + 1, j), (i, j + 1)]
        other = [(i + 1, j + 1), (i, j + 1), (i + 1, j)]
        for corners in (one, other)[: max(0, PARTS - i - j)]:
            for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1]):
                found[a + c, b + d] += 1
    places = np.array([*found]) / (2 * PARTS)
    shares = np.column_stack([1 - places.sum(axis=1), places])
    return shares, np.array([*found.values()]) / (3 * PARTS**2)


SHARES, WEIGHTS = _corners()


def _integral(face, value, axes):
    """Integrals over the free part of a face [N]: of a pressure, and of it times the distance from
    the middle along each axis, over the length of that axis."""
    at = lambda p: atPlace(value, p, FIELD, "pressure") if callable(value) else value
    total = np.zeros(1 + len(axes))
    for sign, polygon in ((1, face.face), *((-1, cover) for cover in face.covers)):
        corners = np.asarray(polygon, float)
        first = corners[0]
        for second, third in zip(corners[1:], corners[2:]):
            area = 0.5 * np.linalg.norm(np.cross(second - first, third - first))
            points = SHARES @ [first, second, third]
            forces = sign * area * WEIGHTS * [at(place) for place in points.tolist()]
            arms = [(points - face.middle) @ axis / (axis @ axis) for axis in axes]
            total += [forces.sum(), *(forces @ arm for arm in arms)]
    return total.tolist()


def atPlace(value, place, kind, name):
    """The value of a function of the place, checked by a validator. Raises ValueError."""
    try:
        return kind(value(*place))
    except Exception as error:  # of the user's own
        where = ", ".join(f"{v:.4g}" for v in place)
        raise ValueError(f"{name}: its value at ({where}) m: {error}") from None


def placesBelow(description, points):
    """Where loads stand that are let down from some points: of each the numbers of the bricks that
    have it on their highest face that looks up, and share it where it is on a joint, and the point
    there [m]; no bricks where there is none."""
    faces, found = Bricks(description.bricks).freeFaces((0, 0, 1), GRAZING), []
    near = 1e-6 * math.dist(description.low, description.high)
    for x, y, z in points:
        below: dict[int, float] = {}
        for face in faces:
            corners, normal = np.array(face.face), np.array(face.normal)
            high = corners[0, 2] - normal[:2] @ ((x, y) - corners[0, :2]) / normal[2]
            sides = np.roll(corners, -1, axis=0) - corners
            inward = np.cross(sides, (x, y, high) - corners) @ normal
            if high <= z + near and min(inward) >= -near * np.abs(sides).max():
                below[face.block] = max(float(high), below.get(face.block, -math.inf))
        high = max(below.values(), default=float(z))
        bricks = [brick for brick, level in below.items() if level >= high - near]
        found.append((bricks, (float(x), float(y), high)))
    return found
