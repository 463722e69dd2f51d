# SPDX-License-Identifier: GPL-2.0-or-later
"""Closed forms beside the engine: runs the cases of this folder, and prints and writes their table.

yade -n -x validation/closed_forms/closed_forms.py [--only NAME ...] [--quick] [--out FILE]
"""

import argparse
import contextlib
import io
import os
import sys
import traceback

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(HERE)]  # yade leaves it out
import arch_cases, column_cases, elastic_cases, motion_cases  # noqa: E401, E402, F401
import part_cases, shear_cases, wall_cases  # noqa: E401, E402, F401
from cases import CASES  # noqa: E402
from studies import head, line  # noqa: E402

HEAD = ["case", "what", "source", "expected", "measured", "error", "aim", "CPU s"]


def number(value):
    if isinstance(value, tuple):
        return " … ".join(f"{v:.5g}" for v in value)
    return f"{value:.5g}"


def row(result):
    """Cells of the table."""
    case = result.case
    share, form = (1, "{:+.2g}") if case.absolute else (100, "{:+.2f} %")
    unit = "" if case.absolute else " %"
    aim = "reported" if case.aim is None else f"± {share * case.aim:g}{unit}"
    if result.met is False:
        aim += ", **missed**"
    return [
        case.name,
        case.what,
        case.source,
        number(result.expected),
        number(result.measured),
        form.format(share * result.error),
        aim,
        f"{result.seconds:.1f}",
    ]


def carryOut(case, quick):
    """Run a case without what it prints. Returns its result, or None after telling what was
    raised."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            return case.run(quick)
    except (Exception, SystemExit):
        lines = said.getvalue().splitlines()
        print("\n".join(lines[-10:]), traceback.format_exc(), sep="\n", file=sys.stderr)
        return None


def chosen(only, problem):
    """The cases with these names, or beginnings of names; without any, all. ``problem`` is called
    with what is wrong."""
    names = [c.name for c in CASES]
    idle = [o for o in only if not any(n.startswith(o) for n in names)]
    if idle:
        problem(f"no case {', '.join(idle)}; there are {', '.join(names)}")
    return [c for c in CASES if not only or any(c.name.startswith(o) for o in only)]


def main(words=None):
    options = argparse.ArgumentParser(prog="closed_forms.py", description=__doc__)
    options.add_argument(
        "--only",
        nargs="+",
        metavar="NAME",
        default=[],
        help="cases, or beginnings of their names",
    )
    options.add_argument(
        "--quick",
        action="store_true",
        help="brackets are the aim around the expected value",
    )
    options.add_argument("--out", metavar="FILE", help="writes the tables there, too")
    args = options.parse_args(words)
    lines, bad, group, missed = [], False, None, []

    def tell(*more):
        lines.extend(more)
        print(*more, sep="\n", flush=True)
        if args.out:
            with open(args.out, "w") as file:
                file.write("\n".join(lines) + "\n")

    cases = chosen(args.only, options.error)
    tell(head(HEAD))
    for case in cases:
        if case.group != group:
            group = case.group
            tell(line([f"**{group}**", *[""] * 7]))
        result = carryOut(case, args.quick)
        if not result:
            tell(line([case.name, case.what, case.source, "", "failed", "", "", ""]))
            bad = True
            continue
        tell(line(row(result)))
        if result.met is False:
            missed.append(f"- {case.name}: {case.misses or 'the reason is not known'}")
            bad |= not case.misses
    if missed:
        tell("", "Missed:", "", *missed)
    return bad


if __name__ == "__main__":
    sys.exit(main())
