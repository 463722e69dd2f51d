# SPDX-License-Identifier: GPL-2.0-or-later
"""The program ``python3 -m masonry_view.report``."""

import argparse
import sys

from masonry import memory
from masonry.numbers.files import program

from ..pages import save
from . import NAME, page, read


@program
def main(words=None):
    """Write the report of a run."""
    parser = argparse.ArgumentParser(
        prog="masonry_view.report",
        description="Write the report of a run, one file that any browser opens, from the files in"
        " its folder.",
    )
    parser.add_argument("result", help="folder of results")
    parser.add_argument(
        "-o",
        "--out",
        metavar="FILE.html",
        help=f"where to write it (default: {NAME} in the folder of results)",
    )
    args = parser.parse_args(words)
    memory.reserve()
    record = read(args.result)
    save(lambda: page(record), args.out, args.result, NAME)


if __name__ == "__main__":
    sys.exit(main())
