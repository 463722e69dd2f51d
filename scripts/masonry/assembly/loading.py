# SPDX-License-Identifier: GPL-2.0-or-later
"""The loads of a structure: what is driven, pressed and blown at, and whose displacement is followed."""

from yade import O, Vector3
from yade.wrapper import MasonryLoad

from .._masonry import loadScene, saveScene
from .drives import PATTERN, bodiesOf, isAlong


class Loading:
    """Loads and drives of a structure, from its description and from stages.

    - ``loads``: MasonryLoad engines by label; ``push`` is the one that drives the pushed target, or None
    - ``target``: what is pushed; from the beginning the target that a drive holds
    - ``followed``: whose displacement is recorded along the load, or None; ``direction`` of the present push or load, and
      ``origin``: that displacement when it began, along it and up, and that of the bricks at the followed platen along it [m]
    - ``pushing``: whether the present load is a push
    - ``grown``: whether presses, dead loads and wind have their whole
    - ``loadFactor`` of the load that a stage puts on or lets grow [-]
    - ``goal``: point of a history that the drive is going to: its number, from 1, and its displacement [mm]

    :param structure: :class:`masonry.assembly.structure.Structure`, whose bodies are there
    """

    def __init__(self, structure):
        self.structure, self.description = structure, structure.description
        self.ids = structure.ids
        self.supports = None
        self.loads = {load.label: load for load in self._made()}
        targets = self.description.targets.values()
        self.target = next((target for target in targets if target.drives), None)
        self.followed = self.target
        self.loads["push"] = self.target and self.driveOf(self.target, self.target.drives[0])  # fmt: skip
        self.direction, self.origin = Vector3.UnitX, (0.0, 0.0, 0.0)
        self.pushing = self.grown = False
        self.loadFactor = 0.0
        self.goal = 0, 0.0
        # forces of presses, dead loads and wind that have grown, by label [N]
        self._grown = {}
        self._lines = {}  # points of the presses, as they were built [m]

    def _made(self):
        """A dead load for every target that has one, and a drive for every one that can be pushed."""
        loads = []
        for target in self.description.targets.values():
            if not target.loaded:
                continue
            # a brick keeps its numerical damping until it is driven
            brick = target.brick is not None
            on = dict(body=target.body, point=target.point, damped=brick)
            if target.pressed is not None or target.force is not None:
                loads.append(MasonryLoad(label=f"{target.name}_force", **on))
            for axis in target.drives:
                direction = Vector3(*(float(axis == a) for a in "xyz"))
                label = f"{target.name}_drive_{axis}"
                on = dict(on, direction=direction, driven=True)
                loads.append(MasonryLoad(label=label, **on))
            if not target.drives:
                loads.append(MasonryLoad(label=f"{target.name}_drive", **on))
        for n, (brick, _, point) in enumerate(self.description.winds):
            on = dict(body=self.ids[brick], point=point)
            loads.append(MasonryLoad(label=f"wind_{n}", damped=True, **on))
        return loads

    @property
    def engines(self):
        """The loads as engines, in the order in which they act."""
        return [load for label, load in self.loads.items() if label != "push"]

    def begin(self, supports):
        """Find what presses, dead loads and wind are when they have grown, when all joints are there.

        :param supports: :class:`masonry.assembly.supports.Supports`
        """
        self.supports = supports
        for target in self.description.targets.values():
            if target.pressed is None and target.force is None:
                continue
            force = Vector3(*(target.force or (0, 0, 0)))
            if target.pressed is not None:
                own = O.bodies[target.body].state.mass * self.structure.gravity
                area, middle = self.supports.contactOf(target)
                force = force - (target.pressed * area - own) * Vector3.UnitZ
                # the resultant goes through the middle of what the platen presses
                load = self.loads[f"{target.name}_force"]
                load.point = (middle[0], middle[1], target.point[2])
                self._lines[target.name] = Vector3(*load.point)
            self._grown[f"{target.name}_force"] = force
        for n, (_, force, _) in enumerate(self.description.winds):
            self._grown[f"wind_{n}"] = Vector3(*force)

    def grow(self, x):
        """Let presses and dead loads grow smoothly: 0 to 1 is from nothing to their whole."""
        self.grown = x == 1
        share = x * x * (3 - 2 * x)
        for label, force in self._grown.items():
            self.loads[label].force = force * share
        self.structure.connectors.grow(share)

    def deadLoads(self):
        """Loads of the scene, each with its force, or that which it will have when presses, dead loads and wind have grown:
        pairs of MasonryLoad and force [N]."""
        for label, load in self.loads.items():
            if load and label != "push":
                yield load, load.force if self.grown else self._grown.get(label, load.force)  # fmt: skip

    def forceOf(self, target):
        """The engine of the dead load on a target; it is made if it is missing."""
        brick = target.brick is not None
        return self._added(f"{target.name}_force", target.body, target.point, brick)

    def pressOf(self, target):
        """The engine of a press, whose resultant goes through the middle of what the platen presses, and the area of that
        [m²]."""
        known = f"{target.name}_force" in self.loads
        area, middle = self.supports.contactOf(target)
        load = self.forceOf(target)
        if not known:
            load.point = (middle[0], middle[1], target.point[2])
        return load, area

    def onBricks(self, label, places):
        """The engines of forces at points of bricks; they are made if they are missing.

        :param label: with which their labels begin
        :param places: pairs of the number of a brick and a point [m]
        """
        made = {
            f"{label}_{n}": dict(body=self.ids[brick], point=point, damped=True)
            for n, (brick, point) in enumerate(places)
        }
        return self._loadsOf(made)

    def _added(self, label, body, point, damped=False):
        """A load that a stage adds, or has added."""
        return self._loadsOf({label: dict(body=body, point=point, damped=damped)})[0]

    def _loadsOf(self, made):
        """Loads by their labels; those that are missing are made all at once, as engines before that of the energy balance.

        :param made: dict from the label to the attributes of a load that may be missing
        """
        new = {n: MasonryLoad(label=n, **of) for n, of in made.items() if n not in self.loads}  # fmt: skip
        if new:
            before = list(O.engines)
            at = next(n for n, one in enumerate(before) if one.label == "energy")
            engines = [*before[:at], *new.values(), *before[at:]]
            # the state at rest gets the engines, too
            if self.structure.atRest is not None:
                now = saveScene("null")
                loadScene(self.structure.atRest)
                O.engines = engines
                self.structure.atRest = saveScene("null")
                O.engines = before
                loadScene(now)
            O.engines = engines
            self.loads.update(new)
        return [self.loads[label] for label in made]

    def isDriven(self, target, axis):
        """Whether a drive holds or moves a target along an axis."""
        return any(
            load and target.body in bodiesOf(load) and isAlong(load, axis)
            for load in self.loads.values()
        )

    def driveOf(self, target, axis):
        """The load that drives a target along an axis, or None."""
        return self.loads.get(f"{target.name}_drive_{axis}")

    def pushOf(self, target, axis):
        """The drive that a push made, if it holds a target along an axis, alone or with others, else None."""
        for label in (f"{target.name}_drive", PATTERN):
            load = self.loads.get(label)
            if load and target.body in bodiesOf(load) and isAlong(load, axis):
                return load
        return None

    def patternDrive(self):
        """The engine of a push in a pattern; it is made if it is missing."""
        return self._added(PATTERN, self.ids[0], (0, 0, 0))

    def driveForce(self, target, axis):
        """Force of the drive of a target along an axis [N], as a vector."""
        load = self.driveOf(target, axis)
        return load.reaction * load.direction.normalized()

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

    def topDisplacement(self):
        """Displacement since the scene was built [m] of the followed point, along the push or load and upwards, and of the bricks at
        the followed platen along it."""
        moved = self.supports.moved(self.followed)[0]
        return moved.dot(self.direction), moved[2], self._masonryMoved()

    def _masonryMoved(self):
        return self.supports.masonryMoved(self.followed, self.direction)

    def masonryAlong(self):
        """Displacement of the bricks at the followed platen along the push or load since that began [m]; 0 if none is followed."""
        return self._masonryMoved() - self.origin[2] if self.followed else 0.0

    def alongNow(self):
        """Displacement of the followed point along the push or load since that began [m]; 0 if none is followed."""
        return self.topDisplacement()[0] - self.origin[0] if self.followed else 0.0

    def hasSunk(self, down=None):
        """Whether the pushed platen has come down by half the height of a brick.

        :param down: its displacement downwards [m], if that is known
        """
        down = -self.supports.moved(self.target)[0][2] if down is None else down
        block = self.description.bricks[-1].corners
        return down > 0.5 * (max(p[2] for p in block) - min(p[2] for p in block))

    def keepLoadLine(self):
        """Move the points of vertical loads that keep their line in space back to it."""
        for target in self.description.targets.values():
            if target.pressed is None or target.riding:
                continue
            load = self.loads[f"{target.name}_force"]
            drive = self.loads["push"] if target is self.target else load
            drive = load if drive.others else drive
            along = drive.displacement()
            away = (along[0], 0 if self.description.plane else along[1], 0)
            load.point = self._lines[target.name] - Vector3(*away)

    def besideThePush(self):
        """What acts on the structure beside a push: weights, dead loads, and other drives [N]. Nothing if none is pushed."""
        if not self.pushing:
            return Vector3.Zero
        beside, push = self.supports.applied(), self.loads["push"]
        for label, load in self.loads.items():
            if label != "push" and load is not push and load.driven:
                beside += load.reaction * load.direction.normalized()
        return beside

    # -- what a checkpoint keeps beside the state in YADE ------------------------------------------------------------

    def state(self):
        """What stages have set: a dict of values that JSON can hold."""
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
        }

    def putState(self, state):
        """Give it a state of :meth:`state`. Raises KeyError if it names a target or a load that is not there."""
        targets, loads = {"": None, **self.description.targets}, {"": None, **self.loads}  # fmt: skip
        self.target, self.followed = targets[state["target"]], targets[state["followed"]]  # fmt: skip
        self.loads["push"] = loads[state["push"]]
        self.direction, self.origin = Vector3(*state["direction"]), tuple(state["origin"])  # fmt: skip
        self.pushing, self.grown = state["pushing"], state["grown"]
        self.goal, self.loadFactor = tuple(state["goal"]), state["loadFactor"]
