# SPDX-License-Identifier: GPL-2.0-or-later
"""From what a surveyor knows of a stone wall to its blocks and joints, by published rules;
README.md tells them in words.

Nothing here reads what was measured in the tests: :func:`read` leaves those columns to results.py.
"""

import csv
import math
import os
from dataclasses import dataclass, replace
from random import Random
from statistics import NormalDist

from masonry.materials.codes import BOND, FRICTION, LOCAL_FRICTION
from masonry.materials.codes import OTHERS, SHEAR, ntc2018

HERE = os.path.dirname(os.path.abspath(__file__))
WALLS = os.path.join(HERE, "reference", "walls.csv")

WEIGHT = 20e3  # of masonry, as the database counts it [N/m³]
GRAVITY = 9.81  # [m/s²]
SAMPLES = 6  # draws of the interval of a wall, beside two best estimates
LOWEST = (
    0.01  # least height of the force of a drive above a wall, the thickness of what it pushes [m]
)
POINTS = ("8", "5", "12")  # along a joint, by turns

#: Rows of table C8.5.I of Circolare 2019 by typology, and what their mean values say; E1 is E
#: without mortar.
ROWS = dict(
    A="rubble", B="roughly cut stone", C="split stone", D="squared soft stone", E="squared stone"
)
TABLE = {kind: ntc2018(row, "LC2", confidence=1) for kind, row in ROWS.items()}
TABLE["E1"] = {**TABLE["E"], "fv0": 0.0}

#: Mean cohesion of general purpose mortar, JCSS Probabilistic Model Code, part 3.2: from a strength
#: [MPa] on [Pa].
JCSS = ((20.0, 0.42e6), (10.0, 0.37e6), (5.0, 0.28e6), (2.5, 0.14e6), (0.0, 0.04e6))
#: Dry joints of sawn granite: their stiffness where they begin to close [Pa/m] and the most that
#: they close [m], fitted to the moduli of walls at three stresses
#: (validation/dry_joint_walls/README.md, What was fixed beforehand). Poisson's ratio of stone [-].
CLOSING_STIFFNESS, CLOSURE, POISSON = 17.8e9, 0.136e-3, 0.2
STIFFER = 20.0  # least modulus of stones, which are rigid, over that of the masonry [-]
TOUGH = 1.2  # least energy of crushing over that up to the peak [-]
STONE_TENSION = 0.1  # tensile over compressive strength of a soft stone [-]

#: Coefficients of variation, JCSS Probabilistic Model Code, part 3.2; of E and of fc where only a
#: table or a few prisms speak.
SCATTER = dict(friction=0.19, bond=0.40, stiffness=0.30, strength=0.20)
#: What a length and a height of stones that nobody wrote down may be, over the assumed ones [-].
UNKNOWN_SIZE = 0.7, 1.4
#: Line of minimum trace of rubble and uncut stone where none was measured, that of the other such
#: walls of the database [-].
TRACE = {"A": 1.1, "B": 1.1}
#: Assumed sizes of such stones by typology: length and height [m].
SIZES = {
    "A": (0.25, 0.15),
    "B": (0.25, 0.15),
    "C": (0.25, 0.15),
    "D": (0.30, 0.15),
    "E": (0.30, 0.15),
}


def _byMortar(row, table):
    """A value by the strength of the mortar; mortar of unknown strength counts as the weakest."""
    return 0.0 if row.dry else next(c for least, c in table if (row.mortar or 0.0) >= least)


#: Cohesion [Pa] and friction [-] of joints, functions of a row by the name of a rule: OTHERS is of
#: natural stone in general purpose mortar, and mortar without a known strength counts as air lime.
BONDS = {
    "en1996": lambda row: (_byMortar(row, OTHERS) / SHEAR, FRICTION / SHEAR),
    "ntc2018": lambda row: (TABLE[row.typology]["fv0"], LOCAL_FRICTION),
    "stone": lambda row: (_byMortar(row, OTHERS) / SHEAR, 0.65),
    "jcss": lambda row: (_byMortar(row, JCSS), 0.8),
}
#: Young's modulus over that of a compression test, by the name of a rule [-].
STIFFNESSES = {"tested": 1.0, "cracked": 0.5}
#: The rules that were chosen with the walls whose results are given.
CHOSEN = "ntc2018", "cracked"


