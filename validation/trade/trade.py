"""The price of speed: errors of the four walls against time, one knob at a time, and the presets.

/usr/bin/python3 validation/trade/trade.py [--draw | --time-only] [--jobs N] [--walls WALL ...]

Runs what is missing in results/trade, times what is not timed yet, prints the table and writes table.md, trade.json and
a figure per wall beside itself. --draw runs nothing; --time-only measures all times anew, for an idle machine.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from masonry.figures import CRACK, readFrame
from masonry.measure import layOut
from masonry.options import PRESETS, parser
from masonry.results import readCurve, readRun

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from validate import ROOT, run

RESULTS = os.path.join(ROOT, "results", "trade")

#: Walls and how far they are pushed [mm].
WALLS = {"wall_comp0a": 30, "wall_comp1": 30, "wall_comp4": 12, "wall_comp6": 16}

SOFT = "--blocks deformable"


def asOptions(preset):
    """Options of a preset as words, without those that are defaults."""
    defaults = vars(parser("", until=1).parse_args([]))
    return " ".join(
        f"--{name.replace('_', '-')} {value:g}"
        if isinstance(value, float)
        else f"--{name.replace('_', '-')} {value}"
        for name, value in PRESETS[preset].items()
        if value != defaults[name]
    )


#: What is varied, and its runs: options of a scene, all others at their defaults.
RUNS = {
    "reference": [f"{SOFT} --divisions 3"],
    "rigid": [""],
    "rigid: rate": [f"--rate {v}" for v in (10, 50, 100, 200, 400)],
    "rigid: subcontacts": [f"--subcontacts {n}" for n in (2, 8)],
    "rigid: rate and subcontacts": [f"--rate {v} --subcontacts 2" for v in (100, 200)],
    "rigid: density scaling": ["--density-scaling 25"],
    "rigid: damping": [f"--damping {a}" for a in (0.4, 0.95)],
    "rigid: local damping": [
        f"--damping-kind local --rate {v}" for v in (20, 50, 100, 200)
    ],
    "rigid: time step": ["--dt-fraction 0.95"],
    "rigid: no crack surfaces": ["--crack-surfaces off"],
    "deformable": [f"{SOFT} --rate 50"],
    "deformable: rate": [f"{SOFT} --rate {v}" for v in (20, 100, 200, 400)],
    "deformable: mesh and rate": [
        f"{SOFT} --divisions 2 --rate {v}" for v in (50, 100, 200)
    ],
    "deformable: damping": [f"{SOFT} --rate 50 --damping 0.4"],
    "deformable: local damping": [
        f"{SOFT} --damping-kind local --rate {v}" for v in (20, 50, 200)
    ],
    "deformable: time step": [f"{SOFT} --rate 50 --dt-fraction 0.95"],
    "deformable: no crack surfaces": [f"{SOFT} --rate 50 --crack-surfaces off"],
    **{f"preset {name}": [asOptions(name)] for name in PRESETS},
}

#: Series whose runs are repeated with these time steps, which differ only to see what is chance.
REPEATED = ["reference", "rigid", "deformable"] + [f"preset {name}" for name in PRESETS]
AGAIN = (0.78, 0.79)

#: Patches for the pattern of cracks: half units by courses, 0.22 × 0.24 m.
PATCH = (2, 3)

#: What makes a step cheap or dear, of run.json's options; and the short run that times such a step.
KINDS = ("blocks", "divisions", "subcontacts", "crack_surfaces", "damping_kind")
STRETCH = {"rigid": "--until 3 --rate 50", "deformable": "--until 3 --rate 100"}
THREADS = (1, 2)


def folder(wall, options):
    """Folder of a run; the order of its options does not matter."""
    words = sorted(" ".join(options.split()).split("--")[1:])
    return os.path.join(
        RESULTS,
        wall,
        "_".join(words).replace(" ", "_").replace("__", "_").strip("_") or "default",
    )


def done(wall, options):
    return os.path.exists(os.path.join(folder(wall, options), "run.json"))


def repeats(series):
    """All runs of a series that is repeated: its own and those with other time steps."""
    return RUNS[series] + [
        f"{o} --dt-fraction {f}" for o in RUNS[series] for f in AGAIN
    ]


def allRuns():
    """Options of all runs, each once, repetitions last."""
    own = [options for series in RUNS.values() for options in series]
    return list(dict.fromkeys(own + [o for s in REPEATED for o in repeats(s)]))


def runAll(walls, jobs):
    """Run what has no results yet; frames of the start and of the end only."""
    tasks = [(w, o) for w in walls for o in allRuns() if not done(w, o)]

    def one(task):
        wall, options = task
        words = f"--until {WALLS[wall]} --vtk-every 1000 {options}".split()
        run({"scene": wall + ".py", "options": words}, folder(wall, options))

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, tasks))


# -- what a run says ----------------------------------------------------------------------------------------------


def pattern(directory):
    """Where a wall is cracked: crack volumes [m³] of its patches.

    The crack volume of a joint is its opening and slide, where that is more than CRACK, times its area.
    """
    entry = readRun(directory)["wall"]
    half, thickness, height = entry["unit_m"][0] / 2, *entry["unit_m"][1:]
    bed, upright = layOut(readFrame(directory, "joints"), entry)
    patches = np.zeros(
        (-(-entry["courses"] // PATCH[1]), -(-entry["half_units"] // PATCH[0]))
    )
    for joints, area in ((bed, half * thickness), (upright, height * thickness)):
        moved = joints["opening"] + joints["slide"]
        rows, columns = np.indices(moved.shape)
        place = rows // PATCH[1], columns // PATCH[0]
        np.add.at(patches, place, area * np.where(moved > CRACK, moved, 0))
    return patches


def numbers(wall, options):
    """Peak and force at the end [kN], initial stiffness [kN/mm], work of the push and what joints dissipated [J]."""
    directory = folder(wall, options)
    entry, curve = readRun(directory), readCurve(directory)
    lost = [c for name, c in curve.items() if name.startswith("dissipated_")]
    return {
        "peak": entry["peak_base_shear_kN"],
        "end": entry["base_shear_end_kN"],
        "stiffness": entry["initial_stiffness_kN_per_mm"],
        "work": float(np.trapz(curve["base_shear_kN"], curve["displacement_mm"])),
        "dissipated": sum(c[-1] - c[0] for c in lost),
    }


def errors(wall, options):
    """Errors of a run against the mean of the reference runs, signed [-].

    ``pattern`` is the share of the crack volume that lies in other patches than the reference's: 0 the same pattern, 1
    none in common.
    """
    references = [r for r in REFERENCES if done(wall, r)]
    held = [numbers(wall, r) for r in references]
    mine = numbers(wall, options)
    result = {
        name: value / np.mean([h[name] for h in held]) - 1
        for name, value in mine.items()
    }
    share = lambda o: pattern(folder(wall, o)) / max(
        pattern(folder(wall, o)).sum(), 1e-30
    )
    result["pattern"] = 0.5 * float(np.abs(share(options) - share(references[0])).sum())
    return result


if __name__ == "__main__":
    for w in sys.argv[1:]:
        for o in allRuns(): print(w, repr(o), folder(w,o), done(w,o))
