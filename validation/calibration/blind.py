# SPDX-License-Identifier: GPL-2.0-or-later
"""Hidden properties of couplets, found again from their curves: twenty cases.

/usr/bin/python3 validation/calibration/blind.py [--jobs 2]

Runs what is missing in results/validation/calibration, prints the table and writes table.md.
README.md says what was fixed before the first comparison.
"""

import argparse
import glob
import os
import shutil
import sys

import numpy as np
from masonry.numbers.files import readCurve
from masonry_study import Calibration, Specimen, Study, uniform
from masonry_study.calibrate import MAX_SPREAD
from masonry_study.gathering import gather
from masonry_study import local
from masonry_study.pictures import increasing
from masonry_study.records import Record
from masonry_study.start import begin

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from studies import RESULTS, table

PLACE = os.path.join(RESULTS, "validation", "calibration")
STRESSES = 0.2, 0.8  # normal stress of the two couplets of a case [MPa]
OPTIONS = {"until": 1.0, "rate": 10}  # slide [mm] and its rate [mm/s]
CURVE = "slide_mm", "shear_stress_MPa"
END, POINTS = 0.9, 12  # slide [mm] up to which a curve is compared, and its points
ERROR = 0.02  # standard deviation of a measured shear stress [MPa], some 5 % of a peak
CASES, HIDDEN = 20, 20261127  # and the seed of the hidden properties and of the errors
RUNS = 48  # of the scene, for each couplet, the same in all cases
LIMIT = 18  # cases of 20 in which a property must lie in its interval
RANGES = {
    "bed.cohesion": (0.08e6, 0.30e6),
    "bed.friction": (0.5, 0.9),
    "bed.residualFriction": (0.3, 0.5),
    "bed.modeIIFractureEnergy": (20.0, 150.0),
    # which sliding under pressure does not tell
    "bed.tensileStrength": (0.02e6, 0.08e6),
}


def options(stress):
    return {**OPTIONS, "normal_stress": -stress}


def tested(jobs):
    """Test the hidden couplets: their properties, a line a case. Writes a measured curve a case and
    a couplet."""
    noise = np.random.default_rng(HIDDEN)
    vary = {name: uniform(*ends) for name, ends in RANGES.items()}
    for number, stress in enumerate(STRESSES, 1):
        study = Study("couplet", options(stress), CASES, HIDDEN, vary)
        folder = begin(study, os.path.join(PLACE, f"hidden{number}"), HERE)
        local.run(folder, jobs)
        gather(folder)
        grid = np.linspace(0, END, POINTS + 1)
        for case in range(1, CASES + 1):
            curve = readCurve(folder.row(case))
            stresses = np.interp(grid, *increasing(*(curve[name] for name in CURVE)))
            stresses += ERROR * noise.standard_normal(len(grid))
            lines = [f"{x!r},{y!r}\n" for x, y in zip(grid.tolist(), stresses.tolist())]
            with open(os.path.join(PLACE, f"case{case}_{number}.csv"), "w") as file:
                file.write("".join(["d,tau\n", *lines]))
    record = Record(folder.path)
    return np.column_stack([record.numbers(name) for name in RANGES])


def found(case, jobs):
    """What the two curves of a case say."""
    for path in glob.glob(os.path.join(PLACE, "specimen*_check*")):
        shutil.rmtree(path)  # of another case; the rounds are the same in all
    specimens = [
        Specimen(
            "couplet",
            os.path.join(PLACE, f"case{case}_{n}.csv:d:tau"),
            ERROR,
            CURVE,
            POINTS,
            options(stress),
        )
        for n, stress in enumerate(STRESSES, 1)
    ]
    return Calibration(specimens, RANGES, runs=RUNS).find(PLACE, HERE, jobs)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--jobs", type=int, default=len(os.sched_getaffinity(0)), help="runs at a time"
    )
    jobs = parser.parse_args().jobs
    os.makedirs(PLACE, exist_ok=True)
    hidden, lines, inside, known = tested(jobs), [], [], []
    for case, true in enumerate(hidden, 1):
        one = found(case, jobs)
        low, high = one.intervals
        inside.append((low <= true) & (true <= high))
        known.append(one.spread < MAX_SPREAD)
        cells = [
            f"{t:.3g} ({a:.3g} … {b:.3g}){'' if a <= t <= b else ' **out**'}"
            for t, a, b in zip(true, low, high)
        ]
        follows = not any("does not follow" in doubt for doubt in one.doubts())
        lines.append([case, *cells, "yes" if follows else "no"])
        if case == 1:
            shutil.copy(os.path.join(PLACE, "calibration.png"), os.path.join(HERE, "case1.png"))
    heads = [
        "case",
        *(f"{name.removeprefix('bed.')}" for name in RANGES),
        "run follows",
    ]
    counts = np.sum(inside, axis=0)
    lines.append(["in the interval", *(f"{n} of {CASES}" for n in counts), ""])
    lines.append(["known from the test", *(f"{n} of {CASES}" for n in np.sum(known, axis=0)), ""])
    text = table(heads, lines)
    text += (
        f"\n\nAll properties of a case at once: {int(np.all(inside, axis=1).sum())} of {CASES}.\n"
    )
    print(text)
    with open(os.path.join(HERE, "table.md"), "w") as file:
        file.write(text)
    return 0 if (counts >= LIMIT).all() else 1


if __name__ == "__main__":
    sys.exit(main())
