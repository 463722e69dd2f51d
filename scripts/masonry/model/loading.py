# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads: displacement-controlled groups, presses, dead loads, wind; and the point whose
displacement is recorded."""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from yade import O, Vector3
from yade.wrapper import MasonryLoad

from .._masonry import loadScene, saveScene
from ..errors import checkPlane
from ..terminal import say

PATTERN = "_drive"  # label of the drive of a push in a pattern
#: Uplift over which friction of a testing machine grows to its whole [m]. A platen on a pier that
#: rocks rises by a fifth to a half of its drift, so a reversal takes 0.1 to 0.2 mm of that.
GUIDE_TRAVEL = 2e-5
LIFT = "_lift"  # end of the label of what makes a platen lighter or heavier than its mass
DRIVE = re.compile("_drive(_[xyz])?$").search  # whether a label is that of a drive


def smooth(x):
    """The share of a load after a share of the time in which it grows [-]."""
    return x * x * (3 - 2 * x)


class Loading:
    """Loads and drives of a structure, from its description and from stages.

    A target has an engine each for its press, its dead load, a press and a force that stages let
    grow beside these, and its drives: what changes one of them leaves the others.

    - ``loads``: MasonryLoad engines by label; ``push``: the one that drives the
      pushed target, or None
    - ``target``: what is pushed, a target or a :class:`Pattern`; at first the target that a drive
      holds
    - ``control``: the target whose displacement the push counts, or the pattern, then of its mean
    - ``followed``: that whose displacement is recorded now, or None; ``direction`` of the present
      push or load, and ``origin``: the displacement when it began, along it and up, and that of the
      bricks at the followed platen along it; of a push that of its target upwards, too [m]
    - ``pushing``: whether the present load is a push
    - ``grown``: whether presses, dead loads and wind have grown
    - ``loadFactor`` of the load that a stage puts on or lets grow [-]
    - ``goal``: number, from 1, and displacement [mm] of the point of a history that the drive is
      going to
    """

    def __init__(self, structure):
        self.structure, self.description = structure, structure.description
        self.ids = structure.ids
        self.loads = {load.label: load for load in self._made()}
        targets = self.description.targets.values()
        self.target = next((target for target in targets if target.drives), None)
        self.followed = self.control = self.target
        self.push = self.target and self.driveOf(self.target, self.target.drives[0])
        #: labels of drives that hold from the beginning on
        self.beginning = {name for name, load in self.loads.items() if load.driven}
        self.direction, self.origin = Vector3.UnitX, (0.0, 0.0, 0.0)
        self.pushing = self.grown = False
        self.loadFactor = 0.0
        self.goal = 0, 0.0
        # forces of grown presses, dead loads and wind, by label [N]
        self._grown = {}
        self._lines = {}  # points of the presses, as they were built [m]

    def _made(self):
        """Loads of targets and wind, then drives of targets that can be pushed: a drive meets its
        velocity under the loads that act before it."""
        targets = [target for target in self.description.targets.values() if target.loaded]
        for target in targets:
            yield from _deadLoadsOn(target)
        for n, (brick, _, point) in enumerate(self.description.winds):
            on = dict(body=self.ids[brick], point=point)
            yield MasonryLoad(label=f"wind_{n}", damped=True, **on)
        for target in targets:
            on = _on(target)
            for axis in target.drives:
                on["direction"] = Vector3(*(float(axis == a) for a in "xyz"))
                label = f"{target.name}_drive_{axis}"
                yield MasonryLoad(label=label, driven=True, **on)
            if not target.drives:
                yield MasonryLoad(label=f"{target.name}_drive", **on)

    def begin(self):
        """Find the grown presses, dead loads and wind, when all joints are there."""
        self.supports = self.structure.supports
        for target in self.description.targets.values():
            if target.force is not None:
                force = self._grown[f"{target.name}_force"] = Vector3(*target.force)
                self._warnHeld(target, force, "load")
            if target.weight is not None:
                self._grown[target.name + LIFT] = self.supports.liftOf(target)
            if target.pressed is not None:
                self._warnHeld(target, Vector3.UnitZ, "press")
                label, own = f"{target.name}_press", self.supports.weightOf(target)
                load = self.loads[label]
                down = target.pressed * self._centre(load, target) - own
                self._grown[label] = -down * Vector3.UnitZ
                self._lines[target.name] = Vector3(*load.point)
        for n, (_, force, _) in enumerate(self.description.winds):
            self._grown[f"wind_{n}"] = Vector3(*force)

    def _centre(self, load, target):
        """Move a resultant to the middle of what a platen presses. Returns the area of that
        [m²]."""
        area, middle = self.supports.contactOf(target)
        load.point = (middle[0], middle[1], target.point[2])
        return area

    def grow(self, x):
        """Let presses, dead loads and wind grow smoothly, for x from 0 to 1."""
        self.grown = x == 1
        for label, force in self._grown.items():
            self.loads[label].force = force * smooth(x)
        self.structure.connectors.grow(smooth(x))

    def deadLoads(self, lifts=True):
        """Pairs of MasonryLoad and its force when it has grown [N], or without those of LIFT."""
        for label, load in self.loads.items():
            if label.endswith(LIFT) and not lifts:
                continue
            grown = load.force if self.grown else self._grown.get(label, load.force)
            yield load, grown

    def forceOf(self, target, grown=False):
        """The engine of the dead load on a target, or of what has grown beside it, made if
        missing."""
        return self._loadsOf({f"{target.name}_force" + "_grown" * grown: _on(target)})[0]

    def pressOf(self, target, grown=False):
        """The engine of a press, or of what has grown beside it, made if missing, and the pressed
        area [m²]."""
        label = f"{target.name}_press" + "_grown" * grown
        known = label in self.loads
        (load,) = self._loadsOf({label: _on(target)})
        return load, self.supports.contactOf(target)[0] if known else self._centre(load, target)

    def onBricks(self, label, places):
        """The engines of forces at pairs of the number of a brick and a point [m], made if missing.

        :param label: with which their labels begin
        """
        made = {
            f"{label}_{n}": dict(body=self.ids[brick], point=point, damped=True)
            for n, (brick, point) in enumerate(places)
        }
        return self._loadsOf(made)

    def patternDrive(self):
        """The engine of a push in a pattern, made if missing."""
        on = dict(body=self.ids[0], point=(0, 0, 0), damped=False)
        return self._loadsOf({PATTERN: on})[0]

    def _loadsOf(self, made):
        """Loads by their labels; missing ones are made from their attributes, drives before the
        engine of the energy balance and others before the drives."""
        new = {n: MasonryLoad(label=n, **of) for n, of in made.items() if n not in self.loads}
        if new:
            before, drives = list(O.engines), PATTERN in new
            ahead = lambda label: label == "energy" or DRIVE(label) and not drives
            at = next(n for n, one in enumerate(before) if ahead(one.label))
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
        return any(isAlong(load, axis, target.body) for load in self.loads.values())

    def checkFree(self, target, force, name):
        """Raise ValueError if a force on a target has a part that a support or a drive takes."""
        if held := self.heldAlong(target.body, force):
            raise ValueError(
                f"{name}: {target.name} is held along {', '.join(held)} by a support or a drive,"
                " which takes the load there until release() lets go"
            )

    def _warnHeld(self, target, force, name):
        """Say that a support or a drive takes a load that is described."""
        try:
            self.checkFree(target, force, name)
        except ValueError as taken:
            say(f"warning: {taken}")

    def heldAlong(self, body, force):
        """Axes along which a force has a part that a support or a drive of its body takes."""
        blocked, loads = O.bodies[body].state.blockedDOFs, self.loads.values()
        along = [a for a, v in zip("xyz", force) if abs(v) > 1e-12 * force.norm()]
        return [a for a in along if a in blocked or any(isAlong(one, a, body) for one in loads)]

    def driveOf(self, target, axis):
        """The load that drives a target along an axis, or None."""
        return self.loads.get(f"{target.name}_drive_{axis}")

    def pushOf(self, target, axis):
        """The drive of a push that holds a target along an axis, or None."""
        made = map(self.loads.get, (f"{target.name}_drive", PATTERN))
        return next((load for load in made if load and isAlong(load, axis, target.body)), None)

    def stopDrives(self):
        """Stop all drives, which hold from now on. Returns them."""
        drives = [load for label, load in self.loads.items() if DRIVE(label)]
        for load in drives:
            load.velocity = load.ramp = 0
        return drives

    def driveForce(self, target, axis):
        """Force of the drive of a target along an axis [N], as a vector."""
        return reactionOf(self.driveOf(target, axis))

    def follow(self, target, direction, origin=None):
        """Record the displacement of a target, or none, along a direction from now on. Returns the
        origin.

        :param origin: [m]; None: where the target is now
        """
        self.followed, self.direction, self.pushing = target, direction, False
        self.origin = origin or (0, 0, 0)
        if target and origin is None:
            self.origin = self.topDisplacement()
        return list(self.origin)

    def topDisplacement(self):
        """Displacement since the scene was built [m] of the followed point, along the load and
        upwards, and of the bricks at the followed platen along the load."""
        moved = self.supports.moved(self.followed)[0]
        masonry = self.supports.masonryMoved(self.followed, self.direction)
        return moved.dot(self.direction), moved[2], masonry

    def masonryAlong(self):
        """Displacement of the bricks at the followed platen along the load since it began [m], or
        0."""
        return self.topDisplacement()[2] - self.origin[2] if self.followed else 0.0

    def alongNow(self):
        """Displacement of the followed point along the load since it began [m]."""
        return self.topDisplacement()[0] - self.origin[0] if self.followed else 0.0

    def level(self):
        """Upward displacement of what is pushed since the scene was built [m], or 0."""
        return self.supports.moved(self.target)[0][2] if self.target else 0.0

    def hasSunk(self, level, path=0.0):
        """Whether what is pushed has come down by half the height of a brick.

        :param level: :meth:`level` when that began to count [m]
        :param path: how far it was pushed upwards since [m]
        """
        block = self.description.bricks[-1].corners
        down = level + min(0.0, path) - self.level()
        return down > 0.5 * (max(p[2] for p in block) - min(p[2] for p in block))

    def keepLoadLine(self):
        """Move the points of presses that do not ride back to their line in space."""
        for target in self.description.targets.values():
            if target.pressed is None or target.riding:
                continue
            load = self.loads[f"{target.name}_press"]
            along = (self.push if target is self.target else load).displacement()
            away = (along[0], 0 if self.description.plane else along[1], 0)
            for one in (load, self.loads.get(f"{target.name}_press_grown")):
                if one:
                    one.point = self._lines[target.name] - Vector3(*away)

    def besideThePush(self):
        """Force of weights, dead loads and other drives beside a push [N]; 0 without a push."""
        if not self.pushing:
            return Vector3.Zero
        beside = self.supports.applied()
        for load in self.loads.values():
            if (load.driven or load.engaged) and load is not self.push:
                beside += reactionOf(load)
        return beside

    # -- what a checkpoint keeps beside the state in YADE ------------------------------------------

    def state(self):
        """What stages have set, for JSON."""
        return {
            "target": self.target.name if self.target else "",
            "control": self.control.name if self.control else "",
            "followed": self.followed.name if self.followed else "",
            "push": self.push.label if self.push else "",
            "direction": list(self.direction),
            "pushing": self.pushing,
            "grown": self.grown,
            "origin": list(self.origin),
            "goal": list(self.goal),
            "loadFactor": self.loadFactor,
        }

    def putState(self, state):
        """Take a state of :meth:`state`. Raises KeyError for unknown targets and loads."""
        targets = {"": None, **self.description.targets}
        self.push = {"": None, **self.loads}[state["push"]]
        if state["push"] == PATTERN:
            targets[state["target"]] = patternOfDrive(self, state["target"])
        names = "target", "control", "followed"
        self.target, self.control, self.followed = (targets[state[name]] for name in names)
        self.direction, self.origin = Vector3(*state["direction"]), tuple(state["origin"])
        self.pushing, self.grown = state["pushing"], state["grown"]
        self.goal, self.loadFactor = tuple(state["goal"]), state["loadFactor"]


def _on(target):
    """Attributes of a load on a target. A brick keeps its numerical damping until it is driven."""
    return dict(body=target.body, point=target.point, damped=target.brick is not None)


def _machineOf(target):
    """Attributes of a press that follows its platen."""
    if not target.isInMachine:
        return {}
    (left, front, _), (right, back, _) = target.box
    load = target.pressed * (right - left) * (back - front)
    return dict(
        direction=-Vector3.UnitZ,
        stiffness=target.stiffness,
        friction=target.friction,
        guideStiffness=target.guides or target.friction * load / GUIDE_TRAVEL,
    )


def _deadLoadsOn(target):
    if target.pressed is not None:
        yield MasonryLoad(label=f"{target.name}_press", **_on(target), **_machineOf(target))
    if target.force is not None:
        yield MasonryLoad(label=f"{target.name}_force", **_on(target))
    if target.weight is not None:
        middle = [(a + b) / 2 for a, b in zip(*target.box)]
        yield MasonryLoad(label=target.name + LIFT, **{**_on(target), "point": middle})


# -- drives of pushes ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Pattern:
    """Blocks that a push moves in place of a target, with forces in a fixed proportion.

    :param name: in bounds and messages
    :param parts: of each block its body, the point of its force in the structure as built [m], and
        its share of the whole force [-]
    :param damped: whether the blocks keep their numerical damping, as where all are driven
    """

    name: str
    parts: tuple[tuple[int, Any, float], ...]
    damped: bool = False
    box = brick = None  # it is no platen and no brick

    @property
    def recorded(self) -> Any:
        """The mean of the points, weighted by the shares [m]."""
        return sum((share * Vector3(*point) for _, point, share in self.parts), Vector3.Zero)


def pushTo(loading, pushed, control, direction, name="push"):
    """Let a push move a target or a :class:`Pattern` in a direction from now on, and record the
    displacement of a control, a target or that pattern. Other drives hold. Returns whether this one
    has held since an earlier push."""
    checkPlane(loading.description, direction, name)
    for body, *_ in pushed.parts:
        blocked = O.bodies[body].state.blockedDOFs
        if not any(v and a not in blocked for a, v in zip("xyz", direction)):
            raise ValueError(
                f"{name}: {pushed.name} is held along {tuple(direction)}, and cannot be pushed"
                " there"
            )
    drive = _drivePattern if isinstance(pushed, Pattern) else _driveOf
    load = drive(loading, pushed, direction, name)
    loading.stopDrives()
    before = loading.pushing and load is loading.push  # a drive may hold from the beginning on
    held = load.driven and (before or load.label not in loading.beginning)
    if load.driven:  # it holds, and is asked for its force before the next step
        load.reaction *= load.direction.normalized().dot(direction)
    load.direction, load.driven = direction, True
    loading.target, loading.direction, loading.push = pushed, direction, load
    loading.followed = loading.control = control
    loading.origin, loading.pushing = (0, 0, 0), True
    return held


def _driveOf(loading, target, direction, name):
    load = loading.loads.get(f"{target.name}_drive")
    pattern = loading.loads.get(PATTERN)
    if pattern and pattern.driven and target.body in bodiesOf(pattern):
        _refuseHeld(name, target, pattern)
    if target.drives:
        along = [a for a, v in zip("xyz", direction) if abs(v) > 1 - 1e-12]
        load = loading.driveOf(target, along[0]) if along else None
        if load is None:
            raise ValueError(
                f"{name}: {target.name} has drives along {', '.join(target.drives)} alone, not"
                f" along {tuple(direction)}"
            )
    elif load.driven and load.direction.cross(direction).norm() > 1e-12:
        raise ValueError(
            f"{name}: the drive of {target.name} holds it along {tuple(load.direction)}, and would"
            f" let go of it to push along {tuple(direction)}; drive='xz' and the like give it a"
            " drive for every axis"
        )
    load.damped = False
    return load


def _drivePattern(loading, pattern, direction, name):
    bodies, points, shares = zip(*pattern.parts)
    for other in loading.loads.values():
        if other.driven and set(bodies) & set(bodiesOf(other)):
            same = bodiesOf(other) == bodies and np.allclose(other.shares or (1,), shares)
            if not same or other.direction.cross(direction).norm() > 1e-12:
                _refuseHeld(name, pattern, other)
    load = loading.patternDrive()
    load.updateAttrs(
        dict(
            body=bodies[0],
            point=points[0],
            others=bodies[1:],
            otherPoints=points[1:],
            shares=shares if bodies[1:] else (),
            damped=pattern.damped,
        )
    )
    return load


def _refuseHeld(name, pushed, drive):
    raise ValueError(
        f"{name}: a drive holds {pushed.name} or some of it along {tuple(drive.direction)} already;"
        " release() lets it go"
    )


def patternOfDrive(loading, name):
    """The pattern of the drive of a push, with a name."""
    load = loading.patternDrive()
    points, shares = (load.point, *load.otherPoints), load.shares or (1.0,)
    return Pattern(name, tuple(zip(bodiesOf(load), points, shares)), load.damped)


def bodiesOf(load):
    """The bodies that a MasonryLoad loads."""
    return load.body, *load.others


def isAlong(load, axis, body):
    """Whether a MasonryLoad is a drive of a body with a part along an axis."""
    along = axis in "xyz" and abs(load.direction["xyz".index(axis)]) > 1e-12
    return load.driven and along and body in bodiesOf(load)


def reactionOf(load):
    """Force of the drive of a MasonryLoad, or of a machine beside its force [N]."""
    return load.reaction * load.direction.normalized()


def forceOn(load, body):
    """Force of a MasonryLoad and its drive or machine on a body [N]."""
    if body not in bodiesOf(load):
        return Vector3.Zero
    share = load.shares[bodiesOf(load).index(body)] if load.others else 1.0
    force = load.force if body == load.body else Vector3.Zero
    return force + share * load.reaction * load.direction.normalized()
