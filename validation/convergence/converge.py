# SPDX-License-Identifier: GPL-2.0-or-later
"""How far the answer of two walls with deformable units moves with mesh, rate, damping and time
step.

/usr/bin/python3 validation/convergence/converge.py [--draw]

Runs what is missing in results/validation/convergence, one run after another, prints the table of
all runs and draws curves.png beside itself; --draw leaves out what was not run.
"""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from masonry_view.measure import measure
from masonry.numbers.files import readCurve

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from studies import RESULTS, done, nameOf, runMissing, secondsOf, table

#: Walls, their options, and how far they must go to show their peak.
WALLS = {
    "COMP-4": ("wall_comp4", "--until 5"),
    "COMP-1": ("wall_comp1", "--until 25"),
}
COMMON = "--blocks deformable --no-vtk"

#: Panels of the figure: what is varied, and the runs by name with their options; "" is the default
#: run.
SERIES = {
    "mesh: cells of a half brick along its length and height": {
        "1": "",
        "2": "--divisions 2",
        "3": "--divisions 3",
    },
    "rate, mm/s": {
        "20": "",
        "50": "--rate 50",
        "100": "--rate 100",
    },
    "damping": {
        "combined 0.8": "",
        "combined 0.4": "--damping 0.4",
        "combined 0.95": "--damping 0.95",
        "local 0.8": "--damping-kind local",
    },
    "time step over its limit": {
        "0.8": "",
        "0.4": "--dt-fraction 0.4",
        "0.95": "--dt-fraction 0.95",
    },
}


def folder(wall, options):
    return os.path.join(RESULTS, "validation", "convergence", wall, nameOf(options))


def runAll():
    runMissing(
        [
            (scene, f"{COMMON} {common} {options}".split(), folder(wall, options))
            for series in SERIES.values()
            for wall, (scene, common) in WALLS.items()
            for options in series.values()
        ]
    )


HEADS = (
    "varied, wall, run, peak kN, at mm, end kN, of the finest mesh, top less base kN, energy error,"
    " steps, s of a core"
).split(", ")


def rows():
    """Peaks, their ratio to that of the finest mesh, and times, of every run that is there."""
    for title, series in SERIES.items():
        for wall in WALLS:
            meshes = list(SERIES.values())[0].values()
            finest = [m for m in meshes if done(folder(wall, m))][-1]
            reference = measure(folder(wall, finest))
            for name, options in series.items():
                if not done(folder(wall, options)):
                    continue
                n = measure(folder(wall, options))
                ratio = n["peak_base_shear_kN"] / reference["peak_base_shear_kN"]
                yield [
                    title,
                    wall,
                    name,
                    f"{n['peak_base_shear_kN']:.1f}",
                    f"{n['displacement_at_peak_mm']:.1f}",
                    f"{n['base_shear_end_kN']:.1f}",
                    f"{ratio:.3f}",
                    f"{n['top_less_base_shear_kN']:.1f}",
                    f"{n['balance_error']:.0e}",
                    n["steps"],
                    f"{secondsOf(folder(wall, options)):.0f}",
                ]


def draw():
    figure, axes = plt.subplots(
        len(WALLS), len(SERIES), figsize=(4 * len(SERIES), 3.2 * len(WALLS))
    )
    for row, wall in zip(axes, WALLS):
        for axis, (title, series) in zip(row, SERIES.items()):
            for name, options in series.items():
                if done(folder(wall, options)):
                    curve = readCurve(folder(wall, options))
                    x, y = curve["displacement_mm"], curve["base_shear_kN"]
                    axis.plot(x, y, lw=1, label=name)
            axis.set_title(title, fontsize=8)
            axis.set_xlabel("displacement [mm]", fontsize=8)
            axis.set_ylabel(f"{wall}: base shear [kN]", fontsize=8)
            axis.set_ylim(bottom=0)
            axis.grid(alpha=0.3)
            axis.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, "curves.png"), dpi=70)


if __name__ == "__main__":
    if sys.argv[1:] != ["--draw"]:
        runAll()
    print(table(HEADS, rows()))
    draw()
