# SPDX-License-Identifier: GPL-2.0-or-later
"""Patterns of pushes: forces on several blocks in a fixed proportion, as floors in a triangle, a mode or masses take them.

The drive of such a push moves the mean of all points, by the shares of their forces, at a constant velocity. That is the displacement
on which the whole force does work, so the push follows the structure beyond its peak. Displacements of the push are those of one
target, its control.
"""

from __future__ import annotations

import zlib
from dataclasses import replace
from typing import Annotated, Any, Callable, Union

from yade import O

from ...common.arguments import isNumber, plain, shown
from ...assembly.drives import Pattern, patternOfDrive
from ...assembly.period import firstMode
from ...basics import Refused
from ..targets import Target, kindOfLoaded
from .rest import rampTime

#: The longest first period of which the shape is looked for, over rampTime() [-].
LONGEST = 20
FREE = 1e-12  # of the sum of all forces: what a block takes at least that is part of a pattern [-]


def masses(model, direction, args):
    """Forces as of a uniform acceleration."""
    return lambda body: 1.0


def triangle(model, direction, args):
    """Forces that grow with the height above the lowest brick."""
    base = model.description.low[2]
    return lambda body: max(0.0, body.state.refPos[2] - base)


def mode(model, direction, args):
    """Forces as of the first mode along the push, in the present state."""
    shape = firstMode(model, direction, LONGEST * rampTime(args))
    if shape is None:
        raise Refused('push: "mode": no first mode along the push is found; name the targets and their shares')  # fmt: skip
    return lambda body: shape[body.id]


#: Patterns over all blocks, by their names. Each is a function of the model, the direction, and the options of the run that gives the
#: force on a block over its mass, as a function of the block's body.
OVER_ALL: dict[str, Callable] = dict(masses=masses, triangle=triangle, mode=mode)


def pushed(value: Any, first: Any = None) -> Any:
    """The kind of what is pushed: a target, a dict from targets to shares, the name of a pattern, or a function of the place."""
    if isinstance(value, dict) and value:
        for target, share in value.items():
            kindOfLoaded(target, first)
            if not isNumber(share) or not 0 < plain(share) < 1e9:
                raise ValueError(f"{shown(share)}, the share of {target.name}, must be a number above 0")  # fmt: skip
        return value
    if callable(value) or value in tuple(OVER_ALL):
        return value
    if isinstance(value, Target):
        return kindOfLoaded(value, first)
    names = ", ".join(map(repr, OVER_ALL))
    raise ValueError(
        f"{shown(value)} must be a platen that moves or a handle() of this scene, a dict from these to their shares of the force, one of {names}, "
        "or a function of x, y and z"
    )


#: What a push moves.
Pushed = Annotated[Union[Target, dict[Target, float], str, Callable[[float, float, float], float]], pushed]  # fmt: skip


def patternOf(scene: Any, value: Any, direction: Any, args: Any) -> Any:
    """What a push moves: a target as it is, anything else as a :class:`masonry.assembly.drives.Pattern`. Raises Refused.

    :param value: as :func:`pushed` returns it
    :param args: the options of the run
    """
    if isinstance(value, Target):
        return value
    if isinstance(value, dict):
        whole = sum(map(plain, value.values()))
        name = " and ".join(f"{plain(share) / whole:.4g} {target.name}" for target, share in value.items())  # fmt: skip
        parts = ((t.body, t.point, plain(share) / whole) for t, share in value.items())
        return Pattern(name, tuple(parts))
    name = value if isinstance(value, str) else "a pattern"
    running, loading = scene.running, scene.model.loading
    # its drive has the pattern, which was found when the push began
    if running.redoes and running.takesUp:
        return _named(patternOfDrive(loading, name))
    if scene.model.zones:
        raise Refused("push: forces on all blocks act on rigid ones: name platens and handles with their shares, or choose --blocks rigid")  # fmt: skip
    of = OVER_ALL[value](scene.model, direction, args) if isinstance(value, str) else _ofPlace(value)  # fmt: skip
    held = lambda body: any(v and a in body.state.blockedDOFs for a, v in zip("xyz", direction))  # fmt: skip
    forces = [
        (body.id, tuple(body.state.refPos), body.state.mass * of(body))
        for body in O.bodies
        if not held(body)
    ]
    whole = sum(force for *_, force in forces)
    if not whole > 0:
        raise Refused(f"push: the forces of {name} have the sum {whole:g}, and it must be above 0")  # fmt: skip
    parts = ((b, p, force / whole) for b, p, force in forces if abs(force) > FREE * whole)  # fmt: skip
    return _named(Pattern(name, tuple(parts), damped=True))


def _named(pattern):
    """A pattern whose name tells it from others: what a mode or a function gives is known by its numbers alone."""
    if pattern.name in ("masses", "triangle"):
        return pattern
    numbers = [(body, f"{share:.6g}") for body, _, share in pattern.parts]
    return replace(pattern, name=f"{pattern.name} {zlib.crc32(repr(numbers).encode()):08x}")  # fmt: skip


def _ofPlace(shape):
    """A function of a body by one of the place of its centre [m]. It raises Refused."""

    def of(body):
        try:
            found = shape(*body.state.refPos)
        except Exception as error:  # of the user's own
            found = f"{type(error).__name__}: {error}"
        if not isNumber(found) or not abs(plain(found)) < 1e9:
            raise Refused(f"push: the pattern at {tuple(body.state.refPos)} m is {shown(found)}, and must be a number")  # fmt: skip
        return plain(found)

    return of


def controlOf(scene: Any, value: Any, control: Target | None) -> Target:
    """The target whose displacement a push counts: the one that is given, else what is pushed, of a dict the highest target, else what
    is watched or moves. Raises Refused."""
    if control or isinstance(value, Target):
        return control or value
    found = max(value, key=lambda t: t.recorded[2]) if isinstance(value, dict) else scene.description.followed()  # fmt: skip
    if found is None:
        raise Refused("push: control is missing: watch() a brick whose displacement counts, and give it")  # fmt: skip
    return found
