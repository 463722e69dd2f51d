# SPDX-License-Identifier: GPL-2.0-or-later
"""What a horizontal section of a structure transmits: normal force, shear force and moment, from its joints, ties and springs.

The free body is that of all blocks, platens too, whose centroid was above the height z when the scene was built. The
joints, ties and springs between it and the other blocks and the ground transmit all that acts between both, so their resultant is exact statics in any
bond, also where the section goes in steps. At rest it is the weight of these blocks and the loads on them.
"""

from dataclasses import dataclass, field

from yade import O, Vector3

from .._masonry import resultant
from ..assembly.columns import Column
from ..basics import Refused

BASE = "base"  # name of the section that every run on a platen records
ENDS = "N", "V_x", "V_y", "M_x", "M_y"  # of names of columns
LEVEL = 1e-9  # of the height of a structure: centroids so near to z do not lie above it


@dataclass
class Section:
    """A horizontal section whose forces are recorded. ``scene.section`` makes it; it can be read between stages.

    :param part: name of a part of the bricks; None: all
    :param middle: point about which moments are, fixed in space [m]
    """

    name: str
    z: float  # [m]
    part: str
    middle: tuple
    # YADE's, of its joints, when the scene is built
    interactions: list = field(default_factory=list)
    # of each: 1 if its first body is the lower one, else -1
    signs: list = field(default_factory=list)
    # ties and springs that cross it, each with its upper end
    connections: list = field(default_factory=list)
    # whether every body is above it, by its id, where a collapse is followed
    above: dict = field(default_factory=dict)
    isBase: bool = False  # whether nobody said it: the base, which every run records
    _structure: object = None
    _parts: dict = field(default_factory=dict)  # of the blocks, by their bodies
    _read: tuple = (None, None)  # the last reading, and what was found then

    def join(self, structure):
        """Find its joints in a structure that stands in YADE. Raises Refused if there are none.

        :param structure: :class:`masonry.assembly.structure.Structure`
        """
        description = structure.description
        size = description.high[2] - description.low[2]
        level = self.z + LEVEL * (size + abs(self.z))
        parts = dict(zip(structure.ids, (b.part for b in description.bricks)))
        self.interactions, self.signs = [], []
        for one in structure.interactions:
            ids = one.id1, one.id2
            above = [O.bodies[body].state.refPos[2] > level for body in ids]
            if above[0] == above[1]:
                continue
            lower, upper = ids if above[1] else ids[::-1]
            # a joint to a platen is of the part of its brick
            if self.part in (None, parts.get(upper, parts.get(lower))):
                self.interactions.append(one)
                self.signs.append(1 if above[1] else -1)
        self._structure, self.connections, self.above = structure, [], {}
        if structure.contacts:
            self.above = {b.id: b.state.refPos[2] > level for b in O.bodies}
            self._parts = parts
        for one in description.connectors:
            bodies = [end.bodyIn(structure.ids) for end in one.ends]
            above = [body >= 0 and O.bodies[body].state.refPos[2] > level for body in bodies]  # fmt: skip
            if above[0] != above[1]:
                upper, lower = bodies if above[0] else bodies[::-1]
                if self.part in (None, parts.get(upper, parts.get(lower))):
                    self.connections.append((one, one.ends[0 if above[0] else 1]))
        if not self.interactions:
            what = f" of part {self.part!r}" if self.part else ""
            raise Refused(
                f"section {self.name}: no joint{what} crosses z = {self.z:g} m: there must be one between a block whose "
                "centroid is above and one whose centroid is below"
            )

    def forces(self):
        """Force [N] and moment about the middle [N m] of what is above on what is below, in global axes: two vectors."""
        if not self.interactions:
            raise ValueError(f"section {self.name}: the scene is not built yet")
        force, moment = resultant(self.interactions, self.signs, self.middle)
        for one, upper in self.connections:
            force, moment = self._with(force, moment, one, upper)
        if self.above:
            force, moment = self._withContacts(force, moment)
        return force, moment

    def _withContacts(self, force, moment):
        """Force and moment with those of contacts of blocks above with blocks below, wherever these lie now."""
        for one, other, on, turning in self._structure.contacts.pairs():
            if self.above[one] == self.above[other]:
                continue
            lower, upper = (one, other) if self.above[other] else (other, one)
            if self.part not in (None, self._parts.get(upper, self._parts.get(lower))):
                continue
            # `on` and `turning` act on the second body of the pair, about its centre
            sign = 1 if lower == other else -1
            arm = O.bodies[other].state.pos - Vector3(*self.middle)
            force, moment = force + sign * on, moment + sign * (arm.cross(on) + turning)
        return force, moment

    def _with(self, force, moment, one, upper):
        """Force and moment with those of a tie or a spring, whose upper end is given."""
        on, turning = one.on(upper, self._structure.connectors)
        arm = self._structure.connectors.placeOf(upper) - Vector3(*self.middle)
        return force - on, moment - arm.cross(on) - turning

    def _of(self, reading):
        if self._read[0] is not reading:
            self._read = reading, self.forces()
        return self._read[1]

    def columns(self, plane):
        """What is recorded of it; see :meth:`masonry.scene.scene.Scene.section` for the signs.

        :param plane: whether the scene moves in the x-z plane only
        """
        of = f" of part {self.part}" if self.part else ""
        at = f"the section at z = {self.z:g} m{of}"
        about = "({})".format(", ".join(f"{v:g}" for v in self.middle))
        yield self._column(
            "N", "kN", f"normal force on {at}, positive in tension", 0, 2
        )
        for i, axis in enumerate("x" if plane else "xy"):
            meaning = (
                f"shear force on {at}: of what is above on what is below, along {axis}"
            )
            yield self._column(f"V_{axis}", "kN", meaning, 0, i)
        for i, axis, side in ((1, "y", "large x"), (0, "x", "small y")):
            if plane and axis == "x":
                continue
            meaning = (
                f"moment on {at}: of what is above on what is below, about {axis} through {about} m by the right-hand "
                f"rule, so that it presses the side of {side} where it is positive"
            )
            yield self._column(f"M_{axis}", "kNm", meaning, 1, i)

    def _column(self, name, unit, meaning, which, axis):
        value = lambda r: 1e-3 * self._of(r)[which][axis]
        return Column(f"{self.name}_{name}", unit, meaning, value)
