# SPDX-License-Identifier: GPL-2.0-or-later
"""Real time: ``shake``, ``run``, and ``shakeAgain``, records one after the other with what is left
after each: ``period``."""

import csv
import itertools
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Annotated, Any, Sequence

import numpy as np
from yade import O, Vector3

from ..arguments import FilePath, Level, Numbers, listOf, number, oneOf, validated
from ..folders import replaced, writing
from ..model.period import smallPeriod
from ..errors import Refused
from ..terminal import say
from ..run import batch
from ..scene.accelerograms import components, drift
from ..scene.ground import UNITS, readRecord, record
from ..run.option_table import USUAL, Damping
from ..scene.script import SHAKES
from .gravity import sideways
from .answers import COLLAPSED, DONE, Answer
from .rest import settle
from .stage import Duration, Time, Timed, combines, stage, timed

TABLE = "shakes.csv"
#: Time step over its limit without numerical damping, under which joints that yield need the larger
#: margin of ``--dt-fraction``; unless the user chooses that option.
UNDAMPED = 0.95
LONGEST = 4.0  # [s]: the longest first period that is looked for


def displacements(scene, rows):
    """The largest horizontal displacement of every target that moves, and that at the end."""
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
    gravity: list | None = None  # that acts beside the record [m/s²]


def inRealTime(scene, name, damping, massDamping=0.0, stiffnessDamping=0.0):
    """Begin a stage in real time with a damping of its own. Returns its memory."""
    at, scheme = scene.running.stage(name, Damped()), scene.model.scheme
    scheme.trueMasses(name)
    scheme.damp(damping, scene.args.damping_kind, massDamping, stiffnessDamping)
    usual = scene.args.dt_fraction == USUAL["dt_fraction"]
    fraction = UNDAMPED if usual and not damping else None
    at.limit = scheme.chooseTimeStep(at.limit, fraction)
    scheme.followStep(fraction)
    return at


def readable(scene, accelerations, every=None, direction=None, scale=1.0, unit=None, *_, **__):
    """Raise Refused for a record that cannot be read, unless the command line replaces it."""
    replaced = scene.args.record is not None and not scene.script.has(SHAKES)
    if not (replaced or scene.running.isResumed):
        _read(accelerations, every, scale, unit)


def readableAll(scene, records, every=None, direction=None, scales=None, longest=None, **how):
    """Raise Refused for one of the records of :func:`shakeAgain` that cannot be read. Returns the
    samples of all [m/s²]."""
    scales = [1.0] * len(records) if scales is None else scales
    return [_read(one, every, s, how.get("unit"))[0] for one, s in zip(records, scales)]


def _read(*how):
    try:
        return readRecord(*how)
    except Refused as refused:
        raise Refused(f"shake: {refused}") from None


@stage(options=("record", "scale"), dynamic=True, check=readable, answers=displacements)
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

    Every block feels the negative ground acceleration, beside those of :meth:`lean`,
    :meth:`accelerate` and :meth:`tilt`, which stay, and displacements are relative to the ground.
    Time is real, so masses must not be scaled. Between the samples the acceleration changes evenly,
    and each step has that of its middle: nothing is filtered, and the time step does not depend on
    the samples.

    Joints that slide, crack and crush take energy, and so do those without bond that close, as
    their ``restitution`` says. The default adds no other damping, since none is measured for
    masonry that rocks. :func:`rayleigh` gives the two viscous ones from a damping ratio. They end
    with the stage.

    ``--record FILE`` replaces the record of the first shake of a scene that is none of
    :meth:`shakeAgain`, with its time between samples, factor and unit, and ``--scale S`` makes that
    shake S times as strong. A record that does not end at rest is named with its numbers; nothing
    is corrected.

    :param accelerations: a list, or the path of a file (:mod:`masonry.scene.accelerograms`); or
        three paths, of both horizontal components and the vertical one, upwards
    :param every: time between two samples [s]; None: that of the file
    :param direction: of the ground's motion, horizontal; the second of three components is at 90°
        to its left
    :param scale: factor on the accelerations
    :param unit: of the accelerations: ``"m/s²"``, ``"g"`` or ``"cm/s²"``; None: what the file says,
        or else m/s², and a record whose peak looks like another unit is refused
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
    values, every = _read(accelerations, every, scale, unit)
    motions = components(values).tolist()
    for motion in motions:
        if doubt := drift(motion, every).sentence():
            say(f"note: shake: the record drifts: {doubt}")
    axes = [sideways(scene, direction, "shake")]
    if len(motions) == 3:
        left = Vector3.UnitZ.cross(axes[0])
        axes += [sideways(scene, left, "shake"), Vector3.UnitZ]
    at = inRealTime(scene, "shake", damping, massDamping, stiffnessDamping)
    if O.dt > every:
        say(
            f"warning: shake: the time step, {O.dt:.3g} s, is longer than the time between samples,"
            f" {every:.3g} s, so that some samples are left out; a smaller --dt-fraction helps"
        )
    scheme = scene.model.scheme
    at.gravity = at.gravity or list(scheme.now)
    scheme.setGravity(Vector3(*at.gravity))
    scheme.shake(motions, axes, every, scale)
    duration = (len(values) - 1) * every + after
    timed(scene, at, scene.share * duration)
    scheme.shake([], [], every, scale)
    return DONE


