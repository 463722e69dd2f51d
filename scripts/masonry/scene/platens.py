# SPDX-License-Identifier: GPL-2.0-or-later
"""What holds a structure, and what of it is watched: words that describe a scene."""

import itertools
from typing import Annotated, Any

from ..arguments import Axes, Freedoms, Name, Numbers, axes, byName, number, oneOf, shown, validated
from ..arguments import vector as numbers
from ..model.bodies import vector
from ..errors import IN_PLANE, refuse
from .targets import BrickAt, Part, Target
from .ties import MOST, End, Spring, Tie
from .script import describes

PLATEN = 0.2  # [m] height of a platen
#: Bars along each side of a platen on a soil without tension, in a plane and in space.
BARS = 21, 11
HIGH = 1e3  # [m] length of these bars

#: A coordinate and a point, not farther from the origin than any masonry.
Coordinate = Annotated[float, number("m", -1e6, 1e6)]
Point = Annotated[Numbers, numbers("m", 1e6)]


def stiffnesses(value: Any, context: Any = None) -> Any:
    """Validator of the stiffnesses of springs: a dict from axes to numbers above 0."""
    found = byName(number("N/m or N m", 0, MOST, above=True))(value)
    unknown = [axis for axis in found if axis not in ("x", "y", "z", "X", "Y", "Z")]
    if unknown or not found:
        raise ValueError(f"{shown(value)} must be a dict from some of the axes xyzXYZ to stiffness")
    return found


@describes
@validated
def platen(
    description: Any,
    where: Annotated[str, oneOf("bottom", "top")],
    rotation: Annotated[str, oneOf("held", "free")] | None = None,
    height: Annotated[float, number("m", 1e-6, 1e6)] = PLATEN,
    name: Name | None = None,
    point: Point | None = None,
    guided: Annotated[Axes, axes("xy", none=True)] = "",
    part: Part | None = None,
    upTo: Coordinate | None = None,
    recorded: Coordinate | None = None,
    drive: Annotated[Axes, axes("xyz", none=True)] = "",
    springs: Annotated[dict[str, float], stiffnesses] | None = None,
    uplift: bool = False,
) -> Target:
    """A stiff block over the whole lower or upper side of the structure.

    The one at the bottom is fixed. The one at the top moves; loads act on it, and ``rotation`` says
    whether it can turn. Its joint to the bricks is the ``support`` joint of the materials.

    :param where: ``"bottom"`` or ``"top"``
    :param rotation: ``"free"`` or ``"held"``, of the platen at the top; None: held
    :param height: [m]
    :param name: in curve.csv; None: base and top
    :param point: (x, y, z) [m] on which loads act; None: the middle of the platen's outer side
    :param guided: axes along which the middle of the one at the top cannot move: ``"x"``, ``"y"``
        or ``"xy"``; its top support then carries horizontal force
    :param part: name of a part of the bricks; the platen is over this part alone. None: over all
    :param upTo: z of its outer side [m], in place of ``height``: where a testing machine pushes
    :param recorded: z of the point whose displacement is recorded [m], on the line through
        ``point``; None: that of ``point``
    :param drive: axes along which a drive holds the one at the top from the beginning: ``"x"``, or
        ``"xz"``; none of them: it is free until it is pushed
    :param springs: of the one at the bottom, a soil or a rig that gives way: a dict from axes, xyz
        along and XYZ about, to stiffness [N/m], [N m/rad], at the middle of its outer side, for
        example ``{"x": 37e6}``; along and about the others it is fixed, and where it is fixed along
        x or y it turns about its own middle. Its weight counts if it can move along z. None: it is
        fixed along and about all
    :param uplift: whether the soil carries no tension. Then ``z`` of ``springs`` is spread over the
        side of the platen, so that it also turns on it, and each part of the soil has compression
        alone
    """
    bottom, plane = where == "bottom", description.plane
    level = description.low[2] if bottom else description.high[2]
    springs = {**(springs or {})}
    problems = [*_problems(plane, bottom, rotation, guided, drive, springs)]
    if uplift and ("z" not in springs or {"X", "Y"} & {*springs}):
        problems.append(
            "uplift needs springs with z, from which X and Y follow, and which have neither"
        )
    if upTo is not None and not 0 < (level - upTo if bottom else upTo - level):
        side = "below" if bottom else "above"
        problems.append(f"upTo {upTo} m must be {side} the bricks, which end at {level:g} m")
    refuse([f"platen: {one}" for one in problems])
    low, high = _sideAt(description, level, where, part)
    outer = level + (-height if bottom else height) if upTo is None else upTo
    begins, ends = sorted((level, outer))
    middle = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, outer)
    held = {*guided, *("yXZ" * plane)}
    held |= {*("xyzXYZ" if bottom else "" if rotation == "free" else "XYZ")}
    held -= {*springs, *(("Y" if plane else "XY") * uplift)}
    point = middle if point is None else tuple(vector(point, "platen: point [m]"))
    if recorded is not None and not begins <= recorded * (1 + 1e-12):
        raise ValueError(
            f"platen: recorded {recorded:g} m is not on the platen, which begins at {begins:g} m"
        )
    target = description.add(
        Target(
            name or ("base" if bottom else "top"),
            fixed=bottom,
            point=point,
            recorded=point if recorded is None else (*point[:2], recorded),
            box=((*low, begins), (*high, ends)),
            freedom="".join(axis for axis in "xyzXYZ" if axis in held),
            loaded=not bottom,
            drives="".join(drive),
        )
    )
    if uplift:
        k = springs.pop("z")
        _standLoose(description, target, k, (*low, outer), (*high, outer))
    if springs:
        of = lambda axes: tuple(float(springs.get(axis, 0)) for axis in axes)
        to = End(middle, target), End(middle)
        made = Spring(f"{target.name}_spring", to, of("xyz"), of("XYZ"))
        description.connectors.append(made)
    return target


