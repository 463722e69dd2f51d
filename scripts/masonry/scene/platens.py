# SPDX-License-Identifier: GPL-2.0-or-later
"""What holds a structure, and what is watched: commands that describe a scene."""

import itertools
from math import dist
from typing import Annotated, Any

from ..arguments import Axes, Freedoms, Name, Numbers, axes, byName, number, oneOf, shown, validated
from ..arguments import vector as numbers
from ..errors import IN_PLANE, Refused, refuse
from .targets import BrickAt, Part, Target
from .ties import BUNDLES, MAX_STIFFNESS, End, Spring, Tie
from .script import describes

PLATEN = 0.2  # [m] height of a platen
#: Bars along each side of a platen on a soil without tension, in a plane and in space.
BARS = 21, 11
BAR_LENGTH = 1e3  # [m]

Coordinate = Annotated[float, number("m", -1e6, 1e6)]
Point = Annotated[Numbers, numbers("m", 1e6)]


def stiffnesses(value: Any, context: Any = None) -> Any:
    found = byName(number("N/m or N m", 0, MAX_STIFFNESS, above=True))(value)
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
    weight: Annotated[float, number("N", 0, 1e12)] | None = None,
) -> Target:
    """A rigid block over the whole lower or upper side of the structure, with ``support`` joints,
    which alone give way.

    The one at the bottom is fixed. The one at the top moves, and loads act on it.

    :param where: ``"bottom"`` or ``"top"``
    :param rotation: of the one at the top: ``"free"`` or ``"held"``; None: held
    :param height: [m]
    :param name: in curve.csv; None: base and top
    :param point: (x, y, z) [m] on which loads act; None: the middle of the platen's outer side
    :param guided: axes along which the middle of the one at the top cannot move: ``"x"``, ``"y"``
        or ``"xy"``
    :param part: name of the part of the bricks on whose lower or upper side the platen is; None:
        of all
    :param upTo: z of its outer side [m], in place of ``height``: where a testing machine pushes
    :param recorded: z of the point whose displacement is recorded [m], on the line through
        ``point``; None: that of ``point``
    :param drive: axes along which a drive holds the one at the top from the beginning, as ``"xz"``;
        else it is free until it is pushed
    :param springs: of the one at the bottom, a soil or a rig that gives way: a dict from axes, xyz
        along and XYZ about, to stiffness [N/m], [N m/rad], at the middle of its outer side, for
        example ``{"x": 37e6}``. Along and about the others it is fixed; where it is fixed along x
        or y it turns about its own middle. Its weight counts if it can move along z
    :param uplift: whether the soil carries no tension: ``z`` of ``springs`` is spread over the side
        of the platen, on which it also turns
    :param weight: of the one at the top [N]; None: that of 1800 kg/m³, whose mass it has in any
        case. The difference grows in :meth:`settle`, as a dead load
    """
    bottom, plane = where == "bottom", description.plane
    level = _levelOf(description, bottom, part)
    springs = {**(springs or {})}
    problems = [*_problems(plane, bottom, rotation, guided, drive, springs, weight)]
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
    point = middle if point is None else tuple(map(float, point))
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
            weight=weight,
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


def _problems(plane, bottom, rotation, guided, drive, springs, weight):
    if bottom and rotation == "free":
        yield "the one at the bottom is fixed and cannot turn"
    for name, value in {"guided": guided, "drive": drive, "weight": weight}.items():
        if bottom and value not in ("", None):
            yield f"{name} {value!r} is for the one at the top"
    if springs and not bottom:
        yield "springs are for the one at the bottom; spring() is for any"
    for name, value, out in (("springs", springs, "yXZ"), ("drive", drive, "y")):
        if plane and {*value} & {*out}:
            yield f"{name} {value!r}: {IN_PLANE}"


def _levelOf(description, bottom, part):
    """Where a part, or all of the bricks, end below or above [m]."""
    heights = [p[2] for b in description.bricks if part in (None, b.part) for p in b.corners]
    return min(heights) if bottom else max(heights)


def _sideAt(description, level, where, part):
    """Opposite corners (x, y) of what a part has at a level [m]. Raises ValueError."""
    near = 1e-6 * (1 + abs(level))
    blocks = [
        [p for p in block.corners if abs(p[2] - level) < near]
        for block in description.bricks
        if part in (None, block.part)
    ]
    touching = [p[:2] for corners in blocks for p in corners]
    if not touching:
        raise ValueError(f"platen: part {part!r} has no corner at the {where}, z = {level:g} m")
    low, high = ([*map(f, zip(*touching))] for f in (min, max))
    # bricks that stand on an edge share no face with a platen
    if any(a == b for a, b in zip(low, high)) or max(map(len, blocks)) < 3:
        raise ValueError(
            f"platen: no horizontal side of a brick lies at the {where}, z = {level:g} m, "
            "so hold bricks, or blocks with an inclined side on which these stand"
        )
    return low, high


