"""The dry-joint walls against their tests, from the runs of this case: envelopes.png and a table on the terminal.

/usr/bin/python3 validation/validate.py dry_joint_walls
/usr/bin/python3 validation/dry_joint_walls/compare.py
"""

import csv
import glob
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from masonry.results import readCurve, readRun

HERE = os.path.dirname(os.path.abspath(__file__))
REFERENCE = os.path.join(HERE, "reference")
RESULTS = os.path.join(HERE, "..", "..", "results", "validation", "dry_joint_walls")
LEVELS = (100, 175, 250)  # [kN]
MODELS = {"rigid": "tab:red", "deformable": "tab:blue"}


def tests(kind, level):
    """Displacements [mm] and forces [kN] of every wall of a level; ``kind`` is 'FD' or 'envelope'."""
    for path in sorted(glob.glob(os.path.join(REFERENCE, f"{kind}_WS?{level}_*.csv"))):
        with open(path, encoding="latin-1") as f:
            rows = [row[:2] for row in list(csv.reader(f))[4:] if row]
        yield np.array(rows, float).T


def peaks(level):
    """Measured peaks of a level [kN], array (walls, 2): in the positive and in the negative direction."""
    with open(os.path.join(REFERENCE, "peaks.csv"), newline="") as f:
        return np.array(
            [
                [float(row["peak_positive_kN"]), float(row["peak_negative_kN"])]
                for row in csv.DictReader(f)
                if int(row["level_kN"]) == level
            ]
        )


def secant(moved, force, share):
    """Secant stiffness where a curve from the origin first reaches a share of its largest force [force/displacement]."""
    moved, force = np.append(0, moved), np.append(0, force)
    target = share * force.max()
    i = int(np.argmax(force >= target))
    part = (target - force[i - 1]) / (force[i] - force[i - 1])
    return target / (moved[i - 1] + part * (moved[i] - moved[i - 1]))


def measuredSecants(level, share):
    """Secant stiffness of every branch of every envelope of a level [kN/mm]."""
    found = []
    for moved, force in tests("envelope", level):
        for sign in (1, -1):
            branch = sign * moved > 0
            order = np.argsort(sign * moved[branch])
            found.append(
                secant(sign * moved[branch][order], sign * force[branch][order], share)
            )
    return np.array(found)


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
    figure, panels = plt.subplots(1, len(LEVELS), figsize=(14, 5))
    for level, axes in zip(LEVELS, panels):
        for moved, force in tests("FD", level):
            axes.plot(moved, force, color="0.85", lw=0.5, zorder=0)
        for moved, force in tests("envelope", level):
            axes.plot(
                moved, force, color="0.35", lw=0.9, label="envelopes of the tests"
            )
        for model, colour in MODELS.items():
            moved, shear, run = computed(f"{model}-{level}")
            for sign in (1, -1):
                axes.plot(sign * moved, sign * shear, color=colour, lw=1.6, label=model)
        for sign in (1, -1):
            axes.axhline(
                sign * rocking(run),
                color="black",
                lw=0.8,
                ls="--",
                label="rigid rocking",
            )
        axes.set_title(f"{level} kN, {len(peaks(level))} walls")
        axes.set_xlabel("displacement 1.325 m above the base [mm]")
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("lateral force [kN]")
    handles = dict(zip(*reversed(axes.get_legend_handles_labels())))
    axes.legend(handles.values(), handles.keys(), loc="lower right", fontsize=8)
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, "envelopes.png"), dpi=80)


def table():
    print(
        "level  measured: V+, V-, mean, secant at 1/4, 1/2 of the peak    rigid rocking"
    )
    for level in LEVELS:
        positive, negative = peaks(level).mean(axis=0)
        mean = (positive + negative) / 2
        quarter, half = (measuredSecants(level, share).mean() for share in (0.25, 0.5))
        print(
            f"{level:5}  {positive:.1f} {negative:.1f} {mean:.1f} kN  {quarter:.1f} {half:.1f} kN/mm"
            f"  {rocking(computed(f'rigid-{level}')[2]):.1f} kN"
        )
    print("run                 peak kN  over V+, V-, mean    secant 1/4, 1/2 kN/mm")
    for directory in sorted(glob.glob(os.path.join(RESULTS, "*", "run.json"))):
        name = os.path.basename(os.path.dirname(directory))
        moved, shear, run = computed(name)
        level = run["options"]["level"]
        positive, negative = peaks(level).mean(axis=0)
        ratios = shear.max() / np.array([positive, negative, (positive + negative) / 2])
        print(
            f"{name:20} {shear.max():6.1f}  {ratios[0]:.3f} {ratios[1]:.3f} {ratios[2]:.3f}"
            f"  {secant(moved, shear, 0.25):7.1f} {secant(moved, shear, 0.5):.1f}"
        )


if __name__ == "__main__":
    table()
    draw()
