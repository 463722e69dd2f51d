# SPDX-License-Identifier: GPL-2.0-or-later
"""How often the interval of --accuracy contains the result of a fine and slow run: forty walls.

/usr/bin/python3 validation/accuracy/accuracy.py [--jobs N] [--walls WALL ...] [--show]

Makes what is missing in results/validation/accuracy: of every wall of walls.py a run with
--accuracy 2, one with --preset fast, and the reference. It goes on where it was stopped, and runs
one wall a core. Then it writes table.md and accuracy.json beside itself; --show only does that.
"""

import argparse
import itertools
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from queue import SimpleQueue

from masonry.errors import Refused
from masonry.numbers.files import readRun

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import studies

#: What is held against what, written down before any comparison was made.
PERCENT = 2.0  # asked of --accuracy
REFERENCE = ["--blocks", "deformable", "--divisions", "3", "--rate", "20"]
#: Walls that were compared before the parameters were fixed; they do not count.
KNOWN = {"short-clamped_silicate", "short-cantilever_granite", "slender-clamped_weak"}

RESULTS = os.path.join(studies.RESULTS, "validation", "accuracy")
#: As of walls.py, which needs YADE.
SHAPES = [
    "squat-clamped",
    "squat-cantilever",
    "slender-clamped",
    "slender-cantilever",
    "short-clamped",
    "short-cantilever",
    "window-clamped",
    "window-cantilever",
    "long-low",
    "tall-narrow",
]
MASONRY = ["silicate", "weak", "strong", "granite"]
WALLS = [f"{shape}_{kind}" for shape, kind in itertools.product(SHAPES, MASONRY)]
KINDS = {
    "asked": ["--accuracy", f"{PERCENT:g}"],
    "fast": ["--preset", "fast"],
    "reference": REFERENCE,
}
#: Numbers of run.json by quantity.
KEYS = {"peak": "peak_at_both_ends_kN", "work": "push_work_J"}


def folder(wall, kind):
    """Folder of the results of a wall, of one of KINDS."""
    return os.path.join(RESULTS, wall, kind)


def over(wall, kind):
    """Whether a run came to its end."""
    try:
        run = readRun(folder(wall, kind))
    except Refused:
        return False
    return not run["interrupted"] and "error" not in run


def runOne(wall, kind, cores):
    """Run a wall on a core of its own, so that its companions run there, too. Returns a sentence if
    it failed."""
    core = cores.get()
    out, (shape, masonry) = folder(wall, kind), wall.split("_")
    os.makedirs(os.path.dirname(out), exist_ok=True)
    script = os.path.join(HERE, "walls.py")
    command = [
        "taskset",
        "-c",
        str(core),
        sys.executable,
        script,
        "--shape",
        shape,
        "--masonry",
        masonry,
    ]
    command += ["--lean", "--checkpoint-every", "0", "--out", out, *KINDS[kind]]
    try:
        with open(out + ".log", "w") as log:
            done = subprocess.run(
                command, stdout=log, stderr=log, env={**os.environ, "OMP_NUM_THREADS": "1"}
            )
    finally:
        cores.put(core)
    if done.returncode or not over(wall, kind):
        return f"{wall} {kind}: exit status {done.returncode}; see {out}.log"
    print(f"{wall} {kind}: {readRun(out)['wall_clock_s']:.0f} s", flush=True)
    return None


def runAll(walls, jobs):
    """Run what is missing, the references, which are longest, among the others. Returns what
    failed."""
    cores = SimpleQueue()
    for core in sorted(os.sched_getaffinity(0))[:jobs]:
        cores.put(core)
    due = [(w, kind) for w in walls for kind in KINDS if not over(w, kind)]
    with ThreadPoolExecutor(jobs) as pool:
        found = list(pool.map(lambda one: runOne(*one, cores), due))
    return [one for one in found if one]


def compared(wall):
    """A row for each quantity of a wall: what the run said and what the reference has."""
    run, fast, reference = (readRun(folder(wall, kind)) for kind in KINDS)
    for one in run["accuracy"]["quantities"]:
        key = KEYS[one["name"]]
        aim = reference[key]
        off = aim - one["value"]
        yield {
            "wall": wall,
            "quantity": one["name"],
            "value": one["value"],
            "half_width_percent": one["half_width_percent"],
            "reference": aim,
            "off_percent": 100 * off / one["value"],
            "fast_percent": 100 * (fast[key] / aim - 1),
            "fast_sudden_loss": fast.get("sudden_loss", 0.0),
            "covered": abs(off) <= one["half_width"],
            "fidelity": run["accuracy"]["fidelity"],
            "parts_percent": one["parts_percent"],
            "collapsed": [run["collapsed"], reference["collapsed"]],
            "seconds": run["wall_clock_s"]
            + sum(c["seconds"] for c in run["accuracy"]["companions"]),
            "reference_seconds": reference["wall_clock_s"],
            "commit": run["commit"],
        }


def report(rows):
    """The text of table.md."""
    heads = [
        "wall",
        "quantity",
        "value ± %",
        "reference off %",
        "fast %",
        "covered",
        "fidelity",
        "s",
        "reference s",
    ]
    cells = [
        [
            r["wall"] + " (known)" * (r["wall"] in KNOWN),
            r["quantity"],
            f"{r['value']:.4g} ± {r['half_width_percent']:.1f}",
            f"{r['off_percent']:+.1f}",
            f"{r['fast_percent']:+.1f}",
            "yes" if r["covered"] else "**no**",
            r["fidelity"],
            f"{r['seconds']:.0f}",
            f"{r['reference_seconds']:.0f}",
        ]
        for r in rows
    ]
    return studies.table(heads, cells) + "\n"


def summary(rows):
    """Rows of a table: how many intervals contain the reference, and errors of the preset fast."""
    for quantity in KEYS:
        mine = [r for r in rows if r["quantity"] == quantity]
        blind = [r for r in mine if r["wall"] not in KNOWN]
        widths = [r["half_width_percent"] for r in mine]
        fast = sorted(abs(r["fast_percent"]) for r in mine)
        yield [
            quantity,
            f"{sum(r['covered'] for r in mine)} of {len(mine)}",
            f"{sum(r['covered'] for r in blind)} of {len(blind)}",
            f"{sum(widths) / len(widths):.2f} %",
            sum(width > PERCENT for width in widths),
            f"{max(abs(r['off_percent']) for r in mine):.1f} %",
            f"{sum(fast) / len(fast):.1f} %",
            ", ".join(f"{error:.1f}" for error in fast[-2:]) + " %",
        ]


SUMMARY = (
    "quantity, intervals that contain the reference, of the walls compared blind, mean half-width,"
    " half-widths above the percentage asked for, largest distance from the reference, fast: mean"
    " error, two largest errors"
).split(", ")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--walls", nargs="+", choices=WALLS, default=WALLS, metavar="WALL")
    arguments.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    arguments.add_argument("--show", action="store_true", help="run nothing")
    args = arguments.parse_args()
    failed = [] if args.show else runAll(args.walls, args.jobs)
    there = [w for w in WALLS if all(over(w, kind) for kind in KINDS)]
    rows = [row for wall in there for row in compared(wall)]
    with open(os.path.join(HERE, "accuracy.json"), "w") as f:
        json.dump(rows, f, indent=1)
        f.write("\n")
    with open(os.path.join(HERE, "table.md"), "w") as f:
        f.write(report(rows))
    print(studies.table(SUMMARY, summary(rows)), *failed, sep="\n")
    return 2 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
