# SPDX-License-Identifier: GPL-2.0-or-later
"""What the runs of the walls of bricks say beside the 17 tests, and predictions of all 52;
README.md says how each number is defined.

/usr/bin/python3 validation/brick_walls/compare.py choose results/validation/brick_walls/choose
/usr/bin/python3 validation/brick_walls/compare.py predict results/validation/brick_walls/push

The first prints a table of the rules and what leaving out one campaign says of them; the second
prints what pushes of today say of the 17. predictions.csv stays as it was made blind.
"""

import csv
import math
import os
import sys
from statistics import fmean, stdev

import assumed  # first: it finds the modules of the stone walls
import codes
import masonry_capacity
import numpy as np
import results
from masonry.numbers.files import readCurve
from masonry_capacity.piers import Pier

sys.path.insert(0, os.path.dirname(assumed.HERE))
import studies

SHARES = 0.8, 0.9  # of the strength in flexure, from which a wall does not fail in shear [-]
CHOSEN = SHARES[0]
KEPT = 1.99  # drift at which a push ended that kept its force [%]
NAMES = "peak", "stiffness", "bilinear", "atPeak", "ultimate"
COMPARED = [*NAMES, "stiffness, E measured", *(f"modes right, share {s}" for s in SHARES)]
LETTERS = {"flexure": "F", "shear": "S", "sliding": "S"}


def code(row):
    """The wall for the formulas of the codes, with the strengths of the row."""
    long, high = row.stone
    return Pier(
        height=1e3 * row.height,
        length=1e3 * row.length,
        thickness=1e3 * row.thickness,
        span=1e3 * row.arm,
        force=row.force,
        strength=1e-6 * row.fc,
        unit=1e-6 * row.fb,
        tau0=1e-6 * row.fv0,
        fv0=1e-6 * row.fv0,
        slope=2 * high / long,
    )


def ofRun(folder, row):
    """Numbers of a push by :data:`NAMES`: kN, kN/mm, %."""
    curve = {name: np.array(values) for name, values in readCurve(folder).items()}
    moved = np.maximum.accumulate(curve["displacement_mm"])
    force = np.minimum(curve["base_shear_kN"], curve["top_shear_kN"])
    found = masonry_capacity.bilinear(moved, force, pulse=results.WAVE)
    drift = lambda mm: 0.1 * mm / row.height
    return dict(
        peak=found.peakForce,
        stiffness=found.stiffness,
        bilinear=found.yieldForce,
        atPeak=drift(found.peakDisplacement),
        ultimate=drift(found.ultimateDisplacement),
    )


def modeOf(numbers, row, share=CHOSEN):
    """F flexure, S shear, H hybrid."""
    if numbers["peak"] < share * 1e-3 * codes.flexure(code(row), 1.15):
        return "S"
    return "F" if numbers["ultimate"] >= KEPT else "H"


def measured():
    """Numbers of the walls whose results are given, by :data:`NAMES`; NaN: not measured."""
    found = {}
    for number in assumed.known():
        cells, row = assumed.rows()[number], assumed.read()[number]
        get = lambda name: float(cells[name]) if cells[name] else math.nan
        found[number] = dict(
            peak=fmean(get(f"Vmax{sign}") for sign in "+-"),
            stiffness=get("Vbil+") / (10 * row.height * get("de+")),
            bilinear=get("Vbil+"),
            atPeak=get("dV+"),
            ultimate=get("du+"),
            mode=cells["mode"][0] if cells["mode"] != "SL" else "SL",
        )
    return found


def runs(folder):
    """Numbers of a study by rule and wall, once for every wall that is like the one that ran."""
    walls, found = assumed.read(), {}
    same = assumed.twins([*walls])
    with open(os.path.join(folder, "study.csv"), encoding="utf-8", newline="") as f:
        for values in csv.DictReader(f):
            if values["status"] != "ended":
                continue
            own = os.path.join(folder, "rows", f"{int(values['run']):04}")
            numbers = ofRun(own, walls[values["wall"]])
            alike = next(group for group in same.values() if values["wall"] in group)
            of = found.setdefault(values.get("rule"), {})
            of.update({wall: numbers for wall in alike})
    return found


