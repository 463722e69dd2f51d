# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene describes before its first stage: its bricks, and what holds, loads and records them. Plain records.

The words that describe are functions of a :class:`Description`: :mod:`masonry.scene.supports`, :mod:`masonry.scene.loads`
and :mod:`masonry.scene.records`. :class:`masonry.assembly.structure.Structure` builds what they say in YADE.
"""

import math
from numbers import Integral

import numpy as np

from ..common.arguments import shown, vector
from ..assembly import columns
from ..basics import GRAVITY, Refused
from ..bricks.blocks import KINDS
from .contact import Contact


class Description:
    """Bricks, materials and everything that a scene says before its first stage.

    :param name: of the scene
    :param bricks: blocks, as in :class:`masonry.scene.scene.Scene`, which checks all parameters
    """

    def __init__(
        self,
        name,
        bricks,
        materials,
        title=None,
        plane=None,
        gravity=GRAVITY,
        choice=None,
        functors=False,
        deformable=False,
        allowGaps=False,
        collapse="end",
    ):
        self.bricks = bricks
        self.name, self.title = name, title or name
        self.materials, self.gravity = materials, gravity  # [m/s²], downwards
        self.functors = functors  # as in masonry.assembly.engines.engines
        self.deformable = deformable  # whether bricks are
        self.allowGaps = allowGaps  # as in masonry.assembly.connecting.connect
        #: Contact of blocks that have lost their joints, if a collapse is followed, else None.
        self.contact = Contact() if collapse == "follow" else None
        points = [p for block in self.bricks for p in block.corners]
        #: corners of the box around all bricks [m]
        self.low, self.high = ([*map(f, zip(*points))] for f in (min, max))
        self.plane = self._inPlane() if plane is None else plane
        # heads of columns, None: all
        self.choice = None if choice is None else list(choice)
        self.targets = {}  # by name
        self.joints = []  # whose means are recorded
        self.drifts = []
        self._boxes = None  # bricks, and their lower and upper corners and middles, for _nearest()
        self.sections = []
        self.connectors = []  # ties and springs, records of masonry.scene.ties
        self.overlays = []
        self.soils = (
            []
        )  # springs that stand for a soil without tension where periods are estimated
        self.winds = []  # forces on faces: masonry.scene.pressures.FaceForce
        self.views = {}  # direction of sight by part
        self.extra = []  # columns of the user's own

    @property
    def halves(self):
        """Whether some of the bricks are in pieces."""
        return len({b.brick for b in self.bricks}) < len(self.bricks)

    def _inPlane(self):
        sides = {
            tuple(round(f(p[1] for p in b.corners), 9) for f in (min, max))
            for b in self.bricks
        }
        return len(sides) == 1

    def problems(self, materials):
        """What does not go together, with the joints that the options choose: a list of sentences."""
        found = []
        if self.halves and "crack" not in materials.joints:
            found.append(
                "--crack-surfaces on: the bricks are in pieces, and these materials have no joint 'crack' between them; "
                "make whole bricks with halves=False, or choose --crack-surfaces off"
            )
        known = {*KINDS, *materials.units, *materials.stiff}
        strange = {block.kind for block in self.bricks} - known
        if strange and not materials.choose:
            named = ", ".join(map(repr, sorted(strange)))
            found.append(
                f"the materials have nothing for blocks of the kind {named}: materials.withBeam(...) or withFloor(...) says what a beam "
                "or a floor is made of, and units={kind: ...} what other blocks are made of"
            )
        return found

    def connectorsOf(self, kind):
        """Connectors of one class of records, in the order in which they were named."""
        return [one for one in self.connectors if type(one) is kind]

    def settable(self):
        """Ties, springs, fibre layers and the contact by name, which ``--set`` and ``--field`` can change."""
        own = [one for one in self.connectors if not one.overlay]
        contact = [self.contact] if self.contact else []
        return {one.name: one for one in (*own, *self.overlays, *contact)}

    def pointLoaded(self):
        """Indices of the bricks at the ends of ties and springs, and of those on which loads and drives act: a point of a brick that
        deforms would give way without bound where the mesh is fine."""
        ends = [end.brick for one in self.connectors for end in one.ends]
        handles = [t.brick for t in self.targets.values() if t.loaded]
        return {*ends, *handles} - {None}

    def ground(self):
        """The target on which blocks fall in a scene whose collapse is followed, or None."""
        return next((t for t in self.targets.values() if not t.joined), None)

    def followed(self, loaded=None):
        """The target whose displacement is drawn under a load that grows: the first that is watched, else the one on which the load
        is, else the first that moves, or None."""
        moving = [t for t in self.targets.values() if not t.fixed]
        watched = [t for t in moving if not t.loaded]
        return next(iter(watched + [loaded] * bool(loaded) + moving), None)

    def loaded(self):
        """Names of what has loads that grow in a stage."""
        names = [t.name for t in self.targets.values() if t.pressed or t.force]
        return names + ["the faces (pressure)"] * bool(self.winds)

    def add(self, target):
        """Take a target. Its name begins those of its columns. Raises ValueError."""
        if not (isinstance(target.name, str) and target.name.isidentifier()):
            raise ValueError(
                f"the name of a target must be letters, digits and underscores, got {target.name!r}"
            )
        if target.name in self.targets:
            raise ValueError(
                f"there are two targets of the name {target.name!r}; give one of them another name"
            )
        self.targets[target.name] = target
        return target

    def replace(self, one, other):
        """Let a record that a script holds stand for one that was made by the same word again: a target, a recorded joint, a
        section, a tie or springs. Its values become those of the new one."""
        if not hasattr(one, "__dict__"):
            return
        vars(other).clear()
        vars(other).update(vars(one))
        for name, target in self.targets.items():
            if target is one:
                self.targets[name] = other
        for records in (self.joints, self.sections, self.connectors):
            records[:] = [other if record is one else record for record in records]

    def columns(self, structure, looped):
        """The columns of curve.csv: those of the scene's choice, or all. Raises Refused.

        :param structure: that is read
        :param looped: whether the drive follows a history
        """
        found = [*columns.PUSH, *accelerations(structure, self.plane)]
        if any(target.box and not target.fixed for target in self.targets.values()):
            found += columns.OF_PLATEN
        for target in self.targets.values():
            found += target.columns(self.plane)
        for drift in self.drifts:
            found += drift.columns(self.plane)
        for joint in self.joints:
            found += joint.columns()
        for record in (*self.sections, *self.connectors, *self.overlays):
            found += record.columns(self.plane)
        balance = columns.BALANCE + columns.CONNECTORS * bool(self.connectors)
        balance += columns.CONTACTS * bool(self.contact)
        found += [columns.CRACKS, *self.extra, *balance, *columns.HISTORY * looped]
        heads = columns.heads(found)
        twice = sorted({n for n in heads if heads.count(n) > 1})
        if twice:
            raise Refused(f"two columns have the name {', '.join(twice)}")
        if self.choice is None:
            return found
        unknown = [n for n in self.choice if n not in heads]
        if unknown:
            raise Refused(
                f"no column {', '.join(unknown)}; there are {', '.join(heads)}"
            )
        ofBase = [c for one in self.sections if one.isBase for c in one.columns(self.plane)]  # fmt: skip
        always = columns.heads(ofBase + balance + columns.HISTORY)
        chosen = [found[heads.index(n)] for n in self.choice if n not in always]
        return chosen + [c for c in found if c.head in always]

    # -- where bricks are -----------------------------------------------------------------------------------------

    def find(self, where):
        """Index of a brick, and the point by which it is named, or None. Raises ValueError with a sentence like that of a kind of
        :mod:`masonry.common.arguments`."""
        count, point = len(self.bricks), None
        if isinstance(where, Integral) and not isinstance(where, bool):
            if not -count <= where < count:
                raise ValueError(f"{shown(where)}: there are {count} bricks, from 0")
            index = int(where) % count
        elif any(where is block for block in self.bricks):
            index = next(i for i, block in enumerate(self.bricks) if block is where)
        else:
            try:
                point = tuple(float(v) for v in vector()(where))
            except ValueError:
                raise ValueError(
                    f"{shown(where)} must be a brick: its index, a point (x, y, z) [m], or the block itself"
                ) from None
            index = self._nearest(point)
            away, size = self._distance(index, point), self.size(index)
            if away > size:
                raise ValueError(
                    f"{point} m: no brick is near it, the nearest is {away:g} m away"
                )
        return index, point

    def middle(self, index):
        """Mean of the corners of a brick [m]."""
        corners = self.bricks[index].corners
        return tuple(sum(p[i] for p in corners) / len(corners) for i in range(3))

    def size(self, index):
        """Longest side of the box around a brick [m]."""
        corners = self.bricks[index].corners
        return max(max(values) - min(values) for values in zip(*corners))

    def _nearest(self, point):
        if self._boxes is None or self._boxes[0] is not self.bricks:
            corners = [np.asarray(block.corners, float) for block in self.bricks]
            of = lambda f: np.array([f(c, axis=0) for c in corners])
            self._boxes = self.bricks, of(np.min), of(np.max), of(np.mean)
        _, low, high, middle = self._boxes
        away = np.maximum(0, np.maximum(low - point, point - high).max(axis=1))
        return int((away + 1e-6 * np.linalg.norm(middle - point, axis=1)).argmin())

    def _distance(self, index, point):
        """How far a point is from the box around a brick, with a little of the way to its middle to break ties [m]."""
        corners = self.bricks[index].corners
        away = 0.0
        for i in range(3):
            low, high = min(p[i] for p in corners), max(p[i] for p in corners)
            away = max(away, low - point[i], point[i] - high)
        return away + 1e-6 * math.dist(self.middle(index), point)


def accelerations(structure, plane):
    """Columns of the horizontal acceleration that acts on the blocks."""
    scaling = structure.args.density_scaling
    for i, axis in enumerate("x" if plane else "xy"):
        yield columns.Column(
            f"acceleration_{axis}",
            "g",
            f"horizontal acceleration along {axis} that acts on the blocks",
            lambda r, i=i: structure.scheme.now[i] * scaling / GRAVITY,
        )
    yield columns.Column(
        "load_factor",
        "-",
        "factor of the load that a stage put on or let grow last",
        lambda r: structure.loading.loadFactor,
    )