def _standLoose(description, target, stiffness, low, high):
    """Let a platen stand on a soil without tension: it hangs from vertical bars, so long that they
    stay vertical as it moves.

    :param stiffness: of all bars together [N/m]
    :param low: and ``high``: opposite corners of the outer side of the platen [m]
    """
    counts = (BARS[0], 1) if description.plane else (BARS[1], BARS[1])
    rows = [_spread(a, b, count) for a, b, count in zip(low, high, counts)]
    name = f"{target.name}_soil"
    for (x, one), (y, other) in itertools.product(*rows):
        ends = End((x, y, low[2]), target), End((x, y, low[2] + BAR_LENGTH))
        bar = Tie(name, ends, one * other * stiffness, None, 0.0, 0.0, None, False, overlay=name)
        bar.isSupport = True
        description.connectors.append(bar)
    wide, deep = (b - a for a, b in zip(low[:2], high))
    rotation = stiffness * deep**2 / 12, stiffness * wide**2 / 12, 0.0
    middle = tuple((a + b) / 2 for a, b in zip(low, high))
    ends = End(middle, target), End(middle)
    description.soils.append(Spring(name, ends, (0.0, 0.0, stiffness), rotation))


def _spread(low, high, count):
    """Places from end to end, and their shares by Simpson's rule, which keep the stiffness against
    rotation."""
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
    to: Point | None = None,
    stiffness: Annotated[float, number("N/m²", 0, MAX_STIFFNESS, above=True)] | None = None,
) -> Target:
    """Hold a brick at its middle, or bricks along a line. They then move by :meth:`move` alone.

    A brick turns about its middle if it is held along y alone. Whole and half bricks at the end of
    a wall, whose middles are not above one another, so clamp it; held along a line or an edge it
    turns::

        scene.hold((0, 0.05, 0), "side", "y", to=(0, 0.05, 2.5))

    :param where: a point [m] in it or near it, its index in the bricks, or the block itself
    :param name: in curve.csv; None: ``brick`` and its index
    :param axes: along which it is held, xyz, and about which, XYZ; a prop against a wall that leans
        is ``"y"``; bricks turn freely about a line. An edge of a panel along x is ``"y"`` where it
        is hinged and ``"yZ"`` where it is clamped; ``x`` makes it an abutment, between two of which
        the panel arches
    :param to: where a line from the point ``where`` ends [m]. Springs along ``axes`` hold each
        brick that has a part of it, at two points of this part; these bricks are rigid in any case
    :param stiffness: of each axis, over the length of the line [N/m²]; None: normal stiffness of
        support joints times the least thickness of the brick
    """
    if to is not None:
        return _holdAlong(description, where, name, axes, to, stiffness)
    if stiffness is not None:
        raise Refused("hold: stiffness is that of a line, whose end to= must say")
    if description.plane and not set(axes) - set("yXZ"):
        raise ValueError(
            f"hold: in the x-z plane no block moves along {axes} anyway; Scene(..., plane=False) is"
            " in space"
        )
    target = brickTarget(description, where, name, fixed=True, loaded=False)
    target.freedom = "".join({*axes, *"yXZ"} if description.plane else axes)
    return target


def _holdAlong(description, where, name, axes, to, stiffness):
    """Hold bricks along a line: see :func:`hold`."""
    begin, end = description.find(where)[1], tuple(map(float, to))
    along = [a for a in "xyz" if a in axes and not (description.plane and a == "y")]
    parts = begin and description.alongLine(begin, end)
    problems = []
    if not begin:
        problems.append("a line begins at a point (x, y, z) [m]")
    elif not parts:
        problems.append(f"no brick has a part of the line from {begin} m to {end} m")
    if not along:
        problems.append(f"a line holds along x, y or z, got axes {axes!r}")
    if description.contact:
        problems.append("collapse='follow' has no lines")
    refuse([f"hold: {one}" for one in problems])
    size = 1e-3 * max(b - a for a, b in zip(description.low, description.high))
    low, high = ([f(a, b) for a, b in zip(begin, end)] for f in (min, max))
    target = description.add(
        Target(
            name or f"line{sum(t.line for t in description.targets.values())}",
            fixed=True,
            point=begin,
            recorded=begin,
            box=(tuple(v - size for v in low), tuple(v + size for v in high)),
            freedom="xyzXYZ",
            loaded=False,
            joined=False,
            line=True,
        )
    )
    support = description.materials.joints["support"].normalStiffness
    for brick, (first, last), thickness in parts:
        k = 0.5 * dist(first, last) * (stiffness or support * thickness)
        for share in BUNDLES:
            point = tuple(a + share * (b - a) for a, b in zip(first, last))
            springs = tuple(k * (a in along) for a in "xyz")
            ends = End(point, None, brick), End(point, target)
            made = Spring(f"{target.name}_{brick}", ends, springs, (0.0, 0.0, 0.0))
            made.overlay = target.name
            description.connectors.append(made)
    return target


@describes
@validated
def watch(description: Any, where: BrickAt, name: Name | None = None) -> Target:
    """Record the motion of a brick, at the point that is given. Parameters as in :meth:`hold`."""
    return brickTarget(description, where, name, fixed=False, loaded=False)


@describes
@validated
def handle(description: Any, where: BrickAt, name: Name | None = None) -> Target:
    """A brick that loads act on, at its centre or at the point that is given; it is rigid.
    Parameters as in :meth:`hold`."""
    return brickTarget(description, where, name, fixed=False, loaded=True)


def brickTarget(
    description: Any, where: Any, name: str | None, fixed: bool, loaded: bool
) -> Target:
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
