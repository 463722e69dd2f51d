# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads after the first stage: ``load``, ``wind`` and ``press`` put them on, ``growLoad``, ``growWind`` and ``growPress`` let them
grow, and ``hold`` holds what was free.

The first three give a load its new value, whatever it was before, and wait for rest, so that ``bracket`` can search for the
largest that is held. The others add to what is there until the structure falls, and search by themselves.
"""

from __future__ import annotations

import math
import re
from typing import Any

from yade import O, Vector3

from ...common.arguments import Freedoms, Level, validated
from ...assembly.blocks import vector
from ...basics import Refused
from ..bounds import findBound, nameOf
from ..loads import Force, Pressure, Stress, checkedForce, doubtPress, windFaces
from ..targets import AnyTarget, Loaded, MovingPlaten, Part
from .acting import Forces
from .gravity import Width, boundAlone, putOn, putOnAnswers
from .growing import WITHIN, found, grow
from .answers import AT_REST
from .stage import stage
from .supports import atOnce
from ..words import PUSHES
from .timed import Duration

GROWS = 2.0  # [s] in which a load grows to its whole


# -- forces on a target -------------------------------------------------------------------------------------------


def _forceOn(scene, target, force, name):
    """The load of a force on a target, in kN along its direction. Raises ValueError."""
    force = checkedForce(scene.description, force, name)
    engine = scene.model.loading.forceOf(target)
    if not force.norm() > 0 and name != "load":
        raise ValueError(f"{name}: force must not be zero")
    # a load that is taken away keeps its direction
    along = force if force.norm() > 0 else engine.force
    towards = along.normalized() if along.norm() > 0 else Vector3.UnitZ
    what = f"load on {target.name} along {nameOf(towards)}"
    made = Forces([engine], [1e3 * towards], what, "kN", 1e-3 * force.norm())
    made.target = target
    return made, towards


@stage(bounded=True, answers=putOnAnswers)
@validated
def load(
    scene: Any, target: Loaded, force: Force, longest: Duration | None = None
) -> str:
    """Give a target another dead load, and wait until the structure is at rest or falls.

    Before the first stage :meth:`load` describes a load that grows in :meth:`settle`. After it the force replaces the dead load
    that the target has, described or put on; it changes within 0.02 s, and longer for tall structures. So
    ``bracket(lambda f: scene.load(target, (0, 0, -f)) == AT_REST, 1e3, 9e3)`` finds the largest that is held.

    :param force: three numbers [N]; zeros take the load away
    :param longest: time in the scene after which it is given up [s]; None: 4 s
    :returns: ``AT_REST``, ``MOVING`` or ``COLLAPSED``
    """
    made, towards = _forceOn(scene, target, force, "load")
    return _putOn(scene, "load", made, towards, longest)


@stage(bounded=True, answers=found)
@validated
def growLoad(
    scene: Any,
    target: Loaded,
    force: Force,
    over: Duration = GROWS,
    within: Width = WITHIN,
) -> str:
    """Let a dead load grow evenly beside what is there, until the structure falls or the force is reached; then search for the
    load that is held.

    :param force: at the end, three numbers [N]
    :param over: time in which it grows to that [s]
    :param within: as in :meth:`tilt`
    :returns: as in :meth:`tilt`; the unit of ``scene.factor`` is kN
    """
    made, towards = _forceOn(scene, target, force, "growLoad")
    return _grow(scene, "growLoad", made, towards, over, within)


# -- wind ---------------------------------------------------------------------------------------------------------


def _windOn(scene, pressure, towards, part, name):
    """The load of a wind, in kPa, and its direction. Raises ValueError."""
    towards = vector(towards, f"{name}: direction")
    calm = name == "wind" and pressure == 0  # the wind of before ends
    faces = windFaces(scene.description, pressure or float(calm), towards, part, name)
    # suction has the engines of a pressure on the same faces, so that one replaces the other
    engines = scene.model.loading.windOf(windLabel(towards.normalized(), part), faces)
    towards = math.copysign(1, pressure) * towards.normalized()
    sign = math.copysign(1e3, pressure)
    forces = [-sign * area * Vector3(*normal) for _, normal, area, _ in faces]
    what = f"wind towards {nameOf(towards)}" + (f" on {part}" if part else "")
    return Forces(engines, forces, what, "kPa", 1e-3 * abs(pressure)), towards


def windLabel(towards, part):
    """How the labels of the engines of a wind begin. YADE makes names of them."""
    axes = "_".join(f"{v + 0.0:.6g}".replace("-", "minus") for v in towards)
    return re.sub(r"\W", "_", f"wind_towards_{axes}_{part or 'all'}")


@stage(bounded=True, answers=putOnAnswers)
@validated
def wind(
    scene: Any,
    pressure: Pressure,
    towards: Level,
    part: Part | None = None,
    longest: Duration | None = None,
) -> str:
    """Give the faces that look against a horizontal direction another pressure, and wait until the structure is at rest or
    falls.

    Before the first stage :meth:`wind` describes a wind that grows in :meth:`settle`, and to which this one is added. Another
    :meth:`wind` of the same direction and part after the first stage replaces it.

    :param pressure: [Pa]; 0 takes the wind away; ``towards`` and ``part``: as before the first stage; ``longest``: as in
        :meth:`load`
    :returns: ``AT_REST``, ``MOVING`` or ``COLLAPSED``
    """
    made, towards = _windOn(scene, pressure, towards, part, "wind")
    return _putOn(scene, "wind", made, towards, longest)


@stage(bounded=True, answers=found)
@validated
def growWind(
    scene: Any,
    pressure: Pressure,
    towards: Level,
    part: Part | None = None,
    over: Duration = GROWS,
    within: Width = WITHIN,
) -> str:
    """Let a wind grow evenly until the structure falls or the pressure is reached; then search for the one that is held.

    :param pressure: at the end [Pa]; ``towards`` and ``part``: as in :meth:`wind`
    :param over: time in which it grows to that [s]
    :param within: as in :meth:`tilt`
    :returns: as in :meth:`tilt`; the unit of ``scene.factor`` is kPa
    """
    made, towards = _windOn(scene, pressure, towards, part, "growWind")
    return _grow(scene, "growWind", made, towards, over, within)


# -- presses ------------------------------------------------------------------------------------------------------


def _pressOn(scene, platen, stress, name):
    """The load of a press, in MPa. Raises ValueError."""
    if not stress > 0:
        raise ValueError(f"{name}: stress {stress!r} Pa must be above 0")
    doubtPress(stress, name)
    engine, area = scene.model.loading.pressOf(platen)
    down = -1e6 * area * Vector3.UnitZ
    what = f"press of {platen.name}"
    made = Forces([engine], [down], what, "MPa", 1e-6 * stress)
    made.target = platen
    return made


@stage(bounded=True, answers=putOnAnswers)
@validated
def press(
    scene: Any, platen: MovingPlaten, stress: Stress, longest: Duration | None = None
) -> str:
    """Press a platen with another mean stress on the bricks below it, and wait until the structure is at rest or falls.

    Before the first stage :meth:`press` describes a press that grows in :meth:`settle`. After it the stress replaces that.

    :param stress: mean vertical stress that the bricks feel [Pa]; the weight of the platen is part of it
    :param longest: as in :meth:`load`
    :returns: ``AT_REST``, ``MOVING`` or ``COLLAPSED``
    """
    made = _pressOn(scene, platen, stress, "press")
    made.beside = [0, 0, scene.model.supports.weightOf(platen)]
    return _putOn(scene, "press", made, -Vector3.UnitZ, longest)


@stage(bounded=True, answers=found)
@validated
def growPress(
    scene: Any,
    platen: MovingPlaten,
    stress: Stress,
    over: Duration = GROWS,
    within: Width = WITHIN,
) -> str:
    """Let a press grow evenly beside what presses already, until the structure falls or the stress is reached; then search for
    the one that is held.

    :param stress: what is added at the end [Pa]
    :param over: time in which it grows to that [s]
    :param within: as in :meth:`tilt`
    :returns: as in :meth:`tilt`; the unit of ``scene.factor`` is MPa
    """
    made = _pressOn(scene, platen, stress, "growPress")
    return _grow(scene, "growPress", made, -Vector3.UnitZ, over, within)


# -- what they share ----------------------------------------------------------------------------------------------


def _putOn(scene, name, made, towards, longest):
    made.replaces, scene.loadUnit, before = True, made.unit, made.now()
    if scene.only:  # what it replaces is no load beside it
        made.put(made.at(before, 0.0))
    if scene.only or not any(before):
        findBound(scene, "forces", made.name, made.unit, made.pairs())
    if scene.only:
        ended = boundAlone(scene, made)
        if ended != AT_REST:
            made.put(before)
        return ended
    return putOn(scene, name, made, towards, longest)


def _grow(scene, name, made, towards, over, within):
    findBound(scene, "forces", made.name, made.unit, made.pairs())
    return grow(scene, name, made, over, towards, within)


@stage()
@validated
def hold(scene: Any, target: AnyTarget, axes: Freedoms = "xyzXYZ") -> str:
    """Hold a target where it is now. What follows is the next stage's.

    Before the first stage :meth:`hold` describes a brick that is held from the beginning.

    A platen that is pressed and then held along z keeps its height, and one held about Y does not turn: so does the top of many
    test rigs.

    :param target: a platen or a :meth:`handle`, or a brick that was held and released: what has columns for its reaction
    :param axes: along which it is held, xyz, and about which it cannot turn, XYZ
    """
    if not (target.fixed or target.loaded):
        raise ValueError(
            f"hold: only a platen, a handle(), or what was held and released, can be held after the first stage: curve.csv has no "
            f"columns for the reaction of {target.name}"
        )
    across = [a for a in axes if a in "xy"] if target.box and not target.fixed else []
    if across:
        raise ValueError(
            f"hold: {target.name} is a platen, which can be held along z and about X, Y and Z after the first stage: curve.csv has no column for its "
            f"reaction along {', '.join(across)}; push() it and let the drive hold it there"
        )
    zones = scene.model.zones
    if zones and target.body in zones.bodies:
        raise Refused(
            f"hold: {target.name} is a deformable brick, which can be held before the first stage alone"
        )
    driven = [a for a in "xyz" if scene.model.loading.isDriven(target, a) and a in axes]
    if driven:
        raise ValueError(
            f"hold: a drive holds {target.name} along {', '.join(driven)} already"
        )

    def act():
        scene.model.supports.holdAlso(target, axes)
        state = O.bodies[target.body].state
        blocked = {*state.blockedDOFs, *axes}
        state.blockedDOFs = "".join(a for a in "xyzXYZ" if a in blocked)
        free = [float(a not in blocked) for a in "xyzXYZ"]
        state.vel = Vector3(*(v * f for v, f in zip(state.vel, free[:3])))
        state.angVel = Vector3(*(v * f for v, f in zip(state.angVel, free[3:])))

    return atOnce(scene, "hold", act)


def prepare(scene, word, arguments):
    """Make the engines of a load that the script puts on after the first stage, before a checkpoint is loaded that has them.

    :param word: what the script said; ``arguments``: its arguments as data
    """
    target = arguments.get("target") or arguments.get("platen")
    inPattern = isinstance(target, dict) or target not in scene.targets
    if word in PUSHES and inPattern:
        scene.model.loading.patternDrive()
        return
    target = None if inPattern else scene.targets[target]
    if word in ("load", "growLoad") and target:
        scene.model.loading.forceOf(target)
    elif word in ("press", "growPress") and target:
        scene.model.loading.pressOf(target)
    elif word in ("wind", "growWind"):
        _windOn(scene, *(arguments[n] for n in ("pressure", "towards", "part")), word)
