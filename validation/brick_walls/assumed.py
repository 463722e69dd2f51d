# SPDX-License-Identifier: GPL-2.0-or-later
"""From a row of walls.csv to the blocks and joints of a wall of bricks, by published rules;
README.md tells them in words. Results of tests are not read here."""

import csv
import math
import os
import sys
from dataclasses import dataclass, replace

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "stone_walls"))
import rules
from masonry.materials.codes import FRICTION, GRAVITY, MEAN, SHEAR, SHEARING, STIFFNESS

WALLS = os.path.join(HERE, "walls.csv")
MORTAR = {"GP": 0.010, "TL": 0.002}  # thickness [m]
WEIGHT = {"HC": 10e3}  # of hollow clay [N/m³]; others:
SOLID = 18e3
#: Direct tensile over compressive strength of units [-], hollow and solid blocks and solid bricks.
UNIT_TENSION = {"HC": 0.026, "CS": 0.032, "SB-C": 0.040, "SB-CS": 0.040}
#: Most bricks of a model, above which a block stands for n by n bricks, and least of its length in
#: the length of the wall [-].
MOST, LEAST = 100, 2.5


@dataclass(frozen=True)
class Rule:
    """What the 17 walls may choose: strength of the bond of filled head joints over that of beds,
    G/E where it was not measured, E over the tested or the code's, strength of joints in
    compression over that of prisms [-]."""

    heads: float = 0.5
    shearing: float = SHEARING
    stiffness: float = 1.0
    toe: float = 1.0


RULES = {
    "base": Rule(),
    "full-heads": Rule(heads=1.0),
    "half-E": Rule(stiffness=0.5),
    "toe-1.4": Rule(toe=1.4),
    "shear-0.22": Rule(shearing=0.22),
    "no-heads": Rule(heads=0.0),
}
#: What the 17 walls chose.
CHOSEN = "chosen"
RULES[CHOSEN] = Rule(stiffness=0.5, shearing=0.22)


@dataclass(frozen=True)
class Row(rules.Row):
    """A wall as the database describes it, in SI units; None: unknown. Its typology is D, of
    stones that are sawn to size and crack."""

    unit: str
    filled: float  # 1: filled head joints, 0.5: filled in the tongue, 0: unfilled
    fv0: float
    mu: float | None
    G: float | None
    pressure: float  # on top [Pa]


def _row(cells):
    get = lambda name, factor=1.0: factor * float(cells[name]) if cells[name] else None
    parts = [float(p.partition("(")[0]) for p in cells["Gm_MPa"].split("/") if p]
    height, mortar, unit = get("H_m"), MORTAR[cells["bed"]], cells["unit"]
    area, pressure = get("L_m") * get("t_m"), get("s0_MPa", 1e6)
    return Row(
        cells["N"],
        cells["ref"],
        cells["name"],
        "D",
        False,
        get("L_m"),
        height,
        get("t_m"),
        max(get("H0/H") * height, height + rules.LOWEST) if get("H0/H") > 0.75 else 0.5 * height,
        get("H0/H") < 0.75,
        get("fmc", 1e6),
        get("Em_MPa", 1e6),
        (get("lb", 1e-3) + mortar, get("hb", 1e-3) + mortar),
        get("fb", 1e6),
        None,
        None,
        area * (pressure + WEIGHT.get(unit, SOLID) * height),
        True,
        None,
        False,
        unit,
        {"F": 1.0, "TF": 0.5, "U": 0.0}[cells["head"]],
        get("fv0", 1e6),
        get("mu"),
        1e6 * sum(parts) / len(parts) if parts else None,
        pressure,
    )


def rows():
    """All cells of walls.csv, by the number of a wall."""
    with open(WALLS, encoding="utf-8-sig", newline="") as f:
        return {cells["N"]: cells for cells in csv.DictReader(f)}


def read():
    """The walls by their number: dict of :class:`Row`."""
    return {number: _row(cells) for number, cells in rows().items()}


def known():
    """Numbers of the walls whose results are given."""
    return [number for number, cells in rows().items() if cells["mode"] != "?"]


def twins(numbers):
    """Walls that no row tells apart have one run: dict from the number of the first to those of
    all."""
    walls, found = read(), {}
    for number in numbers:
        found.setdefault(replace(walls[number], number="", name=""), []).append(number)
    return {same[0]: same for same in found.values()}


class Guess(rules.Guess):
    """Blocks, joints and load of a wall.

    :param row: :class:`Row`
    :param rule: :class:`Rule`
    """

    points = "5"

    def __init__(self, row, rule):
        self.row, self.rule = row, rule
        self.factors = dict.fromkeys(rules.SCATTER, 1.0)
        self.cohesion, self.friction = row.fv0, row.mu or FRICTION / SHEAR
        self.fc = rule.toe * row.fc
        self.E = rule.stiffness * (row.E or STIFFNESS * row.fc / MEAN)
        self.pressure = row.pressure
        long, high = row.stone
        bricks = row.length * row.height / (long * high)
        n = max(1, min(math.ceil(math.sqrt(bricks / MOST)), int(row.length / (LEAST * long))))
        self.stone = n * long, row.height / max(round(row.height / (n * high)), 1)

    def masonry(self, materials):
        row, rule = self.row, self.rule
        return super().masonry(
            materials,
            G=rule.stiffness * row.G if row.G else rule.shearing * self.E,
            head_share=rule.heads * row.filled,
            unit_ft=UNIT_TENSION[row.unit] * row.fb,
            density=WEIGHT.get(row.unit, SOLID) / GRAVITY,
        )
