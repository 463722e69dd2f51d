# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs, resumes and gathers a study: ``/usr/bin/python3 -m masonry_study FILE --out DIR``.
scripts/STUDIES.md is the manual."""

import argparse
import os
import runpy
import sys

from . import interrupts

if __name__ == "__main__":
    interrupts.block()

from masonry.errors import Interrupted, Refused, Unwritable
from masonry.terminal import say
from . import local, slurm
from .calibrate import Calibration
from .gathering import CSV, Folder, gather
from .plan import Study
from .start import NOTHING, begin


SWITCHES = {
    "--slurm": "run the rows on a cluster: one job array",
    "--prepare": "check the study and make its folder; run nothing",
    "--gather": "write study.csv of what is there; run nothing",
}


def parser():
    p = argparse.ArgumentParser(
        prog="python3 -m masonry_study",
        description=(
            "Run a scene many times with values that vary; go on with a study that was stopped;"
            " gather what came out."
        ),
        epilog=(
            "With --slurm all other options, for example --partition=long --time=2:00:00, are those"
            " of sbatch."
        ),
    )
    file = "Python file that makes one masonry_study.Study or Calibration; not needed to --gather"
    jobs = "runs at a time (default: %(default)s, all cores)"
    cores = len(os.sched_getaffinity(0))
    p.add_argument("file", metavar="FILE", nargs="?", help=file)
    p.add_argument("--out", metavar="DIR", required=True, help="folder of the study")
    p.add_argument("--jobs", metavar="N", type=int, default=cores, help=jobs)
    for name, what in SWITCHES.items():
        p.add_argument(name, action="store_true", help=what)
    return p


def load(path):
    """The study or calibration that a file makes. Raises Refused if it makes none or several."""
    if not os.path.isfile(path):
        raise Refused(f"no file {path}")
    with interrupts.watched(NOTHING):
        made = runpy.run_path(path).values()
    studies = {id(v): v for v in made if isinstance(v, (Study, Calibration))}
    if len(studies) != 1:
        raise Refused(
            f"{path} must make one masonry_study.Study or Calibration, it makes {len(studies)}"
        )
    return studies.popitem()[1]


def tell(folder):
    """Gather, and say what is there. Returns the exit status."""
    folder.check()
    counts = gather(folder)
    summary = ", ".join(f"{n} {status}" for status, n in sorted(counts.items()))
    say(f"{summary}; see {folder.of(CSV)}")
    return 0 if set(counts) <= {"ended", "above collapse"} else 1


def main(words):
    p = parser()
    args, more = p.parse_known_args(words)
    if more and not args.slurm:
        p.error(f"unrecognized arguments: {' '.join(more)}")
    if not args.file and not args.gather:
        p.error("FILE is missing")
    if not args.jobs > 0:
        p.error(f"--jobs {args.jobs} must be at least 1")
    try:
        if args.gather:
            return tell(Folder(args.out))
        if args.slurm:
            slurm.check()
        study = load(args.file)
        near = os.path.dirname(os.path.abspath(args.file))
        if isinstance(study, Calibration):
            if args.slurm or args.prepare:
                raise Refused("a calibration runs here: --slurm and --prepare are of studies")
            say("\n".join(study.find(args.out, near, args.jobs).lines()))
            return 0
        folder = begin(study, args.out, near)
        if args.slurm:
            return slurm.submit(folder, study.runs, more)
        if args.prepare:
            say(f"{study.runs} rows; see {folder.path}")
            return 0
        try:
            local.run(folder, args.jobs)
        except Interrupted:
            tell(folder)
            say("interrupted: the same command goes on from here")
            return 130
        return tell(folder)
    except KeyboardInterrupt:
        say("interrupted: what was computed is kept; the same command goes on")
        return interrupts.STATUS
    except Refused as problem:
        say(problem, sys.stderr)
        return 2
    except Unwritable as problem:
        say(f"{problem}; {local.KEPT}", sys.stderr)
        return 1
    except OSError as error:
        name = error.filename or args.out
        say(f"cannot write {name}: {error.strerror}; {local.KEPT}", sys.stderr)
        return 1


def program(words):
    """The program, with Ctrl-C as it was before this module was imported. Returns the exit
    status."""
    try:
        interrupts.unblock()
        return main(words)
    except KeyboardInterrupt:
        say(NOTHING)
        return interrupts.STATUS


if __name__ == "__main__":
    sys.exit(program(sys.argv[1:]))
