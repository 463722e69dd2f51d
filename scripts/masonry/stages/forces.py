# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads after the first stage. ``load``, ``wind``, ``press`` and ``pressure`` give a load its new
value and wait for rest, so that ``bracket`` can search for the largest that is held. ``grow`` adds
loads to what is there until the structure falls, and searches by itself; what has grown stays
beside what those commands replace. ``hold`` holds what was free."""

import math
import re
from types import SimpleNamespace
from typing import Annotated, Any

from yade import O, Vector3

from ..arguments import Direction, Freedoms, Level, isNumber, number, shown, validatorOf
from ..errors import Refused
from ..model.load_names import nameOf
from .bounds import findBound
from ..scene.loads import Field, Force, Friction, Pressure, Stress
from ..scene.loads import checkedForce, doubtPress, doubtWind, windForces
from ..scene.pressures import pressures
from ..scene.targets import AnyTarget, Loaded, MovingPlaten, Part
from .gravity import Acting, Width, putOn, putOnAnswers
from .growing import WITHIN, found
from .growing import grow as growTo
from .answers import AT_REST, DONE
from .stage import Duration, stage
from ..scene.script import PUSHES
from .travelling import placed

GROWS = 2.0  # [s] in which a load grows to its whole


class Forces(Acting):
    """Forces of MasonryLoad engines: of each the vector at a factor of 1 [N]."""

    replaces = False  # the forces replace those that are there, and are not added to them
    beside = 0, 0, 0  # a force that stays beside those that replace [N]
    dead = False  # what was there grows by the factor, too

    def __init__(self, loads, forces, name, unit, most, towards=None):
        super().__init__(name, most, unit, towards)
        self.loads, self.forces = loads, forces

    def pairs(self):
        """The engines and their forces at a factor of 1."""
        pairs = zip(self.loads, self.forces)
        return [(load, force + self.dead * load.force) for load, force in pairs]

    def now(self):
        return [value for load in self.loads for value in load.force]

    def put(self, values):
        for n, load in enumerate(self.loads):
            load.force = Vector3(*values[3 * n : 3 * n + 3])

    def at(self, began, share):
        factor = self.factor(share)
        whole = [factor * value for force in self.forces for value in force]
        if self.replaces:
            return [v + self.beside[n % 3] for n, v in enumerate(whole)]
        return [was * (1 + factor * self.dead) + v for was, v in zip(began, whole)]


def _forceOn(scene, target, force, name):
    """The load of a force on a target, in kN. Raises ValueError."""
    force = checkedForce(scene.description, force, name)
    if not force.norm() > 0 and name != "load":
        raise ValueError(f"{name}: force must not be zero")
    scene.model.loading.checkFree(target, force, name)
    engine = scene.model.loading.forceOf(target, name == "grow")
    # a load that is taken away keeps its direction
    along = force if force.norm() > 0 else engine.force
    towards = along.normalized() if along.norm() > 0 else Vector3.UnitZ
    what = f"load on {target.name} along {nameOf(towards)}"
    made = Forces([engine], [1e3 * towards], what, "kN", 1e-3 * force.norm(), towards)
    made.target = target
    return made


@stage(bounded=True, answers=putOnAnswers)
def load(scene: Any, target: Loaded, force: Force, longest: Duration | None = None) -> str:
    """Give a target another dead load, which replaces the one of :meth:`load` and :meth:`release`,
    and no other load, and wait until the structure is at rest or falls.

    The load changes within 0.02 s, and longer for tall structures. ``bracket(lambda f:
    scene.load(target, (0, 0, -f)) == AT_REST, 1e3, 9e3)`` finds the largest that is held.

    :param force: three numbers [N]; zeros take the load away
    :param longest: time in the scene after which it is given up [s]; None: 4 s, and longer while
        the motion dies away
    :returns: ``AT_REST``, ``MOVING`` or ``COLLAPSED``
    """
    return _putOn(scene, "load", _forceOn(scene, target, force, "load"), longest)


def _windOn(scene, pressure, towards, part):
    """The load of a wind, in kPa. Raises ValueError."""
    if pressure:  # 0 takes a wind away
        doubtWind(pressure, "wind")
    sign = math.copysign(1, pressure)
    forces = windForces(scene.description, 1e3 * sign, Vector3(*towards), part, "wind")
    # suction has the engines of a pressure on the same faces, so that one replaces the other
    return _inKilopascals(_onFaces(scene, forces, "wind", towards, part), pressure)


def _pressureOn(scene, value, towards, part, normal, grown=False, friction=0.0):
    """The load of a pressure, of which 1 is the whole. Raises ValueError."""
    forces = pressures(scene.description, value, towards, part, normal, friction)
    kind = "pressure" if normal else "pressure in plan"
    kind += f" at {friction:g}°" if friction else ""
    return _onFaces(scene, forces, kind, towards, part, grown)


def _evenOn(scene, value, towards, part, normal, grown=False):
    """The load of a pressure that is the same everywhere and not 0, in kPa. Raises ValueError."""
    one = _pressureOn(scene, math.copysign(1e3, value), towards, part, normal, grown)
    return _inKilopascals(one, value)


def _inKilopascals(load, value):
    """A load of 1 kPa, of which a pressure [Pa] is the whole."""
    load.unit, load.most = "kPa", 1e-3 * abs(value)
    load.towards *= math.copysign(1, value)
    return load


def _onFaces(scene, forces, kind, towards, part, grown=False):
    """The load of forces on faces, by what labels its engines and names it."""
    along = Vector3(*towards).normalized()
    axes = ", ".join(f"{v + 0.0:.6g}" for v in along)
    on = f" on {part}" if part is not None else ""
    label = _labelOf(f"{'grown ' * grown}{kind} ({axes}){on}")
    loading, whole = scene.model.loading, [Vector3(*one.force) for one in forces]
    # what was released before a checkpoint is still held while the run that goes on is built
    takes = (loading.heldAlong(loading.ids[one.brick], f) for one, f in zip(forces, whole))
    if not scene.isGone and all(takes):
        raise ValueError(f"{kind}: all bricks that it loads are held, and supports would take it")
    engines = loading.onBricks(label, [(one.brick, one.point) for one in forces])
    what = f"{kind} towards {nameOf(towards)}{on}"
    return Forces(engines, whole, what, "-", 1.0, along)


def _labelOf(text):
    """A text as YADE's names of Python can hold it: no two have the same."""
    return re.sub(r"[^a-zA-Z0-9]", lambda found: f"_{ord(found[0]):x}_", text)


