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

from masonry.materials.codes import LOCAL_FRICTION, MAX_SHEAR
from masonry.materials.codes import TABLE as SAID
from masonry_capacity.piers import GOOD_BOND, Pier, Prediction, diagonal, eurocode, flexure
from masonry_capacity.piers import italian, sliding, smallest, stepped
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


def number(cell: str) -> float | None:
    """The number of a cell, the middle of a range such as 110-140, or None where the cell is
    empty."""
    parts = [float(part) for part in cell.split("-") if part.strip()]
    return sum(parts) / len(parts) if parts else None


def read(row: dict) -> Pier:
    """The wall of a row of walls.csv; the columns of the results are not touched."""
    length, thickness = number(row["L [mm]"]), number(row["t [mm]"])
    force = number(row["Ntot [kN]"])
    height, width = number(row["hb [mm]"]), number(row["lb [mm]"])
    tau0, fv0 = TABLE[row["Stone masonry typology"]]
    if force is None:
        force = 1e-3 * number(row["σ0,tot [MPa]"]) * length * thickness
    return Pier(
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


def eurocodeDraft(wall: Pier) -> Prediction:
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


def turnsekCacovic(wall: Pier) -> Prediction:
    """Turnšek and Čačovič (1971) with ft = 1.5 tau0 and b = H/L: diagonal cracks alone, no drift,
    nothing for dry joints."""
    if not wall.tau0:
        return Prediction()
    return Prediction(diagonal(wall, 1.5 * wall.tau0) / 1e3, "shear", None)


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
