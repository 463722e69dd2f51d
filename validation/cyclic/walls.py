# SPDX-License-Identifier: GPL-2.0-or-later
"""Two calcium-silicate walls in cycles of growing amplitude, under both laws: walls.md and the
figures.

/usr/bin/python3 validation/cyclic/walls.py  # runs what is missing, then all of these
/usr/bin/python3 validation/cyclic/walls.py --walls comp4 --laws softening   # one wall, one law

The runs stand in case.json: a monotonic push to each wall with the paper's law, which is the same
for both laws as long as the load grows, and cycles, most amplitudes twice.
``masonry.numbers.loops`` defines the numbers of a cycle.

- ``loops_WALL.png``: the loops of both laws, with the monotonic curve in both directions
- ``degradation.png``: over the amplitude, stiffness from peak to peak, equivalent damping, and what
  is left of the monotonic force in both directions
- ``walls.md``: the same as a table
"""

import argparse
import os
import sys
from collections import namedtuple

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from masonry.numbers import loops
from masonry.numbers.files import readCurve

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import studies  # noqa: E402

CASE = "cyclic"
WALLS = {"comp0a": "COMP-0a", "comp4": "COMP-4"}
LAWS = {"softening": "tab:blue", "cyclic": "tab:red"}
THRESHOLD = 0.1  # [mm] smaller excursions are no cycles; the smallest amplitude is 0.5 mm
NAMES = (
    "wall",
    "law",
    "amplitude mm",
    "V+ kN",
    "V− kN",
    "V+ over monotonic",
    "V− over monotonic",
    "V− over V+",
    "stiffness kN/mm",
    "over the first",
    "work J",
    "damping",
    "residual after +, − mm",
)

#: A cycle under a law: the numbers of :class:`masonry.numbers.loops.Cycle`; ``repeat``, 0 where the
#: amplitude is new; the force at the largest and at the smallest displacement over the monotonic
#: force there [-]; the stiffness over that of the first cycle [-].
Numbers = namedtuple("Numbers", "cycle repeat positive negative stiffness")


def monotonicForce(monotonic, displacement):
    """Force of the monotonic curve at a displacement [kN], NaN beyond its end.

    :param monotonic: displacements [mm] and forces [kN] of a push, rising displacements
    """
    moved, force = monotonic
    return float(np.interp(displacement, moved, force, left=np.nan, right=np.nan))


def numbers(moved, force, monotonic):
    """The cycles of a run: a list of :class:`Numbers`.

    :param moved: displacement [mm]; ``force``: base shear [kN]
    """
    found, last, first = [], None, None
    for cycle in loops.cycles(moved, force, THRESHOLD):
        first = first or cycle.stiffness_kN_per_mm
        again = last is not None and abs(cycle.amplitude_mm / last - 1) < 0.05
        repeat = found[-1].repeat + 1 if again else 0
        last = cycle.amplitude_mm
        rows = slice(int(np.ceil(cycle.start)), int(cycle.end) + 1)
        high, low = (rows.start + int(f(moved[rows])) for f in (np.argmax, np.argmin))
        found.append(
            Numbers(
                cycle,
                repeat,
                force[high] / monotonicForce(monotonic, moved[high]),
                -force[low] / monotonicForce(monotonic, -moved[low]),
                cycle.stiffness_kN_per_mm / first,
            )
        )
    return found


def tableRows(wall, law, found):
    """Lines of the table: a cycle each."""
    rows = []
    for n in found:
        c = n.cycle
        repeated = f", cycle {n.repeat + 1}" if n.repeat else ""
        rows.append(
            [
                WALLS[wall],
                law,
                f"{c.amplitude_mm:.1f}{repeated}",
                f"{c.largest_kN:.1f}",
                f"{-c.smallest_kN:.1f}",
                f"{n.positive:.2f}",
                f"{n.negative:.2f}",
                f"{-c.smallest_kN / c.largest_kN:.2f}",
                f"{c.stiffness_kN_per_mm:.1f}",
                f"{n.stiffness:.2f}",
                f"{c.work_J:.1f}",
                f"{c.damping:.3f}",
                f"{c.residual_positive_mm:.2f}, {c.residual_negative_mm:.2f}",
            ]
        )
    return rows


