# SPDX-License-Identifier: GPL-2.0-or-later
"""The program ``python3 -m masonry_view.report``."""

import argparse
import os
import sys

from masonry import folders, memory
from masonry.errors import Refused
from masonry.terminal import say
from masonry.numbers.files import program
from . import NAME, read, write


@program
def main(words=None):
    """Write the report of a run."""
    parser = argparse.ArgumentParser(
        prog="masonry_view.report",
        description=(
            "Write the report of a run, one file that any browser opens, from the files in its"
            " folder."
        ),
    )
    parser.add_argument("result", help="folder of results")
    parser.add_argument(
        "-o",
        "--out",
        metavar="FILE.html",
        help=f"where to write it (default: {NAME} in the folder of results)",
    )
    args = parser.parse_args(words)
    path = args.out or os.path.join(args.result, NAME)
    if os.path.isdir(path) or not path.endswith((".html", ".htm")):
        raise Refused(f"{path} must be a file whose name ends in .html or .htm")
    if not args.out:
        folders.check(args.result)
    memory.reserve()
    record = read(args.result)
    try:
        write(record, path)
    except OSError as problem:
        raise Refused(f"cannot write {path}: {problem.strerror}") from None
    say(f"{path}: {os.path.getsize(path) / 1e6:.2f} MB; any browser opens it")


if __name__ == "__main__":
    sys.exit(main())
