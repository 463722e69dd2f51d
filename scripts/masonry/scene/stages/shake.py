# SPDX-License-Identifier: GPL-2.0-or-later
"""Real time: ``shake`` and ``run``."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Annotated, Any, Sequence

from yade import O, Vector3

from ...common.arguments import FilePath, Level, Numbers, number, oneOf, validated
from ...basics import Refused, say
from ...run import batch
from ..accelerograms import components, drift
from ..ground import UNITS, readRecord, record
from ...run.options import Damping
from ..words import SHAKES
from .gravity import sideways
from .answers import DONE, Answer
from .stage import stage
from .timed import Duration, Time, Timed, timed


def displacements(scene, rows):
    """The largest horizontal displacement of every target that moves, and what remains at the end, with the direction's
    sign."""
    for target in scene.description.targets.values():
        for axis in "xy" if not target.fixed else "":
            if values := rows(f"{target.name}_{axis}_mm"):
                how = "relative to the ground, since the scene was built, of the rows of this stage"
                of = f"displacement_of_{target.name}_{axis}"
                yield Answer(f"largest_{of}", "mm", max(values, key=abs), how)
                yield Answer(f"{of}_at_the_end", "mm", values[-1], how)
    for drift in scene.description.drifts:
        for axis, unit in itertools.product("xy", ("mm", "mrad")):
            of = f"{drift.name}_{axis}"
            if values := rows(f"{of}_{unit}"):
                how = f"of {drift.upper.name} against {drift.lower.name}, of the rows of this stage"
                yield Answer(f"largest_{of}", unit, max(values, key=abs), how)
                yield Answer(f"{of}_at_the_end", unit, values[-1], how)
    times = rows("time_s")
    if scene.collapsed and times:
        how = "when the fall was noticed, from the beginning of the stage"
        fell = (one["fell"] for one in scene.model.fallen().values())
        noticed = min(fell, default=times[-1])
        yield Answer("time_of_collapse", "s", noticed - times[0], how)


@dataclass
class Damped(Timed):
    """What a stage remembers that has a damping of its own."""

    limit: float = 0.0  # the stable limit of its time step [s]; 0 before that is known


def inRealTime(scene, name, damping, massDamping=0.0, stiffnessDamping=0.0):
    """Begin a stage in real time with a damping of its own. Returns what it remembers."""
    at, scheme = scene.running.stage(name, Damped()), scene.model.scheme
    scheme.trueMasses(name)
    scheme.damp(damping, scene.args.damping_kind, massDamping, stiffnessDamping)
    at.limit = scheme.chooseTimeStep(at.limit)
    return at


@stage(options=("record", "scale"), real=True, answers=displacements)
@validated
def shake(
    scene: Any,
    accelerations: Annotated[Numbers | FilePath | Sequence[FilePath], record],
    every: Duration | None = None,
    direction: Level = (1, 0, 0),
    scale: Annotated[float, number("", -1e6, 1e6)] = 1.0,
    unit: Annotated[str, oneOf(*UNITS)] | None = None,
    after: Time = 0.0,
    damping: Damping = 0.0,
    massDamping: Annotated[float, number("1/s", 0, 1e6)] = 0.0,
    stiffnessDamping: Annotated[float, number("s", 0, 1)] = 0.0,
) -> str:
    """Shake the ground by a record.

    The scene moves with the ground: every block feels the negative ground acceleration, and all displacements are
    those relative to the ground, whose motion is exact. Time is real, so masses must not be scaled. Between the
    samples the acceleration changes evenly, and each step has that of its middle: nothing is filtered, and the time step
    does not depend on the samples.

    Joints that slide, crack and crush take energy, and so do those without bond that close after they have been open, as
    their ``restitution`` says. The default adds no other damping, since none is measured for masonry that rocks.
    :func:`rayleigh` gives the two viscous ones from a damping ratio. The stages that follow have the damping of the options
    again.

    ``--record FILE`` replaces the record of the first shake of a scene, with the time between its samples, its factor and its
    unit, and ``--scale S`` makes that shake S times as strong. A record that does not end at rest is named with its numbers; nothing is corrected.

    :param accelerations: a list, or the path of a file of PEER or ESM or of a text with one or two columns, as
        :mod:`masonry.scene.accelerograms` says; or three paths, of both horizontal components and the vertical one, upwards,
        which act at once
    :param every: time between two samples [s]; None: that of the file
    :param direction: of the ground's motion, horizontal; the second of three components is at 90° to its left
    :param scale: factor on the accelerations
    :param unit: of the accelerations: ``"m/s²"``, ``"g"`` or ``"cm/s²"``; None: what the file says, or else m/s², and a
        record whose peak looks like another unit is refused
    :param after: time that follows the record [s]
    :param damping: numerical damping constant of the options' kind [-]
    :param massDamping: viscous, of the motion relative to the ground [1/s]
    :param stiffnessDamping: viscous, of the joints [s]; it shortens the time step
    """
    # --record and --scale are for the first shake of a scene
    args, isFirst = scene.args, scene.script.isFirst(SHAKES)
    if isFirst and args.record is not None:
        accelerations, every, scale, unit = batch.beside(args.record), None, 1.0, None
    scale *= args.scale if isFirst else 1
    try:
        values, every = readRecord(accelerations, every, scale, unit)
    except Refused as refused:
        raise Refused(f"shake: {refused}") from None
    motions = components(values).tolist()
    for motion in motions:
        if doubt := drift(motion, every).sentence():
            say(f"note: shake: the record drifts: {doubt}")
    axes = [sideways(scene, direction, "shake")]
    if len(motions) == 3:
        left = Vector3.UnitZ.cross(axes[0])
        axes += [sideways(scene, left, "shake"), Vector3.UnitZ]
    if args.density_scaling != 1:
        raise Refused("--density-scaling: a scene that is shaken runs in real time")
    at = inRealTime(scene, "shake", damping, massDamping, stiffnessDamping)
    if O.dt > every:
        say(
            f"warning: shake: the time step, {O.dt:.3g} s, is longer than the time between samples, {every:.3g} s, so that some "
            "samples are left out; a smaller --dt-fraction helps"
        )
    down = -scene.description.gravity * Vector3.UnitZ

    def before(done, beyond):
        place = (done + 0.5) * O.dt / every
        first = int(place)
        share, now = place - first, down
        if first + 1 < len(values):
            for motion, axis in zip(motions, axes):
                a = (1 - share) * motion[first] + share * motion[first + 1]
                now = now - scale * a * axis
        scene.model.scheme.setGravity(now)

    duration = (len(values) - 1) * every + after
    timed(scene, at, scene.share * duration, before, each=1)
    scene.model.scheme.setGravity(down)
    return DONE


@stage(farther=("seconds",), real=True, answers=displacements)
@validated
def run(scene: Any, seconds: Duration, damping: Damping = 0.0) -> str:
    """Let time pass, as it is: nothing brakes but what joints and contacts lose.

    A block hits a wall, as a car does, if a script gives it a velocity after ``settle()``, and says so to the energy balance::

        from yade import O
        scene = Scene("car", wall + road + car, stones, collapse="follow", allowGaps=True)  # the car is apart from the wall
        ...
        O.bodies[target.body].state.vel = (5, 0, 0)  # [m/s]; target: watch() or handle() of the car
        scene.model.energy.given()
        scene.run(3)

    The script would do this again in a run that ``--resume`` continues later, so start such a run anew.

    :param seconds: time in the scene [s]
    :param damping: numerical damping constant of the options' kind [-]
    """
    at = inRealTime(scene, "run", damping)
    return timed(scene, at, scene.share * seconds, lambda done, beyond: None)
