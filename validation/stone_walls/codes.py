# SPDX-License-Identifier: GPL-2.0-or-later
"""What four rules of today's practice predict for the stone walls: strength in the plane of the
wall and drift capacity.

/usr/bin/python3 validation/stone_walls/codes.py        # a table of all walls, in markdown

Inputs are what a surveyor knows, the columns of ``reference/walls.csv`` up to ``LMTvert``; no
result of a test is read. All strengths are means without safety factors, and the confidence factor
is 1.

Strengths in shear follow from the typology by Table C8.5.I of the Circolare 7/2019 (``TABLE``).
Compression of masonry and of units is that of the row. Dry joints have no cohesion and no tension,
so that friction and the vertical force decide; Turnšek and Čačovič then say nothing. Rubble, uncut
stone and cut stone have no ``fv0`` in the table: EN 1998-3:2005, which has only this formula for
shear, takes ``tau0`` in its place, and the other rules have no sliding for them.
"""

import csv
import math
import os
from dataclasses import dataclass

from masonry.materials.codes import LOCAL_FRICTION, MAX_SHEAR
from masonry.materials.codes import TABLE as SAID
from rules import ROWS

HERE = os.path.dirname(os.path.abspath(__file__))
WALLS = os.path.join(HERE, "reference", "walls.csv")
LAST_INPUT = "LMTvert [mm]"

#: Middle of the ranges of mean values of tau0 and fv0 [MPa] by typology: Circolare 21 January 2019
#: n. 7, Table C8.5.I. E1 is E without mortar.
TABLE = {
    kind: tuple(ends and sum(ends) / 2e6 for ends in (SAID[row].tau0, SAID[row].fv0))
    for kind, row in ROWS.items()
} | {"E1": (0.0, 0.0)}

CODE_FRICTION = 0.4  # of a bed joint: EN 1998-3:2005, C.4.3.1; NTC 2018, 7.8.2.2.2
UNIT_TENSION = 0.1  # over the compressive strength of the unit: Circolare 7/2019, C8.7.1.3.1.1
#: Height of a unit over the overlap where the row has no units: the one at which the equivalent
#: friction is 0.4, which the Circolare gives for good bond.
GOOD_BOND = 1 / 0.4 - 1 / LOCAL_FRICTION


@dataclass(frozen=True)
class Prediction:
    """One rule for one wall; None where the rule says nothing.

    ``peak`` [kN] is the strength, ``failure`` is flexure, shear (diagonal cracks or failure of
    units) or sliding (along a bed joint), ``drift`` [%] is the capacity at near collapse (EN) or at
    the ultimate limit state SLC (NTC).
    """

    peak: float | None = None
    failure: str | None = None
    drift: float | None = None


@dataclass(frozen=True)
class Wall:
    """What the rules need of a wall: lengths [mm], force [N], strengths [MPa].

    ``span`` is the height of zero moment H0, ``force`` acts at the base, ``slope`` is the height of
    a unit over the overlap with the next course, ``unit`` is the compressive strength of the units
    or None.
    """

    height: float
    length: float
    thickness: float
    span: float
    force: float
    strength: float
    unit: float | None
    tau0: float
    fv0: float | None
    slope: float

    @property
    def area(self) -> float:
        return self.length * self.thickness

    @property
    def stress(self) -> float:
        return self.force / self.area

    @property
    def shape(self) -> float:
        """The coefficient b of diagonal cracking, H/L between 1 and 1.5."""
        return min(1.5, max(1.0, self.height / self.length))


def number(cell: str) -> float | None:
    """The number of a cell, the middle of a range such as 110-140, or None where the cell is
    empty."""
    parts = [float(part) for part in cell.split("-") if part.strip()]
    return sum(parts) / len(parts) if parts else None


