# SPDX-License-Identifier: GPL-2.0-or-later
"""joint.png: one joint in cycles, from what joint.py has written. Paths side by side, a colour a
law.

/usr/bin/python3 validation/cyclic/figures.py
"""

import argparse
import csv
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS = os.path.join(os.path.dirname(os.path.dirname(HERE)), "results")
LAWS = {"softening": "tab:blue", "cyclic": "tab:red"}
SHEAR = ("shear_0", "shear_0.5", "shear_1")


def read(folder, law, path):
    """Rows of a path: dict of column -> array, or None if there are none."""
    name = os.path.join(folder, law, f"{path}.csv")
    if not os.path.exists(name):
        return None
    with open(name, newline="") as f:
        heads, *rows = list(csv.reader(f))
    return dict(zip(heads, np.array(rows, float).T))


def draw(folder, out):
    """Write joint.png.

    :param folder: what joint.py had as ``--out``
    :raises FileNotFoundError: if there is no path of any law
    """
    figure, panels = plt.subplots(1, 5, figsize=(19, 4))
    drawn = 0
    for law, colour in LAWS.items():
        style = dict(color=colour, lw=0.9, ls="-" if law == "softening" else "--")
        for axes, path in zip(panels, ("tension", *SHEAR, "closure")):
            rows = read(folder, law, path)
            if rows is None:
                continue
            drawn += 1
            if path == "tension":
                axes.plot(rows["opening_mm"], rows["normal_stress_MPa"], label=law, **style)
            elif path == "closure":
                axes.plot(-rows["opening_mm"], -rows["normal_stress_MPa"], **style)
            else:
                axes.plot(rows["slide_mm"], rows["shear_stress_MPa"], **style)
    if not drawn:
        raise FileNotFoundError(f"no path of joint.py in {folder}")
    tension, *shears, closure = panels
    tension.set_title("tension")
    tension.set_xlabel("opening [mm]")
    tension.set_ylabel("normal stress [MPa]")
    tension.set_ylim(-0.06, 0.12)
    tension.legend(fontsize=8)
    for axes, path in zip(shears, SHEAR):
        stress = float(path.split("_")[1])
        axes.set_title(f"shear at {-stress:g} MPa" if stress else "shear without normal stress")
        axes.set_xlabel("slide [mm]")
        axes.set_ylabel("shear stress [MPa]")
    closure.set_title("closure")
    closure.set_xlabel("closure [mm]")
    closure.set_ylabel("compressive stress [MPa]")
    for axes in panels:
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(out, dpi=75)
    plt.close(figure)


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", default=os.path.join(RESULTS, "validation", "cyclic", "joint"))
    parser.add_argument("--out", default=os.path.join(HERE, "joint.png"))
    args = parser.parse_args(words)
    draw(args.results, args.out)


if __name__ == "__main__":
    main()
