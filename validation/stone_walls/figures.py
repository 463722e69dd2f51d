# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of the stone walls.

/usr/bin/python3 validation/stone_walls/figures.py peaks STUDY
/usr/bin/python3 validation/stone_walls/figures.py opened
/usr/bin/python3 validation/stone_walls/figures.py cracks RUN [RUN ...]

The first writes peaks.png, predicted over measured peaks of the 39 walls; the second opened.png,
those of the 57; the third cracks.png, of runs of wall.py with all files.
"""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import codes
import results
import rules
from masonry.numbers.files import readRun

COLOURS = {
    "E1": "tab:blue",
    "E": "tab:cyan",
    "C": "tab:orange",
    "D": "tab:red",
    "B": "tab:green",
    "A": "tab:olive",
}
SHOWN = ("EN 1998-3:2005", "NTC 2018")


def peaks(study):
    """peaks.png, of a study."""
    _peaks(results.predictions(*study), results.measured(), "peaks.png")


def opened(_):
    """opened.png, of predictions.csv."""
    tests = results.measured(results.OPENED, rules.BLIND)
    _peaks(results.predicted(), tests, "opened.png")


def _peaks(made, tests, name):
    """Predicted over measured peaks of this model and of two codes, a panel each."""
    walls = rules.read()
    said = {row["ID"]: codes.predict(row) for row in codes.rows()}
    figure, panels = plt.subplots(1, 3, figsize=(11, 4), sharey=True, constrained_layout=True)
    for panel, title in zip(panels, ("this model", *SHOWN)):
        for wall, test in tests.items():
            own, colour = made[wall], COLOURS[walls[wall].typology]
            if title in SHOWN:
                panel.plot(test["peak"], said[wall][title].peak, "o", color=colour, markersize=4)
                continue
            best = own.best["peak"]
            ends = own.low and [
                [max(best - own.low["peak"], 0)],
                [max(own.high["peak"] - best, 0)],
            ]
            panel.errorbar(
                test["peak"], best, ends, fmt="o", color=colour, markersize=4, linewidth=0.8
            )
        for factor, style in ((1, "-"), (1.25, ":"), (0.8, ":")):
            panel.plot([10, 300], [10 * factor, 300 * factor], style, color="0.5", linewidth=0.8)
        panel.set(
            xscale="log", yscale="log", title=title, xlabel="measured peak, mean of both sides, kN"
        )
    panels[0].set_ylabel("predicted peak, kN")
    there = {walls[wall].typology for wall in tests}
    for kind in filter(there.__contains__, COLOURS):
        panels[2].plot([], [], "o", color=COLOURS[kind], markersize=4, label=kind)
    panels[2].legend(title="typology")
    figure.savefig(os.path.join(HERE, name), dpi=90)


def cracks(folders):
    """The crack patterns of some runs, with what was measured of the failure."""
    tests = results.measured()
    figure, panels = plt.subplots(
        1, len(folders), figsize=(3 * len(folders), 4), constrained_layout=True
    )
    for panel, folder in zip(panels, folders):
        run = readRun(folder)
        wall = run["scene"].rsplit("_", 1)[-1]
        failure = results.TYPES[tests[wall]["failure"]] if wall in tests else "kept back"
        panel.imshow(plt.imread(os.path.join(folder, "cracks.png")))
        panel.set_title(f"{rules.read()[wall].name}; test: {failure}", size=9)
        panel.axis("off")
    figure.savefig(os.path.join(HERE, "cracks.png"), dpi=100)


if __name__ == "__main__":
    {"peaks": peaks, "opened": opened, "cracks": cracks}[sys.argv[1]](sys.argv[2:])
