# SPDX-License-Identifier: GPL-2.0-or-later
"""Drives along an axis without a run-up: ``drive`` and ``pressJoint``."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Annotated, Any, Callable, Union

from yade import O

from ...common.arguments import number, orFunction
from ...basics import Refused
from ..targets import AnyTarget, RecordedJoint
from .answers import DONE, Answer
from .stage import stage
from .supports import letGo, millimetres

ROWS = 2000  # of curve.csv while a block is driven over a distance
Distance = Annotated[Union[float, Callable[[], float]], orFunction(millimetres)]


#: The largest mean stresses of a recorded joint that are answers: name, column, and the sign with which they are counted.
STRESSES = (
    ("peak_normal_stress", "normal_stress_MPa", 1),
    ("peak_compressive_stress", "normal_stress_MPa", -1),
    ("peak_shear_stress", "shear_stress_MPa", 1),
)


def stresses(scene, rows):
    """The largest mean stresses of the joints that are recorded, in tension, compression and shear."""
    how = "the largest mean over the joint in this stage"
    for joint in scene.description.joints:
        for name, column, sign in STRESSES:
            if values := rows(joint.prefixed(column)):
                value = max(sign * v for v in values)
                yield Answer(joint.prefixed(name), "MPa", value, how)


@stage(options=("rate",), answers=stresses)
def drive(
    scene: Any,
    target: AnyTarget,
    x: Distance = 0.0,
    y: Distance = 0.0,
    z: Distance = 0.0,
) -> str:
    """Drive a target along an axis at ``--rate`` from the first step on, for example two bricks and their joint.

    The rows of curve.csv are closer together at the beginning, where the peaks are. The drives of other axes hold
    what they hold.

    :param x: displacement along x [mm], and likewise ``y`` and ``z``: one of them. It may be a function without
        arguments that gives it when the stage begins
    """
    given = {a: v for a, v in zip("xyz", (x, y, z)) if callable(v) or v}
    if len(given) != 1 or [*given][0] not in target.drives:
        raise ValueError(
            f"drive: give one displacement other than 0, along an axis that has a drive; {_drivesOf(target)}"
        )
    ((axis, value),) = given.items()

    def distance():
        try:
            found = millimetres(value() if callable(value) else value)
        except ValueError as error:
            raise ValueError(f"drive: {axis} {error}") from None
        if not found:
            raise ValueError(f"drive: {axis} {found} mm must be other than 0")
        return 1e-3 * scene.share * found

    return _driveBy(scene, target, axis, distance)


def checkStress(scene, target, joint, stress):
    """Refuse a stress that crushes the bed joint."""
    bed = scene.masonry.joints["bed"]
    if bed.cap and not bed.elastic and -stress >= bed.compressiveStrength:
        raise Refused(
            f"pressJoint: {1e-6 * stress:g} MPa crushes the bed joint, whose compressive strength is "
            f"{1e-6 * bed.compressiveStrength:g} MPa"
        )


@stage(options=("rate",), check=checkStress, answers=stresses)
def pressJoint(
    scene: Any,
    target: AnyTarget,
    joint: RecordedJoint,
    stress: Annotated[float, number("Pa", -1e12, 1e12)],
) -> str:
    """Bring a bed joint to a mean normal stress by a drive along z, then hold that by its force: nothing swings.

    :param target: a platen with a drive along z, above bricks on one column
    :param joint: as :meth:`joint` gave it
    :param stress: [Pa], negative if it presses; one that crushes the joint is refused
    """
    if "z" not in target.drives:
        raise ValueError(f"pressJoint: needs a drive along z; {_drivesOf(target)}")
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