@stage(bounded=True, answers=putOnAnswers)
def wind(
    scene: Any,
    pressure: Pressure,
    towards: Level,
    part: Part | None = None,
    longest: Duration | None = None,
) -> str:
    """Give the faces that look against a horizontal direction another pressure, and wait as
    :meth:`load` does. Winds that grew in :meth:`settle` or :meth:`grow` stay; a later :meth:`wind`
    of the same direction and part replaces this one.

    :param pressure: [Pa]; 0 takes the wind away; ``towards`` and ``part``: as before the first
        stage
    """
    return _putOn(scene, "wind", _windOn(scene, pressure, towards, part), longest)


@stage(bounded=True, answers=putOnAnswers)
def pressure(
    scene: Any,
    value: Field,
    towards: Direction,
    part: Part | None = None,
    normal: bool = True,
    friction: Friction = 0.0,
    longest: Duration | None = None,
) -> str:
    """Give faces another pressure, and wait as :meth:`load` does. Pressures that grew in
    :meth:`settle` or :meth:`grow` stay; a later :meth:`pressure` of the same direction, part,
    ``normal`` and ``friction`` replaces this one.

    :param value: [Pa], or a function of the place; 0 takes it away; ``towards``, ``part``,
        ``normal`` and ``friction``: as before the first stage
    """
    made = _pressureOn(scene, value, towards, part, normal, friction=friction)
    return _putOn(scene, "pressure", made, longest)


def _pressOn(scene, platen, stress, name):
    """The load of a press, in MPa. Raises ValueError."""
    if not stress > 0:
        raise ValueError(f"{name}: stress {stress!r} Pa must be above 0")
    doubtPress(stress, name)
    scene.model.loading.checkFree(platen, Vector3.UnitZ, name)
    engine, area = scene.model.loading.pressOf(platen, name == "grow")
    what, whole = f"press of {platen.name}", [-1e6 * area * Vector3.UnitZ]
    made = Forces([engine], whole, what, "MPa", 1e-6 * stress, -Vector3.UnitZ)
    made.target = platen
    return made


