# SPDX-License-Identifier: GPL-2.0-or-later
"""Polygons in a plane, (n, 2) [m], counter-clockwise."""

import numpy as np

from ..geometry import FLAT

STRAIGHT = 2 * FLAT  # distance of a straight corner from its line over the size of the polygon


def inside(points, ring):
    x, z = points[:, :1], points[:, 1:]
    a, b = ring, np.roll(ring, -1, axis=0)
    passed = (a[:, 1] > z) != (b[:, 1] > z)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (z - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return (passed & (x < at)).sum(axis=1) % 2 == 1


def crossing(ring):
    """A place near where a polygon crosses itself, or None."""
    a, b = ring, np.roll(ring, -1, axis=0)
    side = lambda p, q, r: np.cross(q - p, r - p)
    one = side(a[:, None], b[:, None], a) * side(a[:, None], b[:, None], b) < 0
    found = np.argwhere(one & one.T)
    return (a + b)[found[0]].mean(axis=0) / 2 if len(found) else None


def area(ring):
    """[m²], negative for a polygon that is clockwise."""
    return np.sum(np.cross(ring, np.roll(ring, -1, axis=0))) / 2


def turns(ring):
    """How far each corner is out of the line between its neighbours [m], negative inwards."""
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    base = np.maximum(np.linalg.norm(after - before, axis=1), 1e-300)
    return np.cross(ring - before, after - ring) / base


def withoutStraight(ring, numbers=False):
    """A polygon without straight corners, or the numbers of the others."""
    size, good = np.linalg.norm(np.ptp(ring, axis=0)), np.arange(len(ring))
    while len(good) > 2:
        straight = abs(turns(ring[good]))
        if straight.min() > STRAIGHT * size:
            break
        good = np.delete(good, straight.argmin())
    return good if numbers else ring[good]


def convexParts(ring):
    """Convex polygons that make up a polygon. Every cut begins at a concave corner."""
    ring = withoutStraight(ring)
    bent = np.flatnonzero(turns(ring) < 0)
    if not len(bent):
        return [ring] if len(ring) > 2 else []
    one, two = max(_cuts(ring, bent), key=_worth)
    return convexParts(one) + convexParts(two)


def _worth(parts):
    """Worth of a cut: few corners stay concave, then the thinner part is thick."""
    concave = sum((turns(withoutStraight(part)) < 0).sum() for part in parts)
    thin = min(area(p) / np.linalg.norm(np.ptp(p, axis=0)) for p in parts)
    return -concave, thin


def _cuts(ring, bent):
    """Pairs of polygons, cut from a corner to another one, or straight on to a side."""
    following = np.roll(ring, -1, axis=0)
    sides = following - ring
    for n in bent:
        towards = np.delete(ring, n, axis=0) - ring[n]
        straight = [sides[n - 1], -sides[n]]
        for direction in (*straight, sum(d / np.hypot(*d) for d in straight), *towards):
            with np.errstate(divide="ignore", invalid="ignore"):
                slope = np.cross(direction, sides)
                far = np.cross(ring - ring[n], sides) / slope
                share = np.cross(ring - ring[n], direction) / slope
            hit = (far > 1e-9) & (share > -1e-9) & (share < 1 + 1e-9)
            hit[[n - 1, n]] = False
            if not hit.any():
                continue
            k = int(np.argmin(np.where(hit, far, np.inf)))
            end = ring[n] + far[k] * direction
            if not inside((ring[n] + end)[None] / 2, ring)[0]:
                continue
            near = STRAIGHT * np.linalg.norm(sides[k])
            if np.hypot(*(end - ring[k])) < near:
                end = ring[k]
            elif np.hypot(*(end - following[k])) < near:
                end = following[k]
            turned = np.roll(ring, -n, axis=0)
            m = (k - n) % len(ring)
            one = np.concatenate([turned[: m + 1], [end]])
            two = np.concatenate([turned[:1], [end], turned[m + 1 :]])
            if min(area(one), area(two)) > 0:
                yield one, two
