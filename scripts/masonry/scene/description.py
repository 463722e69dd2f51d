# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene describes before its first stage: its bricks, and what holds, loads and records
them. :class:`masonry.model.structure.Structure` builds that in YADE."""

from numbers import Integral

import numpy as np

from ..arguments import ByName, shown, vector
from ..numbers import columns
from ..units import GRAVITY
from ..errors import Refused
from ..bricks.blocks import KINDS, Bricks
from .contact import Contact


class Description:
    """Bricks, materials and everything that a scene says before its first stage. Parameters are
    those of :class:`masonry.scene.scene.Scene`, which checks them."""

    def __init__(
        self,
        name,
        bricks,
        materials,
        title,
        plane,
        gravity,
        choice,
        functors,
        allowGaps,
        collapse,
    ):
        self.bricks = bricks
        self.name, self.title = name, title or name
        self.materials, self.gravity = materials, gravity  # [m/s²], downwards
        self.functors = functors  # as in masonry.model.engines.engines
        self.deformable = False  # bricks
        self.allowGaps = allowGaps  # as in masonry.model.connecting.connect
        #: Contact of blocks that have lost their joints, if a collapse is followed, else None.
        self.contact = Contact() if collapse == "follow" else None
        points = [p for block in self.bricks for p in block.corners]
        #: corners of the box around all bricks [m]
        self.low, self.high = ([*map(f, zip(*points))] for f in (min, max))
        y = [[round(p[1], 9) for p in block.corners] for block in bricks]
        inPlane = len({(min(one), max(one)) for one in y}) == 1
        self.plane = inPlane if plane is None else plane
        self.choice = choice  # heads of columns, None: all
        self.targets = ByName("target")
        self._boxes = None, None  # bricks, and what _nearest() knows of them
        self.joints, self.drifts, self.sections = [], [], []  # that are recorded
        self.piers = []  # and spandrels, entries of run.json
        self.connectors = []  # ties and springs, records of masonry.scene.ties
        self.overlays = []
        #: springs that stand for a soil without tension where periods are estimated
        self.soils = []
        self.winds = []  # forces on faces: masonry.scene.pressures.FaceForce
        self.views = {}  # direction of sight by part
        self.extra = []  # columns of the user's own

    @property
    def halves(self):
        """Whether some of the bricks are in pieces."""
        return len({b.brick for b in self.bricks}) < len(self.bricks)

    def problems(self, materials):
        found = []
        if self.halves and "crack" not in materials.joints:
            found.append(
                "--crack-surfaces on: the bricks are in pieces, and these materials have no joint"
                " 'crack' between them; make whole bricks with halves=False, or choose"
                " --crack-surfaces off"
            )
        known = {*KINDS, *materials.units, *materials.stiff}
        strange = {block.kind for block in self.bricks} - known
        if strange and not materials.choose:
            named = ", ".join(map(repr, sorted(strange)))
            found.append(
                f"the materials have nothing for blocks of the kind {named}:"
                " materials.withBeam(...) or withFloor(...) says what a beam or a floor is made"
                " of, and units={kind: ...} what other blocks are made of"
            )
        return found

    def connectorsOf(self, kind):
        return [one for one in self.connectors if type(one) is kind]

    def settable(self, copies=False):
        """What ``--set`` and ``--field`` can change beside joints, by name, or copies of it: ties,
        springs, fibre layers and the contact."""
        own = [one for one in self.connectors if not one.overlay] + self.overlays
        own += [self.contact] * bool(self.contact)
        return {one.name: one.copied() if copies else one for one in own}

    def pointLoaded(self):
        """Indices of the bricks on which ties, springs, loads and drives act. They are rigid, since
        a point of a fine mesh would give way without bound."""
        ends = [end.brick for one in self.connectors for end in one.ends]
        handles = [t.brick for t in self.targets.values() if t.loaded]
        return {*ends, *handles} - {None}

    def ground(self):
        """The target on which blocks fall in a scene whose collapse is followed, or None."""
        return next((t for t in self.targets.values() if not (t.joined or t.line)), None)

    def followed(self, loaded=None):
        """The target whose displacement is drawn under a load that grows, or None: the first that
        is watched, else the loaded one, else the first that moves."""
        moving = [t for t in self.targets.values() if not t.fixed]
        watched = [t for t in moving if not t.loaded]
        return next(iter(watched + [loaded] * bool(loaded) + moving), None)

    def loaded(self):
        """Names of what has loads that grow in a stage."""
        names = [t.name for t in self.targets.values() if t.pressed or t.force]
        return names + ["the faces (pressure)"] * bool(self.winds)

    def add(self, target):
        """Take a target. Raises ValueError if its name is taken."""
        if target.name in self.targets:
            raise Refused(
                f"there are two targets of the name {target.name!r}; give one of them another name"
            )
        self.targets[target.name] = target
        return target

    def replace(self, one, other):
        """Let a record ``other`` that a script holds take the values and the place of one that the
        same command has made again."""
        if not hasattr(one, "__dict__"):
            return
        vars(other).clear()
        vars(other).update(vars(one))
        for name, target in self.targets.items():
            if target is one:
                self.targets[name] = other
        for end in (end for connector in self.connectors for end in connector.ends):
            end.target = other if end.target is one else end.target
        for records in (self.joints, self.sections, self.connectors):
            records[:] = [other if record is one else record for record in records]

    def columns(self, structure, looped):
        """The columns of curve.csv: those of the scene's choice, or all. Raises Refused.

        :param looped: whether the drive follows a history
        """
        found = [*columns.PUSH, *accelerations(structure, self.plane)]
        if any(target.box and not target.fixed for target in self.targets.values()):
            found += columns.OF_PLATEN
        for one in (*self.targets.values(), *self.drifts):
            found += one.columns(self.plane)
        for joint in self.joints:
            found += joint.columns(self.plane)
        for one in (*self.sections, *self.connectors, *self.overlays):
            found += one.columns(self.plane)
        machines = any(target.isInMachine for target in self.targets.values())
        balance = columns.BALANCE + columns.CONNECTORS * bool(self.connectors or machines)
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
            raise Refused(f"no column {', '.join(unknown)}; there are {', '.join(heads)}")
        ofBase = [c for one in self.sections if one.isBase for c in one.columns(self.plane)]
        always = columns.heads(ofBase + balance + columns.HISTORY)
        chosen = [found[heads.index(n)] for n in self.choice if n not in always]
        return chosen + [c for c in found if c.head in always]

    def find(self, where):
        """Index of a brick, and the point by which it is named, or None. Raises ValueError like a
        validator."""
        count = len(self.bricks)
        if isinstance(where, Integral) and not isinstance(where, bool):
            if not -count <= where < count:
                raise Refused(f"{shown(where)}: there are {count} bricks, from 0")
            return int(where) % count, None
        for index, block in enumerate(self.bricks):
            if block is where:
                return index, None
        try:
            point = tuple(float(v) for v in vector()(where))
        except ValueError:
            raise Refused(
                f"{shown(where)} must be a brick: its index, a point (x, y, z) [m], or the block"
                " itself"
            ) from None
        index, away = self._nearest(point)
        if away > self.size(index):
            raise Refused(f"{point} m: no brick is near it, the nearest is {away:g} m away")
        return index, point

    def alongLine(self, begin, end):
        """As :meth:`masonry.bricks.Bricks.alongLine`."""
        return Bricks(self.bricks).alongLine(begin, end)

    def middle(self, index):
        """Mean of the corners of a brick [m]."""
        corners = self.bricks[index].corners
        return tuple(sum(p[i] for p in corners) / len(corners) for i in range(3))

    def size(self, index):
        """Longest side of the box around a brick [m]."""
        corners = self.bricks[index].corners
        return max(max(values) - min(values) for values in zip(*corners))

    def _nearest(self, point):
        """The brick whose box is nearest to a point, and its distance [m]; among boxes that contain
        the point, the one with the nearest middle, and of two that are alike the lower one, or that
        of the lower x, then y."""
        if self._boxes[0] is not self.bricks:
            corners = [np.asarray(block.corners, float) for block in self.bricks]
            boxes = [np.array([f(c, axis=0) for c in corners]) for f in (np.min, np.max, np.mean)]
            self._boxes = self.bricks, boxes
        low, high, middle = self._boxes[1]
        away = np.maximum(0, np.maximum(low - point, point - high).max(axis=1))
        away += 1e-6 * np.linalg.norm(middle - point, axis=1)
        alike = np.flatnonzero(away <= away.min() + 1e-12 * (1 + np.abs(point).max()))
        place = lambda n: [*np.round(middle[n], 9)[[2, 0, 1]]]
        return int(min(alike, key=place)), away.min()


def accelerations(structure, plane):
    scaling = structure.args.density_scaling
    for i, axis in enumerate("x" if plane else "xy"):
        value = lambda r, i=i: structure.scheme.now[i] * scaling / GRAVITY
        meaning = f"horizontal acceleration along {axis} that acts on the blocks"
        yield columns.Column(f"acceleration_{axis}", "g", meaning, value)
    meaning = "factor of the load that a stage put on or let grow last"
    yield columns.Column("load_factor", "-", meaning, lambda r: structure.loading.loadFactor)