def read(row: dict) -> Wall:
    """The wall of a row of walls.csv; the columns of the results are not touched."""
    length, thickness = number(row["L [mm]"]), number(row["t [mm]"])
    force = number(row["Ntot [kN]"])
    height, width = number(row["hb [mm]"]), number(row["lb [mm]"])
    tau0, fv0 = TABLE[row["Stone masonry typology"]]
    if force is None:
        force = 1e-3 * number(row["σ0,tot [MPa]"]) * length * thickness
    return Wall(
        height=number(row["H [mm]"]),
        length=length,
        thickness=thickness,
        span=number(row["H0 [mm]"]),
        force=1e3 * force,
        strength=number(row["fc [MPa]"]),
        unit=number(row["fc,b [MPa]"]),
        tau0=tau0,
        fv0=fv0,
        slope=2 * height / width if height and width else GOOD_BOND,
    )


def flexure(wall: Wall, block: float) -> float:
    """Strength [N] in flexure without tension, N L/(2 H0) (1 - block sigma0/fm).

    ``block`` is 1.15 in EN 1998-3:2005, C.4.2.1, and 1/0.85 in NTC 2018, 7.8.2.2.1.
    """
    return (
        wall.force
        * wall.length
        / (2 * wall.span)
        * max(0.0, 1 - block * wall.stress / wall.strength)
    )


def alongBed(wall: Wall, cohesion: float, friction: float) -> float:
    """Sliding strength [N] on the compressed part of the base, V = cohesion L' t + friction N.

    L' = 3 (L/2 - V H0/N), at most L, belongs to linear compression without tension (NTC 2018,
    7.8.2.2.2); V, with which it becomes shorter, is solved for.
    """
    whole = cohesion * wall.area + friction * wall.force
    if whole * wall.span <= wall.force * wall.length / 6:
        return whole
    part = 1.5 * cohesion * wall.area + friction * wall.force
    return part / (1 + 3 * cohesion * wall.thickness * wall.span / wall.force)


def sliding(wall: Wall, cohesion: float, friction: float, bound: float) -> dict:
    """Strengths [N] of a bed joint and, as shear, of its units; their bound [MPa] is ``bound``
    times the unit strength.

    In slender walls of strong units the bound acts just below rocking, because the compressed part
    then is short.
    """
    found = {"sliding": alongBed(wall, cohesion, friction)}
    if wall.unit is not None:
        found["shear"] = alongBed(wall, bound * wall.unit, 0.0)
    return found


def diagonal(wall: Wall, tension: float) -> float:
    """Strength [N] by Turnšek and Čačovič, L t ft/b sqrt(1 + sigma0/ft): Circolare 7/2019,
    C8.7.1.16."""
    return wall.area * tension / wall.shape * math.sqrt(1 + wall.stress / tension)


def stepped(wall: Wall, cohesion: float) -> float:
    """Strength [N] of a crack in steps, at most that of the units: Circolare 7/2019, C8.7.1.17 and
    C8.7.1.18."""
    joints = (cohesion + LOCAL_FRICTION * wall.stress) / (1 + LOCAL_FRICTION * wall.slope)
    found = wall.area / wall.shape * joints
    return (
        found if wall.unit is None else min(found, diagonal(wall, UNIT_TENSION * wall.unit) / 2.3)
    )


def smallest(strengths: dict, drifts: dict) -> Prediction:
    """The prediction of the smallest strength [N], with the drift capacity [-] of its failure."""
    failure = min(strengths, key=strengths.__getitem__)
    return Prediction(strengths[failure] / 1e3, failure, 100 * drifts[failure])


def eurocode(wall: Wall) -> Prediction:
    """EN 1998-3:2005, Annex C, C.4.2 and C.4.3 (from memory).

    Drift capacities of near collapse are 4/3 of 0.008 H0/L in flexure and of 0.004 in shear.
    """
    cohesion = wall.tau0 if wall.fv0 is None else wall.fv0
    strengths = {"flexure": flexure(wall, 1.15)} | sliding(wall, cohesion, CODE_FRICTION, MAX_SHEAR)
    shear = 4 / 3 * 0.004
    drifts = {
        "flexure": 4 / 3 * 0.008 * wall.span / wall.length,
        "shear": shear,
        "sliding": shear,
    }
    return smallest(strengths, drifts)


