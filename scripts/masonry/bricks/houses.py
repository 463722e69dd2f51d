# SPDX-License-Identifier: GPL-2.0-or-later
"""Houses of several storeys, with floors and ring beams."""

from dataclasses import dataclass, replace
from typing import Annotated, Any, Sequence

from ..arguments import isA, isNumber, items, listOf, number, oneOf, shown, validated, whole
from ..units import GRAVITY
from .beams import Beam, Floor
from .blocks import Block, Bricks, Gap, Length, Sides, refuse
from .geometry import boxCorners
from .openings import WHOLE
from .walls import UNIT, Openings, Room

SIDES = "front", "right", "back", "left"


@validated
@dataclass(frozen=True)
class Storey:
    """A storey of a :func:`House`: four walls, a ring beam, and the floor on top.

    :param height: of the walls [m]; whole courses
    :param front: openings of this wall, as ``right``, ``back`` and ``left``: see :func:`Room`
    :param span: direction of the span of its floor, ``"x"`` or ``"y"``
    :param ring: height of a ring beam on the walls [m]; 0: none
    """

    height: Length
    front: Openings = ()
    right: Openings = ()
    back: Openings = ()
    left: Openings = ()
    span: Annotated[str, oneOf("x", "y")] = "x"
    ring: Gap = 0.0


