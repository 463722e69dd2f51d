# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene records beside its targets, and how its figures look: commands that describe a
scene, and what a section transmits.

The free body above a horizontal section is that of all blocks, platens too, whose centroid was
above its height z when the scene was built. The joints, ties and springs below it transmit all that
acts on it, so their resultant is exact statics in any bond. At rest it is the weight of these
blocks and the loads on them. The upright section of a spandrel divides its bricks and lintels alike
by their x or y, without platens above, which go through.
"""

import itertools
from dataclasses import dataclass
from typing import Annotated, Any, Callable, Iterator

import numpy as np
from yade import O, Vector3

from .._masonry import resultant
from ..arguments import Direction, Name, orNone, shown, validated
from ..arguments import vector as point
from ..arguments import name as nameOf
from ..numbers.columns import Column
from ..errors import Refused
from .platens import Coordinate, brickTarget
from .targets import AnyTarget, BrickAt, Drift, JointRecord, Part
from .ties import GROUND
from .script import describes

Corner = Annotated[Any, orNone(point("m", 1e6))]
PIER, SPANDREL = "pier", "spandrel"
BASE = "base"  # name of the section that every run on a platen records
ENDS = "N", "V_x", "V_y", "M_x", "M_y"  # of names of columns
LEVEL = 1e-9  # centroids so near to z, over the height of a structure, do not lie above it


@dataclass
class Section:
    """A section whose forces are recorded. ``scene.section`` makes it."""

    name: str
    place: float  # [m] along its axis
    part: str  # of the bricks; None: all
    middle: tuple  # point in space about which moments are [m]
    isBase: bool = False  # recorded without a command
    axis: int = 2  # across it; a section of axis 0 or 1 is upright
    members: Any = None  # indices of the bricks whose joints count alone; None: those of its part
    interactions: tuple | list = ()  # YADE's, of its joints, when the scene is built
    _read: tuple = (None, None)  # the last reading, and its forces

    def join(self, structure: Any) -> None:
        """Find its joints in a :class:`masonry.model.structure.Structure`. Raises Refused if there
        are none."""
        description = structure.description
        axis, at = self.axis, self.place
        level = at + LEVEL * (description.high[axis] - description.low[axis] + abs(at))
        #: whether every body is above it, or at larger x or y, by its id; the ground is not
        self.above = {b.id: b.state.refPos[axis] > level for b in O.bodies} | {GROUND: False}
        self._structure = structure
        own = (
            b.part if self.members is None else n in self.members
            for n, b in enumerate(description.bricks)
        )
        self._parts = dict(zip(structure.ids, own))
        pairs = [(one, (one.id1, one.id2)) for one in structure.interactions]
        crossing = [(one, ids) for one, ids in pairs if self._cross(*ids)]
        self.interactions = [one for one, _ in crossing]
        #: of each: 1 if its first body is the lower one, else -1
        self.signs = [1 if self.above[ids[1]] else -1 for _, ids in crossing]
        #: ties and springs that cross it, each with its upper end
        self.connections = []
        for one in description.connectors:
            bodies = [end.bodyIn(structure.ids) for end in one.ends]
            if self._cross(*bodies):
                upper = one.ends[0 if self.above[bodies[0]] else 1]
                self.connections.append((one, upper))
        if not self.interactions:
            what = f" of part {self.part!r}" if self.part else ""
            raise Refused(
                f"section {self.name}: no joint{what} crosses {'xyz'[axis]} = {at:g} m: there must"
                " be one between blocks whose centroids are on different sides"
            )

    def _cross(self, one, other):
        """Whether one of two bodies is above it, and what joins them is of its part."""
        if self.above[one] == self.above[other]:
            return False
        if self.axis < 2:
            both = [self._parts.get(body) for body in (one, other)]
            return None not in both and any(both)
        lower, upper = (one, other) if self.above[other] else (other, one)
        # a joint to a platen is of the part of its brick
        wanted = self.part if self.members is None else True
        return wanted in (None, self._parts.get(upper, self._parts.get(lower)))

    def forces(self) -> tuple[Any, Any]:
        """Force [N] and moment about the middle [N m] of what is above on what is below: two
        vectors."""
        if not self.interactions:
            raise ValueError(f"section {self.name}: the scene is not built yet")
        force, moment = resultant(self.interactions, self.signs, self.middle)
        structure, middle = self._structure, Vector3(*self.middle)
        for one, upper in self.connections:
            on, turning = one.on(upper, structure.connectors)
            arm = structure.connectors.placeOf(upper) - middle
            force, moment = force - on, moment - arm.cross(on) - turning
        # contacts of blocks above with blocks below, wherever these lie now
        for one, other, on, turning in structure.contacts.pairs() if structure.contacts else ():
            if self._cross(one, other):
                # `on` and `turning` act on the second body of the pair, about its centre
                sign = 1 if self.above[one] else -1
                arm = O.bodies[other].state.pos - middle
                force, moment = force + sign * on, moment + sign * (arm.cross(on) + turning)
        return force, moment

    def columns(self, plane: bool) -> Iterator[Column]:
        """What is recorded of it; ``scene.section`` has the signs."""
        upright, own = self.axis < 2, "xyz"[self.axis]
        of = f" of part {self.part}" if self.part else ""
        at = f"the section at {own} = {self.place:g} m{of}"
        on = "what is above on what is below"
        shears = "x" if plane else "xy"
        moments = (("y", "large x"), ("x", "small y"))[: len(shears)]
        if upright:
            on, shears = f"what is at larger {own} on the rest", "z"
            moments = ((("y", "small z"), ("x", "large z"))[self.axis],)
        about = "({})".format(", ".join(f"{v:g}" for v in self.middle))
        yield self._column(0, self.axis, "N", "kN", f"normal force on {at}, positive in tension")
        for axis in shears:
            meaning = f"shear force on {at}: of {on}, along {axis}"
            yield self._column(0, "xyz".index(axis), f"V_{axis}", "kN", meaning)
        for axis, side in moments:
            meaning = (
                f"moment on {at}: of {on}, about {axis} through {about} m by the right-hand rule,"
                f" so that it presses the side of {side} where it is positive"
            )
            yield self._column(1, "xyz".index(axis), f"M_{axis}", "kNm", meaning)

    def _column(self, which, axis, name, unit, meaning):
        def value(reading):
            if self._read[0] is not reading:
                self._read = reading, self.forces()
            return 1e-3 * self._read[1][which][axis]

        return Column(f"{self.name}_{name}", unit, meaning, value)


def _nameOrNothing(value, context=None):
    return value if isinstance(value, str) and not value else nameOf(value)


@describes
@validated
def drift(description: Any, lower: AnyTarget, upper: AnyTarget, name: Name | None = None) -> None:
    """Record how far a target moves horizontally against a lower one, for example two floors: the
    difference [mm], and over the height between both points [mrad].

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
    :param meaning: a line for run.json
    :param value: function without arguments that returns a number
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
    """Record the means of a joint: opening, slide, normal and shear stress.

    :param one: a brick, as for :meth:`hold`; ``two``: the other one
    :param name: before the names of the columns; None: ``joint`` and a number; or an empty text
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
    """Record what a horizontal section transmits: normal force, shear force and moment.

    They are the resultant of the joints between the blocks, platens too, whose centroid is above
    ``z`` when the scene is built, and the others, of the structure above on the part below:

    - ``N`` [kN]: normal force, positive in tension
    - ``V_x``, in space also ``V_y`` [kN]: shear force along x and y
    - ``M_y``, in space also ``M_x`` [kN m]: moment about y and x through the middle of the section,
      by the right-hand rule. A push along +x above the section gives a positive ``M_y``, one along
      +y a negative ``M_x``

    The middle is that of the box around the bricks that reach ``z`` as they are built, and stays in
    space, while the forces act where the blocks are: eccentric weight of a wall that leans counts.
    Every run of a structure on platens records ``base``, at its bottom, unless the scene has a
    section there.

    :param z: height [m]
    :param part: name of a part of the bricks: the joints whose upper brick (under a platen, the
        lower one) is of it, so that parts add up to the whole; None: all joints
    :param name: before the names of the columns; None: ``section`` and a number
    :returns: its ``forces()`` can be read between stages, too
    """
    name = f"section{len(description.sections)}" if name is None else name
    found = Section(name, float(z), part, _middleAt(description, z, part, name))
    description.sections.append(found)
    return found


@describes
@validated
def pier(
    description: Any,
    low: Corner = None,
    high: Corner = None,
    name: Name | None = None,
    part: Part | None = None,
) -> None:
    """Record normal force, shear force and moment of a pier at its mid-height, as :meth:`section`
    does, and its drift, for checks by codes (:mod:`masonry_capacity.piers`).

    Without a box all piers of a wall are recorded, or the wall as one: what stands beside openings
    in courses that have more of them than the courses above and below.

    :param low: lowest corner (x, y, z) of the box around the pier [m], in which the bricks have
        their centroids; its longer horizontal side is the length of the pier
    :param high: its highest corner [m]
    :param name: of the columns, and of several their beginning; None: ``pier`` and a number
    :param part: of the bricks, of which the piers are without a box; None: all
    """
    _addElements(description, PIER, low, high, name, part)


@describes
@validated
def spandrel(
    description: Any,
    low: Corner = None,
    high: Corner = None,
    name: Name | None = None,
    part: Part | None = None,
) -> None:
    """Record normal force, shear force and moment of a spandrel in the upright section at the
    middle of its length, for the same checks as of a :meth:`pier`.

    They are the resultant of the joints between bricks of both sides, lintels and beams among them.
    Without a box all spandrels of a wall are recorded: what is above an opening, up to the next one
    or the top, where openings are one above the other.

    :param low: lowest corner (x, y, z) of the box around the spandrel [m], in which the bricks have
        their centroids; its longer horizontal side is the length, that of the opening
    :param high: its highest corner [m]
    :param name: of the columns, and of several their beginning; None: ``spandrel`` and a number
    :param part: as of a pier
    """
    _addElements(description, SPANDREL, low, high, name, part)


def _addElements(description, kind, low, high, name, part):
    """Take the pier or spandrel of a box, or all of a wall. Raises ValueError."""
    boxes = [(low, high)]
    if (low is None) != (high is None):
        raise ValueError(f"{kind}: give both corners of its box, or none")
    if low is None:
        boxes = [*_besideOpenings(description, kind, part)]
        if not boxes:
            raise ValueError(f"{kind}: none is found by the openings: give low and high")
    for one, other in boxes:
        count = sum(entry["kind"] == kind for entry in description.piers)
        own = name if name and len(boxes) == 1 else f"{name or kind}{count}"
        _addElement(description, kind, np.array(one), np.array(other), own)


def _besideOpenings(description, kind, part):
    """Lowest and highest corners of the piers or spandrels of a wall [m]."""
    corners = [np.array(b.corners) for b in description.bricks if part in (None, b.part)]
    boxes = np.array([[c.min(axis=0), c.max(axis=0)] for c in corners]).round(6)
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    along = int(high[1] - low[1] > high[0] - low[0])
    # bands from opening to opening, upwards for piers, and the spans of masonry in each
    across, through = (2, along) if kind == PIER else (along, 2)
    levels, found = np.unique(boxes[:, :, across]), []
    for bottom, top in zip(levels, levels[1:]):
        here = boxes[(boxes[:, 0, across] < top) & (boxes[:, 1, across] > bottom)][:, :, through]
        spans: list[list[float]] = []
        for start, end in sorted(here.tolist()):
            if spans and start <= spans[-1][1] + 1e-5:
                spans[-1][1] = max(spans[-1][1], end)
            else:
                spans.append([start, end])
        if found and found[-1][0] == spans:
            found[-1][2] = top
        else:
            found.append([spans, bottom, top])
    pierced = lambda spans: len(spans) if kind == PIER else -sum(b - a for a, b in spans)
    ranks = [0, *(pierced(spans) for spans, *_ in found), 0]
    for n, (spans, bottom, top) in enumerate(found, 1):
        if ranks[n] > max(ranks[n - 1], ranks[n + 1]) + 1e-5:
            for start, end in spans:
                first, last = low.copy(), high.copy()
                first[across], last[across] = bottom, top
                first[through], last[through] = start, end
                if kind == PIER or start > low[2]:  # else it lies on the foundation
                    yield first, last


def _addElement(description, kind, low, high, name):
    """Take the bricks in a box. Raises ValueError."""
    middles = np.array([np.mean(b.corners, axis=0) for b in description.bricks])
    middle, size = (low + high) / 2, high - low
    inside = np.all((middles > low) & (middles < high), axis=1)
    members = [int(n) for n in np.nonzero(inside)[0]]
    axis, along, about = (0, "x", "y") if size[0] >= size[1] else (1, "y", "x")
    columns = {"N": "N_kN", "V": "V_z_kN", "M": f"M_{about}_kNm"}
    if kind == PIER:
        axis = 2
        columns.update(V=f"V_{along}_kN", drift=f"drift_{along}_mrad")
        # bricks of the lowest and the highest course, the nearest to the axis of the pier first
        members.sort(key=lambda n: float(np.abs(middles[n] - middle)[:2].sum()))
        level = lambda n: round(float(middles[n][2]), 6)
        ends = [choose(members, key=level, default=0) for choose in (min, max)]
        if not members or level(ends[0]) == level(ends[1]):
            raise ValueError(f"pier {name}: its box must have two courses of bricks at least")
        foot, head = (
            brickTarget(description, n, f"{name}_{end}", fixed=False, loaded=False)
            for n, end in zip(ends, ("foot", "head"))
        )
        description.drifts.append(Drift(f"{name}_drift", foot, head))
    at, own = tuple(middle.tolist()), frozenset(members)
    description.sections.append(Section(name, at[axis], None, at, members=own, axis=axis))
    entry = {"name": name, "kind": kind, "low_m": low.tolist(), "high_m": high.tolist()}
    description.piers.append({**entry, **{n: f"{name}_{head}" for n, head in columns.items()}})


def _middleAt(description, z, part, name):
    """Middle of the bricks that reach a height [m]. Raises ValueError."""
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
    """Record the section at the base of a structure on platens, unless the scene has one."""
    z, targets = float(description.low[2]), description.targets.values()
    near = 1e-6 * (1 + abs(z))
    own = (s.part is None and s.axis == 2 and abs(s.place - z) < near for s in description.sections)
    if any(own) or not any(t.box and t.fixed and t.joined for t in targets):
        return
    taken = {one.name for one in (*description.sections, *description.extra)}
    free = lambda name: not {name, *(f"{name}_{end}" for end in ENDS)} & taken
    names = itertools.chain([BASE], (f"{BASE}{k}" for k in itertools.count(2)))
    name = next(filter(free, names))
    middle = _middleAt(description, z, None, name)
    description.sections.append(Section(name, z, None, middle, isBase=True))


def viewAlongY(description: Any) -> None:
    """See parts of a scene in the x-z plane that are deeper than long along y, unless the scene
    says from where."""
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
    """The direction in which the crack figure sees the structure, for example (1, 0, 0) for a panel
    that bows out of its plane.

    :param part: name of a part of the bricks; None: all
    """
    sight = [*map(float, direction)]
    parts = {block.part for block in description.bricks} if part is None else [part]
    description.views.update(dict.fromkeys(parts, sight))
