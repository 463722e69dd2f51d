# SPDX-License-Identifier: GPL-2.0-or-later
"""The blocks and joints of the scene in YADE, as limit analysis takes them."""

from __future__ import annotations

import math

import numpy as np
from yade import O

from ..basics import Refused
from ..read.cracks import CRACK_SURFACE
from .assembly import Assembly

#: What has moved by less, over the size of a typical block, is taken where it stood when the joints were made [-]. It changes
#: a factor by as much, and without it all coefficients of a programme differ by a little, which takes Clp ten times as long.
STOOD = 1e-3
NEVER = 1e300  # strength of a tie that does not yield [N]
AXES = "xyzXYZ"  # as blockedDOFs names the freedoms of a body


#: Components of normals that are smaller are zero [-]. A structure at rest under its weight has such ones everywhere, and with
#: them the solver takes up to a hundred times as long.
SMALLEST = 1e-5


def _cleared(normals):
    """Unit normals without components that are nearly zero."""
    kept = np.where(np.abs(normals) < SMALLEST, 0.0, normals)
    return kept / np.linalg.norm(kept, axis=1)[:, None]


def read() -> Assembly:
    """The blocks and joints of the scene in YADE, as they stand now: an :class:`Assembly`. Where no block has moved by more
    than :data:`STOOD`, they are taken as they stood when the joints were made.

    Joints that have opened are taken as closed, so after supports have moved far the answer is one for other joints.

    :raises Refused: if there are no joints
    """
    blocks = list(O.bodies)
    numbers = {body.id: number for number, body in enumerate(blocks)}
    joints = [i for i in O.interactions if type(i.geom).__name__ == "MasonryJointGeom"]
    if not joints:
        raise Refused("limit analysis: the scene has no joints; connect() makes them")
    joints.sort(key=lambda i: (i.id1, i.id2))
    geoms = [i.geom for i in joints]
    pairs = np.array([[numbers[i.id1], numbers[i.id2]] for i in joints])
    points = [_rows(g.centres) for g in geoms]
    polygons = [_rows(g.polygon) for g in geoms]
    areas = [a for g in geoms for a in g.areas]
    place = _Placement(blocks)
    joint = np.repeat(np.arange(len(joints)), [len(p) for p in points])
    corner = np.repeat(np.arange(len(joints)), [len(p) for p in polygons])
    normals = place.turned(pairs, np.array(_rows([g.normal for g in geoms])))
    moved = place.moved(pairs[corner], np.concatenate(polygons))
    strengths = np.array([_strengths(i.phys.joint) for i in joints], float).T
    return Assembly(
        centres=place.now,
        masses=np.array([b.state.mass for b in blocks], float),
        held=_held(blocks),
        pairs=pairs,
        normals=_cleared(normals / np.linalg.norm(normals, axis=1)[:, None]),
        joint=joint,
        points=place.moved(pairs[joint], np.concatenate(points)),
        areas=np.array(areas, float),
        tension=strengths[0],
        cohesion=strengths[1],
        friction=strengths[2],
        crushing=strengths[3],
        elastic=strengths[4] > 0,
        ids=[b.id for b in blocks],
        polygons=np.split(moved, np.cumsum([len(p) for p in polygons])[:-1]),
        corners=[_corners(b, place.stood) for b in blocks],
        stood=place.stood,
        links=_links(numbers, place),
        seams=np.array([i.phys.joint.name == CRACK_SURFACE for i in joints]),
    )


def _links(numbers, place):
    """Ties and springs of the scene, as :class:`Assembly` takes them. Springs carry any force; ties that break keep theirs, so
    what is found stays an upper bound."""
    found = []
    for engine in O.engines:
        kind = type(engine).__name__
        if kind not in ("MasonryTies", "MasonrySprings") or engine.dead:
            continue
        ends = zip(engine.bodies1, engine.points1, engine.bodies2, engine.points2)
        for n, (one, at1, other, at2) in enumerate(ends):
            sides = [(body, place.placed(numbers.get(body), at)) for body, at in ((one, at1), (other, at2))]  # fmt: skip
            if kind == "MasonryTies":
                if engine.brokenAt and engine.brokenAt[n] >= 0:
                    continue
                away = sides[1][1] - sides[0][1]
                most = engine.strength[n] if engine.strength[n] < NEVER else np.inf
                least = -most if engine.compression[n] else 0.0
                pairs = [(away / np.linalg.norm(away), False, least, most)]
            else:
                pairs = [
                    (axis, turns, -np.inf, np.inf)
                    for turns, stiffness in ((False, engine.stiffness[n]), (True, engine.rotationalStiffness[n]))
                    for k, axis in zip(stiffness, np.eye(3))
                    if k > 0
                ]  # fmt: skip
            for axis, turns, least, most in pairs:
                loads = []
                for sign, (body, at) in zip((1, -1), sides):
                    if body in numbers:
                        arm = at - place.now[numbers[body]]
                        six = [np.zeros(3), axis] if turns else [axis, np.cross(arm, axis)]  # fmt: skip
                        loads.append((numbers[body], sign * np.concatenate(six)))
                found.append((loads, least, most))
    return found


