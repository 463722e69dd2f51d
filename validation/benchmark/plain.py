# SPDX-License-Identifier: GPL-2.0-or-later
"""What a step of a wall costs beside a plain program that does nothing else, and whether both find
the same peak.

/usr/bin/python3 validation/benchmark/plain.py [--rounds N] [--until MM] [--rate MM/S] [--plane]
[OPTIONS OF THE SCENE]

compiles plain_comp4.cpp, which says what it models, and pushes the wall COMP-4 in it and in the
plugin, on one thread each, one after the other, in so many rounds (default 3). It prints for each
the quickest round in microseconds a step of the push, its steps, their time, peak and work. By
default units are rigid, to 3 mm at 20 mm/s. With --plane they are of plane stress in the plain
program and deformable, two by two cells, in the plugin. All other options go to the scene.
"""

import argparse
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import studies  # noqa: E402
import numpy as np  # noqa: E402
from masonry.numbers.files import readCurve, readRun  # noqa: E402
from scipy.integrate import trapezoid  # noqa: E402

OUT = os.path.join(studies.RESULTS, "benchmark", "plain")
PLANE = ["--blocks", "deformable", "--divisions", "2"]


def build():
    """Compile the plain program. Returns its path."""
    os.makedirs(OUT, exist_ok=True)
    program = os.path.join(OUT, "plain_comp4")
    source = os.path.join(HERE, "plain_comp4.cpp")
    flags = ["-std=c++17", "-O3", "-march=native"]
    subprocess.run(["g++", *flags, "-o", program, source], check=True)
    return program


def plain(program, until, rate, plane):
    """Push the wall in the plain program. Returns steps, seconds, peak [kN] and work [J]."""
    words = [f"until={until}", f"rate={rate}", f"plane={int(plane)}"]
    done = subprocess.run(
        [program, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    done.check_returncode()
    steps, seconds, peak, work = done.stderr.split()
    return int(steps), float(seconds), float(peak), float(work)


def plugin(until, rate, words):
    """Push the wall in the plugin, without files but curve.csv. Returns the same."""
    out = os.path.join(OUT, "wall_comp4")
    quiet = ["--no-vtk", "--lean", "--checkpoint-every", "0"]
    push = ["--until", str(until), "--rate", str(rate)]
    studies.run("wall_comp4", [*quiet, *push, *words], out, quiet=True)
    run = readRun(out)
    stage = next(s for s in run["stages"] if s["stage"] == "push")
    curve = readCurve(out)
    force = np.array(curve["top_shear_kN"])  # where the plain program has it, too
    return (
        stage["steps"],
        stage["seconds"],
        force.max(),
        trapezoid(force, curve["displacement_mm"]),
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--until", type=float, default=3)
    parser.add_argument("--rate", type=float, default=20)
    parser.add_argument("--plane", action="store_true")
    args, more = parser.parse_known_args()
    wanted = [*(PLANE if args.plane else []), *more]
    program = build()
    results = {"plain program": [], "plugin": []}
    for _ in range(args.rounds):
        results["plain program"].append(plain(program, args.until, args.rate, args.plane))
        results["plugin"].append(plugin(args.until, args.rate, wanted))
    for name, rounds in results.items():
        steps, seconds, peak, work = min(rounds, key=lambda r: r[1] / r[0])
        print(
            f"{name:14}{1e6 * seconds / steps:8.1f} µs a step of {steps}, {seconds:.2f} s; peak"
            f" {peak:.2f} kN, work {work:.1f} J"
        )
