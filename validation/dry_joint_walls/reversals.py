# SPDX-License-Identifier: GPL-2.0-or-later
"""How the force goes after a reversal, and how high the loops are: of tests in dry joints and in
mortar, and of walls in a press that is a dead load or has friction and stiffness, as a testing
machine may have.

/usr/bin/python3 validation/dry_joint_walls/reversals.py            # all
/usr/bin/python3 validation/dry_joint_walls/reversals.py --measured # without runs

Runs of rig.py that have no results yet are made; writes reversals.md, the tables, and
reversals.png. What is looked at:

- a *reversal*: a turning point of the displacement at 5 mm or more, before and after which the wall
  moves by 2.5 mm and more; the force after it is that as the wall goes back, less that at the
  turning point, both positive towards the side of the turning point
- the *half height* of a loop, W / (4 A N): W the work of a cycle, A its amplitude, N the vertical
  force at the base. It is half the distance of both branches in the mean, over N
"""

import argparse
import csv
import os
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from masonry.numbers import loops

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.dirname(HERE)]
import compare_loops  # noqa: E402
import measured  # noqa: E402
import studies  # noqa: E402

FARTHEST, SWING = 5.0, 2.5  # [mm] least displacement of a reversal, and least swing beside it
BACK = np.array([0.25, 0.5, 1.0, 1.5, 2.0])  # [mm] where the force is looked at
CYCLE = 5.0  # [mm] least amplitude of a loop whose height is looked at
RATE = 40  # [mm/s]
MACHINE = dict(friction=0.05, uplift=1.4)
#: Of each run the wall, the law of its joints, and the press.
RUNS = {
    "paper's law": ("WS2175", "softening", {}),
    "paper's law, friction": ("WS2175", "softening", dict(friction=0.05)),
    "paper's law, friction, stiffness and soft guides": (
        "WS2175",
        "softening",
        dict(**MACHINE, guides=11),
    ),
    "cyclic law, `blind.json`": ("WS2175", "cyclic", {}),
    "in mortar, paper's law": (measured.DRIVEN, "softening", {}),
    "in mortar, paper's law, friction and stiffness": (measured.DRIVEN, "softening", MACHINE),
}
HEADS = [
    "curve",
    "reversals",
    "change of the force kN at 0.5, 1, 1.5, 2 mm",
    "above the old force at 2 mm",
    "loops",
    "W/(4 A N), least and largest",
]


def reversals(moved, force):
    """Changes of the force [kN] at :data:`BACK` after each reversal: a list of arrays."""
    rows, found = loops.turningPoints(moved, measured.THRESHOLD), []
    for before, at, after in zip(rows, rows[1:], rows[2:]):
        side = np.sign(moved[at])
        swings = side * (moved[at] - moved[[before, after]])
        if side * moved[at] < FARTHEST or min(swings) < SWING:
            continue
        back = np.maximum.accumulate(side * (moved[at] - moved[at : after + 1]))
        found.append(np.interp(BACK, back, side * (force[at : after + 1] - force[at])))
    return found


def heights(wall, cycles):
    """W / (4 A N) of the cycles of a wall whose work is known: a list."""
    normal = normalForce(wall)
    large = [c for c in cycles if c.amplitude_mm >= CYCLE and np.isfinite(c.work_J)]
    return [c.work_J / (4 * c.amplitude_mm * normal) for c in large]


def normalForce(wall):
    """Vertical force at the base of a wall [kN], as the table of the database has it."""
    path = os.path.join(studies.HERE, "stone_walls", "reference", "walls.csv")
    with open(path, newline="") as f:
        for row in csv.DictReader(f):
            if row["Test unit name"].replace(".", "").replace("-", "") == wall:
                return float(row["Ntot [kN]"])
    raise ValueError(f"{path} has no wall {wall}")


def measuredGroups():
    """Walls by group: dry joints by their load, and those in mortar."""
    groups = {f"WS, dry, {level} kN": measured.walls(level) for level in measured.LEVELS}
    kinds = {"WI": "sawn granite", "WR": "irregular granite"}
    for kind, what in kinds.items():
        for level in measured.LEVELS:
            walls = [w for w in measured.mortarWalls() if w[:2] == kind and w.endswith(str(level))]
            groups[f"{kind}, {what} in lime mortar, {level} kN"] = walls
    groups["T, tuff in cement mortar, clamped"] = [
        w for w in measured.mortarWalls() if w.startswith("T")
    ]
    return groups