@stage(bounded=True, answers=putOnAnswers)
def press(scene: Any, platen: MovingPlaten, stress: Stress, longest: Duration | None = None) -> str:
    """Press a platen with another mean stress on the bricks below it, and wait as :meth:`load`. It
    replaces the press before; dead loads, and what :meth:`grow` has added, stay beside it.

    :param stress: mean vertical stress on the bricks, with the weight of the platen [Pa]
    """
    made = _pressOn(scene, platen, stress, "press")
    scene.model.disengage(platen)
    made.beside = [0, 0, scene.model.supports.weightOf(platen)]
    return _putOn(scene, "press", made, longest)


def together(value, context):
    """Validator of loads that grow together: a dict from targets to forces [N] or, of platens,
    stresses [Pa]."""
    if not isinstance(value, dict):
        raise ValueError(
            f"{shown(value)} must be a dict from targets to forces [N] or stresses [Pa]"
        )
    kinds = {True: (MovingPlaten, Stress), False: (Loaded, Force)}
    return {
        validatorOf(target)(one, context): validatorOf(load)(amount, context)  # type: ignore[misc]
        for one, amount in value.items()
        for target, load in [kinds[isNumber(amount)]]
    }


@stage(bounded=True, answers=found)
def grow(
    scene: Any,
    loads: Annotated[dict[Any, Any], together],
    most: Annotated[float, number("", 0, 1e6, above=True)] = 1.0,
    dead: bool = False,
    pressure: Field | None = None,
    towards: Direction = (1, 0, 0),
    part: Part | None = None,
    normal: bool = True,
    over: Duration = GROWS,
    within: Width = WITHIN,
) -> str:
    """Let a load, or several in a fixed proportion, grow evenly beside what is there, until the
    structure falls or they are ``most`` times as large; then search for the load that is held.

    ``scene.grow({stone: (2e3, 0, 0)})`` adds a force to a brick, ``scene.grow({top: 0.1e6})`` a
    stress to what presses a platen, and ``scene.grow({}, pressure=2e3, towards=(1, 0, 0))`` an even
    pressure, as of wind, to faces. ``scene.grow({top: 0.1e6, stone: (2e3, 0, 0)}, most=10)`` lets
    two grow together.

    :param loads: a dict from targets to three numbers [N], or to a stress of a platen [Pa], at a
        factor of 1; it may be empty
    :param most: factor of all of them at the end [-]
    :param dead: whether what acts already grows, too: at a factor of 1 dead loads, presses without
        the weight of their platens, pressures, and what has grown before are twice what they were.
        Gravity stays
    :param pressure: [Pa] at a factor of 1, or a function of the place, with ``towards``, ``part``
        and ``normal`` as in :meth:`pressure`
    :param over: time in which they grow to that [s]
    :param within: as in :meth:`tilt`
    :returns: as in :meth:`tilt`. ``scene.factor`` of one load alone is its amount: of a force in
        kN, of a stress in MPa, of an even pressure in kPa; otherwise it has no unit
    """
    for target in scene.description.targets.values():
        if target.isInMachine and (dead or isNumber(loads.get(target))):
            raise ValueError(
                f"grow: friction or stiffness of a testing machine follows a load that stays:"
                f" press {target.name} again with another stress"
            )
    made = [
        (_pressOn if isNumber(amount) else _forceOn)(scene, target, amount, "grow")
        for target, amount in loads.items()
    ]
    if pressure is not None:
        even = isNumber(pressure) and pressure != 0
        make: Any = _evenOn if even and not loads and not dead else _pressureOn
        made.append(make(scene, pressure, towards, part, normal, True))
    if len(made) == 1 and not dead:
        made[0].most *= most
        return _grow(scene, made[0], over, within)
    pairs = [(e, one.most * force) for one in made for e, force in one.pairs()]
    if dead:
        pairs += [(one, Vector3.Zero) for one, _ in scene.model.loading.deadLoads(lifts=False)]
    if not pairs:
        raise ValueError("grow: loads, pressure or dead must say what grows")
    forces: dict[str, Any] = {}
    for engine, force in pairs:
        forces[engine.label] = forces.get(engine.label, Vector3.Zero) + force
    engines = [scene.model.loading.loads[label] for label in forces]
    amount = lambda one: f" ({one.most:.4g} {one.unit})" * (one.unit != "-")
    names = [one.name + amount(one) for one in made]
    what = " and ".join(names + ["the dead loads"] * dead)
    total = sum(forces.values(), Vector3.Zero)
    along = total.normalized() if total.norm() > 0 else -Vector3.UnitZ
    whole = Forces(engines, [*forces.values()], what, "-", most, along)
    whole.dead = dead
    whole.target = next((one.target for one in made if one.target), None)
    return _grow(scene, whole, over, within)


