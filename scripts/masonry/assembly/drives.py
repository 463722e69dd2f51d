# SPDX-License-Identifier: GPL-2.0-or-later
"""Drives of pushes: of a target alone, or of several blocks with forces in a fixed proportion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from yade import O, Vector3

PATTERN = "_drive"  # label of the drive of a push in a pattern: that of no target


@dataclass(frozen=True)
class Pattern:
    """Blocks that a push moves with forces in a fixed proportion; what a push moves in place of a target.

    :param name: in bounds and messages
    :param parts: of each block its body, the point on which its force acts in the structure as built [m], and its share of the whole
        force [-]
    :param damped: whether the blocks keep their numerical damping. Where all blocks are driven nothing else would be damped
    """

    name: str
    parts: tuple[tuple[int, Any, float], ...]
    damped: bool = False


def pushTo(loading, pushed, control, direction, name="push"):
    """From now on ``push`` moves a target, or all of a pattern, in a direction. The other drives hold what they hold.

    :param pushed: a target, or :class:`Pattern`
    :param control: the target whose displacement is recorded
    """
    if loading.description.plane and direction[1]:
        raise ValueError(
            f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
        )
    for body, *_ in pushed.parts:
        blocked = O.bodies[body].state.blockedDOFs
        if not any(v and a not in blocked for a, v in zip("xyz", direction)):
            raise ValueError(
                f"{name}: {pushed.name} is held along {tuple(direction)}, and cannot be pushed there"
            )
    drive = _drivePattern if isinstance(pushed, Pattern) else _driveOf
    load = drive(loading, pushed, direction, name)
    loading.stopDrives()
    load.direction, load.driven = direction, True
    loading.target, loading.direction, loading.push = control, direction, load
    loading.followed, loading.origin, loading.pushing = control, (0, 0, 0), True


def _driveOf(loading, target, direction, name):
    """The drive that pushes a target. Raises ValueError."""
    load = loading.loads.get(f"{target.name}_drive")
    pattern = loading.loads.get(PATTERN)
    if pattern and pattern.driven and target.body in bodiesOf(pattern):
        _refuseHeld(name, target, pattern)
    if target.drives:
        along = [a for a, v in zip("xyz", direction) if abs(v) > 1 - 1e-12]
        load = loading.driveOf(target, along[0]) if along else None
        if load is None:
            raise ValueError(
                f"{name}: {target.name} has drives along {', '.join(target.drives)} alone, not along {tuple(direction)}"
            )
    elif load.driven and load.direction.cross(direction).norm() > 1e-12:
        raise ValueError(
            f"{name}: the drive of {target.name} holds it along {tuple(load.direction)}, and would let go of it to push "
            f"along {tuple(direction)}; drive='xz' and the like give it a drive for every axis"
        )
    load.damped = False
    return load


def _drivePattern(loading, pattern, direction, name):
    """The drive that pushes in a pattern. Raises ValueError."""
    bodies, points, shares = zip(*pattern.parts)
    for other in loading.loads.values():
        if other.driven and set(bodies) & set(bodiesOf(other)):
            same = bodiesOf(other) == bodies and np.allclose(other.shares or (1,), shares)  # fmt: skip
            if not same or other.direction.cross(direction).norm() > 1e-12:
                _refuseHeld(name, pattern, other)
    load = loading.patternDrive()
    load.updateAttrs(
        dict(
            body=bodies[0],
            point=points[0],
            others=bodies[1:],
            otherPoints=points[1:],
            shares=shares if bodies[1:] else (),
            damped=pattern.damped,
        )
    )
    return load


def _refuseHeld(name, pushed, drive):
    """Refuse to push what another drive holds. Raises ValueError."""
    raise ValueError(
        f"{name}: a drive holds {pushed.name} or some of it along {tuple(drive.direction)} already; release() lets it go"
    )


def patternOfDrive(loading, name):
    """The pattern that the drive of a push has, by its name."""
    load = loading.patternDrive()
    points, shares = (load.point, *load.otherPoints), load.shares or (1.0,)
    return Pattern(name, tuple(zip(bodiesOf(load), points, shares)), load.damped)


def bodiesOf(load):
    """The bodies that a MasonryLoad loads."""
    return load.body, *load.others


def isAlong(load, axis, body):
    """Whether a MasonryLoad is a drive that holds or moves a body along an axis, also across its direction."""
    along = axis in "xyz" and abs(load.direction["xyz".index(axis)]) > 1e-12
    return load.driven and along and body in bodiesOf(load)


def reactionOf(load):
    """Force of the drive of a MasonryLoad [N]."""
    return load.reaction * load.direction.normalized()


def forceOn(load, body):
    """Force of a MasonryLoad and its drive on a body [N]."""
    if body not in bodiesOf(load):
        return Vector3.Zero
    share = load.shares[bodiesOf(load).index(body)] if load.others else 1.0
    force = load.force if body == load.body else Vector3.Zero
    return force + share * load.reaction * load.direction.normalized()
