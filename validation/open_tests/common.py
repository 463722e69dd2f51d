# SPDX-License-Identifier: GPL-2.0-or-later
"""What the programs of this folder share: options of a quiet run, its answers, and the table of a
program."""

import argparse
import contextlib
import io
import os
import sys
import tempfile
import time

import numpy as np

from masonry.numbers.files import readCurve, readRun

sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.abspath(__file__)))]
from studies import head, line  # noqa: E402


def words(name, *more):
    """Options of a scene that leaves nothing but its answers: a list of words."""
    folder = tempfile.mkdtemp(prefix=f"open_tests_{name}_")
    return ["--lean", "--no-vtk", "--checkpoint-every", "0", "--out", folder, *more]


def answer(scene, name):
    """The last answer of a scene with this name, or not a number."""
    found = [a["value"] for a in scene.answers if a["name"] == name]
    return found[-1] if found else float("nan")


def finished(scene):
    """Finish a scene. Returns its run.json and its curve.csv, as dicts."""
    scene.finish()
    return readRun(scene.results.directory), readCurve(scene.results.directory)


def boundOf(scene):
    """The factor of limit analysis that a scene found last."""
    return list(scene.bounds.entries.values())[-1]["factor"]


def section(ft, GfI, kn, depth, normal=0.0):
    """The largest moment of a joint that stays plane, over its section modulus [Pa]: an integral of
    the law by itself.

    Tension softens as exp(-ft·w/GfI) beyond the peak, compression is linear. A plane of opening is
    w = a + b·x.
    """
    x = np.linspace(-0.5, 0.5, 4001) * depth
    u0 = ft / kn
    tail = GfI / ft - 0.5 * u0  # so that the whole area is GfI

    def moment(tilt):
        def stress(a):
            w = a + tilt * x
            return np.where(w < u0, kn * w, ft * np.exp(-np.maximum(w - u0, 0) / tail))

        low, high = -tilt * depth, tilt * depth
        for _ in range(60):
            a = 0.5 * (low + high)
            low, high = (a, high) if stress(a).mean() < normal else (low, a)
        return 6 * (stress(a) * x).mean() / depth

    return max(moment(tilt) for tilt in np.geomspace(0.1, 300, 400) * u0 / depth)


def torque(bed, sides, normal=0.0):
    """The largest torque [N m] of a bed joint of these sides [m] between two rigid bricks, under a
    normal stress [Pa]: an integral of the law by itself. Cohesion softens with the slip, friction
    stays."""
    c, ks = bed.cohesion, bed.shearStiffness
    x, y = ((np.arange(400) + 0.5) / 400 * side - side / 2 for side in sides)
    r = np.hypot(*np.meshgrid(x, y))
    s0, brittleness = (c + bed.friction * normal) / ks, c**2 / (ks * bed.modeIIFractureEnergy)

    def at(twist):
        slip = twist * r
        bond = c * np.exp(-brittleness * np.maximum(slip / s0 - 1, 0))
        return (np.minimum(ks * slip, bond + bed.friction * normal) * r).mean()

    return sides[0] * sides[1] * max(map(at, np.geomspace(0.1, 300, 200) * s0 / max(sides)))


def number(value):
    """A cell: numbers with three digits."""
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def main(description, names, cases):
    """Carry out the cases that are asked for and print their table.

    :param names: heads of the columns between the name of the case and its processor time
    :param cases: dict from name to a function without arguments that gives the cells
    :returns: the exit status, 2 if one failed
    """
    options = argparse.ArgumentParser(description=description)
    options.add_argument(
        "--only", nargs="+", metavar="NAME", default=[], help="cases, or beginnings of their names"
    )
    asked = tuple(options.parse_args().only) or ("",)
    bad = False
    print(head(["case", *names, "CPU s"]), flush=True)
    for name, run in cases.items():
        if not name.startswith(asked):
            continue
        said, began = io.StringIO(), time.process_time()
        try:
            with contextlib.redirect_stdout(said):
                cells = run()
        except (Exception, SystemExit) as error:
            if getattr(error, "code", 0) == 130:  # interrupted
                raise
            print("\n".join(said.getvalue().splitlines()[-8:]), error, file=sys.stderr)
            cells, bad = ["failed"], True
        seconds = f"{time.process_time() - began:.0f}"
        print(line([name, *map(number, cells), seconds]), flush=True)
    return 2 * bad
