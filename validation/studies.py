# SPDX-License-Identifier: GPL-2.0-or-later
"""What the studies of this folder share: where their runs go, running what is missing, and tables.

A study is a program that runs scenes with options as a user would, or builds scenes itself, and
prints a table. This module needs no YADE.
"""

import json
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor

from masonry.numbers.files import readRun

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
RESULTS = os.path.join(ROOT, "results")
SECONDS = "seconds_of_a_core"  # file of a run


def readCase(case):
    """Runs of a case by name, from its case.json: ``scene``, ``options`` and ``limits`` of each.

    ``quick``, the variant for the tests, is one of them if the case has it.
    """
    with open(os.path.join(HERE, case, "case.json")) as f:
        content = json.load(f)
    quick = {"quick": content["quick"]} if "quick" in content else {}
    return {**content["runs"], **quick}


def scenePath(scene):
    """The path of a scene of scripts/ or of its gallery, from the root of the repository."""
    name = scene.removesuffix(".py") + ".py"
    paths = (os.path.join("scripts", *folder, name) for folder in ((), ("gallery",)))
    return next(path for path in paths if os.path.exists(os.path.join(ROOT, path)))


def run(scene, options, out, threads=1, quiet=False):
    """Run a scene of scripts/ as a user would. Raises CalledProcessError if it fails.

    :param scene: its name
    :param options: list of words
    :param out: folder of its results
    """
    path = os.path.join(ROOT, scenePath(scene))
    command = ["yade", f"-j{threads}", "-n", "-x", path, "--out", out, *options]
    status, seconds = timed(command, stdout=subprocess.DEVNULL if quiet else None)
    if status:
        raise subprocess.CalledProcessError(status, command)
    with open(os.path.join(out, SECONDS), "w") as f:
        f.write(f"{seconds:.1f}\n")


def timed(command, **how):
    """Run a program, with the settings of subprocess.Popen. Returns its exit status, and the
    seconds of a core that it took with the programs it started."""
    process = subprocess.Popen(command, **how)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, used.ru_utime + used.ru_stime


def secondsOf(out):
    """Seconds of a core that the run of a folder took."""
    with open(os.path.join(out, SECONDS)) as f:
        return float(f.read())


def done(out):
    """Whether a folder holds a run that went to its end."""
    there = os.path.exists(os.path.join(out, "run.json"))
    return there and not readRun(out)["interrupted"]


def runMissing(tasks, jobs=1):
    """Run what has no results yet.

    :param tasks: list of (scene, list of options, folder of results)
    :param jobs: how many run at a time
    """

    def one(task):
        print(task[-1], flush=True)
        run(*task)

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, [task for task in tasks if not done(task[-1])]))


def nameOf(text):
    """A text as the name of a folder: options without their dashes, blanks and signs as
    underscores."""
    plain = "".join(c if c.isalnum() or c in ".…-" else "_" for c in text)
    return plain.replace("--", "") or "default"


def line(cells):
    """A line of a markdown table."""
    return f"| {' | '.join(map(str, cells))} |"


def head(names):
    """The two lines on top of a markdown table."""
    return line(names) + "\n" + line(["---"] * len(names))


def table(names, rows):
    """A markdown table."""
    return "\n".join([head(names), *map(line, rows)])