@dataclass(frozen=True)
class Row:
    """A wall as the database describes it, in SI units; None: unknown."""

    number: str
    campaign: str
    name: str
    typology: str
    dry: bool
    length: float
    height: float
    thickness: float
    arm: float  # height of zero moment above the base, of a cantilever that of the force
    clamped: bool  # whether the top cannot turn
    fc: float
    E: float | None
    stone: tuple | None  # length and height of a stone
    fb: float | None  # strength of the stone
    Eb: float | None
    mortar: float | None  # strength of the mortar [MPa]
    force: float  # vertical force at the base [N]
    level: bool  # whether the bed joints are horizontal
    trace: float | None  # line of minimum trace over a metre [-]
    cyclic: bool


def _number(text, factor=1.0):
    """The value of a cell, the middle of a range; None if it is empty."""
    parts = [float(p) for p in text.split("-") if p]
    return factor * sum(parts) / len(parts) if parts else None


def _row(cells):
    get = lambda name, factor=1.0: _number(cells[name], factor)
    height, stone = get("hb [mm]", 1e-3), get("lb [mm]", 1e-3)
    trace = get("LMTvert [mm]", 1e-3)
    return Row(
        cells["ID"],
        cells["Reference"],
        cells["Test unit name"],
        cells["Stone masonry typology"],
        cells["Joints"] == "Dry",
        get("L [mm]", 1e-3),
        get("H [mm]", 1e-3),
        get("t [mm]", 1e-3),
        max(get("H0 [mm]", 1e-3), get("H [mm]", 1e-3) + LOWEST),
        get("H0/H") < 0.75,
        get("fc [MPa]", 1e6),
        get("Ecompr [MPa]", 1e6),
        (stone, height) if stone and height else None,
        get("fc,b [MPa]", 1e6),
        get("Eb [MPa]", 1e6),
        get("fc,m  [MPa]"),
        get("Ntot [kN]", 1e3),
        cells["HC"] == "R" or not cells["HC"] and cells["Stone masonry typology"] in "DE1",
        trace or TRACE.get(cells["Stone masonry typology"]),  # 0 stands for unknown
        cells["Cyclic / Monotonic"] == "Cyclic",
    )


#: Numbers of the walls whose results are given, and of those whose results are kept back.
KNOWN = [str(n) for n in (*range(1, 25), *range(47, 52), *range(99, 103), *range(118, 124))]
BLIND = [
    str(n)
    for n in (
        *range(25, 29),
        *range(33, 37),
        *range(69, 73),
        *range(80, 99),
        *range(103, 117),
        *range(124, 136),
    )
]


def read():
    """The walls by their number: dict of :class:`Row`."""
    with open(WALLS, encoding="utf-8-sig", newline="") as f:
        return {cells["ID"]: _row(cells) for cells in csv.DictReader(f)}


def twins(numbers):
    """Walls that no surveyor could tell apart have one run: dict from the number of the first to
    the numbers of all."""
    rows, found = read(), {}
    for number in numbers:
        own = rows[number]
        bonds = tuple(bond(own) for bond in BONDS.values())
        key = replace(own, number="", name="", cyclic=False, mortar=None), bonds
        found.setdefault(key, []).append(number)
    return {same[0]: same for same in found.values()}


