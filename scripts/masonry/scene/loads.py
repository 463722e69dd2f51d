# SPDX-License-Identifier: GPL-2.0-or-later
"""What loads a structure from its first stage on: words that describe a scene."""

from __future__ import annotations

from typing import Annotated, Any

from ..common.arguments import Level, Numbers, number, validated
from ..common.arguments import vector as numbers
from ..assembly.blocks import vector
from ..basics import Refused, say
from ..bricks import Bricks
from .targets import Loaded, MovingPlaten, Part
from .words import describes


#: A mean stress, a force and the pressure of a wind. More than these would crush or throw over any masonry.
Stress = Annotated[float, number("Pa", 0, 1e12)]
Force = Annotated[Numbers, numbers("N", 1e15)]
Pressure = Annotated[float, number("Pa", -1e9, 1e9)]


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
@validated
def press(
    description: Any, platen: MovingPlaten, stress: Stress, riding: bool = True
) -> None:
    """Press a platen on the bricks below it. The load grows in :meth:`settle`, and stays. A platen has one press, as its stress is
    the whole that the bricks feel; dead loads and winds add up.

    :param stress: mean vertical stress that the bricks feel [Pa]; the weight of the platen is part of it
    :param riding: whether the load moves with the platen; else it keeps its line in space, as over rollers
    """
    doubtPress(stress, "press")
    if platen.pressed is not None:
        raise ValueError(
            f"press: {platen.name} is pressed already, with {platen.pressed:g} Pa: say the whole stress once, or press it again after "
            "the first stage"
        )
    platen.pressed, platen.riding = float(stress), riding


@describes
@validated
def load(description: Any, target: Loaded, force: Force) -> None:
    """A dead load on a target. It grows in :meth:`settle`, and stays; loads on one target add up.

    :param force: three numbers [N]
    """
    force = checkedForce(description, force, "load")
    before = target.force or (0.0, 0.0, 0.0)
    target.force = tuple(a + b for a, b in zip(force, before))


@describes
@validated
def wind(
    description: Any, pressure: Pressure, towards: Level, part: Part | None = None
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
