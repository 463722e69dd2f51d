# SPDX-License-Identifier: GPL-2.0-or-later
"""Slow pushes of a target, as the drive of a testing machine makes them: ``push``, ``cycle`` and
``follow``.

In a pattern several blocks are pushed by forces in a fixed proportion. The drive moves the mean of
their points, weighted by the shares of the forces, at a constant velocity: the whole force does
work on this displacement, so the push follows the structure beyond its peak. Displacements of the
push are those of its control, which changes no force.
"""

import math
import zlib
from dataclasses import replace
from types import SimpleNamespace
from typing import Annotated, Any, Callable, Union

from yade import O, Vector3

from ..arguments import (
    Direction,
    FilePath,
    Numbers,
    asFloat,
    isNumber,
    listOf,
    number,
    oneOf,
    shown,
    whole,
)
from ..model.loading import Pattern, patternOfDrive, pushTo
from ..model.period import firstMode
from ..errors import NotAccurate, Refused
from ..terminal import say
from ..numbers import curves
from ..numbers.run_data import BASE, MOVED, TOP, RunData
from ..model.load_names import nameOfPush
from .bounds import findBound
from ..scene.history import CYCLES, MAX_DISPLACEMENT, MIN_AMPLITUDE, parse
from ..run.option_table import Rate
from ..scene.targets import AnyTarget, Target, kindOfLoaded
from ..scene.script import PUSHES
from .pushing import SHORT, drivePush
from .answers import DONE, Answer
from .rest import rampTime
from .stage import stage

OPTIONS = "until", "history", "rate"  # of the command line, for the stages of this file
PATTERNS = "masses", "triangle", "mode"  # over all blocks
LONGEST = 20  # the longest first period of which the shape is looked for, over rampTime() [-]
FREE = 1e-12  # least share of a block in a pattern [-]


def pushed(value: Any, context: Any = None) -> Any:
    """Validator of what is pushed: a target, a dict from targets to shares, the name of a pattern,
    or a function of the place."""
    if isinstance(value, dict) and value:
        for target, share in value.items():
            kindOfLoaded(target, context)
            if not isNumber(share) or not 0 < asFloat(share) < 1e9:
                raise ValueError(
                    f"{shown(share)}, the share of {target.name}, must be a number above 0"
                )
        return value
    if isinstance(value, Target):
        return kindOfLoaded(value, context)
    if callable(value) or value in PATTERNS:
        return value
    names = ", ".join(map(repr, PATTERNS))
    raise ValueError(
        f"{shown(value)} must be a platen that moves or a handle() of this scene, a dict from these"
        f" to their shares of the force, one of {names}, or a function of x, y and z"
    )


#: What a push moves.
Pushed = Annotated[
    Union[Target, dict[Target, float], str, Callable[[float, float, float], float]], pushed
]


def patternOf(scene: Any, value: Any, direction: Any, args: Any) -> Any:
    """What a push moves: a target or a :class:`masonry.model.loading.Pattern` as it is, anything
    else as a pattern. Raises Refused."""
    if isinstance(value, (Target, Pattern)):
        return value
    if isinstance(value, dict):
        whole = sum(map(asFloat, value.values()))
        shares = {target: asFloat(share) / whole for target, share in value.items()}
        name = " and ".join(f"{share:.4g} {target.name}" for target, share in shares.items())
        return Pattern(name, tuple((t.body, t.point, s) for t, s in shares.items()))
    name = value if isinstance(value, str) else "a pattern"
    if scene.running.resumedHere and scene.running.isResumed:
        # its drive has the pattern, which was found when the push began
        return _named(patternOfDrive(scene.model.loading, name))
    if scene.model.zones:
        raise Refused(
            "push: forces on all blocks act on rigid ones: name platens and handles with their"
            " shares, or choose --blocks rigid"
        )
    of = _shapeOf(scene.model, value, direction, args)
    isHeld = lambda body: any(v and a in body.state.blockedDOFs for a, v in zip("xyz", direction))
    forces = {b: b.state.mass * of(b) for b in O.bodies if not isHeld(b)}
    whole = sum(forces.values())
    if not whole > 0:
        raise Refused(f"push: the forces of {name} have the sum {whole:g}, and it must be above 0")
    parts = [
        (body.id, tuple(body.state.refPos), force / whole)
        for body, force in forces.items()
        if abs(force) > FREE * whole
    ]
    return _named(Pattern(name, tuple(parts), damped=True))


