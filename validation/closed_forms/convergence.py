# SPDX-License-Identifier: GPL-2.0-or-later
"""How answers of the engine come to those of rigid blocks with stiffer joints, more points and
slower loads.

yade -n -x validation/closed_forms/convergence.py [--out FILE]
"""

import argparse
import contextlib
import io
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(HERE)]  # yade leaves it out
from arch_cases import acceleration, oppenheim, tilting  # noqa: E402
from cases import Case  # noqa: E402
from motion_cases import quarter  # noqa: E402
from studies import head, line  # noqa: E402
from wall_cases import panel, tipping  # noqa: E402

STIFFNESS, POINTS = "joint stiffness [Pa/m]", "points along a joint"
#: What is measured, what changes, its values, and a function of such a value that gives the
#: expected and measured one.
STUDIES = [
    (
        "arch of 7, acceleration",
        STIFFNESS,
        (1e9, 1e10, 1e11, 1e12),
        lambda k: acceleration(oppenheim(), False, k),
    ),
    (
        "arch of 7, acceleration",
        POINTS,
        (3, 5, 8),
        lambda n: acceleration(oppenheim(), False, words=["--points", f"{n},{n}"]),
    ),
    (
        "arch of 7, tilt",
        "rate [degrees/s]",
        (16, 8, 4, 2, 1),
        tilting,
    ),
    (
        "panel, load in the middle, O = 0.25 W",
        STIFFNESS,
        (1e10, 1e11, 1e12),
        lambda k: panel(0.25, False, "free", k),
    ),
    (
        "block of 0.25 × 1 m, tips",
        STIFFNESS,
        (1e9, 1e10, 1e11),
        lambda k: tipping(False, inPlane=True, stiffness=k),
    ),
    (
        "block of 0.25 × 1 m, tips",
        POINTS,
        (2, 3, 5, 8),
        lambda n: tipping(False, inPlane=True, points=n),
    ),
    (
        "block of 0.25 × 1 m with 8 points, tips",
        STIFFNESS,
        (1e9, 1e10, 1e11),
        lambda k: tipping(False, inPlane=True, points=8, stiffness=k),
    ),
    (
        "rocking block, quarter period at θ0/α = 0.25",
        STIFFNESS,
        (1e8, 1e9, 1e10, 1e11),
        lambda k: quarter(0.25, k),
    ),
]


def error(result):
    """The error as text; of a limit that lies outside of where it was looked for, on which side."""
    low, high = result.measured if isinstance(result.measured, tuple) else (1.0, 1.0)
    if low == 0:
        return f"below {100 * (high / result.expected - 1):+.0f} %"
    if high == math.inf:
        return f"above {100 * (low / result.expected - 1):+.0f} %"
    return f"{100 * result.error:+.2f} %"


def main(words=None):
    options = argparse.ArgumentParser(prog="convergence.py", description=__doc__)
    options.add_argument("--out", metavar="FILE", help="writes the table there, too")
    out = options.parse_args(words).out
    lines = [head(["what", "changes", "values", "errors", "CPU s"])]
    print(lines[0])
    for what, changes, values, measure in STUDIES:
        found = []
        for value in values:
            one = Case(what, "", "", "", lambda quick, v=value: measure(v))
            with contextlib.redirect_stdout(io.StringIO()):
                found.append(one.run())
        errors = ", ".join(map(error, found))
        tried = ", ".join(f"{v:g}" for v in values)
        seconds = sum(r.seconds for r in found)
        lines.append(line([what, changes, tried, errors, f"{seconds:.0f}"]))
        print(lines[-1], flush=True)
        if out:
            with open(out, "w") as file:
                file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
