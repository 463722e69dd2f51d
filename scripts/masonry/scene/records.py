# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene records beside its targets, and how its figures look: words that describe a
scene."""

import itertools
from typing import Annotated, Any, Callable

from ..arguments import Direction, Name, shown, validated
from ..arguments import name as nameOf
from ..model.bodies import vector
from ..numbers.columns import Column
from .sections import BASE, ENDS, Section
from .platens import Coordinate
from .targets import AnyTarget, BrickAt, Drift, JointRecord, Part
from .script import describes


def _nameOrNothing(value, context=None):
    """Validator of a name, or of an empty text."""
    return value if isinstance(value, str) and not value else nameOf(value)


@describes
@validated
def drift(description: Any, lower: AnyTarget, upper: AnyTarget, name: Name | None = None) -> None:
    """Record how far a target moves horizontally against a lower one, for example two floors.

    The columns of curve.csv are the difference [mm] and that over the height between both points
    [mrad].

    :param lower: a target, as :meth:`platen` or :meth:`watch` give it; ``upper``: one above it
    :param name: of the columns; None: that of ``upper`` with ``_drift``
    """
    if not upper.recorded[2] - lower.recorded[2] > 0:
        raise ValueError(
            f"drift: {upper.name} at z = {upper.recorded[2]:g} m must be above {lower.name} at"
            f" {lower.recorded[2]:g} m"
        )
    description.drifts.append(Drift(name or f"{upper.name}_drift", lower, upper))


@describes
@validated
def column(description: Any, name: Name, meaning: str, value: Callable[[], float]) -> None:
    """Record something of one's own: a column of curve.csv.

    :param name: with its unit at the end, for example ``drift_mm``
    :param meaning: one line for run.json
    :param value: function without arguments that gives a number
    """

    def read(reading):
        found = value()
        try:
            return float(found)
        except (TypeError, ValueError, OverflowError):
            raise ValueError(
                f"column {name}: its function must give a number, got {shown(found)}"
            ) from None

    description.extra.append(Column(name, None, meaning, read))


@describes
@validated
def joint(
    description: Any,
    one: BrickAt,
    two: BrickAt,
    name: Annotated[str, _nameOrNothing] | None = None,
) -> JointRecord:
    """Record the means of a joint: opening, slide, normal and shear stress, as columns of
    curve.csv.

    :param one: a brick, as for :meth:`hold`; ``two``: the other one
    :param name: before the names of the columns; None: ``joint`` and a number; an empty text:
        nothing before them
    :returns: a :class:`JointRecord`, which can be read between stages, too
    """
    pair = tuple(description.find(where)[0] for where in (one, two))
    if pair[0] == pair[1]:
        raise ValueError(f"joint: both are brick {pair[0]}")
    name = f"joint{len(description.joints)}" if name is None else name
    description.joints.append(JointRecord(name, pair))
    return description.joints[-1]


@describes
@validated
def section(
    description: Any, z: Coordinate, part: Part | None = None, name: Name | None = None
) -> Section:
    """Record what a horizontal section transmits: normal force, shear force and moment, as columns
    of curve.csv.

    They are the resultant of the joints between the blocks, platens too, whose centroid is above
    ``z`` when the scene is built, and those whose centroid is not: exact statics in any bond. All
    are of the structure above on the part below:

    - ``N`` [kN]: normal force, positive in tension
    - ``V_x``, in space also ``V_y`` [kN]: shear force along x and y
    - ``M_y``, in space also ``M_x`` [kN m]: moment about y and x through the middle of the section,
      by the right-hand rule. A push along +x above the section gives a positive ``M_y``, one along
      +y a negative ``M_x``

    The middle is that of the box around the bricks that reach ``z``, at the height ``z``, as they
    are built; it stays in space, while the forces act where the blocks are, so eccentric weight of
    a wall that leans counts.

    Every run of a structure on platens at its bottom records that at its base, ``base``, unless the
    scene has one there.

    :param z: height [m]
    :param part: name of a part of the bricks: the joints whose upper brick is of it (under a
        platen, the lower one), so that what several parts transmit adds up to the whole; None: all
        joints
    :param name: before the names of the columns; None: ``section`` and a number
    :returns: a :class:`masonry.scene.sections.Section`, whose ``forces()`` can be read between
        stages, too
    """
    name = f"section{len(description.sections)}" if name is None else name
    found = Section(name, float(z), part, _middleAt(description, z, part, name))
    description.sections.append(found)
    return found


def _middleAt(description, z, part, name):
    """The middle of the box around the bricks that reach a height [m]. Raises ValueError."""
    boxes = [
        [[*map(f, zip(*b.corners))] for f in (min, max)]
        for b in description.bricks
        if part in (None, b.part)
    ]
    near = 1e-6 * (1 + abs(z))
    cut = [box for box in boxes if box[0][2] - near <= z <= box[1][2] + near]
    ends = lambda of, i: (min(low[i] for low, _ in of), max(high[i] for _, high in of))
    if not cut:
        least, most = ends(boxes, 2)
        raise ValueError(
            f"section {name}: no brick{f' of part {part!r}' if part else ''} reaches z = {z:g} m;"
            f" they are from {least:g} to {most:g} m"
        )
    return (*(sum(ends(cut, i)) / 2 for i in range(2)), float(z))


def recordBase(description: Any) -> None:
    """Record the section at the base of a structure that stands on platens, unless the scene has
    one there."""
    z, targets = float(description.low[2]), description.targets.values()
    near = 1e-6 * (1 + abs(z))
    own = (s.part is None and abs(s.z - z) < near for s in description.sections)
    if any(own) or not any(t.box and t.fixed and t.joined for t in targets):
        return
    taken = {one.name for one in (*description.sections, *description.extra)}
    free = lambda name: not {name, *(f"{name}_{end}" for end in ENDS)} & taken
    names = itertools.chain([BASE], (f"{BASE}{k}" for k in itertools.count(2)))
    name = next(filter(free, names))
    middle = _middleAt(description, z, None, name)
    description.sections.append(Section(name, z, None, middle, isBase=True))


def viewAlongY(description: Any) -> None:
    """See parts that move in the x-z plane and are deeper than long from the front, unless the
    scene says from where."""
    if not description.plane:
        return
    for name in {block.part for block in description.bricks} - set(description.views):
        corners = [p for b in description.bricks if b.part == name for p in b.corners]
        long, deep = (max(p[i] for p in corners) - min(p[i] for p in corners) for i in (0, 1))
        if deep > long:
            description.views[name] = [0.0, 1.0, 0.0]


@describes
@validated
def view(description: Any, direction: Direction, part: Part | None = None) -> None:
    """From where the crack figure sees the structure: the direction of sight, for example (1, 0, 0)
    for a panel that bows out of its plane.

    :param part: name of a part of the bricks; None: all
    """
    sight = [float(v) for v in vector(direction, "view: direction")]
    parts = {block.part for block in description.bricks} if part is None else [part]
    description.views.update(dict.fromkeys(parts, sight))
