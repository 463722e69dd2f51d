# SPDX-License-Identifier: GPL-2.0-or-later
"""What the runs of the stone walls say, and what was measured; README.md says how each number is defined.

/usr/bin/python3 validation/stone_walls/results.py --choose results/stone_walls/choose     # the eight combinations of rules
/usr/bin/python3 validation/stone_walls/results.py results/stone_walls/push [CYCLES]       # predictions.csv and table.md
"""

import argparse
import csv
import math
import os
import sys
from dataclasses import dataclass, fields
from statistics import fmean, quantiles, stdev

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import codes
import numpy as np
import rules
from masonry.read import curves
from masonry.read.files import readCurve

FLEXURE, SHEAR = 0.2, 0.4  # share of the work of the push that sliding takes [-]
LOST, COLLAPSED = (
    0.8,
    0.5,
)  # share of the peak at the ultimate drift and at collapse [-]
ELASTIC, EFFECTIVE = 0.15, 0.7  # share of the peak at the secants [-]
WAVE = 0.2  # a fall of the force that is over within this displacement is a wave [mm]
TYPES = {0.0: "shear", 0.5: "hybrid", 1.0: "flexure"}


@dataclass
class Numbers:
    """Of one push: force [kN], secant stiffnesses [kN/mm], drifts [%], failure 0 shear, 0.5 hybrid, 1 flexure."""

    peak: float
    elastic: float
    effective: float
    atPeak: float
    ultimate: float
    collapse: float
    failure: float


NAMES = [one.name for one in fields(Numbers)]
UNITS = dict(peak="kN", elastic="kN/mm", effective="kN/mm", atPeak="%", ultimate="%", collapse="%")  # fmt: skip


def ofRun(folder, height):
    """The :class:`Numbers` of a push.

    :param height: of the wall [m]
    """
    curve = {name: np.array(values) for name, values in readCurve(folder).items()}
    side = np.sign(curve["displacement_mm"][-1])
    moved = np.maximum.accumulate(side * curve["displacement_mm"])
    # what both ends carry, so that no wave counts
    force = np.minimum(side * curve["base_shear_kN"], side * curve["top_shear_kN"])
    at = int(force.argmax())
    peak = float(force[at])
    drift = lambda mm: 0.1 * mm / height
    ends = [_fallen(moved, force, at, share * peak) for share in (LOST, COLLAPSED)]
    until = moved <= ends[0]
    work = lambda name: curve[name][until][-1] - curve[name][0]
    slid = work("dissipated_shear_J") / max(work("external_J"), 1e-9)
    failure = 1.0 if slid < FLEXURE else 0.0 if slid > SHEAR else 0.5
    secants = [_secant(moved, force, share) for share in (ELASTIC, EFFECTIVE)]
    return Numbers(peak, *secants, drift(moved[at]), *map(drift, ends), failure)


def _fallen(moved, force, at, level):
    """Displacement after the peak at which the force has fallen to a level, or the end [mm]."""
    place = curves.fallen(moved, force, at, level, WAVE)
    return float(moved[-1] if place is None else np.interp(place, np.arange(len(moved)), moved))  # fmt: skip


def _secant(moved, force, share):
    """Secant stiffness at a share of the peak, on the way to it [kN/mm]."""
    level = share * force.max()
    row = int(np.flatnonzero(force >= level)[0])
    reached = np.interp(level, force[row - 1 : row + 1], moved[row - 1 : row + 1]) if row else moved[0]  # fmt: skip
    return float(level / max(reached, 1e-6))


def measured():
    """By number of a wall, what was measured: dict of means of both sides by the names of :class:`Numbers`, and each side."""
    columns = dict(peak="Vmax,{} [kN]", elastic="Kel,{} [kN/mm]", effective="Keff,{} [kN/mm]", atPeak="dmax,{} [%]", ultimate="du,{} [%]", collapse="dc,{} [%]")  # fmt: skip
    found = {}
    with open(rules.WALLS, encoding="utf-8-sig", newline="") as f:
        for cells in csv.DictReader(f):
            if cells["ID"] not in rules.KNOWN:
                continue
            own = {}
            for name, column in columns.items():
                sides = [cells[column.format(sign)] for sign in "+-"]
                own[name] = fmean(float(s) for s in sides if s)
            own["failure"] = float(cells["Failure type"])
            found[cells["ID"]] = own
    return found


def runs(folder):
    """Rows of a study that ended, with the :class:`Numbers` of each: pairs of a dict of what varies and these, once for every
    wall that is like the one that was run."""
    walls, same = rules.read(), rules.twins([*rules.read()])
    with open(os.path.join(folder, "study.csv"), encoding="utf-8", newline="") as f:
        for values in csv.DictReader(f):
            row = os.path.join(folder, "rows", f"{int(values['run']):04}")
            if values["status"] == "ended":
                numbers = ofRun(row, walls[values["wall"]].height)
                for wall in same[values["wall"]]:
                    yield {**values, "wall": wall}, numbers


def spread(ratios):
    """Mean and coefficient of variation."""
    mean = fmean(ratios)
    return mean, (stdev(ratios) / mean if len(ratios) > 1 else math.nan)


def choose(folder):
    """Print how each combination of rules does on the walls with results."""
    tests, found = measured(), {}
    for values, numbers in runs(folder):
        key = values["bond"], values["stiffness"]
        found.setdefault(key, {})[values["wall"]] = numbers
    print("| bond | stiffness | walls | peak | effective stiffness | initial stiffness | ultimate drift | failure right |")  # fmt: skip
    print("|---|---|---|---|---|---|---|---|")
    for (bond, stiffness), of in found.items():
        cells = []
        for name in ("peak", "effective", "elastic", "ultimate"):
            mean, cov = spread([getattr(n, name) / tests[w][name] for w, n in of.items()])  # fmt: skip
            cells.append(f"{mean:.2f} ({100 * cov:.0f} %)")
        right = sum(n.failure == tests[w]["failure"] for w, n in of.items())
        print(f"| {bond} | {stiffness} | {len(of)} | {' | '.join(cells)} | {right} |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--choose", metavar="STUDY")
    args = parser.parse_args()
    if args.choose:
        choose(args.choose)