def _problems(plane, bottom, rotation, guided, drive, springs):
    if bottom and rotation == "free":
        yield "the one at the bottom is fixed and cannot turn"
    for name, value in {"guided": guided, "drive": drive}.items():
        if bottom and value:
            yield f"{name} {value!r} is for the one at the top"
    if springs and not bottom:
        yield "springs are for the one at the bottom; spring() is for any"
    for name, value, out in (("springs", springs, "yXZ"), ("drive", drive, "y")):
        if plane and {*value} & {*out}:
            yield f"{name} {value!r}: {IN_PLANE}"


def _sideAt(description, level, where, part):
    """The opposite corners (x, y) of what the bricks of a part have at a level [m]. Raises
    ValueError."""
    near = 1e-6 * (1 + abs(level))
    blocks = [
        [p for p in block.corners if abs(p[2] - level) < near]
        for block in description.bricks
        if part in (None, block.part)
    ]
    touching = [p[:2] for corners in blocks for p in corners]
    if not touching:
        raise ValueError(f"platen: part {part!r} does not reach the {where}, z = {level:g} m")
    low, high = ([*map(f, zip(*touching))] for f in (min, max))
    # bricks that stand on an edge share no face with a platen
    if any(a == b for a, b in zip(low, high)) or max(map(len, blocks)) < 3:
        raise ValueError(
            f"platen: no horizontal side of a brick lies at the {where}, z = {level:g} m, "
            "so hold bricks, or blocks with an inclined side on which these stand"
        )
    return low, high


def _standLoose(description, target, stiffness, low, high):
    """Let a platen stand on a soil without tension: bars by which it hangs from points so high
    above that they stay upright.

    :param stiffness: of all together [N/m]
    :param low: and ``high``: opposite corners of its outer side [m]
    """
    counts = (BARS[0], 1) if description.plane else (BARS[1], BARS[1])
    rows = [_spread(a, b, count) for a, b, count in zip(low, high, counts)]
    name = f"{target.name}_soil"
    for (x, one), (y, other) in itertools.product(*rows):
        ends = End((x, y, low[2]), target), End((x, y, low[2] + HIGH))
        bar = Tie(name, ends, one * other * stiffness, None, 0.0, 0.0, None, False, overlay=name)
        bar.isSupport = True
        description.connectors.append(bar)
    wide, deep = (b - a for a, b in zip(low[:2], high))
    rotation = stiffness * deep**2 / 12, stiffness * wide**2 / 12, 0.0
    middle = tuple((a + b) / 2 for a, b in zip(low, high))
    ends = End(middle, target), End(middle)
    description.soils.append(Spring(name, ends, (0.0, 0.0, stiffness), rotation))


def _spread(low, high, count):
    """Places from end to end, and the share of each by Simpson's rule, so that a soil has its
    stiffness against rotation, too."""
    if count == 1:
        return [((low + high) / 2, 1.0)]
    shares = [1, *([4, 2] * (count // 2))[:-1], 1]
    step = (high - low) / (count - 1)
    return [(low + n * step, share / sum(shares)) for n, share in enumerate(shares)]


@describes
@validated
def hold(
    description: Any,
    where: BrickAt,
    name: Name | None = None,
    axes: Freedoms = "xyzXYZ",
) -> Target:
    """Hold a brick, so that it neither moves nor turns but by :meth:`move`.

    :param where: a point [m] in it or near it, its index in the bricks, or the block itself
    :param name: in curve.csv; None: ``brick`` and its index
    :param axes: along which it is held, xyz, and about which it cannot turn, XYZ; a prop against a
        wall that leans is ``"y"``
    """
    if description.plane and not set(axes) - set("yXZ"):
        raise ValueError(
            f"hold: in the x-z plane no block moves along {axes} anyway; Scene(..., plane=False) is"
            " in space"
        )
    target = _brick(description, where, name, fixed=True, loaded=False)
    target.freedom = "".join({*axes, *"yXZ"} if description.plane else axes)
    return target


@describes
@validated
def watch(description: Any, where: BrickAt, name: Name | None = None) -> Target:
    """Record the motion of a brick. Parameters as in :meth:`hold`; a point is the one that is
    recorded."""
    return _brick(description, where, name, fixed=False, loaded=False)


@describes
@validated
def handle(description: Any, where: BrickAt, name: Name | None = None) -> Target:
    """A brick that loads act on, at its centre or at the point that is given. It is rigid, also
    where bricks are deformable. Parameters as in :meth:`hold`."""
    return _brick(description, where, name, fixed=False, loaded=True)


def _brick(description, where, name, fixed, loaded):
    index, point = description.find(where)
    point = point or description.middle(index)
    return description.add(
        Target(
            name or f"brick{index}",
            fixed=fixed,
            point=point,
            recorded=point,
            brick=index,
            freedom="xyzXYZ" if fixed else None,
            loaded=loaded,
        )
    )
