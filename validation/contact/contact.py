# SPDX-License-Identifier: GPL-2.0-or-later
"""Contacts of rigid blocks beside closed forms and published results: runs the cases of this
folder, and prints their table.

yade -n -x validation/contact/contact.py [--only NAME ...] [--quick] [--out FILE]
"""

import argparse
import os
import sys
import time
import traceback

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(HERE)]  # yade leaves it out
import contact_arch, contact_motion, contact_steps  # noqa: E401, E402, F401
from contact_rows import CASES  # noqa: E402
from studies import head, line  # noqa: E402
from yade import O  # noqa: E402

HEAD = "case, what, source, expected, measured, error, limit, CPU s".split(", ")


def main(words=None):
    """Run cases. Returns whether one failed or missed a limit."""
    options = argparse.ArgumentParser(prog="contact.py", description=__doc__)
    options.add_argument(
        "--only", nargs="+", metavar="NAME", default=[], help="cases, or beginnings of their names"
    )
    options.add_argument("--quick", action="store_true", help="shorter runs")
    options.add_argument("--out", metavar="FILE", help="writes the table there, too")
    args = options.parse_args(words)
    idle = [o for o in args.only if not any(n.startswith(o) for n in CASES)]
    if idle:
        options.error(f"no case {', '.join(idle)}; there are {', '.join(CASES)}")
    lines, missed, bad = [], [], False

    def tell(*more):
        lines.extend(more)
        print(*more, sep="\n", flush=True)
        if args.out:
            with open(args.out, "w") as file:
                file.write("\n".join(lines) + "\n")

    tell(head(HEAD))
    for name, run in CASES.items():
        if args.only and not any(name.startswith(o) for o in args.only):
            continue
        began = time.process_time()
        O.reset()
        try:
            rows = run(args.quick)
        except (Exception, SystemExit):
            traceback.print_exc()
            tell(line([name, "failed", "", "", "", "", "", ""]))
            bad = True
            continue
        seconds = f"{time.process_time() - began:.1f}"
        for n, row in enumerate(rows):
            tell(line([name, *row.cells(), "" if n else seconds]))
            if row.met is False:
                missed.append(f"- {name}, {row.what}: {row.misses or 'the reason is not known'}")
                bad = True
    if missed:
        tell("", "Missed:", "", *missed)
    return bad


if __name__ == "__main__":
    sys.exit(main())