def _named(pattern):
    """A pattern whose name has a number of its own, if it is a mode or a function."""
    if pattern.name in ("masses", "triangle"):
        return pattern
    numbers = [(body, f"{share:.6g}") for body, _, share in pattern.parts]
    number = zlib.crc32(repr(numbers).encode())
    return replace(pattern, name=f"{pattern.name} {number:08x}")


def _shapeOf(model, value, direction, args):
    """The force on a block over its mass, as a function of its body, which raises Refused.
    Parameters as in :func:`push`."""
    if value == "mode":
        mode = firstMode(model, direction, LONGEST * rampTime(args))
        if mode is None:
            raise Refused(
                'push: "mode": no first mode along the push is found; name the targets and their'
                " shares"
            )
        return lambda body: mode[body.id]
    if value == "masses":
        return lambda body: 1.0
    if value == "triangle":
        return lambda body: max(0.0, body.state.refPos[2] - model.description.low[2])

    def of(body):
        try:
            found = value(*body.state.refPos)
        except Exception as error:  # of the user's own
            found = f"{type(error).__name__}: {error}"
        if not isNumber(found) or not abs(asFloat(found)) < 1e9:
            raise Refused(
                f"push: the pattern at {tuple(body.state.refPos)} m is {shown(found)}, and must be"
                " a number"
            )
        return asFloat(found)

    return of


def controlOf(value: Any, pushed: Any, control: Target | None) -> Any:
    """What the displacement of a push is counted of: a target, or the pattern that is pushed.

    :param value: what the user pushes, and ``control``, as in :func:`push`
    :param pushed: it as :func:`patternOf` gives it
    """
    if control is None and isinstance(value, dict):
        return max(value, key=lambda t: t.recorded[2])
    return control or pushed


def peaks(scene, rows):
    """The largest force that both ends carried, on each side of a loop, with the displacement."""
    looped, run = bool(scene.pushed.history), {"stages": [{"load": ["push"], "first_row": 0}]}
    if looped:
        run["history"] = {}
    data = RunData(run, lambda name: rows(name) or None)
    if not all(map(data.column, (BASE, TOP, MOVED))):
        return
    imbalance = curves.dynamicImbalance(data[TOP], data[BASE])
    for name, side in (("peak", 1), ("negative_peak", -1))[: 1 + looped]:
        at = data.peak(side)
        how = (
            "the largest force that supports and loaded point carried at once; the supports alone"
            f" had {data[BASE][at]:.4g} kN then, and {100 * imbalance:.1f} % of the force did not"
            " reach them on the way there or behind it. How far rate, mesh and points change it is"
            " not known from one run"
        )
        yield Answer(name, "kN", data.peakForce(side), how)
        how = "displacement of the pushed point at the peak"
        yield Answer(f"displacement_at_{name}", "mm", data[MOVED][at], how)


@stage(bounded=True, extendable=("until",), options=OPTIONS, answers=peaks)
def push(
    scene: Any,
    target: Pushed,
    until: Annotated[float, number("mm", 0, MAX_DISPLACEMENT, above=True)] | None = None,
    direction: Direction = (1, 0, 0),
    rate: Rate | None = None,
    continued: bool = False,
    control: AnyTarget | None = None,
) -> str:
    """Push a target at a constant velocity, as the drive of a testing machine does, or several
    points in a pattern.

    In a pattern the forces keep their proportion, and the mean displacement of the points, weighted
    by their shares of the force, grows at the rate. Loads of :meth:`load` and :meth:`press` are no
    masses; a :class:`masonry.bricks.Floor` has one.

    :param target: a platen that moves, or a :meth:`handle`; or a dict from some of these to their
        shares of the force, ``{roof: 2, floor: 1}``; or, for a force on every rigid block that is
        free, ``"masses"``, as of a uniform acceleration, ``"triangle"``, mass times height above
        the lowest brick, ``"mode"``, mass times the first mode along the push in the present state;
        or a function of x, y and z [m] that multiplies the masses
    :param until: displacement from where the push begins [mm]; the drive then stops and holds.
        ``--until`` and ``--history`` replace it; None: one of these must be given
    :param direction: of the push
    :param rate: [mm/s]; None: ``--rate``
    :param continued: whether displacements count on from where the push before began, of this
        target in this direction, and not from where the target is now
    :param control: the target whose displacement ``until`` and the curve count; None: what is
        pushed, of a dict the highest, of another pattern the mean that the drive moves. A push
        whose drive goes ten times as far as its control ends as a collapse
    """
    how = direction, rate, continued
    aimed = _aimed(scene, target, direction, control)
    return _drive(scene, "push", aimed, *how, until=until and until * scene.share)