class House(Bricks):
    """A house of one room on each storey, with interlocking corners, ring beams and floors.

    ::

        door = bricks.Opening(1.8, 0, 1.2, 1.8, bricks.Lintel(0.3, 0.3))
        storeys = [bricks.Storey(2.4, front=[door]), bricks.Storey(2.4, span="y", ring=0.3)]
        house = bricks.House(4.8, 3.6, storeys, unit=(0.6, 0.3, 0.3))
        house.withFloors(stones, shear=1e6, mass=300)

    Parts are ``front 1``, ``floor 1``, ``ring 1`` and so on, by storeys from 1. What stands between
    the openings of a wall, at the heights at which all of them are open, is a part of its own:
    ``front 1 pier 1`` and so on, from the origin. Floors lie on the walls or ring beams, and carry
    the next storey.

    :param length: along x, measured outside [m]; ``width``: along y. Both are whole units
    :param storeys: from below
    :param unit: length, thickness and height of a unit, joints included [m]
    :param thickness: of the floors [m]
    :param eccentricity: of the mass of each floor over length and width [-], 0.05 in EN 1998-1: a
        part of the mass stands as a strip on the floor, along the wall
    :ivar heights: of the section through the piers of each storey [m]
    :ivar piers: for each storey a dict from the part to (wall, from where, to where along it [m])
    """

    @validated
    def __init__(
        self,
        length: Length,
        width: Length,
        storeys: Annotated[Sequence[Storey], listOf(isA(Storey, "bricks.Storey"))],
        unit: Sides = UNIT,
        thickness: Length = 0.2,
        eccentricity: Annotated[Any, listOf(number("", -0.2, 0.2), 2)] = (0.0, 0.0),
    ) -> None:
        self.size, self.thick = (length, width), unit[1]
        self.heights, self.piers, self.eccentricity = [], [], tuple(eccentricity)
        blocks, z = Bricks(), 0.0
        for n, storey in enumerate(storeys, 1):
            openings = {side: getattr(storey, side) for side in SIDES}
            walls = Room(length, width, storey.height, unit, halves=False, **openings)
            blocks += self._named(walls.moved(0, 0, z), storey, n, z)
            z += storey.height
            if storey.ring:
                blocks += self._ring(n, z, storey.ring, unit)
                z += storey.ring
            across = width if storey.span == "x" else length
            span = length + width - across
            blocks += Floor(
                (0, 0, z),
                span,
                across,
                thickness,
                storey.span,
                max(2, round(across / unit[1])),
                f"floor {n}",
            )
            z += thickness
            blocks += self._ballast(n, z)
        super().__init__(blocks)

    def _named(self, walls, storey, n, z):
        openings = [o for side in SIDES for o in getattr(storey, side)]
        low = max((o.z for o in openings), default=0.0) + z
        high = min((o.z + o.height for o in openings), default=storey.height) + z
        if not low < high:
            refuse(
                "House",
                [f"storey {n}: no height is common to all its openings, so it has no piers there"],
            )
        between = walls.where(lambda block: low < block.middle[2] < high)
        courses = {block.middle[2] for block in between}
        course = min(courses, key=lambda at: abs(at - (low + high) / 2))
        self.heights.append(course - walls[0].high[2] / 2 + walls[0].low[2] / 2)
        piers = {}
        for side in SIDES:
            axis = SIDES.index(side) % 2
            found = []
            for a, b in sorted((b.low[axis], b.high[axis]) for b in between if b.part == side):
                if found and a <= found[-1][1] + WHOLE:
                    a, b = found[-1][0], max(b, found.pop()[1])
                found.append((a, b))
            for k, ends in enumerate(found, 1):
                piers[f"{side} {n}" + f" pier {k}" * (len(found) > 1)] = side, *ends
        self.piers.append(piers)

        def part(block):
            if not low < block.middle[2] < high:
                return f"{block.part} {n}"
            at = block.middle[SIDES.index(block.part) % 2]
            return next(
                name for name, (side, a, b) in piers.items() if side == block.part and a <= at <= b
            )

        return Bricks(replace(block, part=part(block)) for block in walls)

    def _ring(self, n, z, height, unit):
        (length, width), thick = self.size, self.thick
        rows = [(0, y, length, "x") for y in (0, width - thick)]
        rows += [(x, thick, width - 2 * thick, "y") for x in (0, length - thick)]
        return sum(
            Beam((x, y, z), long, thick, height, along, max(2, round(long / unit[0])), f"ring {n}")
            for x, y, long, along in rows
        )

    def _ballast(self, n, z):
        """Strips along the walls to which the mass of a floor is moved."""
        found, thick = Bricks(), self.thick
        for axis, share in enumerate(self.eccentricity):
            if share:
                low, high = [thick, thick, z], [a - thick for a in self.size] + [z + thick]
                if axis:  # both strips have space
                    low[0], high[0] = 2 * thick, self.size[0] - 2 * thick
                if share < 0:
                    high[axis] = 2 * thick
                else:
                    low[axis] = high[axis] - thick
                name = f"ballast {n}{'xy'[axis]}"
                found += Bricks([Block(boxCorners(low, high), 0, name, -1, name)])
        return found

    def part(self, name: str) -> Bricks:
        return self.where(lambda block: block.part == name)

    def withFloors(
        self, masonry: Any, shear: float, mass: Any, bearing: Any = "fixed", ring: float = 30e9
    ) -> Any:
        """Add the materials of floors and ring beams to the :class:`masonry.materials.Masonry`, and
        return it.

        :param shear: shear stiffness G t of the floors [N/m]
        :param mass: with live loads [kg/m²], of every floor from below, or one for all
        :param bearing: of the floors, as for ``withFloor``
        :param ring: Young's modulus of ring beams [Pa]; their density is 2400 kg/m³
        """
        masses = [mass] * len(self.piers) if isNumber(mass) else items(mass)
        if masses is None or len(masses) != len(self.piers):
            refuse(
                "withFloors",
                [
                    f"mass {shown(mass)} must be a number, or one for each of the"
                    f" {len(self.piers)} floors"
                ],
            )
        for n, own in enumerate(masses, 1):
            if len(beams := self.part(f"ring {n}")):
                masonry.withBeam(beams, young=ring, density=2400, bearing="fixed")
            moved = 0.0
            for axis, share in enumerate(self.eccentricity):
                if share:
                    (strip,) = ballast = self.part(f"ballast {n}{'xy'[axis]}")
                    lever = abs(strip.middle[axis] - self.size[axis] / 2)
                    part = abs(share) * self.size[axis] / lever
                    moved += part
                    density = part * own * self.size[0] * self.size[1] / ballast.volume
                    masonry.units[strip.kind] = type(masonry.unit)(
                        label=strip.kind, young=masonry.unit.young, density=density
                    )
            masonry.withFloor(
                self.part(f"floor {n}"), shear=shear, mass=own * (1 - moved), bearing=bearing
            )
        return masonry

    @validated
    def weights(self, masonry: Any, storey: Annotated[int, whole(1)] = 1) -> dict[str, float]:
        """Weight on each pier of a storey as by hand [kN]: of all above the section through the
        piers that is nearer to a pier than to the next one of its wall, and of half of each strip
        of a floor at either end, which carries its ballast as a beam."""
        if storey > len(self.piers):
            refuse("weights", [f"storey {storey} must be at most {len(self.piers)}"])
        piers, z = self.piers[storey - 1], self.heights[storey - 1]
        found = dict.fromkeys(piers, 0.0)

        def carry(side, at, weight):
            off = lambda name: max(piers[name][1] - at, at - piers[name][2])
            found[min((name for name in piers if piers[name][0] == side), key=off)] += weight

        for block, volume in zip(self, self._solids.volumes()):
            if block.middle[2] < z:
                continue
            unit = masonry.units.get(block.kind, masonry.unit)
            weight = float(unit.density * volume * GRAVITY / 1e3)
            x, y, _ = block.middle
            if block.part.startswith(("floor", "ballast")):
                strips = self.part(f"floor {block.part.split()[1].strip('xy')}")
                axis = int(strips[:1].length < strips[0].high[1] - strips[0].low[1])
                share, across = block.middle[axis] / self.size[axis], 1 - axis
                over = [
                    s.middle[across]
                    for s in strips
                    if block.low[across] < s.middle[across] < block.high[across]
                ]
                over = over or [block.middle[across]]
                for at in over:
                    carry(("left", "front")[axis], at, weight * (1 - share) / len(over))
                    carry(("right", "back")[axis], at, weight * share / len(over))
                continue
            side = block.part.split()[0]
            if side not in SIDES:  # a ring beam
                away = {"front": y, "right": self.size[0] - x, "back": self.size[1] - y, "left": x}
                side = min(away, key=away.get)
            carry(side, (x, y)[SIDES.index(side) % 2], weight)
        return found