def _rows(vectors):
    """Vectors of YADE as a list of (x, y, z)."""
    return [(v[0], v[1], v[2]) for v in vectors]


def _held(blocks):
    """Whether each block cannot move along x, y, z or turn about them (n, 6). The nodes of deformable units are held in their
    engine, not in the States of their bodies."""
    blocked = [b.state.blockedDOFs for b in blocks]
    numbers = {body.id: number for number, body in enumerate(blocks)}
    for engine in O.engines:
        if type(engine).__name__ == "MasonryZones":
            along = engine.blocked
            about = "".join(axis.upper() for axis in "xyz" if set(along) - {axis})
            for body in engine.bodies:
                blocked[numbers[body]] = along + about
    return np.array([[axis in axes for axis in AXES] for axes in blocked])


class _Placement:
    """Where blocks are now, and how they have turned since the reference state."""

    def __init__(self, blocks):
        states = [b.state for b in blocks]
        self.was = np.array(_rows([s.refPos for s in states]))
        self.now = np.array(_rows([s.pos for s in states]))
        self.turns = np.array(
            [(s.ori * s.refOri.conjugate()).toRotationMatrix() for s in states]
        )
        sizes = np.array([max(v.norm() for v in b.shape.v) for b in blocks])
        angles = np.linalg.norm(self.turns - np.eye(3), axis=(1, 2))
        moved = np.linalg.norm(self.now - self.was, axis=1) + sizes * angles
        self.stood = bool((moved < STOOD * np.median(sizes)).all())
        if self.stood:
            self.now, self.turns = self.was, np.tile(np.eye(3), (len(blocks), 1, 1))

    def placed(self, block, point):
        """Where a point of a block is, given in the reference state; of None, the ground, the point itself."""
        point = np.array(point)
        if block is None:
            return point
        return self.turns[block] @ (point - self.was[block]) + self.now[block]

    def turned(self, pairs, vectors):
        """The mean of directions fixed to both blocks of pairs (k, 2), from the reference state (k, 3)."""
        turn = lambda side: np.einsum("kij,kj->ki", self.turns[pairs[:, side]], vectors)
        return 0.5 * (turn(0) + turn(1))

    def moved(self, pairs, points):
        """The mean of points fixed to both blocks of pairs (k, 2), from the reference state (k, 3)."""
        ways = []
        for block in pairs.T:
            arms = points - self.was[block]
            ways.append(np.einsum("kij,kj->ki", self.turns[block], arms) + self.now[block])  # fmt: skip
        return 0.5 * (ways[0] + ways[1])


def _strengths(p):
    """Tensile strength, cohesion, friction, compressive strength, and whether a joint never gives way."""
    cohesion, friction = max(p.cohesion, p.residualCohesion), max(p.friction, p.residualFriction)  # fmt: skip
    values = p.tensileStrength, cohesion, friction
    if p.elastic or not p.cap:
        return *values, math.inf, p.elastic
    # of eq. (8c) without shear: Cnn σ² - Cn σ = fc²
    half = p.capLinear / (2 * p.capNormal)
    crushing = half + math.sqrt(half * half + p.compressiveStrength**2 / p.capNormal)
    return *values, crushing, p.elastic


def _corners(body, stood):
    """Corners of a block as it stands now, or as it stood when the joints were made (k, 3) [m]."""
    state = body.state
    turn, at = (state.refOri, state.refPos) if stood else (state.ori, state.pos)
    return np.array(body.shape.v) @ np.array(turn.toRotationMatrix()).T + np.array(at)