@stage(extendable=("seconds",), dynamic=True, answers=displacements)
def run(scene: Any, seconds: Duration, damping: Damping = 0.0) -> str:
    """Let time pass: nothing brakes but what joints and contacts lose.

    A script may give a block a velocity after ``settle()``, as to a car that hits a wall, if it
    says so to the energy balance::

        from yade import O
        # allowGaps: the car is apart from the wall
        scene = Scene("car", wall + road + car, stones, collapse="follow", allowGaps=True)
        ...
        O.bodies[target.body].state.vel = (5, 0, 0)  # [m/s]; target: watch() or handle() of the car
        scene.model.energy.given()
        scene.run(3)

    ``--resume`` would give the velocity again, so start such a run anew.

    :param seconds: time in the scene [s]
    :param damping: numerical damping constant of the options' kind [-]
    """
    at = inRealTime(scene, "run", damping)
    return timed(scene, at, scene.share * seconds, lambda done, beyond: None)


def remains(scene, rows):
    """The first period, what has moved since the scene was built, and the widest crack."""
    at = scene.running.memory
    looked = (
        f"free vibration after a push of {at.share:g} g, which a smaller one does not change; at"
        f" most {LONGEST:g} s"
    )
    yield Answer("first_period", "s", at.period or None, looked)
    for target in scene.description.targets.values():
        moved = scene.model.supports.moved(target)[0]
        for i, axis in enumerate("xyz" if not target.fixed else ""):
            how = "at rest, since the scene was built"
            yield Answer(f"residual_{target.name}_{axis}", "mm", 1e3 * moved[i], how)
    width = scene.model.widestCrack()
    yield Answer("largest_crack", "mm", width, "of all joints, at rest")


@stage(answers=remains)
def period(scene: Any, direction: Level = (1, 0, 0)) -> str:
    """Measure the first period of the structure, which is at rest, and what has moved since it was
    built. Of an elastic structure it is that of its mode with its present weights, else that of its
    free vibration after a push of 0.05 g, and less where the period depends on it, as where
    something lifts off. Drives hold. The scene stays as it is.

    :param direction: horizontal
    """
    along = sideways(scene, direction, "period")
    # the first period [s], 0 if there is none, and the push over gravity
    at = scene.running.stage("period", SimpleNamespace(period=0.0, share=0.0))
    scheme, slower = scene.model.scheme, scene.args.density_scaling**0.5  # heavy blocks swing so
    if scheme.massScaling:
        scheme.trueMasses("period")
        scheme.chooseTimeStep()
    with scene.running.clock("setup"), scene.running.breakable():
        period, at.share = smallPeriod(scene.model, along, LONGEST * slower)
        at.period = (period or 0.0) / slower
    return DONE


@combines
@validated
def shakeAgain(
    scene: Any,
    records: Annotated[Sequence[Any], listOf(record)],
    every: Duration | None = None,
    direction: Level = (1, 0, 0),
    scales: Annotated[Sequence[float], listOf(number("", -1e6, 1e6))] | None = None,
    longest: Duration = 4.0,
    **how: Any,
) -> list[str]:
    """Shake a structure by one record after the other, as it was left by those before. After each
    it comes to rest, and its period and what remains are measured: stages :meth:`shake`,
    :meth:`settle` and :meth:`period`. ``shakes.csv`` has a row for every record, whose ``ended`` is
    ``"at rest"``, or ``"moving"`` if it did not come to rest. A :meth:`shake` after them shakes
    what they have damaged, and ``--record`` and ``--scale`` are for it.

    :param records: of each what :meth:`shake` takes
    :param every: time between two samples [s], and ``direction``: as in :meth:`shake`
    :param scales: a factor for each record [-]; None: 1
    :param longest: time after a record in which it comes to rest at most [s]
    :param how: other arguments of :meth:`shake`, as ``unit`` and ``damping``
    :returns: how each shake ended; a collapse ends the sequence
    :raises ValueError: if there are not as many scales as records
    """
    if scene.args.record is not None or scene.args.scale != 1:
        say("note: shakeAgain: --record and --scale are for a shake() that follows")
    scales = [1.0] * len(records) if scales is None else scales
    if len(scales) != len(records):
        raise Refused(f"shakeAgain: {len(scales)} scales for {len(records)} records")
    ends, rows = [], []
    read = readableAll(scene, records, every, scales=scales, **how)
    for count, (one, scale) in enumerate(zip(records, scales), 1):
        scene.script.aside = True
        try:
            ends.append(shake(scene, one, every, direction, scale, **how))
        finally:
            scene.script.aside = False
        stages, rests = [scene.running.entered], COLLAPSED
        if ends[-1] != COLLAPSED:
            rests = settle(scene, longest=longest)
        if rests != COLLAPSED:
            period(scene, direction)
            stages.append(scene.running.entered)
        peak = abs(scale) * float(np.abs(read[count - 1]).max())
        row = {"shake": count, "peak_m_per_s2": peak}
        for answer in scene.answers:
            if answer["number"] in stages:
                unit = "" if answer["unit"] == "-" else f"_{answer['unit']}"
                row[answer["name"] + unit] = answer["value"]
        rows.append({**row, "ended": scene.ended if rests == COLLAPSED else rests})
        _write(scene, rows)
        if scene.collapsed:
            say(f"shakeAgain: the structure fell in record {count} of {len(records)}")
            break
    return ends


def _write(scene, rows):
    heads = dict.fromkeys(head for row in rows for head in row if head != "ended")
    path = scene.results.path(TABLE)
    with writing(path), replaced(path, "w", newline="") as file:
        writer = csv.DictWriter(file, [*heads, "ended"])
        writer.writeheader()
        writer.writerows(rows)
