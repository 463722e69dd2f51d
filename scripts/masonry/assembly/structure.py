# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene is in YADE: its bodies, joints, loads and engines."""

import math

from yade import O, Vector3
from yade.wrapper import (
    MasonryContacts,
    MasonryJoint,
    MasonryLoad,
    MasonrySprings,
    MasonryTies,
    MasonryZones,
)

from .._masonry import loadScene, saveScene, timeStepLimit
from ..basics import GRAVITY, Collapsed, Refused, say
from ..bricks import boxCorners
from . import threads
from .blocks import placeBlock
from .connecting import connect
from .engines import engine, engines
from .columns import Reading
from .motion import Motion

MOST_SCALED = 50.0  # largest massScaling that is chosen by itself: more gained nothing in any wall
NEVER = 1e300  # strength [N] and breaking elongation [m] of a tie that has none
FILLED = 1e-9  # of a platen's side: what may be free of bricks if it is said to be full


class Structure:
    """What a scene is in YADE, and what acts on it.

    It is made in two steps, so that what the user asks for can be refused before anything changes: ``__init__`` takes the
    description, and :meth:`build` builds it in YADE. From then on it has

    - ``ids``: body ids of the bricks, in their order; ``parts``: those of every part; ``bricks``: number of the brick by
      body id, for all bodies that are bricks or parts of bricks
    - ``interactions``: the joints between blocks; ``subcontacts``: how many points they have
    - ``loads``: MasonryLoad engines by label; ``push`` is the one that drives the pushed target
    - ``zones``: the engine of deformable units, or None; ``energy``, ``integrator``: these engines
    - ``limit``: the stable limit of the time step under the present damping [s]
    - ``held``: targets of which a direction is held; ``motion``: how blocks move

    :param description: :class:`masonry.scene.description.Description`
    :param masonry: its materials for these options: :class:`masonry.scene.materials.Masonry`
    :param args: the options of :func:`masonry.scene.options.parser`
    """

    def __init__(self, description, masonry, args):
        self.description, self.masonry, self.args = description, masonry, args
        kinds = {block.kind for block in description.bricks} - set(masonry.units)
        self.unit, self.joints = masonry.unit, masonry.joints
        self.units = {**masonry.units, **dict.fromkeys(kinds, masonry.unit)}
        # Heavier blocks that are attracted less weigh the same; waves are slower and the time step is longer.
        for unit in {
            id(unit): unit for unit in (self.unit, *self.units.values())
        }.values():
            unit.density *= args.density_scaling
        self.gravity = description.gravity / args.density_scaling
        self.axes = (0, 2) if description.plane else (0, 1, 2)
        self.ties = self.springs = self.contacts = None  # their engines
        self._news = {
            "yields": set(),
            "breaks": set(),
        }  # overlays of which that was said
        self._newsFrom = 0  # step from which ties that yield or break are news
        self.bricks, self.loads, self.zones = {}, {}, None
        self._stiff = masonry.stiff  # kinds of blocks that are rigid in themselves
        #: Indices of blocks that are rigid also where bricks are deformable.
        self._rigid = description.connectedBricks() | {
            n for n, b in enumerate(description.bricks) if b.kind in self._stiff
        }
        #: What is pushed; from the beginning the target that a drive holds.
        self.target = next((t for t in description.targets.values() if t.drives), None)
        self.followed = self.target  # whose displacement is recorded along the load
        self.atRest = None  # the last state at rest, as saveScene gave it
        self.loadFactor = 0.0  # of the load that a stage puts on or lets grow [-]
        self.direction = Vector3.UnitX  # of the present push or load
        self.pushing = False  # whether the present load is a push
        self.grown = False  # whether presses, dead loads and wind have their whole
        #: Displacement of the followed point when the push or load began, along it and up, and of the bricks at the followed
        #: platen along it [m].
        self.origin = 0.0, 0.0, 0.0
        #: Point of the history that the drive is going to: its number, from 1, and its displacement [mm].
        self.goal = 0, 0.0

    # -- building -------------------------------------------------------------------------------------------------

    def build(self, loadingBlock):
        """Build all of it in YADE.

        :param loadingBlock: MasonryMat of the platens
        """
        threads.beginScene(host=self.description.functors)
        O.reset()
        loadingBlock.density *= self.args.density_scaling
        self._addBodies(loadingBlock)
        self._addEngines(loadingBlock)
        self.loads["push"] = None
        if self.target:
            self.loads["push"] = self.driveOf(self.target, self.target.drives[0])
        self._joinRecords()
        self._findPresses()
        targets = self.description.targets.values()
        self.held = [target for target in targets if target.freedom]
        # Rows are read at every few steps: what does not change is kept.
        self._placed = {t.name: self._placeOf(t.body, t.recorded) for t in targets}
        self._faces = {t.name: self._faceOf(t) for t in targets if t.box and not t.fixed}  # fmt: skip
        self._forces = O.forces
        held = {target.body for target in self.held}
        self._freeMass = sum(b.state.mass for b in O.bodies if b.id not in held)
        self.motion = Motion(self)

    def _addBodies(self, loadingBlock):
        description = self.description
        mats = {id(m): m for m in (*self.units.values(), self.unit, loadingBlock)}
        O.materials.append(list(mats.values()))
        self.parts, self.ids = {}, []
        targets = description.targets.values()
        for target in targets:
            if target.box and target.fixed and target.joined:
                self._addPlaten(target, loadingBlock)
        for block in description.bricks:
            material = self.units[block.kind]
            body = placeBlock(block.corners, material, description.plane)
            self.ids.append(body)
            self.bricks[body] = block.brick
            self.parts.setdefault(block.part, []).append(body)
        for target in targets:
            if target.box and not target.fixed:
                self._addPlaten(target, loadingBlock)
            elif not target.box:
                target.body = self.ids[target.brick]
                if target.fixed:
                    O.bodies[target.body].state.blockedDOFs = target.freedom
        if not any(target.fixed and target.joined for target in targets):
            raise Refused(
                "nothing is held: a scene needs a platen at the bottom, or hold()"
            )

    def _addPlaten(self, target, material):
        corners = boxCorners(*target.box)
        target.body = placeBlock(corners, material, self.description.plane)
        O.bodies[target.body].state.blockedDOFs = target.freedom

    def _addEngines(self, loadingBlock):
        """Engines, joints and the time step, when all blocks are there."""
        args, description = self.args, self.description
        loads, connectors = self._loads(), self._connectors()
        self.loads = {load.label: load for load in loads}
        kind = args.damping_kind
        if args.blocks == "deformable":
            for target in description.targets.values():
                if target.freedom:
                    self.bricks.pop(target.body, None)
            for index in self._rigid:
                self.bricks.pop(self.ids[index], None)
            held = [n for n in description.connectedBricks() if description.bricks[n].kind not in self._stiff]  # fmt: skip
            if held:
                say(f"note: {len(held)} of {len(description.bricks)} bricks are rigid, because ties, springs or fibre layers end at them")  # fmt: skip
            # cells of a half brick along its length; a whole one has twice as many
            n = args.divisions
            if args.mass_scaling and "crack" in self.joints:
                # the halves of a brick move as one, as far as masses are scaled, until their crack surface yields
                self.joints["crack"].monolithic = True
            self.zones = MasonryZones(
                bodies=list(self.bricks),
                divisions=[n if description.halves else 2 * n, 1, n],
                damping=args.damping,
                dampingKind=kind,
                blocked="y" if description.plane else "",
                label="zones",
            )
        if description.contact:
            self.contacts = MasonryContacts(
                takesJoints=True,
                label="contacts",
                **description.contact.of(self.joints["bed"]),
            )
        points = [int(n) for n in args.points.split(",")] if args.points else []
        engines(
            # the rule chooses; YADE wants a joint that fits any pair before it asks
            [MasonryJoint(name="any", elastic=True)],
            damping=args.damping,
            gravity=(0, 0, -self.gravity),
            points=points[0] if points else None,
            subcontacts=points[1] if len(points) > 1 else None,
            rows=points[1] if len(points) > 1 and not description.plane else None,
            inPlane=description.plane,
            loads=loads,
            connectors=connectors,
            zones=self.zones,
            contacts=self.contacts,
            functors=description.functors,
            dampingKind="local" if description.functors else kind,
        )
        self.energy, self.integrator = engine("energy"), engine("integrator")
        self.damp(args.damping, kind)
        blocks = dict(zip(self.ids, description.bricks))
        self.interactions = connect(
            self.masonry.rule(blocks), allowGaps=description.allowGaps
        )
        for target in description.targets.values():
            if not target.joined:  # it is no neighbour of what it touches
                self._addPlaten(target, loadingBlock)
        self.massScaling = self._massScaling()
        self.scaleMasses(self.massScaling)
        self._usualLimit = self.chooseTimeStep()
        self.subcontacts = sum(len(i.geom.areas) for i in self.interactions)

    def _loads(self):
        """A dead load for every target that has one, and a drive for every one that can be pushed. Raises Refused."""
        loads, deformable = [], self.args.blocks == "deformable"
        for target in self.description.targets.values():
            if not target.loaded:
                continue
            if deformable and target.brick not in {None, *self._rigid} and not target.freedom:  # fmt: skip
                raise Refused(
                    f"handle: {target.name} is a deformable brick, and loads and drives act on rigid ones: load a platen, "
                    "or choose --blocks rigid"
                )
            # a brick keeps its numerical damping until it is driven
            brick = target.brick is not None
            on = dict(body=target.body, point=target.point, damped=brick)
            if target.pressed is not None or target.force is not None:
                loads.append(MasonryLoad(label=f"{target.name}_force", **on))
            for axis in target.drives:
                direction = Vector3(*(float(axis == a) for a in "xyz"))
                label = f"{target.name}_drive_{axis}"
                loads.append(
                    MasonryLoad(label=label, direction=direction, driven=True, **on)
                )
            if not target.drives:
                loads.append(MasonryLoad(label=f"{target.name}_drive", **on))
        for n, (brick, _, point) in enumerate(self.description.winds):
            on = dict(body=self.ids[brick], point=point)
            loads.append(MasonryLoad(label=f"wind_{n}", damped=True, **on))
        return loads

    def _connectors(self):
        """Engines of ties and springs, if there are any."""
        ties, springs = self.description.ties, self.description.springs
        bodies = lambda side, records: [one.ends[side].bodyIn(self.ids) for one in records]  # fmt: skip
        points = lambda side, records: [one.ends[side].point for one in records]
        ends = lambda records: dict(
            bodies1=bodies(0, records),
            points1=points(0, records),
            bodies2=bodies(1, records),
            points2=points(1, records),
        )
        never = lambda value: NEVER if value is None else value
        self.ties = ties and MasonryTies(
            label="ties",
            **ends(ties),
            stiffness=[one.stiffness for one in ties],
            strength=[never(one.strength) for one in ties],
            breaking=[
                never(one.breaking and one.breaking * one.length) for one in ties
            ],
            compression=[int(one.compression) for one in ties],
            rest=[one.rest(0) for one in ties],
        )
        self.springs = springs and MasonrySprings(
            label="springs",
            **ends(springs),
            stiffness=[one.stiffness for one in springs],
            rotationalStiffness=[one.rotation for one in springs],
        )
        for records, made in ((ties, self.ties), (springs, self.springs)):
            for one in records:
                one.engine = made
        return [made for made in (self.ties, self.springs) if made]

    def _joinRecords(self):
        """Find the joints whose means are recorded, and those of the sections."""
        pairs = {frozenset((i.id1, i.id2)): i for i in self.interactions}
        for joint in self.description.joints:
            joint.interaction = pairs.get(frozenset(self.ids[b] for b in joint.bricks))
            if joint.interaction is None:
                raise Refused(
                    "joint: bricks {} and {} share no face".format(*joint.bricks)
                )
        for section in self.description.sections:
            section.join(self)

    def _findPresses(self):
        """What presses, dead loads and wind are when they have grown."""
        self._grown = {}  # forces by label [N]
        self._lines = {}  # points of the presses, as they were built [m]
        for target in self.description.targets.values():
            if target.pressed is None and target.force is None:
                continue
            force = Vector3(*(target.force or (0, 0, 0)))
            if target.pressed is not None:
                own = O.bodies[target.body].state.mass * self.gravity
                area, middle = self._contact(target)
                force = force - (target.pressed * area - own) * Vector3.UnitZ
                # the resultant goes through the middle of what the platen presses
                load = self.loads[f"{target.name}_force"]
                load.point = (middle[0], middle[1], target.point[2])
                self._lines[target.name] = Vector3(*load.point)
            self._grown[f"{target.name}_force"] = force
        for n, (_, force, _) in enumerate(self.description.winds):
            self._grown[f"wind_{n}"] = Vector3(*force)

    def _contact(self, target):
        """Area of a platen's joints [m²], and their middle [m]."""
        area, middle = 0.0, Vector3.Zero
        for interaction in self.interactions:
            if target.body in (interaction.id1, interaction.id2):
                geom = interaction.geom
                for a, c in zip(geom.areas, geom.centres):
                    area += a
                    middle += a * c
        low, high = target.box
        side = (high[0] - low[0]) * (high[1] - low[1])
        if abs(area - side) < FILLED * side:
            return side, [(a + b) / 2 for a, b in zip(low, high)]
        return area, middle / area

    def _placeOf(self, body, point):
        """What the motion of a point of a body is found from."""
        state = O.bodies[body].state
        arm = Vector3(*point) - state.refPos
        upright = state.refOri.conjugate()
        return state, state.refPos, arm, upright * arm, upright

    def _faceOf(self, target):
        """The middles of a platen's joints, as points of the bricks there: pairs of what their motion is found from, and the share of
        the platen's area. Of a deformable brick its own middle stands for that."""
        found, deformable = [], set(self.zones.bodies) if self.zones else ()
        for one in self.interactions:
            if target.body not in (one.id1, one.id2):
                continue
            brick = one.id2 if one.id1 == target.body else one.id1
            areas, area = one.geom.areas, sum(one.geom.areas)
            middle = sum((a * c for a, c in zip(areas, one.geom.centres)), Vector3.Zero) / area  # fmt: skip
            middle = O.bodies[brick].state.refPos if brick in deformable else middle
            found.append((self._placeOf(brick, middle), area))
        whole = sum(area for _, area in found)
        return [(place, area / whole) for place, area in found]

    # -- loads ----------------------------------------------------------------------------------------------------

    def _addLoad(self, label, body, point, damped=False):
        """A load that a stage adds: an engine before that of the energy balance."""
        if label not in self.loads:
            load = MasonryLoad(label=label, body=body, point=point, damped=damped)
            before = list(O.engines)
            at = next(n for n, one in enumerate(before) if one.label == "energy")
            engines = [*before[:at], load, *before[at:]]
            if self.atRest is not None:  # the state at rest gets the engine, too
                now = saveScene("null")
                loadScene(self.atRest)
                O.engines = engines
                self.atRest = saveScene("null")
                O.engines = before
                loadScene(now)
            O.engines = engines
            self.loads[label] = load
        return self.loads[label]

    def forceOf(self, target):
        """The engine of the dead load on a target; it is made if it is missing."""
        brick = target.brick is not None
        return self._addLoad(f"{target.name}_force", target.body, target.point, brick)

    def pressOf(self, target):
        """The engine of a press, whose resultant goes through the middle of what the platen presses, and the area of that
        [m²]."""
        known = f"{target.name}_force" in self.loads
        area, middle = self._contact(target)
        load = self.forceOf(target)
        if not known:
            load.point = (middle[0], middle[1], target.point[2])
        return load, area

    def windOf(self, label, faces):
        """The engines of a wind on faces, as of :meth:`masonry.bricks.Bricks.freeFaces`; they are made if they are missing."""
        return [
            self._addLoad(f"{label}_{n}", self.ids[brick], middle, damped=True)
            for n, (brick, _, _, middle) in enumerate(faces)
        ]

    def weightOf(self, target):
        """Weight of the body of a target [N]."""
        return O.bodies[target.body].state.mass * self.gravity

    def isDriven(self, target, axis):
        """Whether a drive holds or moves a target along an axis."""
        return any(
            load and load.body == target.body and load.driven and abs(load.direction["xyz".index(axis)]) > 1e-12
            for load in self.loads.values()
        )  # fmt: skip

    def holdAlso(self, target, axes):
        """Count a target as one that is held along more axes."""
        if target not in self.held:
            self.held.append(target)
            self._freeMass -= O.bodies[target.body].state.mass
        held = {*(target.freedom or ""), *axes}
        target.freedom = "".join(a for a in "xyzXYZ" if a in held)

    def grow(self, x):
        """Let presses and dead loads grow smoothly: 0 to 1 is from nothing to their whole."""
        self.grown = x == 1
        share = x * x * (3 - 2 * x)
        for label, force in self._grown.items():
            self.loads[label].force = force * share
        if self.ties:
            self.ties.rest = [one.rest(share) for one in self.description.ties]

    def deadLoads(self):
        """Loads of the scene, each with its force, or that which it will have when presses, dead loads and wind have grown:
        pairs of MasonryLoad and force [N]."""
        for label, load in self.loads.items():
            if load and label != "push":
                yield load, load.force if self.grown else self._grown.get(label, load.force)  # fmt: skip

    def damp(self, damping, kind, massDamping=0.0, stiffnessDamping=0.0):
        """Choose the damping from now on; :meth:`chooseTimeStep` follows it.

        :param damping: numerical damping constant of what moves: deformable units, else rigid ones [-]
        :param kind: of that, ``local`` or ``combined``
        :param massDamping: viscous, of the motion [1/s]
        :param stiffnessDamping: viscous, of the joints [s]
        """
        if self.zones:
            self.zones.damping, self.zones.dampingKind = damping, kind
        else:
            self.integrator.damping, self.integrator.dampingKind = damping, kind
        self.integrator.massDamping = massDamping
        engine("joints").stiffnessDamping = stiffnessDamping

    def countImpacts(self, real):
        """Let impacts of joints that close take energy from now on, or not.

        :param real: whether what follows runs in real time
        """
        engine("joints").impacts = real

    def _massScaling(self):
        """The scaling of masses that the options say, for this structure [-].

        ``auto`` finds two limits of the time step: with true masses, and with deformation so slow that only the rigid motions
        of bricks are left. Waves through a brick get slower by the root of 1 + massScaling, so the least that brings their
        limit to the second one is known.
        """
        if not self.zones:
            return 0.0
        if self.args.mass_scaling != "auto":
            return self.args.mass_scaling
        limits = []
        for scaling in (0.0, 1e8):
            self.scaleMasses(scaling)
            limits.append(timeStepLimit())
        return min(MOST_SCALED, max(0.0, round((limits[1] / limits[0]) ** 2 - 1, 1)))

    def scaleMasses(self, scaling):
        """Choose the selective scaling of the masses of deformable units from now on [-]; :meth:`chooseTimeStep` follows it."""
        if self.zones and self.zones.massScaling != scaling:
            self.zones.massScaling = scaling

    def trueMasses(self, stage):
        """Have true masses from now on, because a stage runs in real time, and say so if the options say otherwise. Returns
        whether they have changed; :meth:`chooseTimeStep` is then to follow.

        :param stage: its name
        """
        if not (self.zones and self.massScaling):
            return False
        say(
            f"note: {stage} runs in real time with true masses, without --mass-scaling {self.massScaling:g}"
        )
        self.scaleMasses(0.0)
        return True

    def dampByOptions(self):
        """Choose the damping and the masses that the options say, for a stage that says nothing else, and its time step if a
        stage has chosen another one. A time step that the script sets stays."""
        self.damp(self.args.damping, self.args.damping_kind)
        self.scaleMasses(self.massScaling)
        if self.limit != self._usualLimit:
            self.chooseTimeStep(self._usualLimit)

    def chooseTimeStep(self, limit=None):
        """Choose the time step that the present damping allows. Returns the stable limit.

        :param limit: the stable limit if it is known [s]: that of blocks that have moved differs in its third digit
        """
        self.limit = limit or timeStepLimit()
        O.dt = self.args.dt_fraction * self.limit
        return self.limit

    def setGravity(self, gravity):
        """Gravity from now on [m/s²]; deformable units follow."""
        self.integrator.gravity = gravity

    @property
    def now(self):
        """Present gravity [m/s²]."""
        return self.integrator.gravity

    def factor(self):
        """Horizontal over vertical acceleration that acts on the blocks [-]."""
        down = abs(self.now[2]) or GRAVITY / self.args.density_scaling
        return math.hypot(self.now[0], self.now[1]) / down

    def driveOf(self, target, axis):
        """The load that drives a target along an axis, or None."""
        return self.loads.get(f"{target.name}_drive_{axis}")

    def pushOf(self, target, axis):
        """The drive that a push made, if it holds a target along an axis, else None."""
        load = self.loads.get(f"{target.name}_drive")
        if axis not in "xyz" or not (load and load.driven):
            return None
        return load if abs(load.direction["xyz".index(axis)]) > 1e-12 else None

    def driveForce(self, target, axis):
        """Force of the drive of a target along an axis [N], as a vector."""
        load = self.driveOf(target, axis)
        return load.reaction * load.direction.normalized()

    def pushTo(self, target, direction, name="push"):
        """From now on ``push`` moves this target in this direction. The other drives hold what they hold."""
        if self.description.plane and direction[1]:
            raise ValueError(
                f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
            )
        blocked = O.bodies[target.body].state.blockedDOFs
        if not any(v and a not in blocked for a, v in zip("xyz", direction)):
            raise ValueError(
                f"{name}: {target.name} is held along {tuple(direction)}, and cannot be pushed there"
            )
        load = self.loads.get(f"{target.name}_drive")
        if target.drives:
            along = [a for a, v in zip("xyz", direction) if abs(v) > 1 - 1e-12]
            load = self.driveOf(target, along[0]) if along else None
            if load is None:
                raise ValueError(
                    f"{name}: {target.name} has drives along {', '.join(target.drives)} alone, not along {tuple(direction)}"
                )
        elif load.driven and load.direction.cross(direction).norm() > 1e-12:
            raise ValueError(
                f"{name}: the drive of {target.name} holds it along {tuple(load.direction)}, and would let go of it to push "
                f"along {tuple(direction)}; drive='xz' and the like give it a drive for every axis"
            )
        for label, other in self.loads.items():
            if "_drive" in label:
                other.velocity = other.ramp = 0
        load.damped = False
        load.direction, load.driven = direction, True
        self.target, self.direction, self.loads["push"] = target, direction, load
        self.followed, self.origin, self.pushing = target, (0, 0, 0), True

    def follow(self, target, direction):
        """From now on record the displacement of a target, or None, along a direction. Returns its origin [m]."""
        self.followFrom(target, direction, (0, 0, 0))
        if target:
            self.origin = self.topDisplacement()
        return list(self.origin)

    def followFrom(self, target, direction, origin):
        """As :meth:`follow`, from an origin that is known [m]."""
        self.followed, self.direction, self.origin = target, direction, origin
        self.pushing = False

    def keepLoadLine(self):
        """Move the points of vertical loads that keep their line in space back to it."""
        for target in self.description.targets.values():
            if target.pressed is None or target.riding:
                continue
            load = self.loads[f"{target.name}_force"]
            drive = self.loads["push"] if target is self.target else load
            along = drive.displacement()
            away = (along[0], 0 if self.description.plane else along[1], 0)
            load.point = self._lines[target.name] - Vector3(*away)

    # -- what a checkpoint keeps beside the state in YADE ------------------------------------------------------------

    def state(self):
        """What stages have set, beside what YADE keeps: a dict of values that JSON can hold."""
        push = self.loads["push"]
        nameOf = lambda target: target.name if target else ""
        return {
            "target": nameOf(self.target),
            "followed": nameOf(self.followed),
            "push": push.label if push else "",
            "direction": list(self.direction),
            "pushing": self.pushing,
            "grown": self.grown,
            "origin": list(self.origin),
            "goal": list(self.goal),
            "loadFactor": self.loadFactor,
            "held": {target.name: target.freedom for target in self.held},
            "freeMass": self._freeMass,
            "limit": self.limit,
            "newsFrom": self._newsFrom,
            "news": {what: sorted(names) for what, names in self._news.items()},
        }

    def putState(self, state):
        """Give it a state of :meth:`state`. Raises KeyError if it names a target or a load that is not there."""
        targets, loads = {"": None, **self.description.targets}, {
            "": None,
            **self.loads,
        }
        self.target, self.followed = targets[state["target"]], targets[state["followed"]]  # fmt: skip
        self.loads["push"] = loads[state["push"]]
        self.direction, self.origin = Vector3(*state["direction"]), tuple(state["origin"])  # fmt: skip
        self.pushing, self.grown = state["pushing"], state["grown"]
        self.goal, self.loadFactor = tuple(state["goal"]), state["loadFactor"]
        self._freeMass, self.limit = state["freeMass"], state["limit"]
        self._newsFrom = state["newsFrom"]
        self._news = {what: set(names) for what, names in state["news"].items()}
        self.held = [targets[name] for name in state["held"]]
        for name, freedom in state["held"].items():
            targets[name].freedom = freedom

    # -- what is measured -----------------------------------------------------------------------------------------

    def read(self):
        """What the columns are made of, measured now."""
        return Reading(self)

    def forceOn(self, target):
        """Force of the structure on a target [N]."""
        return self._forces.f(target.body, True)

    def supportedBy(self, target):
        """Force of the structure on a target along the axes that are held now, 0 along the others [N]."""
        force, blocked = self.forceOn(target), O.bodies[target.body].state.blockedDOFs
        return Vector3(*(f if a in blocked else 0.0 for a, f in zip("xyz", force)))

    def forceFrom(self, target):
        """Force of what loads, drives and holds a target on it [N]."""
        total, blocked = Vector3(0, 0, 0), O.bodies[target.body].state.blockedDOFs
        for label, load in self.loads.items():
            if label != "push" and load.body == target.body:
                total += load.force + load.reaction * load.direction.normalized()
        on = self.forceOn(target)
        for i, axis in enumerate("xyz"):
            if axis in blocked:
                total[i] = -on[i]
        return total

    def moved(self, target):
        """Displacement of a target's recorded point since the scene was built [m], and its rotation, about y in a plane,
        else its angle [rad]."""
        state, place, arm, ownArm, upright = self._placed[target.name]
        turn = state.ori
        axis, angle = (turn * upright).toAxisAngle()
        if self.description.plane:
            angle *= axis[1]
        return state.pos + turn * ownArm - place - arm, angle

    def topDisplacement(self):
        """Displacement since the scene was built [m] of the followed point, along the push or load and upwards, and of the bricks at
        the followed platen along it."""
        moved = self.moved(self.followed)[0]
        return moved.dot(self.direction), moved[2], self.masonryMoved()

    def masonryMoved(self):
        """Displacement of the bricks at the followed platen along the push or load since the scene was built [m]; of a brick that is
        followed, that of its point."""
        face = self._faces.get(self.followed.name)
        if not face:
            return self.moved(self.followed)[0].dot(self.direction)
        return sum(
            share * (state.pos + state.ori * ownArm - place - arm).dot(self.direction)
            for (state, place, arm, ownArm, _), share in face
        )

    def driftHeight(self):
        """Height of the points of which :meth:`masonryMoved` is [m]."""
        face = self._faces.get(self.followed.name)
        if not face:
            return self.followed.recorded[2]
        return sum(share * (place[2] + arm[2]) for (_, place, arm, *_), share in face)

    def alongNow(self):
        """Displacement of the followed point along the push or load since that began [m]; 0 if none is followed."""
        return self.topDisplacement()[0] - self.origin[0] if self.followed else 0.0

    def hasSunk(self, down=None):
        """Whether the pushed platen has come down by half the height of a brick.

        :param down: its displacement downwards [m], if that is known
        """
        down = -self.moved(self.target)[0][2] if down is None else down
        block = self.description.bricks[-1].corners
        return down > 0.5 * (max(p[2] for p in block) - min(p[2] for p in block))

    def applied(self):
        """Sum of the weights of what is free to follow them, and of the loads without drives [N]."""
        applied = self._freeMass * self.now
        for target in self.held:
            state = O.bodies[target.body].state
            for i, axis in enumerate("xyz"):
                if axis not in state.blockedDOFs:
                    applied[i] += state.mass * self.now[i]
        for label, load in self.loads.items():
            if label != "push":
                applied += load.force
        return applied

    def carried(self):
        """Sum of the forces of supports and drives on the structure [N]."""
        carried = Vector3(0, 0, 0)
        for target in self.held:
            blocked, on = O.bodies[target.body].state.blockedDOFs, self.forceOn(target)
            for i, axis in enumerate("xyz"):
                if axis in blocked:
                    carried[i] -= on[i]
        for label, load in self.loads.items():
            if label != "push":
                carried += load.reaction * load.direction.normalized()
        return carried - self.onGround()

    def ofTies(self):
        """Forces [N] and elongations [m] of all ties: two lists."""
        count = len(self.description.ties)
        if not (self.ties and len(self.ties.forces)):
            return [0.0] * count, [0.0] * count
        return list(self.ties.forces), list(self.ties.elongations)

    def onGround(self):
        """Force of ties and springs on the ground, to which they are fixed, along the axes of the scene [N]."""
        force = Vector3.Zero
        for one in (*self.description.ties, *self.description.springs):
            if one.ends[1].isGround:
                force -= one.on(one.ends[0], self)[0]
        return Vector3(*(force[i] if i in self.axes else 0.0 for i in range(3)))

    def onSpringsOf(self, target):
        """Force of a target on the springs on which it stands [N]."""
        force = Vector3.Zero
        for one in self.description.springs:
            if one.ends[0].target is target and one.ends[1].isGround:
                force -= Vector3(*one.force)
        return force

    def placeOf(self, end):
        """Where the end of a tie or a spring is now [m]."""
        if end.isGround:
            return Vector3(*end.point)
        state = O.bodies[end.bodyIn(self.ids)].state
        turn = state.ori * state.refOri.conjugate()
        return state.pos + turn * (Vector3(*end.point) - state.refPos)

    def news(self):
        """Sentences on ties that have yielded or broken since this was asked last."""
        if not self.ties:
            return
        since, self._newsFrom = min(self._newsFrom, O.iter), O.iter
        for what, steps in (("yields", self.ties.yieldedAt), ("breaks", self.ties.brokenAt)):  # fmt: skip
            for one, step in zip(self.description.ties, steps):
                first = not one.overlay or one.overlay not in self._news[what]
                if step >= since and first:
                    self._news[what].add(one.overlay)
                    yield f"{one.name} {what}: between {one.ends[0].words} and {one.ends[1].words}"  # fmt: skip

    def besideThePush(self):
        """What acts on the structure beside a push: weights, dead loads, and other drives [N]. Nothing if none is pushed."""
        if not self.pushing:
            return Vector3.Zero
        beside, push = self.applied(), self.loads["push"]
        for label, load in self.loads.items():
            if label != "push" and load is not push and load.driven:
                beside += load.reaction * load.direction.normalized()
        return beside

    def fallen(self):
        """Blocks that have fallen, in a scene whose collapse is followed: a dict from the index of the block to a dict with
        ``since``, when it had come loose [s], ``fell`` [s], ``most``, its largest kinetic energy [J], and ``at``, when it had
        that [s]."""
        if not self.contacts:
            return {}
        known = self.contacts.fallen()
        return {
            index: known[body]
            for index, body in enumerate(self.ids)
            if body in known and known[body]["fell"] is not None
        }

    def checkFallen(self):
        """Raise Collapsed if a block has fallen, in a scene whose collapse is followed."""
        fallen = self.fallen()
        if fallen:
            first = min(fallen, key=lambda index: (fallen[index]["fell"], index))
            at = ", ".join(f"{v:.3g}" for v in self.description.middle(first))
            others = f", and so have {len(fallen) - 1} others since" if len(fallen) > 1 else ""  # fmt: skip
            raise Collapsed(
                f"brick {first} at ({at}) m has fallen at {fallen[first]['fell']:.4g} s{others}"
            )

    def letFall(self):
        """From now on no drive and no support moves, no numerical damping brakes blocks that have come loose, and impacts of
        joints that close take energy."""
        self.countImpacts(True)
        for target in self.held:
            if target.fixed:
                O.bodies[target.body].state.vel = Vector3.Zero
        for label, load in self.loads.items():
            if "_drive" in label:
                load.velocity = load.ramp = 0
        self.contacts.dampsLoose = False

    def refinedJoints(self):
        """How many joints have got more points during the run."""
        return engine("joints").refinedJoints

    def unrest(self):
        """What of the loads is missing at the supports, and kinetic over elastic energy [-]."""
        energy = self.energy.balance()
        elastic = sum(
            energy.get(f"elastic_{m}", 0.0)
            for m in ("compression", "shear", "tension", "units", "connectors")
        )
        applied, carried = self.applied(), self.carried()
        if self.description.plane:
            applied[1] = carried[1] = 0
        size = applied.norm()
        loads = sum(load.force.norm() for n, load in self.loads.items() if n != "push")
        if size < 1e-6 * loads:  # loads that balance each other
            size = loads
        missing = (applied + carried).norm() / (size or 1.0)
        moving = abs(energy["kinetic"])
        return missing, moving / elastic if elastic else math.inf