def _putOn(scene, name, made, longest):
    made.replaces, before = True, made.now()
    if scene.limitAnalysisOnly:  # what it replaces is no load beside it
        made.put(made.at(before, 0.0))
    if scene.limitAnalysisOnly or not any(before):
        _findBound(scene, made)
    ended = putOn(scene, name, made, longest)
    if scene.limitAnalysisOnly and ended != AT_REST:
        made.put(before)
    return ended


def _grow(scene, made, over, within):
    _findBound(scene, made)
    return growTo(scene, "grow", made, over, within)


def _findBound(scene, made):
    findBound(scene, "forces", made.name, made.unit.strip("-"), made.pairs())


@stage()
def hold(scene: Any, target: AnyTarget, axes: Freedoms = "xyzXYZ") -> str:
    """Hold a target where it is now. What follows is the next stage's.

    The top of many test rigs is pressed, then held along z and about Y: it keeps its height and
    does not turn.

    :param target: a platen or a :meth:`handle`, or a brick that was held and released: what has
        columns for its reaction
    :param axes: along which it is held, xyz, and about which it cannot turn, XYZ
    """
    if not (target.fixed or target.loaded):
        raise ValueError(
            "hold: only a platen, a handle(), or what was held and released, can be held after the"
            f" first stage: curve.csv has no columns for the reaction of {target.name}"
        )
    across = [a for a in axes if a in "xy" and target.box and not target.fixed]
    if across:
        raise ValueError(
            f"hold: {target.name} is a platen, which can be held along z and about X, Y and Z after"
            f" the first stage: curve.csv has no column for its reaction along {', '.join(across)};"
            " push() it and let the drive hold it there"
        )
    zones = scene.model.zones
    if zones and target.body in zones.bodies:
        raise Refused(
            f"hold: {target.name} is a deformable brick, which can be held before the first stage"
            " alone"
        )
    driven = [a for a in "xyz" if scene.model.loading.isDriven(target, a) and a in axes]
    if driven:
        raise ValueError(f"hold: a drive holds {target.name} along {', '.join(driven)} already")
    scene.model.supports.holdAlso(target, axes)
    state = O.bodies[target.body].state
    blocked = {*state.blockedDOFs, *axes}
    state.blockedDOFs = "".join(a for a in "xyzXYZ" if a in blocked)
    for i, (axis, about) in enumerate(zip("xyz", "XYZ")):
        state.vel[i] *= axis not in blocked
        state.angVel[i] *= about not in blocked
    scene.running.stage("hold", SimpleNamespace())
    return DONE


def prepare(scene, word, arguments):
    """Make the engines of a load after the first stage, before a checkpoint is loaded that has
    them."""
    loading, get = scene.model.loading, arguments.get
    target = get("target") or get("platen")
    if word in PUSHES and (isinstance(target, dict) or target not in scene.targets):
        loading.patternDrive()
        return
    alone = {"load": None, "press": 0, "pressJoint": None}
    if word == "release" and get("force") is not None:
        alone[word] = None
    loads, grown = {target: alone[word]} if word in alone else get("loads", {}), word == "grow"
    for name, amount in loads.items():
        if name in scene.targets:
            make = loading.pressOf if isNumber(amount) else loading.forceOf
            make(scene.targets[name], grown)
    if word == "wind":
        _windOn(scene, *(arguments[n] for n in ("pressure", "towards", "part")))
    elif word == "pressure" or get("pressure") is not None:
        # its value, which may be a function, has no part in where its engines are
        _pressureOn(
            scene,
            0.0,
            *(arguments[n] for n in ("towards", "part", "normal")),
            grown,
            get("friction", 0.0),
        )
    elif word == "travel":
        placed(scene, arguments["along"], get("axles", [(0.0, 1.0)]), get("spread", 0.0))
