# SPDX-License-Identifier: GPL-2.0-or-later
"""What loads a structure from its first stage on: words that describe a scene."""

import math

from ..assembly.blocks import vector
from ..basics import Refused, say
from ..bricks import Bricks
from .targets import Target
from .words import describes


def checkPress(platen, stress, name):
    """Refuse what is no platen that moves, or no stress. Raises ValueError."""
    if not isinstance(platen, Target) or not platen.box or platen.fixed:
        raise ValueError(f"{name}: only a platen that moves can be pressed")
    if not (isinstance(stress, (int, float)) and 0 <= stress < math.inf):
        raise ValueError(f"{name}: stress {stress!r} must be at least 0 Pa")
    if 0 < stress < 1e3:
        say(f"warning: {name}: {stress:g} Pa: is it in Pa, not MPa?")


def checkedForce(description, target, force, name):
    """A force on a target as a vector [N]. Raises ValueError."""
    if not isinstance(target, Target) or not target.loaded:
        raise ValueError(
            f"{name}: only a platen that moves or a handle() can be loaded"
        )
    force = vector(force, f"{name}: force [N]")
    if not all(map(math.isfinite, force)):
        raise ValueError(f"{name}: force {tuple(force)} N must be finite")
    if description.plane and force[1]:
        raise ValueError(
            f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
        )
    return force


def windFaces(description, pressure, towards, part, name):
    """The faces that a wind loads: tuples of brick, normal, area [m²] and middle. Raises ValueError."""
    if not isinstance(pressure, (int, float)) or not 0 < abs(pressure) < math.inf:
        raise ValueError(f"{name}: pressure {pressure!r} Pa must be other than 0")
    if abs(pressure) > 1e5:
        say(f"warning: {name}: {pressure:g} Pa: is it in Pa? A storm has about 1000 Pa")
    if towards[2] or not towards.norm():
        raise ValueError(f"{name}: the direction must be horizontal, got {towards}")
    if description.plane and towards[1]:
        raise ValueError(
            f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
        )
    description.checkPart(part, name)
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
def press(description, platen, stress, riding=True):
    """Press a platen on the bricks below it. The load grows in :meth:`settle`, and stays.

    :param stress: mean vertical stress that the bricks feel [Pa]; the weight of the platen is part of it
    :param riding: whether the load moves with the platen; else it keeps its line in space, as over rollers
    """
    checkPress(platen, stress, "press")
    platen.pressed, platen.riding = float(stress), bool(riding)


@describes
def load(description, target, force):
    """A dead load on a target. It grows in :meth:`settle`, and stays; loads on one target add up.

    :param force: three numbers [N]
    """
    force = checkedForce(description, target, force, "load")
    before = target.force or (0.0, 0.0, 0.0)
    target.force = tuple(a + b for a, b in zip(force, before))


@describes
def wind(description, pressure, towards, part=None):
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
