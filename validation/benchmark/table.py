# SPDX-License-Identifier: GPL-2.0-or-later
"""Seconds and microseconds a step of whole runs, of one build or of several side by side.

    # the plugin that is installed
    /usr/bin/python3 validation/benchmark/table.py
    # two folders with a `masonry` package each, some rows
    /usr/bin/python3 validation/benchmark/table.py SITE OLDER --rows fast wide

The builds take turns, and of each the best of ``--repeat`` runs counts. Scenes are those of this
repository. A row whose run fails, for example because an older build does not know one of its
options, has a dash. ``plain`` and ``plain plane`` are the steps of the plain program beside those
of ``rigid`` and ``deformable``, see ``plain.py``.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
YADE, ONE, PYTHON = (
    ["yade", "-n", "-x"],
    ["yade", "-j1", "-n", "-x"],
    ["/usr/bin/python3"],
)
COMP4 = "scripts/wall_comp4.py"


def ofSteps(folder, seconds, said):
    with open(os.path.join(folder, "run.json")) as file:
        return json.load(file)["microseconds_per_step"], "µs a step"


def ofRun(folder, seconds, said):
    return seconds, "s"


def ofImport(folder, seconds, said):
    return float(said), "s"


def ofWide(folder, seconds, said):
    return float(re.search(r"([\d.]+) µs a step", said)[1]), "µs a step"


def ofPlain(folder, seconds, said):
    return float(re.search(r"plain program +([\d.]+) µs", said)[1]), "µs a step"


PLAIN = [*PYTHON, "validation/benchmark/plain.py", "--rounds", "1"]
IMPORT = (
    "import time, masonry, yade; t = time.time(); from masonry import Scene; print(time.time() - t)"
)
#: Rows: the command, and a function of the folder of results, the seconds of the run, and what it
#: said that gives number and unit.
ROWS = {
    "fast": ([*YADE, COMP4, "--preset", "fast"], ofRun),
    "lean": ([*YADE, COMP4, "--preset", "fast", "--lean"], ofRun),
    "rigid": ([*ONE, COMP4, "--until", "3", "--rate", "20", "--lean"], ofSteps),
    "deformable": ([*ONE, COMP4, "--preset", "accurate", "--until", "1", "--lean"], ofSteps),
    "plain": (PLAIN, ofPlain),
    "plain plane": ([*PLAIN, "--plane", "--until", "1"], ofPlain),
    "accurate": ([*YADE, COMP4, "--preset", "accurate"], ofRun),
    "facade": ([*ONE, "scripts/gallery/facade.py", "--lean"], ofSteps),
    "house": ([*ONE, "scripts/gallery/house.py", "--lean"], ofSteps),
    "panel": ([*ONE, "scripts/gallery/panel.py", "--lean"], ofSteps),
    "gable": ([*ONE, "scripts/gallery/falling_gable.py", "--lean"], ofSteps),
    "shaken": (
        [
            *ONE,
            "validation/benchmark/shaken_facade.py",
            "--lean",
            "--preset",
            "fast",
            "--seconds",
            "2",
        ],
        ofSteps,
    ),
    "wide": ([*YADE, "validation/benchmark/benchmark.py", "--wide", "224", "224"], ofWide),
    "import": ([*PYTHON, "-c", IMPORT], ofImport),
}


def measured(row, site):
    """The number of a row and its unit; None if the run fails.

    :param site: folder with the package, or None: the one that is installed
    """
    command, numberOf = ROWS[row]
    paths = {"PYTHONPATH": os.path.abspath(site)} if site else {}
    with tempfile.TemporaryDirectory() as folder:
        words = [*command, "--out", folder] if numberOf in (ofSteps, ofRun) else command
        began = time.monotonic()
        run = subprocess.run(
            words, cwd=ROOT, env={**os.environ, **paths}, capture_output=True, text=True
        )
        seconds = time.monotonic() - began
        try:
            return numberOf(folder, seconds, run.stdout) if run.returncode == 0 else None
        except (OSError, TypeError, ValueError):
            return None


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("site", nargs="*", help="folder with a package, one for each build")
    p.add_argument("--rows", nargs="+", choices=list(ROWS), default=list(ROWS))
    p.add_argument("--repeat", type=int, default=2)
    args = p.parse_args()
    builds = args.site or [None]
    print("|".join(["", " run ", *(f" {b or 'installed'} " for b in builds), ""]))
    print("|".join(["", *["---"] * (1 + len(builds)), ""]))
    for row in args.rows:
        runs = [[measured(row, site) for site in builds] for _ in range(args.repeat)]
        best = [min(filter(None, one), default=None) for one in zip(*runs)]
        cells = [f" {one[0]:.4g} {one[1]} " if one else " - " for one in best]
        print("|".join(["", f" {row} ", *cells, ""]), flush=True)


if __name__ == "__main__":
    sys.exit(main())
