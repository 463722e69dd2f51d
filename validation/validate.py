# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs validation cases as a user would, measures the results and holds them against the limits of
case.json.

/usr/bin/python3 validation/validate.py CASE [RUN ...] [--measure]
"""

import argparse
import glob
import math
import os
import sys

from masonry_view.measure import measure
from studies import HERE, RESULTS, readCase, run


def bounds(limits, name, other):
    """The two bounds of a number. A bound that is the name of a case stands for that number in its
    run."""
    value = lambda bound: other(bound)[name] if isinstance(bound, str) else bound
    low, high = (value(bound) for bound in limits)
    return (-math.inf if low is None else low, math.inf if high is None else high)


def check(limits, numbers, other):
    """Compare numbers with limits, and print a line a limit. Returns whether all hold.

    :param limits: dict of name -> [low, high], null for none
    :param numbers: what :func:`masonry_view.measure.measure` returns; a number that it has not, as
        where the force never falls, misses its limit
    :param other: function of a case's name -> the numbers of its run
    """
    fine = True
    for name, pair in limits.items():
        low, high = bounds(pair, name, other)
        number = numbers.get(name, math.nan)
        holds = low <= number <= high
        fine = fine and holds
        verdict = "holds" if holds else "MISSED"
        print(f"  {name:34} {number:12.5g}  [{low:.5g}, {high:.5g}]  {verdict}")
    return fine


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    cases = glob.glob(os.path.join(HERE, "*", "case.json"))
    names = sorted(os.path.basename(os.path.dirname(case)) for case in cases)
    parser.add_argument("case", choices=names, help="folder in validation/")
    parser.add_argument("run", nargs="*", help="runs of its case.json (default: all)")
    parser.add_argument("--measure", action="store_true", help="measure the results there are")
    parser.add_argument(
        "--results",
        default=os.path.join(RESULTS, "validation"),
        help="folder of the results",
    )
    args = parser.parse_args(words)
    runs = readCase(args.case)
    unknown = set(args.run) - set(runs)
    if unknown:
        parser.error(f"no run {', '.join(unknown)}; there are {', '.join(runs)}")
    fine = True
    for name in args.run or [name for name in runs if name != "quick"]:
        folder = lambda case: os.path.join(args.results, case, name)
        if not args.measure:
            chosen = runs[name]
            run(chosen["scene"], chosen["options"], folder(args.case))
        print(f"{args.case} {name}", flush=True)
        numbers = measure(folder(args.case))
        held = check(runs[name]["limits"], numbers, lambda case: measure(folder(case)))
        fine = fine and held
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