@stage(bounded=True, extendable=("amplitudes", "repeats"), options=OPTIONS, answers=peaks)
def cycle(
    scene: Any,
    target: Pushed,
    amplitudes: Annotated[Numbers, listOf(number("mm or %", 1e-6, MAX_DISPLACEMENT))],
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
    :param unit: of the amplitudes; a drift is the displacement that the curve counts over the
        height of its point above the lowest brick, and on a platen that cannot turn over the height
        of the bricks below it
    :param continued: and other parameters: as in :meth:`push`
    """
    aimed = _, counted = _aimed(scene, target, direction, control)
    turns = not counted.box or "Y" not in counted.freedom
    height = counted.recorded[2] if turns else counted.box[0][2]
    height -= scene.description.low[2]
    millimetres = 10 * height if unit == "%" else 1  # per unit
    ends = [v / scene.share for v in (MIN_AMPLITUDE, MAX_DISPLACEMENT)]
    for amplitude in amplitudes:
        if not ends[0] <= millimetres * amplitude <= ends[1]:
            low, high = (v / millimetres if millimetres > 0 else math.inf for v in ends)
            over = f", over a height of {height:.4g} m" * (unit == "%")
            raise Refused(
                f"cycle: amplitude {amplitude:g} {unit} must be from {low:.4g} to {high:.4g}"
                f" {unit}{over}"
            )
    share = scene.share * millimetres
    text = ",".join(f"{share * a:g}x{repeats}" for a in amplitudes)
    return _drive(scene, "cycle", aimed, direction, rate, continued, history=text)


def readableHistory(scene, target, path, *_, **__):
    """Raise Refused for a history that cannot be read, unless the command line replaces it."""
    if not (scene.args.until or scene.args.history or scene.running.isResumed):
        try:
            parse(str(path))
        except ValueError as error:
            raise Refused(f"follow: {error}") from None


@stage(bounded=True, extendable=("path",), options=OPTIONS, check=readableHistory, answers=peaks)
def follow(
    scene: Any,
    target: Pushed,
    path: FilePath,
    direction: Direction = (1, 0, 0),
    rate: Rate | None = None,
    continued: bool = False,
    control: AnyTarget | None = None,
) -> str:
    """Push a target through the displacements of a CSV file with a column ``displacement_mm``.

    :param continued: and other parameters: as in :meth:`push`
    """
    aimed = _aimed(scene, target, direction, control)
    return _drive(scene, "follow", aimed, direction, rate, continued, history=str(path))


def _aimed(scene, target, direction, control):
    """What a push moves, and what its displacement is counted of."""
    pushed = patternOf(scene, target, Vector3(*direction).normalized(), scene.args)
    return pushed, controlOf(target, pushed, control)


def _drive(scene, name, aimed, direction, rate, continued, **aim):
    args = _argumentsOf(scene, name, **aim)
    if rate is not None and args.accuracy:
        raise NotAccurate(
            f"--accuracy: it chooses the rate, and {name}() has one of its own: rate={rate:g} mm/s"
        )
    args.rate = args.rate if rate is None else rate
    direction, running = Vector3(*direction).normalized(), scene.running
    (pushed, control), loading = aimed, scene.model.loading
    held = pushTo(loading, pushed, control, direction, name)
    scene.pushed = args
    counted = "" if pushed is control else control.name
    began = f"{pushed.name} {[round(v, 9) for v in direction]}" + f" {counted}" * bool(counted)
    if continued and began not in running.state.origins:
        raise ValueError(
            f"{name}: continued: {pushed.name} has not been pushed along {tuple(direction)} before,"
            " with this control"
        )
    findBound(scene, "push", pushed, direction, bool(args.history))
    names = [nameOfPush(pushed, sign * direction) for sign in (1, -1)]
    running.note("push", *names, counted, path=[continued, bool(args.history)])
    if not scene.limitAnalysisOnly:
        drivePush(scene, name, args, began, continued, held)
        loading.stopDrives()
    return DONE


def _argumentsOf(scene, name, until=None, history=None):
    """The options of the run, with the aim of this push. ``--until`` and ``--history`` are for the
    first push alone."""
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
            f"{name}: until None must be above 0 and at most {MAX_DISPLACEMENT:g} mm; the direction"
            " says where to"
        )
    elif until < SHORT * scene.share:
        say(f"warning: {name}: until {until:g} mm: is it in mm, not m?")
    return args
