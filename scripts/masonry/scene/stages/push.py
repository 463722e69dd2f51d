# SPDX-License-Identifier: GPL-2.0-or-later
"""Slow pushes of a target, as the drive of a testing machine makes them: ``push``, ``cycle`` and ``follow``."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Annotated, Any

from yade import Vector3

from ...common.arguments import Direction, FilePath, Numbers, listOf, number, oneOf, validated, whole  # fmt: skip
from ...assembly.drives import pushTo
from ...basics import NotAccurate, Refused, say
from ...read import curves
from ...read.run_data import BASE, MOVED, TOP, RunData
from ..bounds import findBound, nameOfPush
from ..history import CYCLES, MOST, parse
from ...run.options import Rate
from ..targets import AnyTarget
from ..words import PUSHES
from .pattern import Pushed, controlOf, patternOf
from .pushing import SHORT, drivePush
from .answers import DONE, Answer
from .stage import stage

#: What the stages of this file take from the command line.
OPTIONS = "until", "history", "rate"


def peaks(scene, rows):
    """The largest force that both ends carried, on either side if the push goes there and back, with the displacement there."""
    looped, run = bool(scene.pushed.history), {"stages": [{"load": ["push"], "first_row": 0}]}  # fmt: skip
    run.update({"history": {}} if looped else {})
    data = RunData(run, lambda name: rows(name) or None)
    if not all(map(data.column, (BASE, TOP, MOVED))):
        return
    imbalance = curves.dynamicImbalance(data[TOP], data[BASE])
    for name, side in (("peak", 1), ("negative_peak", -1))[: 1 + looped]:
        at = data.peak(side)
        how = (
            f"the largest force that supports and loaded point carried at once; the supports alone had {data[BASE][at]:.4g} kN then, and "
            f"{100 * imbalance:.1f} % of the force did not reach them on the way there or behind it. How far rate, mesh and points change it is "
            "not known from one run"
        )
        yield Answer(name, "kN", data.peakForce(side), how)
        how = "displacement of the pushed point at the peak"
        yield Answer(f"displacement_at_{name}", "mm", data[MOVED][at], how)


@stage(bounded=True, farther=("until",), options=OPTIONS, answers=peaks)
@validated
def push(
    scene: Any,
    target: Pushed,
    until: Annotated[float, number("mm", 0, MOST, above=True)] | None = None,
    direction: Direction = (1, 0, 0),
    rate: Rate | None = None,
    continued: bool = False,
    control: AnyTarget | None = None,
) -> str:
    """Push a target at a constant velocity, as the drive of a testing machine does, or several points in a pattern.

    In a pattern the forces keep their proportion, whatever the structure does, and the mean displacement of the points, by their shares of
    the force, grows at the rate. The shares are forces: a triangle over floors of other masses is mass times height. Loads of
    :meth:`load` and :meth:`press` are no masses; a :class:`masonry.bricks.Floor` has one.

    :param target: a platen that moves, or a :meth:`handle`; or a dict from some of these to their shares of the force, ``{roof: 2, floor: 1}``;
        or, for a force on every rigid block that is free, ``"masses"``, as of a uniform acceleration, ``"triangle"``, mass times height
        above the lowest brick, ``"mode"``, mass times the first mode along the push in the present state; or a function of x, y
        and z [m] that multiplies the masses
    :param until: displacement from where the push begins [mm]; the drive then stops and holds. ``--until`` and
        ``--history`` replace it; None: one of these must be given
    :param direction: of the push
    :param rate: [mm/s]; None: ``--rate``
    :param continued: whether displacements count on from where the push before began, of this target in this direction,
        and not from where the target is now
    :param control: the target whose displacement ``until`` and the curve count; None: what is pushed, of a dict the highest, else the first
        that is watched or moves
    """
    if until is not None:
        until *= scene.share
    how = direction, rate, continued, control
    return _drive(scene, "push", target, *how, until=until)


@stage(bounded=True, farther=("amplitudes", "repeats"), options=OPTIONS, answers=peaks)
@validated
def cycle(
    scene: Any,
    target: Pushed,
    amplitudes: Annotated[Numbers, listOf(number("mm or %", 1e-6, MOST))],
    repeats: Annotated[int, whole(1, CYCLES)] = 1,
    direction: Direction = (1, 0, 0),
    rate: Rate | None = None,
    continued: bool = False,
    control: AnyTarget | None = None,
    unit: Annotated[str, oneOf("mm", "%")] = "mm",
) -> str:
    """Push a target to and fro: each amplitude A is a cycle from 0 to +A, to -A and back to 0.

    :param amplitudes: a list of displacements [mm], or of drifts [%]
    :param repeats: how often each of them
    :param unit: of the amplitudes; a drift is the displacement that the curve counts over the height of its point above the lowest brick,
        and on a platen that cannot turn over the height of the bricks below it
    :param continued: and other parameters: as in :meth:`push`
    """
    height = _driftHeight(scene, controlOf(scene, target, control))
    share = scene.share * (10 * height if unit == "%" else 1)
    text = ",".join(f"{share * a:g}x{repeats}" for a in amplitudes)
    how = direction, rate, continued, control
    return _drive(scene, "cycle", target, *how, history=text)


@stage(bounded=True, farther=("path",), options=OPTIONS, answers=peaks)
@validated
def follow(
    scene: Any,
    target: Pushed,
    path: FilePath,
    direction: Direction = (1, 0, 0),
    rate: Rate | None = None,
    continued: bool = False,
    control: AnyTarget | None = None,
) -> str:
    """Push a target through the displacements of a CSV file, which has a column ``displacement_mm``.

    :param continued: and other parameters: as in :meth:`push`
    """
    how = direction, rate, continued, control
    return _drive(scene, "follow", target, *how, history=str(path))


def _drive(scene, name, target, direction, rate, continued, control, **aim):
    args = _argumentsOf(scene, name, **aim)
    if rate is not None and args.accuracy:
        raise NotAccurate(
            f"--accuracy: it chooses the rate, and {name}() has one of its own: rate={rate:g} mm/s"
        )
    args.rate = args.rate if rate is None else rate
    direction, running = Vector3(*direction).normalized(), scene.running
    control = controlOf(scene, target, control)
    pushed, loading = patternOf(scene, target, direction, args), scene.model.loading
    pushTo(loading, pushed, control, direction, name)
    scene.pushed = args
    counted = "" if pushed is control else control.name
    began = f"{pushed.name} {[round(v, 9) for v in direction]}" + f" {counted}" * bool(counted)  # fmt: skip
    if continued and began not in running.at.origins:
        raise ValueError(
            f"{name}: continued: {pushed.name} has not been pushed along {tuple(direction)} before, with this control"
        )
    findBound(scene, "push", pushed, direction, bool(args.history))
    names = [nameOfPush(pushed, sign * direction) for sign in (1, -1)]
    running.note("push", *names, counted)
    if not scene.only:
        drivePush(scene, name, args, began, continued)
        loading.stopDrives()
    return DONE


def _driftHeight(scene, target):
    """Height over which the displacements of a target are drifts [m]."""
    turns = not target.box or "Y" not in target.freedom
    return (target.recorded[2] if turns else target.box[0][2]) - scene.description.low[2]  # fmt: skip


def _argumentsOf(scene, name, until=None, history=None):
    """The options of the run, with what this push goes to. ``--until`` or ``--history`` are for the first push alone."""
    args = SimpleNamespace(**vars(scene.args))
    if (args.until or args.history) and scene.script.isFirst(PUSHES):
        args.until = args.until and args.until * scene.share
        return args
    args.until, args.history = until, None
    if history is not None:
        try:
            args.history = parse(history)
        except ValueError as error:
            raise Refused(f"{name}: {error}") from None
    elif until is None:
        raise Refused(
            f"{name}: until None must be above 0 and at most {MOST:g} mm; the direction says where to"
        )
    elif until < SHORT * scene.share:
        say(f"warning: {name}: until {until:g} mm: is it in mm, not m?")
    return args
