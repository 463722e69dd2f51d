# SPDX-License-Identifier: GPL-2.0-or-later
"""What loads a structure from its first stage on: commands that describe a scene."""

import math
from typing import Annotated, Any, Callable, Union

from ..arguments import Direction, Level, Numbers, number, orFunction, validated
from ..arguments import vector as numbers
from ..model.bodies import vector
from ..errors import checkPlane
from ..terminal import say
from .pressures import LEAST, FaceForce, facesAgainst, pressures
from .targets import Loaded, MovingPlaten, Part
from .ties import MAX_STIFFNESS
from .script import describes

#: Larger ones would crush or throw over any masonry.
Stress = Annotated[float, number("Pa", 0, 1e12)]
Force = Annotated[Numbers, numbers("N", 1e15)]
Pressure = Annotated[float, number("Pa", -1e9, 1e9)]
Field = Annotated[
    Union[float, Callable[[float, float, float], float]], orFunction(number("Pa", -1e9, 1e9))
]

Friction = Annotated[float, number("degrees", -60, 60)]


def doubtPress(stress: float, name: str) -> None:
    if 0 < stress < 1e3:
        say(f"warning: {name}: {stress:g} Pa: is it in Pa, not MPa?")


def checkedForce(description: Any, force: Numbers, name: str) -> Any:
    """A force as a vector [N]. Raises ValueError."""
    force = vector(force, f"{name}: force [N]")
    checkPlane(description, force, name)
    return force


def doubtWind(pressure: float, name: str) -> None:
    """Refuse no wind, and say that one looks as if it were not in Pa. Raises ValueError."""
    if not pressure:
        raise ValueError(f"{name}: pressure {pressure!r} Pa must be other than 0")
    if abs(pressure) > 1e5:
        say(f"warning: {name}: {pressure:g} Pa: is it in Pa? A storm has about 1000 Pa")


def windForces(
    description: Any, pressure: float, towards: Any, part: str | None, name: str
) -> list[FaceForce]:
    """The forces of a wind, one on each face. Raises ValueError."""
    on = lambda face: [-pressure * face.area * n for n in face.normal]
    faces = facesAgainst(description, towards, part, name)
    return [FaceForce(face.block, on(face), face.middle) for face in faces]


@describes
@validated
def press(
    description: Any,
    platen: MovingPlaten,
    stress: Stress,
    riding: bool = True,
    friction: Annotated[float, number("", 0, 1, below=True)] = 0.0,
    stiffness: Annotated[float, number("N/m", 0, MAX_STIFFNESS)] = 0.0,
    guides: Annotated[float, number("N/m", 0, MAX_STIFFNESS, above=True)] | None = None,
) -> None:
    """Press a platen, once, on the bricks below it. The load grows in :meth:`settle`, and stays.

    :param stress: mean vertical stress on the bricks, with the weight of the platen [Pa]
    :param riding: whether the load moves with the platen; else it keeps its line in space, as over
        rollers
    :param friction: of jack and guides of a testing machine, over its load (that on the bricks
        without the weight of the platen) [-]. When the platen rises, up to this share is added to
        the load, when it sinks, taken off
    :param stiffness: with which the load of a testing machine follows the uplift of the platen
        where it acts [N/m]; the load is never below 0. Both begin at rest under the whole load, in
        :meth:`settle` or a later :meth:`press`; 0 is a dead load. Limit analysis has the load
        without them
    :param guides: stiffness of jack and guides until the friction slips [N/m]; None: it slips after
        0.02 mm (:data:`masonry.model.loading.GUIDE_TRAVEL`), nearly at once
    """
    if not stress > 0 and friction + stiffness > 0:
        raise ValueError(f"press: stress {stress:g} Pa of a testing machine must be above 0")
    doubtPress(stress, "press")
    if platen.pressed is not None:
        raise ValueError(
            f"press: {platen.name} is pressed already, with {platen.pressed:g} Pa: say the whole"
            " stress once, or press it again after the first stage"
        )
    platen.pressed, platen.riding = float(stress), riding
    platen.friction, platen.stiffness, platen.guides = friction, stiffness, guides


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
def pressure(
    description: Any,
    value: Field,
    towards: Direction,
    part: Part | None = None,
    normal: bool = True,
    friction: Friction = 0.0,
) -> tuple[float, float, float]:
    """A pressure that may vary with the place: of water, earth, grain, snow, or fill on an arch. It
    grows in :meth:`settle`, and stays.

    Loaded are the faces of rigid bricks that look against a direction, also behind others, where no
    joint covers them; there is no pressure in the joints. On each face the forces have the
    resultant and the moments of the pressure, exactly if it varies linearly. With water up to z = 3
    m and 0.4 m of fill above the crown of an arch at z = 2 m::

        scene.pressure(lambda x, y, z: 9810 * max(0, 3 - z), towards=(1, 0, 0))
        fill = lambda x, y, z: 18e3 * (2.4 - z)
        scene.pressure(fill, towards=(0, 0, -1), part="arch", normal=False)

    :param value: [Pa], or a function of the place (x, y, z) [m] that gives it
    :param towards: direction to which it presses
    :param part: name of a part of the bricks; None: all
    :param normal: whether it acts along the normals of the faces, as water does; else along
        ``towards``, on the projected area, as snow and fill do
    :param friction: angle between the force and the normal, by which what presses drags a face
        down, as soil does (:mod:`masonry.earth`) [degrees]
    :returns: the sum of the forces [N]
    """
    forces = pressures(description, value, towards, part, normal, friction)
    sizes = [math.hypot(*one.force) for one in forces]
    largest = max(sizes)
    if not largest > 0:
        raise ValueError("pressure: it is 0 on all faces that look against it; places are in m")
    loaded = (f for f, size in zip(forces, sizes) if size > LEAST * largest)
    description.winds.extend(loaded)
    return _sumOf(forces)


def _sumOf(forces):
    x, y, z = map(math.fsum, zip(*(one.force for one in forces)))
    return x, y, z


@describes
@validated
def wind(
    description: Any, pressure: Pressure, towards: Level, part: Part | None = None
) -> tuple[float, float, float]:
    """A pressure on the faces that look against a horizontal direction. It grows in :meth:`settle`,
    and stays.

    Loaded are the faces of rigid bricks within 45 degrees of the direction, also behind others,
    each along its normal, where no joint covers it.

    :param pressure: [Pa]; negative: suction
    :param towards: direction in which the wind blows, horizontal
    :param part: name of a part of the bricks; None: all
    :returns: the sum of the forces [N]
    """
    towards = vector(towards, "wind: direction")
    doubtWind(pressure, "wind")
    forces = windForces(description, pressure, towards, part, "wind")
    description.winds.extend(forces)
    return _sumOf(forces)
