# SPDX-License-Identifier: GPL-2.0-or-later
"""What a horizontal section of a structure transmits: normal force, shear force and moment, from
its joints, ties and springs.

The free body is that of all blocks, platens too, whose centroid was above the height z when the
scene was built. The joints, ties and springs between it and the other blocks and the ground
transmit all that acts between both, so their resultant is exact statics in any bond, also where the
section goes in steps. At rest it is the weight of these blocks and the loads on them.
"""

from dataclasses import dataclass

from yade import O, Vector3

from .._masonry import resultant
from ..numbers.columns import Column
from ..errors import Refused
from .ties import GROUND

BASE = "base"  # name of the section that every run on a platen records
ENDS = "N", "V_x", "V_y", "M_x", "M_y"  # of names of columns
LEVEL = 1e-9  # of the height of a structure: centroids so near to z do not lie above it


@dataclass
class Section:
    """A horizontal section whose forces are recorded. ``scene.section`` makes it; it can be read
    between stages.

    :param part: name of a part of the bricks; None: all
    :param middle: point about which moments are, fixed in space [m]
    :param isBase: whether nobody said it: the base, which every run records
    """

    name: str
    z: float  # [m]
    part: str
    middle: tuple
    isBase: bool = False
    interactions: tuple | list = ()  # YADE's, of its joints, when the scene is built
    _read: tuple = (None, None)  # the last reading, and what was found then

    def join(self, structure):
        """Find its joints in a structure that stands in YADE. Raises Refused if there are none.

        :param structure: :class:`masonry.model.structure.Structure`
        """
        description = structure.description
        size = description.high[2] - description.low[2]
        level = self.z + LEVEL * (size + abs(self.z))
        #: whether every body is above it, by its id; the ground is not
        self.above = {b.id: b.state.refPos[2] > level for b in O.bodies} | {GROUND: False}
        self._structure = structure
        self._parts = dict(zip(structure.ids, (b.part for b in description.bricks)))
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
                f"section {self.name}: no joint{what} crosses z = {self.z:g} m: there must be one"
                " between a block whose centroid is above and one whose centroid is below"
            )

    def _cross(self, one, other):
        """Whether what joins two bodies is a part of it: one is above, the other is not."""
        if self.above[one] == self.above[other]:
            return False
        lower, upper = (one, other) if self.above[other] else (other, one)
        # a joint to a platen is of the part of its brick
        return self.part in (None, self._parts.get(upper, self._parts.get(lower)))

    def forces(self):
        """Force [N] and moment about the middle [N m] of what is above on what is below, in global
        axes: two vectors."""
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

    def columns(self, plane):
        """What is recorded of it; see :meth:`masonry.scene.scene.Scene.section` for the signs.

        :param plane: whether the scene moves in the x-z plane only
        """
        at = f"the section at z = {self.z:g} m{f' of part {self.part}' if self.part else ''}"
        about = "({})".format(", ".join(f"{v:g}" for v in self.middle))
        yield self._column(0, 2, "N", "kN", f"normal force on {at}, positive in tension")
        for i, axis in enumerate("x" if plane else "xy"):
            meaning = f"shear force on {at}: of what is above on what is below, along {axis}"
            yield self._column(0, i, f"V_{axis}", "kN", meaning)
        for axis, side in (("y", "large x"), ("x", "small y"))[: 1 if plane else 2]:
            meaning = (
                f"moment on {at}: of what is above on what is below, about {axis} through {about} m"
                f" by the right-hand rule, so that it presses the side of {side} where it is"
                " positive"
            )
            yield self._column(1, "xy".index(axis), f"M_{axis}", "kNm", meaning)

    def _column(self, which, axis, name, unit, meaning):
        def value(reading):
            if self._read[0] is not reading:
                self._read = reading, self.forces()
            return 1e-3 * self._read[1][which][axis]

        return Column(f"{self.name}_{name}", unit, meaning, value)
