# SPDX-License-Identifier: GPL-2.0-or-later
"""Supports that are taken away or that move: ``release`` and ``move``."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Annotated, Any, Callable, Union, cast

from yade import O, Vector3

from ...common.arguments import Freedoms, number, orFunction
from ...assembly.blocks import inPlane
from ...assembly.motion import FAR
from ..history import MOST
from ..loads import Force
from ..pressures import atPlace
from ...run.options import Rate
from ..targets import AnyTarget, HeldTargets, Target
from .rest import rampTime
from .answers import DONE, Answer
from .stage import Timed, stage, timed

millimetres = number("mm", -MOST, MOST)  # the kind of a displacement
Along = Annotated[Union[float, Callable[[float, float, float], float]], orFunction(millimetres)]  # fmt: skip


@stage(bounded=True)
def release(
    scene: Any, target: AnyTarget, axes: Freedoms, force: Force | None = None
) -> str:
    """Take a support away, or let the drive of a platen go. What follows is the next stage's, for example ``settle``.

    :param target: a brick or platen that is held, a platen with a drive, or what a push has left under its drive
    :param axes: along which it becomes free, some of xyz, and about which, XYZ
    :param force: three numbers [N] of a load that stays in place of a drive; None: none
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
    if force is not None and not any(drives.values()):
        problems.append("release: only in place of a drive a force can stay")
    if force is not None and any(drive and drive.others for drive in drives.values()):
        problems.append("release: force: a drive in a pattern moves several blocks")
    if problems:
        raise ValueError("\n".join(problems))
    for axis, drive in drives.items():
        if drive:
            drive.driven, drive.velocity = False, 0
            drive.force = Vector3(*(force or (0, 0, 0)))
            scene.model.motion.far = FAR  # what it held swings back
        else:
            state.blockedDOFs = state.blockedDOFs.replace(axis, "")
    return DONE


def displacement(scene, rows):
    """How far each held target has moved in this stage: at its end, or when the structure fell."""
    how = "from the first row of the stage to its last, which is the collapse if the structure fell"
    for target in scene.description.targets.values():
        columns = [rows(f"{target.name}_{axis}_mm") for axis in "xyz" if target.fixed]
        squares = sum((values[-1] - values[0]) ** 2 for values in columns if values)
        if squares:
            yield Answer(f"displacement_of_{target.name}", "mm", squares**0.5, how)


@stage(farther=("x", "y", "z"), options=("rate",), answers=displacement)
def move(
    scene: Any,
    target: HeldTargets,
    x: Along = 0.0,
    y: Along = 0.0,
    z: Along = 0.0,
    rate: Rate | None = None,
) -> str:
    """Move fixed targets by a displacement [mm], in straight lines at once: settlement or spreading of supports, or a trough under
    a row of them.

    They start and stop smoothly, and none of them turns: ``scene.move(footings, z=lambda x, y, z: -20 * math.exp(-x * x / 18))``.

    :param target: one that is held, or a list of them
    :param x: [mm], or a function of the place (x, y, z) [m] of the recorded point of a target that gives it; ``y`` and ``z``: likewise
    :param rate: of the one that moves farthest [mm/s]; None: ``--rate``
    """
    at = scene.running.stage("move", Timed())
    targets = cast("list[Target]", target)
    paths = [_path(scene, one, (x, y, z)) for one in targets]
    rate = 1e-3 * (scene.args.rate if rate is None else rate)
    distance = 1e-3 * max(path.norm() for path in paths)
    if not distance > 0:
        raise ValueError("move: the displacement must not be zero")
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
        began, ends = (place(min(duration, steps * O.dt)) for steps in (done, beyond))
        speed = (ends - began) / ((beyond - done) * O.dt)
        for state, path in zip(states, paths):
            state.vel = speed * (1e-3 / distance * path)

    timed(scene, at, duration, before)
    scene.running.at.supportsMoved = True
    for state in states:
        state.vel = Vector3.Zero
    return DONE


def _path(scene, target, along):
    """The displacement of a target in :func:`move` [mm]. Raises ValueError."""
    values = [atPlace(v, target.recorded, millimetres, "move") if callable(v) else v for v in along]  # fmt: skip
    path = scene.share * inPlane(scene.description, values, "move")
    loose = [a for a, w in zip("xyz", path) if w and a not in target.freedom]
    if loose:
        raise ValueError(f"move: {target.name} is not held along {', '.join(loose)}")
    return path
