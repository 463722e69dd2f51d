# SPDX-License-Identifier: GPL-2.0-or-later
"""The price of speed: errors of the four walls against time, by block model, mesh, rate, damping.

/usr/bin/python3 validation/trade/trade.py [--draw]

Makes what is missing in results/validation/trade, one run after another, prints tables, and writes
table.md and all_walls.png beside itself; --draw makes no runs.
"""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from masonry.numbers.cracks import CRACK, layOut
from masonry.numbers.files import readRun
from masonry.numbers.frames import readFrame

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import studies

#: Walls and how far they are pushed [mm].
WALLS = {"wall_comp0a": 30, "wall_comp1": 30, "wall_comp4": 12, "wall_comp6": 16}
_SCALED = "--mass-scaling auto"
_ONE = f"--blocks deformable --rate 50 {_SCALED}"

REFERENCE = f"--blocks deformable --divisions 3 --rate 20 {_SCALED}"
#: What is compared with the reference, and its options; all others have their defaults.
RUNS = {
    "rigid, 20 mm/s": "",
    "rigid, 50 mm/s": "--rate 50",
    "rigid, 100 mm/s: preset fast": "--preset fast",
    "rigid, 200 mm/s": "--rate 200",
    "one cell, 50 mm/s": _ONE,
    "the same, combined damping of 0.4": f"{_ONE} --damping 0.4",
    "the same, local damping": f"{_ONE} --damping-kind local",
    "the same, time step 0.95 of its limit": f"{_ONE} --dt-fraction 0.95",
    "one cell, 100 mm/s": f"--blocks deformable --rate 100 {_SCALED}",
    "two by two cells, 50 mm/s: preset accurate": "--preset accurate",
    "two by two cells, 100 mm/s": f"--blocks deformable --divisions 2 --rate 100 {_SCALED}",
}
#: Limit analysis alone: a bound of the peak, without a run.
BOUND = "--preset bound"

#: Patches for the pattern of cracks: half units by courses, 0.22 × 0.24 m.
PATCH = (2, 3)
ERRORS = ["peak", "work", "end", "stiffness", "pattern"]


def folder(wall, options):
    return os.path.join(studies.RESULTS, "validation", "trade", wall, studies.nameOf(options))


def runAll():
    """Make what is missing; frames of the start and of the end only."""
    studies.runMissing(
        [
            (wall, f"--until {until} --vtk-every 1000 {o}".split(), folder(wall, o))
            for wall, until in WALLS.items()
            for o in (BOUND, REFERENCE, *RUNS.values())
        ]
    )


def pattern(directory):
    """Where a wall is cracked: the share of its crack volume in each patch [-].

    The crack volume of a joint is its opening and slide, where that is more than CRACK, times its
    area.
    """
    entry = readRun(directory)["wall"]
    half, thickness, height = entry["unit_m"][0] / 2, *entry["unit_m"][1:]
    bed, upright = layOut(readFrame(directory, "joints"), entry)
    patches = np.zeros((-(-entry["courses"] // PATCH[1]), -(-entry["half_units"] // PATCH[0])))
    for joints, area in ((bed, half * thickness), (upright, height * thickness)):
        moved = joints["opening"] + joints["slide"]
        rows, columns = np.indices(moved.shape)
        place = rows // PATCH[1], columns // PATCH[0]
        np.add.at(patches, place, area * np.where(moved > CRACK, moved, 0))
    return patches / max(patches.sum(), 1e-30)


def numbers(wall, options):
    """Peak and force at the end [kN], initial stiffness [kN/mm] and work of the push [J]."""
    run = readRun(folder(wall, options))
    return {
        "peak": run["peak_at_both_ends_kN"],
        "work": run["push_work_J"],
        "end": run["base_shear_end_kN"],
        "stiffness": run["initial_stiffness_kN_per_mm"],
    }


def compared(wall, options):
    """A run beside the reference: signed errors [%], of the pattern the share of the crack volume
    that lies in other patches; dynamic imbalance [%], steps and seconds of a core."""
    mine, aim = numbers(wall, options), numbers(wall, REFERENCE)
    own = folder(wall, options)
    other = pattern(own) - pattern(folder(wall, REFERENCE))
    run = readRun(own)
    return {
        **{name: 100 * (mine[name] / aim[name] - 1) for name in mine},
        "pattern": 50 * float(np.abs(other).sum()),
        "imbalance": 100 * run["dynamic_imbalance"],
        "steps": run["steps"],
        "seconds": studies.secondsOf(own),
    }


def cells(found):
    """Cells of a row of a table, of what :func:`compared` returns."""
    errors = [f"{found[name]:+.1f}" for name in ERRORS[:-1]]
    return [*errors, f"{found['pattern']:.0f}", f"{found['imbalance']:.1f}"]


def worst(all):
    """Of runs of several walls the errors that are largest in magnitude, and the time together."""
    found = {name: max((one[name] for one in all), key=abs) for name in [*ERRORS, "imbalance"]}
    return {**found, "seconds": sum(one["seconds"] for one in all)}


def bounds():
    """Rows of a table: the bound of limit analysis over the peak of the reference."""
    for wall in WALLS:
        bound = readRun(folder(wall, BOUND))["bound_base_shear_kN"]
        peak = numbers(wall, REFERENCE)["peak"]
        over = f"{100 * (bound / peak - 1):.0f} %"
        yield [wall, f"{bound:.1f}", f"{peak:.1f}", over, f"{numbers(wall, REFERENCE)['work']:.0f}"]


def draw(found):
    """all_walls.png: time of the four walls together against the errors of peak and work."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharex=True, sharey=True)
    for axis, name in zip(axes, ("peak", "work")):
        for title, one in found.items():
            mark = "o" if title.startswith("rigid") else "s"
            axis.plot(one["seconds"], max(0.05, abs(one[name])), mark, label=title)
        axis.axvline(
            sum(studies.secondsOf(folder(wall, REFERENCE)) for wall in WALLS), color="0.7", ls="--"
        )
        axis.set(xscale="log", yscale="log", xlabel="seconds of a core, four walls together")
        axis.set_title(f"largest error of the {name} [%]", fontsize=10)
        axis.grid(alpha=0.3, which="both", lw=0.4)
    axes[0].legend(fontsize=7)
    figure.suptitle("dashed: time of the reference", fontsize=9)
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, "all_walls.png"), dpi=80)


def main(words):
    if words != ["--draw"]:
        runAll()
    heads = [*(f"{name} %" for name in (*ERRORS, "imbalance")), "s of a core"]
    found, rows = {}, []
    for title, options in RUNS.items():
        mine = {wall: compared(wall, options) for wall in WALLS}
        found[title] = worst(mine.values())
        for wall, one in mine.items():
            steps = f"{one['steps'] / 1000:.0f}k"
            rows.append([wall[5:], title, *cells(one), f"{one['seconds']:.0f}", steps])
    rows.sort(key=lambda row: row[0])
    with open(os.path.join(HERE, "table.md"), "w") as f:
        f.write(studies.table(["wall", "run", *heads, "steps"], rows) + "\n")
    of = [[title, *cells(one), f"{one['seconds']:.0f}"] for title, one in found.items()]
    print(studies.table(["run: worst of the four walls", *heads], of), end="\n\n")
    print(
        studies.table(
            "wall, bound kN, reference: peak kN, below the bound, work J".split(", "), bounds()
        )
    )
    draw(found)


if __name__ == "__main__":
    main(sys.argv[1:])