def eurocodeDraft(wall: Wall) -> Prediction:
    """prEN 1998-3, the draft of 2018 to 2022: from memory, no public text of its formulas was
    found.

    Rocking; sliding with the friction of a joint and diagonal cracks in steps where units are
    regular (the table has fv0), diagonal cracks by tension where not. The forms of strength are
    likely, their coefficients are those of EN 1998-3:2005 and of the Circolare. The drift
    capacities 0.01 (1 - sigma0/fm), 0.008 and 0.006 are doubtful.
    """
    strengths = {"flexure": flexure(wall, 1.15)}
    if wall.fv0 is None:
        strengths["shear"] = diagonal(wall, 1.5 * wall.tau0)
    else:
        strengths |= sliding(wall, wall.fv0, LOCAL_FRICTION, MAX_SHEAR)
        strengths["shear"] = min(strengths.get("shear", math.inf), stepped(wall, wall.fv0))
    drifts = {
        "flexure": 0.01 * (1 - wall.stress / wall.strength),
        "shear": 0.006,
        "sliding": 0.008,
    }
    return smallest(strengths, drifts)


def turnsekCacovic(wall: Wall) -> Prediction:
    """Turnšek and Čačovič (1971) with ft = 1.5 tau0 and b = H/L: diagonal cracks alone, no drift,
    nothing for dry joints."""
    if not wall.tau0:
        return Prediction()
    return Prediction(diagonal(wall, 1.5 * wall.tau0) / 1e3, "shear", None)


def italian(wall: Wall) -> Prediction:
    """NTC 2018, 7.8.2.2, and Circolare 7/2019, C8.7.1.3.1.1, with mean values as for nonlinear
    static analysis.

    The bound of the unit strength is 0.065 fb/0.7 (C8.7.1.14). Drift capacities at SLC: 0.010 in
    flexure, 0.005 else.
    """
    strengths = {"flexure": flexure(wall, 1 / 0.85)}
    if wall.fv0 is None:
        strengths["shear"] = diagonal(wall, 1.5 * wall.tau0)
    else:
        strengths |= sliding(wall, wall.fv0, CODE_FRICTION, MAX_SHEAR / 0.7)
        strengths["shear"] = min(strengths.get("shear", math.inf), stepped(wall, wall.fv0))
    return smallest(strengths, {"flexure": 0.010, "shear": 0.005, "sliding": 0.005})


RULES = {
    "EN 1998-3:2005": eurocode,
    "prEN 1998-3": eurocodeDraft,
    "Turnšek-Čačovič": turnsekCacovic,
    "NTC 2018": italian,
}


def predict(row: dict) -> dict[str, Prediction]:
    """The prediction of each rule, by its name, for a row of walls.csv."""
    found = read(row)
    return {name: rule(found) for name, rule in RULES.items()}


def rows(path: str = WALLS) -> list[dict]:
    """The rows of walls.csv without the results of the tests."""
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.reader(file)
        names = next(reader)
        inputs = names[: names.index(LAST_INPUT) + 1]
        return [dict(zip(inputs, cells)) for cells in reader]


def text(prediction: Prediction) -> str:
    """A cell of the table: peak [kN], failure, drift [%]."""
    if prediction.peak is None:
        return "–"
    drift = "–" if prediction.drift is None else f"{prediction.drift:.2f}"
    return f"{prediction.peak:.1f}, {prediction.failure}, {drift}"


def main() -> None:
    print("Strength [kN], failure, drift capacity [%].\n")
    print("| wall | reference | typology | " + " | ".join(RULES) + " |")
    print("|---|---|---|" + "---|" * len(RULES))
    for row in rows():
        cells = [row["Test unit name"], row["Reference"], row["Stone masonry typology"]]
        print(
            "| "
            + " | ".join(cells + [text(prediction) for prediction in predict(row).values()])
            + " |"
        )


if __name__ == "__main__":
    main()