def ofTest(wall):
    """Reversals and heights of loops of a test, without what is doubtful."""
    moved, force, _ = measured.curve(wall)
    cycles = measured.cycles(wall)
    end = min((int(c.start) for c, doubtful in cycles if doubtful), default=None)
    high = heights(wall, [c for c, doubtful in cycles if not doubtful])
    return reversals(moved[:end], force[:end]), high


def ofRun(wall, curve):
    """Reversals and heights of loops of a run."""
    return reversals(*curve), heights(wall, loops.cycles(*curve, measured.THRESHOLD))


def cells(name, changes, high):
    """A row of a table."""
    row = [name, len(changes)]
    row.append(", ".join(f"{v:.1f}" for v in np.mean(changes, axis=0)[1:]))
    row.append(sum(one[-1] > 0 for one in changes))
    return [*row, len(high), f"{np.mean(high):.3f} ({min(high):.3f}–{max(high):.3f})"]


def folder(results, name):
    return os.path.join(results, studies.nameOf(name).replace("’", ""))


def runMissing(results):
    """Make the runs that have no results yet, one after the other."""
    for name, (wall, law, press) in RUNS.items():
        out = folder(results, name)
        if studies.done(out):
            continue
        words = ["--rig", "0", "--wall", wall, "--rate", str(RATE), "--joints", law, "--no-vtk"]
        if wall != measured.DRIVEN and law == "cyclic":
            for key, value in compare_loops.BLIND["properties"].items():
                for kind in compare_loops.KINDS:
                    words += ["--set", f"{kind}.{key}={value:g}"]
        words += [word for key, value in press.items() for word in (f"--{key}", str(value))]
        path = os.path.join(HERE, "rig.py")
        subprocess.run(["yade", "-n", "-x", path, "--out", out, *words], check=True)


def measuredRows():
    for name, walls in measuredGroups().items():
        changes, high = (sum(each, []) for each in zip(*map(ofTest, walls)))
        yield cells(f"{name}: {len(walls)}", changes, high)


def calculatedRows(curves):
    for wall in dict.fromkeys(wall for wall, *_ in RUNS.values()):
        yield cells(f"{wall}, test", *ofTest(wall))
        for name, (of, *_) in RUNS.items():
            if of == wall:
                yield cells(f"{wall}, {name}", *ofRun(wall, curves[name]))


def draw(curves, path):
    """The force after a reversal in the mean, a panel a wall."""
    walls = list(dict.fromkeys(wall for wall, *_ in RUNS.values()))
    figure, panels = plt.subplots(1, len(walls), figsize=(10, 4))
    for axes, wall in zip(panels, walls):
        mean = lambda changes: np.append(0, np.mean(changes, axis=0))
        back = np.append(0, BACK)
        axes.plot(back, mean(ofTest(wall)[0]), "k", lw=2.5, label="test")
        for name, (of, _, press) in RUNS.items():
            if of == wall:
                line = "-" if len(press) > 1 else ":" if press else "--"
                axes.plot(back, mean(reversals(*curves[name])), line, label=name.replace("`", ""))
        axes.axhline(0, color="0.6", lw=0.8)
        axes.set_title(f"{wall[:3]}.{wall[3:]}")
        axes.set_xlabel("way back from a reversal [mm]")
        axes.legend(fontsize=8)
    panels[0].set_ylabel("change of the lateral force [kN]")
    figure.tight_layout()
    figure.savefig(path, dpi=75)
    plt.close(figure)


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--measured", action="store_true", help="no runs, the tests alone")
    parser.add_argument(
        "--results",
        default=os.path.join(studies.RESULTS, "validation", "dry_joint_walls", "reversals"),
        help="folder of the results",
    )
    parser.add_argument("--out", default=HERE, help="folder of tables and figure")
    args = parser.parse_args(words)
    text = studies.table(HEADS, measuredRows())
    if not args.measured:
        runMissing(args.results)
        curves = {name: compare_loops.calculated(folder(args.results, name)) for name in RUNS}
        parts = [
            "# Reversals and heights of loops",
            "Made by `reversals.py`, which says what the columns are.",
            "Tests, with the number of walls:",
            text,
            "Test and runs; friction 0.05, stiffness 1.4 kN/mm of uplift, soft guides 11 kN/mm:",
            studies.table(HEADS, calculatedRows(curves)),
        ]
        text = "\n\n".join(parts) + "\n"
        with open(os.path.join(args.out, "reversals.md"), "w") as f:
            f.write(text)
        draw(curves, os.path.join(args.out, "reversals.png"))
    print(text)


if __name__ == "__main__":
    main()