def drawLoops(wall, monotonic, curves, path):
    """The loops of a wall: a panel a law, over the monotonic curve in both directions.

    :param curves: dict of law -> (displacement, force)
    """
    figure, panels = plt.subplots(
        1, len(curves), figsize=(6 * len(curves), 4.4), sharey=True, squeeze=False
    )
    for axes, (law, curve) in zip(panels[0], curves.items()):
        axes.plot(*curve, color=LAWS[law], lw=0.7, label="cycles")
        for sign in (1, -1):
            axes.plot(
                *(sign * np.array(monotonic)),
                color="black",
                lw=1.1,
                ls="--",
                label="monotonic, both directions" if sign > 0 else None,
            )
        axes.set_title(f"{WALLS[wall]}, {law} law")
        axes.set_xlabel("displacement at the top of the masonry [mm]")
        far = 1.05 * max(abs(curve[0]))
        axes.set_xlim(-far, far)
        axes.grid(alpha=0.3)
    panels[0][0].set_ylabel("base shear [kN]")
    panels[0][0].legend(loc="lower right", fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=75)
    plt.close(figure)


def drawDegradation(found, path):
    """Stiffness, damping and force over the amplitude: a column a wall.

    :param found: dict of wall -> dict of law -> list of :class:`Numbers`
    """
    figure, panels = plt.subplots(
        3,
        len(found),
        figsize=(3.6 * len(found) + 1, 8.5),
        sharex="col",
        sharey="row",
        squeeze=False,
    )
    for column, (wall, laws) in zip(panels.T, found.items()):
        for law, each in laws.items():
            for repeat, style in ((0, dict(marker="o")), (1, dict(marker="x", ls=":"))):
                chosen = [n for n in each if n.repeat == repeat]
                if not chosen:
                    continue
                amplitude = [n.cycle.amplitude_mm for n in chosen]
                look = dict(color=LAWS[law], lw=1, ms=4, **style)
                name = f"{law}, {'second' if repeat else 'first'} cycle"
                column[0].plot(amplitude, [n.stiffness for n in chosen], label=name, **look)
                column[1].plot(amplitude, [100 * n.cycle.damping for n in chosen], **look)
                if repeat == 0:
                    look["ls"] = "-"
                    column[2].plot(amplitude, [n.positive for n in chosen], label=law, **look)
                    look.update(ls="--", mfc="white")
                    column[2].plot(
                        amplitude,
                        [n.negative for n in chosen],
                        label=f"{law}, negative",
                        **look,
                    )
        column[0].set_title(WALLS[wall])
        column[2].axhline(1, color="black", lw=0.6)
        column[2].set_xlabel("amplitude [mm]")
        for axes in column:
            axes.set_xlim(0)
            axes.grid(alpha=0.3)
    panels[0][0].set_ylabel("stiffness peak to peak\nover that of the first cycle [-]")
    panels[1][0].set_ylabel("equivalent damping [%]")
    panels[2][0].set_ylabel("force at the turn over\nthe monotonic force there [-]")
    for row in panels[:2]:
        row[0].set_ylim(0)
    panels[0][-1].legend(fontsize=8)
    panels[2][-1].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=75)
    plt.close(figure)


def curve(name, results):
    rows = readCurve(os.path.join(results, name))
    return np.array(rows["displacement_mm"]), np.array(rows["base_shear_kN"])


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--walls", nargs="+", choices=list(WALLS), default=list(WALLS))
    parser.add_argument("--laws", nargs="+", choices=list(LAWS), default=list(LAWS))
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--results", default=os.path.join(studies.RESULTS, "validation", CASE))
    parser.add_argument("--out", default=HERE, help="folder of table and figures")
    args = parser.parse_args(words)
    runs = studies.readCase(CASE)
    names = [f"{wall}-{kind}" for wall in args.walls for kind in ("monotonic", *args.laws)]
    studies.runMissing(
        [
            (
                runs[name]["scene"],
                runs[name]["options"],
                os.path.join(args.results, name),
            )
            for name in names
        ],
        args.jobs,
    )
    found, rows = {}, []
    for wall in args.walls:
        monotonic = curve(f"{wall}-monotonic", args.results)
        curves = {law: curve(f"{wall}-{law}", args.results) for law in args.laws}
        found[wall] = {law: numbers(*c, monotonic) for law, c in curves.items()}
        for law, each in found[wall].items():
            rows += tableRows(wall, law, each)
        drawLoops(wall, monotonic, curves, os.path.join(args.out, f"loops_{wall}.png"))
    drawDegradation(found, os.path.join(args.out, "degradation.png"))
    text = (
        "# Cycles of the calcium-silicate walls\n\nMade by"
        f" `walls.py`.\n\n{studies.table(NAMES, rows)}\n"
    )
    with open(os.path.join(args.out, "walls.md"), "w") as f:
        f.write(text)
    print(text)


if __name__ == "__main__":
    main()
