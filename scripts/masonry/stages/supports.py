# SPDX-License-Identifier: GPL-2.0-or-later
"""Drives along an axis without a run-up, and supports that are taken away or that move: ``drive``,
``pressJoint``, ``release`` and ``move``."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Annotated, Any, Callable, Union, cast

from yade import O, Vector3

from ..arguments import Freedoms, number, orFunction
from ..model.motion import SWUNG
from ..errors import Refused, checkPlane
from ..terminal import say
from ..numbers.quantities import IMBALANCE, shearOf
from ..scene.history import MAX_DISPLACEMENT
from ..scene.loads import Force
from ..scene.pressures import atPlace
from ..run.option_table import Rate
from ..scene.targets import AnyTarget, HeldTargets, RecordedJoint, Target
from .rest import rampTime
from .answers import DONE, Answer
from .stage import Timed, stage, timed

ROWS = 2000  # of curve.csv while a block is driven over a distance
millimetres = number("mm", -MAX_DISPLACEMENT, MAX_DISPLACEMENT)  # validator of a displacement
Along = Annotated[Union[float, Callable[[float, float, float], float]], orFunction(millimetres)]
Distance = Annotated[Union[float, Callable[[], float]], orFunction(millimetres)]


@stage(bounded=True)
def release(scene: Any, target: AnyTarget, axes: Freedoms, force: Force | None = None) -> str:
    """Take a support away, or let a drive go. What follows is the next stage's, as ``settle``.

    :param target: a brick or platen that is held, a platen with a drive, or what a push has left
        under its drive
    :param axes: along which it becomes free, some of xyz, and about which, XYZ
    :param force: three numbers [N] that stay in place of a drive, as a part of the dead load, which
        :meth:`load` replaces; None: none
    """
    letGo(scene, target, axes, force)  # first: what it refuses is no stage
    scene.running.stage("release", SimpleNamespace())
    return DONE


def letGo(scene, target, axes, force):
    """Free a target along some axes, with a force in place of its drive."""
    free = "xzY" if scene.description.plane else "xyzXYZ"  # nothing moves along others
    state, loading = O.bodies[target.body].state, scene.model.loading
    axes = [a for a in axes if a in free] or axes
    drives = {a: loading.driveOf(target, a) or loading.pushOf(target, a) for a in axes}
    held = set(state.blockedDOFs) & set(free)
    loose = [a for a, drive in drives.items() if not (drive or a in held)]
    problems = [f"release: {target.name} is not held along {axis}" for axis in loose]
    if target.line:
        problems.append(f"release: {target.name} is a line, which holds to the end")
    if force is not None and not any(drives.values()):
        problems.append("release: only in place of a drive a force can stay")
    if force is not None and any(drive and drive.others for drive in drives.values()):
        problems.append("release: force: a drive in a pattern moves several blocks")
    if problems:
        raise Refused("\n".join(problems))
    for axis, drive in drives.items():
        if drive:
            drive.driven, drive.velocity = False, 0
            scene.model.motion.far = SWUNG  # what it held swings back
        else:
            state.blockedDOFs = state.blockedDOFs.replace(axis, "")
    if force is not None:
        loading.forceOf(target).force += Vector3(*force)
    return DONE


@dataclass
class Moving(Timed):
    """What a stage remembers that moves supports."""

    imbalance: float = 0.0  # Supports.imbalance() in the last row [-]
    largest: float = 0.0  # and in any row so far


def answersOfMove(scene, rows):
    """How far each held target has moved in this stage, and what inertia takes of reactions."""
    how = "from the first row of the stage to its last, which is the collapse if the structure fell"
    for target in scene.description.targets.values():
        columns = [rows(f"{target.name}_{axis}_mm") for axis in "xyz" if target.fixed]
        squares = sum((values[-1] - values[0]) ** 2 for values in columns if values)
        if squares:
            yield Answer(f"displacement_of_{target.name}", "mm", squares**0.5, how)
    how = (
        "the force that inertia takes, over the largest reaction of a support along the same axis,"
        " in the last row; 0 at rest"
    )
    yield Answer("dynamic_imbalance", "-", scene.running.memory.imbalance, how)


@stage(extendable=("x", "y", "z"), options=("rate",), answers=answersOfMove)
def move(
    scene: Any,
    target: HeldTargets,
    x: Along = 0.0,
    y: Along = 0.0,
    z: Along = 0.0,
    rate: Rate | None = None,
) -> str:
    """Move fixed targets by a displacement, in straight lines at once: settlement or spreading of
    supports, or a trough under a row of them, as ``scene.move(footings, z=lambda x, y, z: -20 *
    math.exp(-x * x / 18))``. They start and stop smoothly, and none turns. Reactions include the
    inertia of what moves; a note says so where it is large. :meth:`settle` takes it out of the last
    row, a lower rate out of all.

    :param target: one that is held, or a list of them
    :param x: [mm], or a function that gives it of the recorded point (x, y, z) [m] of a target; so
        are ``y`` and ``z``
    :param rate: of the one that moves farthest [mm/s]; None: ``--rate``
    """
    at = scene.running.stage("move", Moving())
    scene.model.scheme.followStep()
    targets = cast("list[Target]", target)
    paths = [_path(scene, one, (x, y, z)) for one in targets]
    rate = 1e-3 * (scene.args.rate if rate is None else rate)
    distance = 1e-3 * max(path.norm() for path in paths)
    if not distance > 0:
        raise Refused("move: the displacement must not be zero")
    ramp = min(rampTime(scene.args), distance / rate)
    duration = distance / rate + ramp

    def place(time):  # along the path [m], with velocity that grows evenly
        if time < ramp:
            return rate * time * time / (2 * ramp)
        if time > duration - ramp:
            return distance - rate * max(0.0, duration - time) ** 2 / (2 * ramp)
        return rate * (time - ramp / 2)

    states = [O.bodies[one.body].state for one in targets]

    def before(done, beyond):
        began, ends = (place(min(duration, ticks * at.tick)) for ticks in (done, beyond))
        speed = (ends - began) / ((beyond - done) * at.tick)
        for state, path in zip(states, paths):
            state.vel = speed * (1e-3 / distance * path)

    def after():
        at.imbalance = scene.model.supports.imbalance()
        at.largest = max(at.largest, at.imbalance)

    timed(scene, at, duration, before, after)
    if at.largest > IMBALANCE:
        say(
            f"note: move: of a reaction inertia is {100 * at.imbalance:.0f} % in the last row, and"
            f" up to {100 * at.largest:.0f} % in others: settle() takes it out of the last one, a"
            " lower rate= out of all"
        )
    scene.running.state.supportsMoved = True
    for state in states:
        state.vel = Vector3.Zero
    return DONE


def _path(scene, target, along):
    """The displacement of a target in :func:`move` [mm]. Raises ValueError."""
    values = [atPlace(v, target.recorded, millimetres, "move") if callable(v) else v for v in along]
    checkPlane(scene.description, values, "move")
    path = scene.share * Vector3(*values)
    loose = [a for a, w in zip("xyz", path) if w and a not in target.freedom]
    if loose:
        raise Refused(f"move: {target.name} is not held along {', '.join(loose)}")
    return path


def stresses(scene, rows):
    """The largest mean stresses of recorded joints, in tension, compression and shear."""
    how = "the largest mean over the joint in this stage"
    for joint in scene.description.joints:
        own = lambda head: rows(joint.prefixed(head))
        for name, values in (
            ("peak_normal_stress", own("normal_stress_MPa")),
            ("peak_compressive_stress", [-v for v in own("normal_stress_MPa")]),
            ("peak_shear_stress", shearOf(own)),
        ):
            if values:
                yield Answer(joint.prefixed(name), "MPa", max(values), how)


@stage(options=("rate",), answers=stresses)
def drive(
    scene: Any,
    target: AnyTarget,
    x: Distance = 0.0,
    y: Distance = 0.0,
    z: Distance = 0.0,
) -> str:
    """Drive a target along an axis at ``--rate`` from the first step on, for example two bricks and
    their joint. Drives of other axes hold what they hold.

    The rows of curve.csv are closer together at the beginning, where the peaks are.

    :param x: displacement along x, or ``y`` or ``z``, one of them [mm]. It may be a function
        without arguments that gives it when the stage begins
    """
    given = {a: v for a, v in zip("xyz", (x, y, z)) if callable(v) or v}
    if len(given) != 1 or [*given][0] not in target.drives:
        raise Refused(
            "drive: give one displacement other than 0, along an axis that has a drive;"
            f" {_drivesOf(target)}"
        )
    ((axis, value),) = given.items()

    def distance():
        try:
            found = millimetres(value() if callable(value) else value)
        except ValueError as error:
            raise Refused(f"drive: {axis} {error}") from None
        if not found:
            raise Refused(f"drive: {axis} {found} mm must be other than 0")
        return 1e-3 * scene.share * found

    return _driveBy(scene, target, axis, distance)


def checkStress(scene, target, joint, stress):
    """Refuse a stress that crushes the bed joint."""
    bed = scene.masonry.joints["bed"]
    if bed.cap and not bed.elastic and -stress >= bed.compressiveStrength:
        raise Refused(
            f"pressJoint: {1e-6 * stress:g} MPa crushes the bed joint, whose compressive strength"
            f" is {1e-6 * bed.compressiveStrength:g} MPa"
        )


@stage(options=("rate",), check=checkStress, answers=stresses)
def pressJoint(
    scene: Any,
    target: AnyTarget,
    joint: RecordedJoint,
    stress: Annotated[float, number("Pa", -1e12, 1e12)],
) -> str:
    """Bring a bed joint to a mean normal stress by a drive along z, which then holds its force.

    :param target: a platen with a drive along z, above bricks on one column
    :param joint: as :meth:`joint` gave it
    :param stress: [Pa], negative if it presses; one that crushes the joint is refused
    """
    if "z" not in target.drives:
        raise Refused(f"pressJoint: needs a drive along z; {_drivesOf(target)}")
    scene.model.loading.forceOf(target)  # checkpoints of the drive have its engine, too
    distance = stress / joint.normalStiffness
    _driveBy(scene, target, "z", lambda: distance)
    if stress:
        # other joints and deformable bricks have taken their part of the displacement
        missing = lambda: distance * (stress / joint.normalStress() - 1)
        _driveBy(scene, target, "z", missing)
    return letGo(scene, target, "z", (0, 0, stress * joint.area))


def _driveBy(scene, target, axis, distance):
    """Drive a target along an axis by what a function gives when the stage begins [m]."""
    run, load = scene.running, scene.model.loading.driveOf(target, axis)
    at = run.stage(axis, SimpleNamespace(length=0, done=0))  # steps in all, and so far
    if at is None:
        return DONE
    if not at.length:
        speed, path = run.args.rate * 1e-3, distance()
        at.length = max(ROWS, int(abs(path) / (speed * O.dt)))
        load.velocity = path / (at.length * O.dt)
    marks = {round(at.length * (i / ROWS) ** 2) for i in range(1, ROWS + 1)}
    for mark in sorted(mark for mark in marks if mark > at.done):
        run.advance(mark - at.done)
        at.done = mark
        reading = run.record()
        run.show(at.done / at.length, lambda: f"{reading.time:.4f} s")
    run.flush()
    load.velocity = 0
    return DONE


def _drivesOf(target):
    return f"drives of {target.name}: {', '.join(target.drives) or 'none'}"
