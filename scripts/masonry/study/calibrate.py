# SPDX-License-Identifier: GPL-2.0-or-later
"""Finds properties from tests: ``/usr/bin/python3 -m masonry.study.calibrate FILE --out DIR``. scripts/STUDIES.md is the manual.

DIR gets ``calibration.json`` and, of measured curves, ``calibration.png``. The same command goes on with what was stopped.
"""

import argparse
import os
import sys

import numpy as np
from scipy import stats

from ..basics import Interrupted, Refused, Unwritable, say
from . import pictures
from .__main__ import load
from .calibration import Calibration


def table(found):
    """Lines on every property, and on every number that was measured."""
    of = found.calibration
    wide = max(map(len, of.names))
    yield f"{'property':{wide}}  {'value':>10}  {'95 % interval':^23}  deviation over that of the range"
    for name, value, low, high, spread in zip(of.names, found.sample.mean(axis=0), *found.intervals, found.spread):  # fmt: skip
        yield f"{name:{wide}}  {value:10.4g}  {low:10.4g} … {high:10.4g}  {spread:.2f}"
    yield "correlation, in this order"
    for line in found.correlation:
        yield "  " + " ".join(f"{v:5.2f}" for v in line)
    names = [name for one in of.specimens for name in one.names]
    run = found.run[0] if len(found.run) else np.full(len(names), np.nan)
    for name, value, low, high, one in zip(names, found.values, *found.bands(), run):
        yield f"  {name}: measured {value:.4g}, draws {low:.4g} … {high:.4g}, run with their means {one:.4g}"


def forStudies(found):
    """Lines of Python: the properties as a study takes them, whose curves then have a band."""
    of, draws = found.calibration, found.sample
    yield "for a Study with these properties, whose report draws the band of all curves:"
    yield "vary = {"
    for key, one, low, high in zip(of.keys, draws.T, of.low, of.high):
        cov = one.std() / abs(one.mean())
        yield f"    {key!r}: normal(mean={one.mean():.4g}, cov={cov:.3g}, low={low:.4g}, high={high:.4g}),"  # fmt: skip
    ranks = {
        (of.keys[m], of.keys[n]): float(stats.spearmanr(draws[:, m], draws[:, n]).statistic.round(2))
        for n in range(len(of.keys))
        for m in range(n)
    }  # fmt: skip
    yield f"}}\ncorrelation = {ranks}"


def main(words):
    """The program. Returns its exit status."""
    p = argparse.ArgumentParser(prog="python3 -m masonry.study.calibrate", description="Find properties from tests.")  # fmt: skip
    p.add_argument("file", metavar="FILE", help="Python file that makes one masonry.study.Calibration")  # fmt: skip
    p.add_argument("--out", metavar="DIR", required=True, help="folder of the results")
    p.add_argument("--jobs", metavar="N", type=int, default=len(os.sched_getaffinity(0)), help="runs at a time (default: %(default)s, all cores)")  # fmt: skip
    args = p.parse_args(words)
    try:
        near = os.path.dirname(os.path.abspath(args.file))
        found = load(args.file, Calibration).find(args.out, near, max(args.jobs, 1))
        for line in (*table(found), *found.doubts(), *forStudies(found)):
            say(line)
        if any(one.grid is not None for one in found.calibration.specimens):
            path = os.path.join(args.out, "calibration.png")
            pictures.calibration(path, found)
            say(path)
    except (KeyboardInterrupt, Interrupted):
        say("interrupted: the same command goes on from here")
        return 130
    except Refused as problem:
        say(problem, sys.stderr)
        return 2
    except (Unwritable, OSError) as problem:
        say(problem, sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