class Guess:
    """Blocks, joints and load of a wall: a best estimate, or one of the draws of its interval.

    :param row: :class:`Row`
    :param bond: key of :data:`BONDS`
    :param stiffness: key of :data:`STIFFNESSES`
    :param sample: 0 and 1 are best estimates, pushed to the right and to the left, with two draws
        of the stones; 2 to SAMPLES + 1 a Latin hypercube of what is not known
    """

    def __init__(self, row, bond, stiffness, sample):
        self.row, self.sample = row, sample
        self.points = POINTS[sample % len(POINTS)]
        self.factors = {name: self._factor(name) for name in SCATTER}
        self.cohesion, self.friction = BONDS[bond](row)
        self.cohesion *= self.factors["bond"]
        self.friction *= self.factors["friction"]
        self.fc = row.fc * self.factors["strength"]
        self.E = (row.E or TABLE[row.typology]["E"]) * self.factors["stiffness"]
        self.E *= STIFFNESSES[stiffness]
        self.pressure = row.force / (row.length * row.thickness) - WEIGHT * row.height
        long, high = row.stone or SIZES[row.typology]
        size = 1.0
        if not row.stone and self.drawn:
            low, most = map(math.log, UNKNOWN_SIZE)
            size = math.exp(low + (most - low) * self._share("size"))
        courses = max(round(row.height / (size * high)), 1)
        self.stone = min(size * long, row.length), row.height / courses

    @property
    def drawn(self):
        return self.sample > 1

    def _share(self, what):
        """Where a draw lies between 0 and 1, one in every interval of 1 / SAMPLES."""
        draw = Random(f"{self.row.number} {what}")
        order = draw.sample(range(SAMPLES), SAMPLES)
        within = [draw.random() for _ in order]
        n = self.sample - 2
        return (order[n] + within[n]) / SAMPLES

    def _factor(self, what):
        """A lognormal factor of median 1."""
        if not self.drawn:
            return 1.0
        spread = math.sqrt(math.log1p(SCATTER[what] ** 2))
        return math.exp(spread * NormalDist().inv_cdf(self._share(what)))

    def bricks(self, bricks):
        """The stones.

        :param bricks: :mod:`masonry.bricks`
        """
        row, (long, high) = self.row, self.stone
        unit = (long, row.thickness, high)
        if row.typology == "D":  # soft stone is sawn to size, and cracks
            half = row.length / max(round(2 * row.length / long), 2)
            return bricks.Wall(row.length, row.height, unit=(2 * half, *unit[1:]))
        return bricks.StoneWall(
            row.length,
            row.height,
            unit,
            pattern="squared" if row.level else "irregular",
            trace=row.trace,
            seed=self.sample,
        )

    def masonry(self, materials, **others):
        """Joints and stones.

        :param materials: :mod:`masonry.materials`; ``others``: arguments in place of these rules'
        """
        row = self.row
        soft = row.typology == "D"
        young = max(row.Eb or 0.0, STIFFER * self.E)
        # what crushing takes up to the peak at the strain 2 fc/E is the least that it takes in all
        rising = self.fc**2 * self.stone[1] * (2 / self.E - 1 / young)
        values = dict(
            E=self.E,
            unit_E=young,
            Gc=max(materials.compressiveFractureEnergy(self.fc)[0], TOUGH * rising),
            fc=self.fc,
            fv0=self.cohesion,
            friction=self.friction,
            ft=BOND * self.cohesion,
            unit=(self.stone[0], row.thickness, self.stone[1]),
            joint=0.0,
            density=WEIGHT / GRAVITY,
            unit_ft=STONE_TENSION * row.fb if soft else None,
        )
        made = materials.masonry(**{**values, **others})
        if row.dry:
            self._sawn(made.joints)
        return made

    def _sawn(self, joints):
        """Dry joints of sawn stone close by a curve, and their stones do not crush. The modulus of
        prisms says nothing of them."""
        closing = CLOSING_STIFFNESS * self.factors["stiffness"]
        for joint in (joints["bed"], joints["head"]):
            joint.updateAttrs(
                dict(
                    law="cyclic",  # the paper's has no curve by which joints close
                    cap=False,
                    compressionStiffnessLoss=0.0,
                    normalStiffness=max(self.row.Eb / self.stone[1], 2 * closing),
                    initialClosingStiffness=closing,
                    closureLimit=CLOSURE,
                    shearStiffness=closing / (2 * (1 + POISSON)),
                )
            )
