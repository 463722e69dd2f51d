# SPDX-License-Identifier: GPL-2.0-or-later
"""What decides the work of the dry-joint walls' cycles: variants of a plain model of the wall,
against the test WS2.175.

/usr/bin/python3 validation/dry_joint_walls/plain_wall.py        # all variants, a table in markdown
/usr/bin/python3 validation/dry_joint_walls/plain_wall.py blind  # one of them

plain_wall.cpp is the model, and says what it is. Every variant is a run through the measured
history.
"""

import argparse
import os
import subprocess
import sys

import numpy as np
from masonry.numbers import loops

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.path.insert(0, os.path.dirname(HERE))
import compare_loops  # noqa: E402
import measured  # noqa: E402
import studies  # noqa: E402

WALL = "WS2175"
PROGRAM = os.path.join(studies.RESULTS, "plain_wall")
_blind = compare_loops.BLIND["properties"]
CURVE = {
    "kn0": _blind["initialClosingStiffness"],
    "cm": _blind["closureLimit"],
    "kn": _blind["normalStiffness"],
}
#: Points along a joint of a half block, and rate [mm/s]: with twice the points at 50 mm/s the work
#: grows by up to a third.
COARSE = {"points": 4, "rate": 80}
#: Names and options; what is not given is a linear joint with kn 34, ks 13.6 N/mm³, friction 0.65.
VARIANTS = {
    "linear": {},
    "closing curve": {**CURVE},
    "blind": {**CURVE, "ks": _blind["shearStiffness"], "friction": _blind["friction"]},
    "closing curve, ks 4": {**CURVE, "ks": 4e9},
    "closing curve, rig 37 kN/mm": {**CURVE, "rig": 37e6},
    "linear, ks 1.3": {"ks": 1.3e9},
    "linear, kn 10": {"kn": 10e9},
    "linear, friction 0.5": {"friction": 0.5},
    "linear, friction of closing 0.15": {"closingFriction": 0.15},
    "linear, kn 10, friction 0.5": {"kn": 10e9, "friction": 0.5},
    "linear, kn 17, ks 6.8": {"kn": 17e9, "ks": 6.8e9},
    "linear, kn 360, ks 150": {"kn": 360e9, "ks": 150e9},
    "linear, rigid stones, kn 340, ks 136": {"rigid": 1, "kn": 340e9, "ks": 136e9},
    "linear, friction wears to 0.4": {"worn": 0.4},
    "linear, cap 10 MPa": {"cap": 10e6},
    "linear, ks by pressure": {"shearPower": 1},
    "linear, gaps of 2 mm in head joints": {"headGap": 2e-3},
    "linear, head joints without friction": {"headFriction": 0},
    "linear, base and top joints ten times softer": {"supportFactor": 0.1},
    "linear, load rides": {"riding": 1},
    "linear, rollers of 1 %": {"rollers": 0.01},
    "closing curve, ks 7.4": {**CURVE, "ks": 7.4e9},
    "closing curve, ks 7.4, friction 0.5": {**CURVE, "ks": 7.4e9, "friction": 0.5},
    "closing curve, ks 7.4, rig 37 kN/mm": {**CURVE, "ks": 7.4e9, "rig": 37e6},
}


def build(program=PROGRAM):
    """Compile the model, if it is older than its source. Returns the program."""
    source = os.path.join(HERE, "plain_wall.cpp")
    if not os.path.exists(program) or os.path.getmtime(program) < os.path.getmtime(source):
        os.makedirs(os.path.dirname(program), exist_ok=True)
        command = ["g++", "-std=c++17", "-O3", "-march=native", "-o", program, source]
        subprocess.run(command, check=True)
    return program


def run(history, program=PROGRAM, **options):
    """Displacement [mm] and force [kN] of a run through turning points [mm].

    :raises CalledProcessError: if an option is unknown
    """
    words = [f"{name}={value:.10g}" for name, value in options.items()]
    lines = "\n".join(f"{x:.6f}" for x in history)
    done = subprocess.run(
        [program, *words], input=lines, capture_output=True, text=True, check=True
    )
    rows = [line.split(",") for line in done.stdout.splitlines()[1:]]
    return np.array(rows, float).T


def describe(moved, force):
    """Cells of a row: stiffness from turn to turn of the first cycle, peaks, work over measured
    work by range, and mean width of the loops from 5 mm on, the distance of both residual
    displacements."""
    first = loops.cycles(moved, force, measured.THRESHOLD)[0]
    cells = [f"{first.stiffness_kN_per_mm:.1f}"]
    cells.append(f"{force.max():.1f}, {-force.min():.1f}")
    found = compare_loops.pairs(WALL, moved, force)
    for low, high in compare_loops.RANGES:
        work = np.array([p.work for p in found if low <= p.amplitude < high])
        tests, ours = work.mean(axis=0)
        cells.append(f"{ours:.0f} ({ours / tests:.2f})")
    wide = [p.residuals[:, 0] - p.residuals[:, 1] for p in found if p.amplitude >= 5]
    cells.append(f"{np.mean(wide, axis=0)[1]:.1f}")
    return cells


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("variants", nargs="*", help=f"of {', '.join(VARIANTS)} (default: all)")
    args = parser.parse_args(words)
    unknown = set(args.variants) - set(VARIANTS)
    if unknown:
        parser.error(f"no variant {', '.join(unknown)}")
    build()
    ranges = [f"{low:g}–{high:g} mm" for low, high in compare_loops.RANGES]
    print(
        studies.head(
            [
                "variant",
                "stiffness of the first cycle kN/mm",
                "V+, V− kN",
                *ranges,
                "width mm",
            ]
        ),
        flush=True,
    )
    moved, force, _ = measured.curve(WALL)
    print(studies.line(["test", *describe(moved, force)]), flush=True)
    history = measured.history(WALL)
    for name in args.variants or VARIANTS:
        curve = run(history, level=measured.levelOf(WALL), **COARSE, **VARIANTS[name])
        print(studies.line([name, *describe(*curve)]), flush=True)


if __name__ == "__main__":
    main()
