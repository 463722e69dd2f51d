# SPDX-License-Identifier: GPL-2.0-or-later
"""Supports of a structure: forces and displacements of its platens and held bricks, and rest."""

import math

from yade import O, Vector3

from ..units import GRAVITY
from .loading import Pattern, forceOn, reactionOf
from .motion import FALLEN

#: Share of horizontal loads above which they must be carried on their own at rest [-].
HORIZONTAL = 1e-3
SMALL_REACTION = 0.1  # along an axis over the largest one [-]
LOST = 0.5  # swing under loads over the height [-]: one that would swing by more is not waited for
FILLED = 1e-9  # free share of a platen's side that counts as full [-]


class _Point:
    """A point of a body, at ``arm`` from its centre as built [m]."""

    def __init__(self, body, at):
        self.state = O.bodies[body].state
        self.upright = self.state.refOri.conjugate()
        self.arm = Vector3(*at) - self.state.refPos
        self._own = self.upright * self.arm

    def moved(self):
        state = self.state
        return state.pos + state.ori * self._own - state.refPos - self.arm


def _reach(block, direction):
    """How far the corners of a block lie along a direction [m]."""
    return [direction.dot(Vector3(*p)) for p in block.corners]


class Supports:
    """Platens, and bricks that are held, loaded or watched.

    - ``held``: targets with a held direction
    - ``freeMass``: of all other blocks [kg]
    - ``unloaded``: what :meth:`alongWall` was before the present load
    """

    def __init__(self, structure):
        self.structure, self.description = structure, structure.description
        targets = self.description.targets.values()
        self.held = [target for target in targets if target.freedom]
        zones = structure.zones
        self._deformable = set(zones.bodies) if zones else set()
        self._points = {t.name: _Point(t.body, t.recorded) for t in targets}
        self._ofPattern = None, ()  # a pattern, and its points with their shares
        self._faces = {t.name: [*self._faceOf(t)] for t in targets if t.box and not t.fixed}
        held = {target.body for target in self.held}
        self.freeMass = sum(b.state.mass for b in O.bodies if b.id not in held)

    def _jointsOf(self, target):
        return [i for i in self.structure.interactions if target.body in (i.id1, i.id2)]

    def _faceOf(self, target):
        """The middles of a platen's joints, as points of the bricks, with their shares of the
        area; of deformable bricks their own middles."""
        joints = self._jointsOf(target)
        whole = sum(sum(one.geom.areas) for one in joints)
        for one in joints:
            brick = one.id2 if one.id1 == target.body else one.id1
            areas, area = one.geom.areas, sum(one.geom.areas)
            middle = sum((a * c for a, c in zip(areas, one.geom.centres)), Vector3.Zero) / area
            middle = O.bodies[brick].state.refPos if brick in self._deformable else middle
            yield area / whole, _Point(brick, middle)

    def holdAlso(self, target, axes):
        if target not in self.held:
            self.held.append(target)
            self.freeMass -= O.bodies[target.body].state.mass
        held = {*(target.freedom or ""), *axes}
        target.freedom = "".join(a for a in "xyzXYZ" if a in held)

    def forceOn(self, target):
        """Force of the structure on a target [N]."""
        return O.forces.f(target.body, True)

    def supportedBy(self, target):
        """Force of the structure on a target along the axes that are held now [N]."""
        force, blocked = self.forceOn(target), O.bodies[target.body].state.blockedDOFs
        return Vector3(*(f if a in blocked else 0.0 for a, f in zip("xyz", force)))

    def forceFrom(self, target):
        """Force of loads, drives and supports on a target [N]."""
        return self._loadsOn(target) - self.supportedBy(target)

    def _loadsOn(self, target):
        loads = self.structure.loading.loads.values()
        return sum((forceOn(load, target.body) for load in loads), Vector3.Zero)

    def jointsOn(self, target):
        """Force of the joints of a target on it [N]."""
        return self.forceOn(target) - self._loadsOn(target)

    def moved(self, target):
        """Displacement of a target's recorded point since the scene was built [m], and rotation,
        about y in a plane, else its angle [rad]; the mean displacement of a pattern, and 0."""
        if isinstance(target, Pattern):
            if target is not self._ofPattern[0]:
                points = [(share, _Point(body, at)) for body, at, share in target.parts]
                self._ofPattern = target, points
            return sum((s * p.moved() for s, p in self._ofPattern[1]), Vector3.Zero), 0.0
        point = self._points[target.name]
        axis, angle = (point.state.ori * point.upright).toAxisAngle()
        return point.moved(), angle * axis[1] if self.description.plane else angle

    def masonryMoved(self, target, direction):
        """Displacement of the bricks at a platen, or of what :meth:`moved` has, along a direction
        since the scene was built [m]."""
        face = self._faceAt(target)
        if not face:
            return self.moved(target)[0].dot(direction)
        return sum(share * point.moved().dot(direction) for share, point in face)

    def _faceAt(self, target):
        return None if isinstance(target, Pattern) else self._faces.get(target.name)

    def heights(self, target, direction):
        """Heights of the recorded point of a target, and of the points of :meth:`masonryMoved`,
        above the lowest brick [m]; None of one that is not above it, or if the direction is not
        horizontal."""
        face, z = self._faceAt(target), target.recorded[2]
        of = sum(share * (p.state.refPos[2] + p.arm[2]) for share, p in face) if face else z
        above = [level - self.description.low[2] for level in (z, of)]
        return [h if h > 0 and abs(direction[2]) < 1e-9 else None for h in above]

    def applied(self):
        """Sum of the weights of what is free to follow them, and of the loads [N]."""
        gravity = self.structure.scheme.now
        applied = self.freeMass * gravity
        for target in self.held:
            state = O.bodies[target.body].state
            for i, axis in enumerate("xyz"):
                if axis not in state.blockedDOFs:
                    applied[i] += state.mass * gravity[i]
        loads = self.structure.loading.loads.values()
        return sum((load.force for load in loads), applied)

    def carried(self):
        """Sum of the forces of supports and drives on the structure [N]."""
        carried = Vector3.Zero
        for target in self.held:
            carried -= self.supportedBy(target)
        for load in self.structure.loading.loads.values():
            carried += reactionOf(load)
        return carried - self.structure.connectors.onGround()

    def _endsOf(self, across):
        """A horizontal unit vector at right angles to a direction, and the held bricks in the first
        and the last quarter of the structure along it."""
        along = Vector3(-across[1], across[0], 0).normalized()
        held = [t for t in self.held if t.brick is not None]
        if not held or not along.norm():
            return along, ([], [])
        places = [v for b in self.description.bricks for v in _reach(b, along)]
        low, high = min(places), max(places)
        off = lambda t: (along.dot(Vector3(*t.recorded)) - (low + high) / 2) / (high - low)
        return along, [[t for t in held if side * off(t) > 0.25] for side in (-1, 1)]

    def alongWall(self, across):
        """Thrust of the ends of a wall against held bricks, at right angles to a load ``across``
        it, and the force that all supports carry along that load [N]."""
        along, ends = self._endsOf(across)
        low, high = (sum(self.supportedBy(t).dot(along) for t in end) for end in ends)
        return max(0.0, min(-low, high)), -self.carried().dot(across)

    def arching(self, across):
        """Thrust as in :meth:`alongWall` that came since ``unloaded`` [kN], and the share of the
        load that it carries at most [-]: 8 N r/(F L), the thrust N times its rise r over the moment
        of the load F on the clear span L. The rise is from the side in compression in the middle of
        the span to the far side of the held bricks."""
        thrust, load = (now - was for now, was in zip(self.alongWall(across), self.unloaded))
        if thrust <= 0 or load <= 0:
            return 0.0, 0.0
        (along, ends), bricks = self._endsOf(across), self.description.bricks
        low, high = ([bricks[t.brick] for t in end] for end in ends)
        far = max(max(_reach(b, across)) for b in low + high)
        low = min(max(_reach(b, along)) for b in low)
        high = max(min(_reach(b, along)) for b in high)
        middle = [b for b in bricks if 2 * min(p := _reach(b, along)) <= low + high <= 2 * max(p)]
        rise = far - min((min(_reach(b, across)) for b in middle), default=far)
        share = 8 * thrust * rise / load / max(high - low, 1e-9)
        return 1e-3 * thrust, min(1.0, max(0.0, share))

    def unrest(self):
        """Share of the loads, or of the horizontal ones if larger, that is missing at the supports,
        and kinetic over elastic energy [-]."""
        energy = self.structure.energy.balance()
        elastic = sum(
            energy.get(f"elastic_{m}", 0.0)
            for m in ("compression", "shear", "tension", "units", "connectors")
        )
        applied, carried = self.applied(), self.carried()
        if self.description.plane:
            applied[1] = carried[1] = 0
        size = applied.norm()
        loads = sum(one.force.norm() for one in self.structure.loading.loads.values())
        if size < 1e-6 * loads:  # loads that balance each other
            size = loads
        rest = applied + carried
        missing = rest.norm() / (size or 1.0)
        across, flat = (Vector3(v[0], v[1], 0).norm() for v in (applied, rest))
        if across > HORIZONTAL * size:  # else it is round-off of what is vertical
            missing = max(missing, flat / across)
        moving = abs(energy["kinetic"])
        # without loads motion is compared with the work of the weight over a picometre
        least = 1e-12 * GRAVITY * self.freeMass
        return missing, moving / max(elastic, least) if moving else 0.0

    def imbalance(self):
        """The force that inertia takes over the largest reaction of a support, of the axis along
        which that is most [-]; axes without a reaction above :data:`SMALL_REACTION` of the largest
        do not count."""
        of = lambda t: self.supportedBy(t) + self.structure.connectors.onSpringsOf(t)
        reactions, inertia = [of(target) for target in self.held], self.applied() + self.carried()
        largest = [max((abs(one[i]) for one in reactions), default=0.0) for i in range(3)]
        counted = (i for i in range(3) if largest[i] > SMALL_REACTION * max(largest))
        return max((abs(inertia[i]) / largest[i] for i in counted), default=0.0)

    def _sinkingPeriod(self):
        """The vertical period of a structure so soft that its swing under its loads could be taken
        for a fall [s]; 0 of a stiffer one, and of one that would lose more of its height than
        :data:`LOST`. It counts as a column of its height and volume, as soft as its softest joint.
        """
        structure, description = self.structure, self.description
        load = structure.gravity * self.freeMass
        load -= sum(force[2] for _, force in structure.loading.deadLoads())
        height = description.high[2] - description.low[2]
        bricks = (O.bodies[body] for body in structure.ids)
        area = sum(b.state.mass / b.material.density for b in bricks) / height
        sinking = max(0.0, load) * height / self._softest() / area
        least = min(description.size(n) for n in range(len(structure.ids)))
        if not FALLEN * least < 2 * sinking < LOST * height:
            return 0.0
        return 2 * math.pi * math.sqrt(sinking * structure.args.density_scaling / GRAVITY)

    def _softest(self):
        """The least modulus of the masonry across a joint, with that of deformable bricks [Pa]."""
        moduli = [math.inf]
        for one in self.structure.interactions:
            thickness = one.geom.distance1 + one.geom.distance2
            compliance = 1 / (one.phys.normalStiffness * thickness)
            soft = self._deformable & {one.id1, one.id2}
            compliance += max((1 / O.bodies[b].material.young for b in soft), default=0)
            moduli.append(1 / compliance)
        return min(moduli)

    def slowest(self):
        """The longest period of what is free [s]: of one rigid body on the springs of a platen, or
        of :meth:`_sinkingPeriod`; 0 without either. Weight makes a rotation slower; where it
        overturns the body, there is no period."""
        held = {target.body for target in self.held}
        found = [self._sinkingPeriod()]
        free = [body.state for body in O.bodies if body.id not in held]
        springs = [one for one in self.description.connectors if one.WORD == "spring"]
        for one in [*springs, *self.description.soils]:
            if not (one.ends[0].target and one.ends[0].target.box):
                continue
            arms = [(s.mass, s.pos - Vector3(*one.ends[0].point)) for s in free]
            weight = self.structure.gravity * sum(m * r[2] for m, r in arms)  # lever
            pairs = [(self.freeMass, one.stiffness[i]) for i in range(3)]
            for i, k in enumerate(one.rotation[:2]):
                if k:
                    inertia = sum(m * (r.dot(r) - r[i] ** 2) for m, r in arms)
                    pairs.append((inertia, k - weight))
            found += [2 * math.pi * math.sqrt(m / k) for m, k in pairs if k > 0]
        return max(found)

    def contactOf(self, target):
        """Area of a platen's joints [m²], and their middle [m]."""
        geoms = [one.geom for one in self._jointsOf(target)]
        points = [point for one in geoms for point in zip(one.areas, one.centres)]
        area = sum(a for a, _ in points)
        low, high = target.box
        side = (high[0] - low[0]) * (high[1] - low[1])
        if abs(area - side) < FILLED * side:
            return side, [(a + b) / 2 for a, b in zip(low, high)]
        return area, sum((a * c for a, c in points), Vector3.Zero) / area

    def weightOf(self, target):
        """Weight of the body of a target [N]."""
        own = O.bodies[target.body].state.mass * self.structure.gravity
        return own if target.weight is None else target.weight

    def liftOf(self, target):
        """What carries a platen of another weight than that of its mass [N]."""
        own = O.bodies[target.body].state.mass * self.structure.gravity
        return (own - self.weightOf(target)) * Vector3.UnitZ
