# SPDX-License-Identifier: GPL-2.0-or-later
"""What loads a structure from its first stage on: words that describe a scene."""

from __future__ import annotations

from typing import Any

from ..arguments import Numbers, direction, flag, number, orNone, takes
from ..arguments import vector as numbers
from ..assembly.blocks import vector
from ..basics import Refused, say
from ..bricks import Bricks
from .targets import LOADED, MOVING_PLATEN, Target
from .targets import part as partName
from .words import describes


#: Kinds of arguments: a mean stress, a force and the pressure of a wind, as of :mod:`masonry.arguments`. More than these would
#: crush or throw over any masonry.
STRESS = number("Pa", 0, 1e12)
FORCE = numbers("N", 1e15)
PRESSURE = number("Pa", -1e9, 1e9)


def doubtPress(stress: float, name: str) -> None:
    """Say that a stress looks as if it were in MPa."""
    if 0 < stress < 1e3:
        say(f"warning: {name}: {stress:g} Pa: is it in Pa, not MPa?")


def checkedForce(description: Any, force: Numbers, name: str) -> Any:
    """A force as a vector [N]. Raises ValueError."""
    force = vector(force, f"{name}: force [N]")
    if description.plane and force[1]:
        raise ValueError(
            f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
        )
    return force


def windFaces(
    description: Any, pressure: float, towards: Any, part: str | None, name: str
) -> list[Any]:
    """The faces that a wind loads: tuples of brick, normal, area [m²] and middle. Raises ValueError."""
    if not pressure:
        raise ValueError(f"{name}: pressure {pressure!r} Pa must be other than 0")
    if abs(pressure) > 1e5:
        say(f"warning: {name}: {pressure:g} Pa: is it in Pa? A storm has about 1000 Pa")
    if description.plane and towards[1]:
        raise ValueError(
            f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
        )
    if description.deformable:
        raise Refused(f"{name}: it loads rigid bricks; choose --blocks rigid")
    faces = [
        face
        for face in Bricks(description.bricks).freeFaces(-towards)
        if part in (None, description.bricks[face[0]].part)
    ]
    if not faces:
        raise ValueError(f"{name}: no free face looks against {tuple(towards)}")
    return faces


@describes
@takes(platen=MOVING_PLATEN, stress=STRESS, riding=flag)
def press(description: Any, platen: Target, stress: float, riding: bool = True) -> None:
    """Press a platen on the bricks below it. The load grows in :meth:`settle`, and stays.

    :param stress: mean vertical stress that the bricks feel [Pa]; the weight of the platen is part of it
    :param riding: whether the load moves with the platen; else it keeps its line in space, as over rollers
    """
    doubtPress(stress, "press")
    platen.pressed, platen.riding = float(stress), riding


@describes
@takes(target=LOADED, force=FORCE)
def load(description: Any, target: Target, force: Numbers) -> None:
    """A dead load on a target. It grows in :meth:`settle`, and stays; loads on one target add up.

    :param force: three numbers [N]
    """
    force = checkedForce(description, force, "load")
    before = target.force or (0.0, 0.0, 0.0)
    target.force = tuple(a + b for a, b in zip(force, before))


@describes
@takes(pressure=PRESSURE, towards=direction(level=True), part=orNone(partName))
def wind(
    description: Any, pressure: float, towards: Numbers, part: str | None = None
) -> float:
    """A pressure on the faces that look against a horizontal direction. It grows in :meth:`settle`, and stays.

    Loaded are the faces of rigid bricks within 45 degrees of the direction, each along its normal, on the part that no
    joint covers. Those that stand behind others are among them. Suction is a negative pressure.

    :param pressure: [Pa]
    :param towards: direction in which the wind blows, horizontal
    :param part: name of a part of the bricks; None: all
    """
    towards = vector(towards, "wind: direction")
    faces = windFaces(description, pressure, towards, part, "wind")
    for brick, normal, area, middle in faces:
        description.winds.append(
            (brick, [-pressure * area * n for n in normal], middle)
        )
    return sum(area for _, _, area, _ in faces)
