# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene in YADE: its bodies, joints, loads and engines."""

from yade import O, Vector3
from yade.wrapper import MasonryContacts, MasonryZones

from ..errors import Collapsed, Refused
from ..terminal import say
from ..bricks import boxCorners
from . import threads
from .bodies import placeBlock
from .connecting import connected, makeJoints
from .connectors import Connectors
from .engines import engine, engines
from .loading import Loading, reactionOf
from .motion import Motion
from .overturning import Overturning
from .scheme import Scheme
from .restraints import Supports


class Structure:
    """A scene in YADE. From :meth:`build` on it has

    - ``ids``: body ids of the bricks, in their order; ``parts``: those of every part; ``bricks``:
      number of the brick by the body id of it or of its parts
    - ``widest``: width of the widest crack when it was looked for last [mm]
    - ``interactions``: the joints between blocks; ``subcontacts``: number of their points
    - ``loading``, ``connectors``, ``supports``, ``scheme``, ``motion``: objects of these modules
    - ``zones``, ``contacts``: the engines of deformable units and of contacts, or None; ``energy``:
      that of the balance

    :param masonry: the materials for these options: :class:`masonry.materials.Masonry`
    """

    def __init__(self, description, masonry, args):
        self.description, self.masonry, self.args = description, masonry, args
        kinds = {block.kind for block in description.bricks} - set(masonry.units)
        self.unit, self.joints = masonry.unit, masonry.joints
        self.units = {**masonry.units, **dict.fromkeys(kinds, masonry.unit)}
        # heavier blocks that are attracted less weigh the same, and the time step is longer
        for unit in {id(u): u for u in (self.unit, *self.units.values())}.values():
            unit.density *= args.density_scaling
        self.gravity = description.gravity / args.density_scaling  # as built [m/s²]
        self.axes = (0, 2) if description.plane else (0, 1, 2)
        self.ids, self.parts, self.bricks = [], {}, {}
        self.zones = self.contacts = None
        self.atRest = None  # the last state at rest, as saveScene gave it

    # -- building ----------------------------------------------------------------------------------

    def build(self, loadingBlock):
        threads.beginScene(host=self.description.functors)
        O.reset()
        loadingBlock.density *= self.args.density_scaling
        self._addBodies(loadingBlock)
        self.loading, self.connectors = Loading(self), Connectors(self)
        if self.description.deformable:
            self.zones = self._deformableUnits()
        if self.description.contact:
            contact = self.description.contact.of(self.joints["bed"])
            self.contacts = MasonryContacts(takesJoints=True, label="contacts", **contact)
        self._addEngines()
        self.scheme = Scheme(self.args, self.zones, self.contacts)
        blocks = dict(zip(self.ids, self.description.bricks))
        rule, allowGaps = self.masonry.rule(blocks), self.description.allowGaps
        self.interactions = makeJoints(rule, allowGaps=allowGaps)
        self.widest = 0.0
        self.subcontacts = sum(len(i.geom.areas) for i in self.interactions)
        for target in self.description.targets.values():
            if not target.joined:  # placed later: no joints are made to the blocks it touches
                self._addPlaten(target, loadingBlock)
        self.connectors.attach()
        connected()  # also what needs no joint
        self.scheme.begin(not (self.zones or self.contacts or self.description.functors))
        self._joinRecords()
        self.supports = Supports(self)
        self.loading.begin()
        self.motion = Motion(self)
        self.overturning = Overturning(self) if self.contacts else None

    def _addBodies(self, loadingBlock):
        description = self.description
        mats = {id(m): m for m in (*self.units.values(), self.unit, loadingBlock)}
        O.materials.append(list(mats.values()))
        targets = description.targets.values()
        for target in targets:
            if target.box and target.fixed and target.joined:
                self._addPlaten(target, loadingBlock)
        for block in description.bricks:
            body = placeBlock(block.corners, self.units[block.kind], description.plane)
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
        if not any(target.fixed and (target.joined or target.line) for target in targets):
            raise Refused("nothing is held: a scene needs a platen at the bottom, or hold()")

    def _addPlaten(self, target, material):
        corners = boxCorners(*target.box)
        target.body = placeBlock(corners, material, self.description.plane)
        O.bodies[target.body].state.blockedDOFs = target.freedom

    def _deformableUnits(self):
        args, description = self.args, self.description
        blocks, loaded = enumerate(description.bricks), description.pointLoaded()
        stiff = {n for n, block in blocks if block.kind in self.masonry.stiff}
        held = {t.body for t in description.targets.values() if t.freedom}
        for body in held.union(self.ids[n] for n in loaded | stiff):
            self.bricks.pop(body, None)
        if loaded - stiff:
            say(
                f"note: {len(loaded - stiff)} of {len(description.bricks)} bricks are rigid,"
                " because ties, springs or fibre layers end at them"
            )
        if args.mass_scaling and "crack" in self.joints:
            # scaled masses let the halves of a brick move as one until their crack surface yields
            self.joints["crack"].monolithic = True
        # cells of a half brick along its length; a whole one has twice as many
        n = args.divisions
        return MasonryZones(
            bodies=list(self.bricks),
            divisions=[n if description.halves else 2 * n, 1, n],
            damping=args.damping,
            dampingKind=args.damping_kind,
            blocked="y" if description.plane else "",
            label="zones",
        )

    def _addEngines(self):
        args, description = self.args, self.description
        points = [int(n) for n in args.points.split(",")] if args.points else []
        points, along = (*points, None, None)[:2]
        engines(
            list(self.joints.values()),
            damping=args.damping,
            gravity=(0, 0, -self.gravity),
            points=points,
            subcontacts=along,
            rows=None if description.plane else along,
            inPlane=description.plane,
            loads=list(self.loading.loads.values()),
            connectors=list(self.connectors.engines.values()),
            zones=self.zones,
            contacts=self.contacts,
            functors=description.functors,
            dampingKind="local" if description.functors else args.damping_kind,
        )
        self.energy = engine("energy")

    def _joinRecords(self):
        pairs = {frozenset((i.id1, i.id2)): i for i in self.interactions}
        for joint in self.description.joints:
            joint.interaction = pairs.get(frozenset(self.ids[b] for b in joint.bricks))
            if joint.interaction is None:
                one, two = joint.bricks
                raise Refused(f"joint: bricks {one} and {two} share no face")
        for section in self.description.sections:
            section.join(self)

    def widestCrack(self):
        """The largest opening of a point of any joint now [mm], 0 if none is open."""
        return 1e3 * max(0.0, *(max(one.phys.opening) for one in self.interactions))

    def energies(self):
        """Energy that joints have lost, and elastic energy [J]."""
        energy = self.energy.balance()
        return [
            sum(abs(v) for name, v in energy.items() if name.startswith(kind))
            for kind in ("dissipated", "elastic")
        ]

    def fallen(self):
        """Fallen blocks of a scene whose collapse is followed: by the index of the block a dict
        with ``since``, when it had come loose [s], ``fell`` [s], ``most``, its largest kinetic
        energy [J], and ``at``, when it had that [s]."""
        if not self.contacts:
            return {}
        known = {b: one for b, one in self.contacts.fallen().items() if one["fell"] is not None}
        return {n: known[body] for n, body in enumerate(self.ids) if body in known}

    def onGround(self, index):
        """Whether a block has not gone past the edge of the ground."""
        level = self.description.ground().box[1][2]
        return O.bodies[self.ids[index]].state.pos[2] >= level

    def stopLost(self):
        """Stop the blocks that have gone past the edge of the ground where they are: nothing would
        stop them."""
        for index in self.fallen():
            state = O.bodies[self.ids[index]].state
            if not self.onGround(index) and state.blockedDOFs != "xyzXYZ":
                state.vel = state.angVel = state.angMom = Vector3.Zero
                state.blockedDOFs = "xyzXYZ"
                self.supports.freeMass -= state.mass
                self.energy.given()

    def checkFallen(self):
        """Raise Collapsed if a block has fallen, in a scene whose collapse is followed."""
        fallen = self.fallen()
        if fallen:
            first = min(fallen, key=lambda index: fallen[index]["fell"])
            at = ", ".join(f"{v:.3g}" for v in self.description.middle(first))
            others = f", and so have {len(fallen) - 1} others since" if len(fallen) > 1 else ""
            raise Collapsed(
                f"brick {first} at ({at}) m has fallen at {fallen[first]['fell']:.4g} s{others}"
            )

    def letFall(self):
        """Stop drives and supports and the numerical damping of loose blocks from now on, and let
        impacts of joints that close take energy."""
        self.scheme.joints.impacts = True
        for target in self.supports.held:  # one that was released moves on
            state = O.bodies[target.body].state
            for i, axis in enumerate("xyz"):
                if axis in state.blockedDOFs:
                    state.vel[i] = 0.0
        for drive in self.loading.stopDrives():
            if drive.others:  # forces in a pattern are loads, and end
                drive.driven = False
        self.contacts.dampsLoose = False

    def engage(self):
        """Let the machines that press follow their platens from now on, if presses have grown."""
        for target in self.description.targets.values():
            if target.isInMachine and self.loading.grown:
                self.loading.loads[f"{target.name}_press"].engaged = True

    def disengage(self, target):
        """Let the machine that presses a target keep its present load."""
        load = self.loading.loads.get(f"{target.name}_press")
        if load and load.engaged:
            load.force += reactionOf(load)
            load.engaged, load.reaction = False, 0

    # -- what a checkpoint keeps beside the state in YADE ------------------------------------------

    def state(self):
        return {
            **self.loading.state(),
            "held": {target.name: target.freedom for target in self.supports.held},
            "freeMass": self.supports.freeMass,
            "limit": self.scheme.limit,
            "saidUntil": self.connectors.saidUntil,
            "said": sorted(map(list, self.connectors.reported)),
        }

    def putState(self, state):
        targets = self.description.targets
        self.loading.putState(state)
        self.supports.held = [targets[name] for name in state["held"]]
        for name, freedom in state["held"].items():
            targets[name].freedom = freedom
        self.supports.freeMass, self.scheme.limit = state["freeMass"], state["limit"]
        self.connectors.saidUntil = state["saidUntil"]
        self.connectors.reported = set(map(tuple, state["said"]))
