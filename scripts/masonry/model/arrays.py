# SPDX-License-Identifier: GPL-2.0-or-later
"""The blocks, joints and loads of the scene in YADE as arrays, as limit analysis takes them."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from yade import O

from ..errors import Refused
from ..numbers.cracks import CRACK_SURFACE
from .bodies import placeOf
from .loading import LIFT, bodiesOf

#: Blocks that have moved by less, over the size of a typical block, are taken where they stood when
#: the joints were made [-]. A factor changes by as much; without it Clp takes ten times as long.
STOOD = 1e-3
NEVER = 1e300  # strength of a tie that does not yield [N]
AXES = "xyzXYZ"  # of blockedDOFs
#: Smaller components of normals are set to zero [-]. A structure at rest under its weight has them
#: everywhere, and with them the solver takes up to a hundred times as long.
SMALLEST = 1e-5


def _unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def blocksAndJoints() -> dict[str, Any]:
    """The blocks and joints of the scene as they stand now: the arguments of
    :class:`masonry_limit.Assembly`. Open joints are taken as closed, so after supports have moved
    far the answer is one for other joints. Raises Refused if there are no joints."""
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
    place = _Placement(blocks)
    joint = np.repeat(np.arange(len(joints)), [len(p) for p in points])
    corner = np.repeat(np.arange(len(joints)), [len(p) for p in polygons])
    normals = _unit(place.turned(pairs, np.array(_rows([g.normal for g in geoms]))))
    moved = place.moved(pairs[corner], np.concatenate(polygons))
    strengths = np.array([_strengths(i.phys.joint) for i in joints], float).T
    return dict(
        centres=place.now,
        masses=np.array([b.state.mass for b in blocks], float),
        held=_held(blocks),
        pairs=pairs,
        normals=_unit(np.where(np.abs(normals) < SMALLEST, 0.0, normals)),
        joint=joint,
        points=place.moved(pairs[joint], np.concatenate(points)),
        areas=np.array([a for g in geoms for a in g.areas], float),
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
    """Ties and springs as :class:`Assembly` takes them. Springs carry any force; ties that break
    keep theirs, so the bound stays an upper one."""
    found = []
    for engine in O.engines:
        kind = type(engine).__name__
        if kind not in ("MasonryTies", "MasonrySprings") or engine.dead:
            continue
        ends = zip(engine.bodies1, engine.points1, engine.bodies2, engine.points2)
        for n, (one, at1, other, at2) in enumerate(ends):
            one, other = numbers.get(one), numbers.get(other)  # None: the ground
            at1, at2 = place.placed(one, at1), place.placed(other, at2)
            if kind == "MasonryTies":
                if engine.brokenAt and engine.brokenAt[n] >= 0:
                    continue
                axis = (at2 - at1) / np.linalg.norm(at2 - at1)
                most = engine.strength[n] if engine.strength[n] < NEVER else np.inf
                bounds = -most if engine.compression[n] else 0.0, most
                forces = [np.append(axis, np.zeros(3))]
            else:
                stiffness = [*engine.stiffness[n], *engine.rotationalStiffness[n]]
                forces, bounds = np.eye(6)[np.array(stiffness) > 0], (-np.inf, np.inf)
            for force in forces:
                loads = []
                for sign, block, at in ((1, one, at1), (-1, other, at2)):
                    if block is not None:
                        moment = np.cross(at - place.now[block], force[:3]) + force[3:]
                        load = sign * np.append(force[:3], moment)
                        loads.append((block, load))
                found.append((loads, *bounds))
    return found


def _rows(vectors):
    return [(v[0], v[1], v[2]) for v in vectors]


def _held(blocks):
    """Whether each block is held along x, y, z and about them (n, 6). Nodes of deformable units are
    held in their engine, not in the States of their bodies."""
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
        self.turns = np.array([(s.ori * s.refOri.conjugate()).toRotationMatrix() for s in states])
        sizes = np.array([max(v.norm() for v in b.shape.v) for b in blocks])
        angles = np.linalg.norm(self.turns - np.eye(3), axis=(1, 2))
        moved = np.linalg.norm(self.now - self.was, axis=1) + sizes * angles
        self.stood = bool((moved < STOOD * np.median(sizes)).all())
        if self.stood:
            self.now, self.turns = self.was, np.tile(np.eye(3), (len(blocks), 1, 1))

    def placed(self, block, point):
        """Where a point in the reference state of a block is; of None, the ground, itself."""
        point = np.array(point)
        if block is None:
            return point
        return self.turns[block] @ (point - self.was[block]) + self.now[block]

    def turned(self, pairs, vectors):
        """Means of directions (k, 3) fixed to both blocks of pairs (k, 2) in the reference
        state."""
        return 0.5 * (self._turn(pairs[:, 0], vectors) + self._turn(pairs[:, 1], vectors))

    def _turn(self, blocks, vectors):
        return np.einsum("kij,kj->ki", self.turns[blocks], vectors)

    def moved(self, pairs, points):
        """Means of points (k, 3) fixed to both blocks of pairs (k, 2) in the reference state."""
        at = lambda side: self._turn(side, points - self.was[side]) + self.now[side]
        return 0.5 * (at(pairs[:, 0]) + at(pairs[:, 1]))


def _strengths(p):
    crushing = math.inf
    if p.cap and not p.elastic:
        # of eq. (8c) without shear: Cnn σ² - Cn σ = fc²
        half, root = p.capLinear / (2 * p.capNormal), p.compressiveStrength**2 / p.capNormal
        crushing = half + math.sqrt(half * half + root)
    cohesion = max(p.cohesion, p.residualCohesion)
    friction = max(p.friction, p.residualFriction)
    return p.tensileStrength, cohesion, friction, crushing, p.elastic


def _corners(body, stood):
    """Corners of a block now, or when the joints were made (k, 3) [m]."""
    state = body.state
    turn, at = (state.refOri, state.refPos) if stood else (state.ori, state.pos)
    return np.array(body.shape.v) @ np.array(turn.toRotationMatrix()).T + np.array(at)


# -- loads -----------------------------------------------------------------------------------------


@dataclass
class DeadLoad:
    """A load that acts beside another one.

    :param point: on the body, in the structure as built [m]
    :param force: when it has grown [N]
    :param label: of its engine
    :param held: unit vector along which a drive holds bodies, or None
    """

    body: int
    point: Any
    force: np.ndarray
    label: str
    held: np.ndarray | None
    bodies: list[int]

    @property
    def isLift(self):
        return self.label.endswith(LIFT)


def deadLoads(model):
    """Presses, dead loads and wind when they have grown, and drives that hold the structure."""
    for load, force in model.loading.deadLoads():
        held = np.array(load.direction.normalized()) if load.driven else None
        yield DeadLoad(load.body, load.point, np.array(force), load.label, held, [*bodiesOf(load)])


def beside(model, gravity):
    """Loads beside a load, and supports, as data that can be compared."""
    loads = [[load.body, *force, load.driven] for load, force in model.loading.deadLoads()]
    held = [O.bodies[target.body].state.blockedDOFs for target in model.supports.held]
    return [list(gravity), loads, held]


def placeNow(body, point):
    """Where a point of a body is now [m], by its place in the structure as built."""
    return np.array(placeOf(body, point))