def compared(numbers, tests):
    """Cells of a table: mean and coefficient of variation of predicted over measured numbers, the
    stiffness of walls whose E was measured, modes that are right with each of SHARES."""
    walls = assumed.read()
    cells = []
    for name in NAMES:
        mean, cov = results.spread([numbers[w][name] / own[name] for w, own in tests.items()])
        cells.append(f"{mean:.2f} ({100 * cov:.1f} %)")
    of = [w for w in tests if walls[w].E]
    cells.append(f"{fmean(numbers[w]['stiffness'] / tests[w]['stiffness'] for w in of):.2f}")
    for share in SHARES:
        cells.append(sum(modeOf(numbers[w], walls[w], share) == tests[w]["mode"] for w in tests))
    return cells


def scatter(numbers, tests):
    """Coefficient of variation of predicted over measured peaks [%]."""
    return 100 * results.spread([numbers[w]["peak"] / tests[w]["peak"] for w in tests])[1]


def choose(folder):
    """Print how each rule does, and which one the walls of all but one campaign would choose."""
    tests, walls = measured(), assumed.read()
    found = {r: of for r, of in runs(folder).items() if set(of) >= set(tests)}
    rows = [[rule, *compared(of, tests)] for rule, of in found.items()]
    for rule, prediction in said(tests).items():
        mean, cov = results.spread([prediction[w].peak / tests[w]["peak"] for w in tests])
        right = sum(LETTERS[prediction[w].failure] == tests[w]["mode"] for w in tests)
        rows.append([rule, f"{mean:.2f} ({100 * cov:.1f} %)", *[""] * len(NAMES), right, ""])
    print(studies.table(["rule", *COMPARED], rows), end="\n\n")
    campaigns, rows = sorted({walls[w].campaign for w in tests}), []
    for rule, of in found.items():
        without = [
            scatter(of, {w: t for w, t in tests.items() if walls[w].campaign != one})
            for one in campaigns
        ]
        rows.append([rule, *(f"{one:.1f}" for one in (scatter(of, tests), *without))])
    heads = ["scatter of peaks %", "all", *(f"without {one}" for one in campaigns)]
    print(studies.table(heads, rows))
    for wall, own in tests.items():
        ratios = [f"{of[wall]['peak'] / own['peak']:.2f}" for of in found.values()]
        mode = modeOf(found["base"][wall], walls[wall])
        print(walls[wall].name, own["mode"], mode, *ratios)


def said(numbers):
    """The predictions of codes by rule and wall."""
    walls = assumed.read()
    rules = {name: rule for name, rule in codes.RULES.items() if "Turn" not in name}
    return {name: {w: rule(code(walls[w])) for w in numbers} for name, rule in rules.items()}


def errors(made, tests):
    """Mean and standard deviation of the logarithms of measured over predicted numbers, by name:
    the mean of the tests, and the larger deviation of these and of the 96 stone walls."""
    stones = {**results.measured(), **results.measured(results.OPENED, results.rules.BLIND)}
    alike = dict(peak="peak", bilinear="peak", stiffness="effective")
    found = {}
    for name in NAMES:
        ratios = [own[name] / made[w][name] for w, own in tests.items()]
        logs = [math.log(ratio) for ratio in ratios if not math.isnan(ratio)]
        others = results.ratiosOf(results.predicted(), stones, alike.get(name, name)).values()
        found[name] = fmean(logs), max(stdev(logs), stdev(map(math.log, others)))
    return found


def predict(folder):
    """Print what the chosen rule says of the 17."""
    (made,) = runs(folder).values()
    tests = measured()
    error = errors(made, tests)
    held = dict.fromkeys(NAMES, 0)
    for number, own in tests.items():
        ends = results.expected(results.Prediction(*3 * [made[number]]), error)
        for name, (low, high) in ends.items():
            held[name] += low <= own[name] <= high
    print(studies.table(["rule", *COMPARED], [["chosen", *compared(made, tests)]]), end="\n\n")
    rows = [[n, f"{math.exp(m):.2f}", f"{s:.2f}", held[n]] for n, (m, s) in error.items()]
    heads = "number, measured over predicted, deviation of its logarithm, intervals that hold"
    print(studies.table(heads.split(", "), rows))


if __name__ == "__main__":
    {"choose": choose, "predict": predict}[sys.argv[1]](*sys.argv[2:])
