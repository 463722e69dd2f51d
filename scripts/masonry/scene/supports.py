# SPDX-License-Identifier: GPL-2.0-or-later
"""What holds a structure, and what of it is watched: words that describe a scene."""

import math

from ..assembly.blocks import vector
from .targets import Target
from .words import describes

PLATEN = 0.2  # [m] height of a platen


@describes
def platen(
    description,
    where,
    rotation=None,
    height=PLATEN,
    name=None,
    point=None,
    guided="",
    part=None,
    upTo=None,
    recorded=None,
    drive="",
):
    """A stiff block over the whole lower or upper side of the structure.

    The one at the bottom is fixed. The one at the top moves; loads act on it, and ``rotation`` says whether it can
    turn. Its joint to the bricks is the ``support`` joint of the materials.

    :param where: ``"bottom"`` or ``"top"``
    :param rotation: ``"free"`` or ``"held"``, of the platen at the top; None: held
    :param height: [m]
    :param name: in curve.csv; None: base and top
    :param point: (x, y, z) [m] on which loads act; None: the middle of the platen's outer side
    :param guided: axes along which the middle of the one at the top cannot move: ``"x"``, ``"y"`` or ``"xy"``; its top
        support then carries horizontal force
    :param part: name of a part of the bricks; the platen is over this part alone. None: over all
    :param upTo: z of its outer side [m], in place of ``height``: where a testing machine pushes
    :param recorded: z of the point whose displacement is recorded [m], on the line through ``point``; None: that of
        ``point``
    :param drive: axes along which a drive holds the one at the top from the beginning: ``"x"``, or ``"xz"``; None of
        them: it is free until it is pushed
    """
    if where not in ("bottom", "top"):
        raise ValueError(f"platen: where must be 'bottom' or 'top', got {where!r}")
    if where == "bottom" and rotation not in (None, "held"):
        raise ValueError("platen: the one at the bottom is fixed and cannot turn")
    if rotation not in (None, "held", "free"):
        raise ValueError(f"platen: rotation must be 'held' or 'free', got {rotation!r}")
    if guided not in ("", "x", "y", "xy") or guided and where == "bottom":
        raise ValueError(
            f"platen: guided must be 'x', 'y' or 'xy', of the one at the top, got {guided!r}"
        )
    if not 0 < height < math.inf:
        raise ValueError(f"platen: height {height} m must be above 0")
    bottom = where == "bottom"
    level = description.low[2] if bottom else description.high[2]
    side = "below" if bottom else "above"
    if upTo is not None and not 0 < (level - upTo if bottom else upTo - level):
        raise ValueError(
            f"platen: upTo {upTo} m must be {side} the bricks, which end at {level:g} m"
        )
    if set(drive) - set("xz" if description.plane else "xyz") or drive and bottom:
        raise ValueError(
            f"platen: drive must be some of 'x', 'y' and 'z', of the one at the top, got {drive!r}"
        )
    description.checkPart(part, "platen")
    touching = [
        p
        for block in description.bricks
        for p in block.corners
        if part in (None, block.part) and abs(p[2] - level) < 1e-6 * (1 + abs(level))
    ]
    if not touching:
        raise ValueError(
            f"platen: part {part!r} does not reach the {where}, z = {level:g} m"
        )
    low = [min(p[i] for p in touching) for i in range(2)]
    high = [max(p[i] for p in touching) for i in range(2)]
    if any(a == b for a, b in zip(low, high)):
        raise ValueError(
            f"platen: no horizontal side of a brick lies at the {where}, z = {level:g} m"
        )
    outer = level - height if bottom else level + height
    outer = outer if upTo is None else upTo
    box = ((*low, min(level, outer)), (*high, max(level, outer)))
    middle = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, outer)
    freedom = (
        "xyzXYZ"
        if bottom
        else ("yXYZ" if description.plane else "XYZ")
        if rotation != "free"
        else ("yXZ" if description.plane else "")
    )
    freedom += "".join(axis for axis in guided if axis not in freedom)
    point = tuple(vector(point or middle, "platen: point [m]"))
    if recorded is not None and not isinstance(recorded, (int, float)):
        raise ValueError(f"platen: recorded must be a z in m, got {recorded!r}")
    if recorded is not None and not min(level, outer) <= recorded * (1 + 1e-12):
        raise ValueError(
            f"platen: recorded {recorded:g} m is not on the platen, which begins at {min(level, outer):g} m"
        )
    return description.add(
        Target(
            name or ("base" if bottom else "top"),
            fixed=bottom,
            point=point,
            recorded=point if recorded is None else (*point[:2], recorded),
            box=box,
            freedom=freedom,
            loaded=not bottom,
            drives=drive,
        )
    )


@describes
def hold(description, where, name=None, axes="xyzXYZ"):
    """Hold a brick, so that it neither moves nor turns but by :meth:`move`.

    :param where: a point [m] in it or near it, its index in the bricks, or the block itself
    :param name: in curve.csv; None: ``brick`` and its index
    :param axes: along which it is held, xyz, and about which it cannot turn, XYZ; a prop against a wall that leans is
        ``"y"``
    """
    if not axes or set(axes) - set("xyzXYZ"):
        raise ValueError(f"hold: axes must be some of 'xyzXYZ', got {axes!r}")
    if description.plane and not set(axes) - set("yXZ"):
        raise ValueError(
            f"hold: in the x-z plane no block moves along {axes} anyway; Scene(..., plane=False) is in space"
        )
    target = _brick(description, where, name, fixed=True)
    target.freedom = (
        "".join(axes) if not description.plane else "".join({*axes, *"yXZ"})
    )
    return target


@describes
def watch(description, where, name=None):
    """Record the motion of a brick. Parameters as of :meth:`hold`; a point is the one that is recorded."""
    return _brick(description, where, name, fixed=False, loaded=False)


@describes
def handle(description, where, name=None):
    """A brick that loads act on, at its centre or at the point that is given. Parameters as of :meth:`hold`."""
    return _brick(description, where, name, fixed=False)


def _brick(description, where, name, fixed, loaded=None):
    index, point = description.find(where)
    return description.add(
        Target(
            name or f"brick{index}",
            fixed=fixed,
            point=point or description.middle(index),
            recorded=point or description.middle(index),
            brick=index,
            freedom="xyzXYZ" if fixed else None,
            loaded=not fixed if loaded is None else loaded,
        )
    )
