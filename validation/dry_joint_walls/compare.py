# SPDX-License-Identifier: GPL-2.0-or-later
"""The dry-joint walls against their tests, from the runs of this case: envelopes.png and tables on
the terminal.

/usr/bin/python3 validation/validate.py dry_joint_walls
/usr/bin/python3 validation/dry_joint_walls/compare.py
"""

import csv
import glob
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from masonry.numbers.files import readCurve, readRun

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import studies

REFERENCE = os.path.join(HERE, "reference")
RESULTS = os.path.join(studies.RESULTS, "validation", "dry_joint_walls")
LEVELS = (100, 175, 250)  # [kN]
START = 6  # [mm] shown of the first displacements
MODELS = {"rigid": "tab:red", "deformable": "tab:blue"}


def tests(kind, level):
    """Displacements [mm] and forces [kN] of every wall of a level; ``kind`` is 'FD' or
    'envelope'."""
    for path in sorted(glob.glob(os.path.join(REFERENCE, f"{kind}_WS?{level}_*.csv"))):
        with open(path, encoding="latin-1") as f:
            rows = [row[:2] for row in list(csv.reader(f))[4:] if row]
        yield np.array(rows, float).T


def peaks(level):
    """Measured peaks of a level [kN], array (walls, 2): in the positive and in the negative
    direction."""
    with open(os.path.join(REFERENCE, "peaks.csv"), newline="") as f:
        return np.array(
            [
                [float(row["peak_positive_kN"]), float(row["peak_negative_kN"])]
                for row in csv.DictReader(f)
                if int(row["level_kN"]) == level
            ]
        )


def secant(moved, force, share):
    """Secant stiffness where a curve first reaches a share of its largest force
    [force/displacement]."""
    target = share * force.max()
    i = int(np.argmax(force >= target))
    part = (target - force[i - 1]) / (force[i] - force[i - 1])
    return target / (moved[i - 1] + part * (moved[i] - moved[i - 1]))


def signed(moved, force, sign):
    """The branch of an envelope in one direction, from the origin on, as positive numbers:
    displacements and forces."""
    branch = sign * moved > 0
    order = np.argsort(sign * moved[branch])
    return [np.append(0, sign * values[branch][order]) for values in (moved, force)]


def measuredSecants(level, share):
    """Secant stiffness of every branch of every envelope of a level [kN/mm]."""
    return np.array(
        [
            secant(*signed(moved, force, sign), share)
            for moved, force in tests("envelope", level)
            for sign in (1, -1)
        ]
    )


def computed(name):
    """Displacement [mm], base shear [kN] and run.json of a run of this case."""
    directory = os.path.join(RESULTS, name)
    curve = readCurve(directory)
    return (
        np.array(curve["displacement_mm"]),
        np.array(curve["base_shear_kN"]),
        readRun(directory),
    )


def rocking(run):
    """Force at which the whole wall, undeformed, turns about its toe [kN]."""
    wall = run["wall"]
    area = wall["length_m"] * wall["thickness_m"]
    unit = run["unit_material"]["density_kg_per_m3"] * 9.81
    load = area * (wall["precompression_Pa"] + wall["height_m"] * unit)
    return 1e-3 * load * wall["length_m"] / (2 * wall["load_height_m"])


def draw():
    """envelopes.png: a column a level; above whole tests, below the first millimetres, both
    directions folded."""
    figure, panels = plt.subplots(2, len(LEVELS), figsize=(14, 9))
    for level, (whole, start) in zip(LEVELS, panels.T):
        for moved, force in tests("FD", level):
            whole.plot(moved, force, color="0.85", lw=0.5, zorder=0, label="tests")
        for moved, force in tests("envelope", level):
            whole.plot(moved, force, color="0.35", lw=0.9, label="their envelopes")
            for sign in (1, -1):
                start.plot(*signed(moved, force, sign), color="0.35", lw=0.9)
        for model, colour in MODELS.items():
            moved, shear, run = computed(f"{model}-{level}")
            start.plot(moved, shear, color=colour, lw=1.2)
            for sign in (1, -1):
                whole.plot(sign * moved, sign * shear, color=colour, lw=1.2, label=model)
        for sign in (1, -1):
            line = dict(color="black", lw=0.8, ls="--", label="rigid rocking")
            whole.axhline(sign * rocking(run), **line)
        whole.set_title(f"{level} kN, {len(peaks(level))} walls")
        start.set_xlim(0, START)
        start.set_ylim(0, None)
        start.set_xlabel("displacement 1.325 m above the base [mm]")
        for axes in (whole, start):
            axes.grid(alpha=0.3)
    for axes in panels[:, 0]:
        axes.set_ylabel("lateral force [kN]")
    handles, labels = whole.get_legend_handles_labels()
    named = dict(zip(labels, handles))
    whole.legend(named.values(), named.keys(), loc="lower right", fontsize=8)
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, "envelopes.png"), dpi=75)


def tables():
    """Print peaks and secant stiffnesses of the tests, by level, and of the runs."""
    print(
        "| level kN | V+, V−, mean kN | secant at 1/4, 1/2 of the peak, kN/mm | rigid rocking kN |"
    )
    print("|---|---|---|---|")
    for level in LEVELS:
        sides = peaks(level).mean(axis=0)
        secants = [measuredSecants(level, share).mean() for share in (0.25, 0.5)]
        rigid = rocking(computed(f"rigid-{level}")[2])
        print(f"| {level} | {some([*sides, sides.mean()])} | {some(secants)} | {rigid:.1f} |")
    print("\n| run | peak kN | over V+, V−, mean | secant at 1/4, 1/2 of the peak, kN/mm |")
    print("|---|---|---|---|")
    for name in studies.readCase("dry_joint_walls"):
        if name != "quick":
            moved, shear, run = computed(name)
            sides = peaks(run["options"]["level"]).mean(axis=0)
            ratios = shear.max() / np.array([*sides, sides.mean()])
            secants = [secant(moved, shear, share) for share in (0.25, 0.5)]
            print(f"| {name} | {shear.max():.1f} | {some(ratios, 2)} | {some(secants)} |")


def some(values, digits=1):
    return ", ".join(f"{value:.{digits}f}" for value in values)


if __name__ == "__main__":
    tables()
    draw()
