# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the rows of a study on a cluster: one job array of Slurm."""

import re
import shlex
import shutil
import subprocess
import sys

from masonry.run import batch
from masonry.errors import Refused
from masonry.terminal import say
from masonry.numbers.files import readWhole
from .gathering import written

SCRIPT = "slurm.sh"  # in the study's folder: what was submitted last
JOB = "slurm.job"  # there: the number of the job array
LEAST = 60  # [s] before the end of its time in which a task is asked to stop
ARRAY = 1001  # tasks that an array has at most where Slurm does not say


def check():
    """Refuse a machine without Slurm."""
    missing = [n for n in ("sbatch", "squeue", "scontrol") if not shutil.which(n)]
    if missing:
        raise Refused(
            f"--slurm: no {', '.join(missing)} here: run this where jobs are submitted, or apt-get"
            " install slurm-client"
        )


def _asked(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        why = done.stderr.strip() or f"exit status {done.returncode}"
        raise Refused(f"--slurm: {command[0]}: {why}")
    return done.stdout


def waiting(folder):
    """The number of the job array that still has tasks, or None."""
    try:
        job = readWhole(folder.of(JOB)).decode().strip()
    except OSError:
        return None
    command = ["squeue", "--noheader", "--jobs", job]
    done = subprocess.run(command, capture_output=True, text=True)
    return job if done.returncode == 0 and done.stdout.strip() else None


def script(folder, rows, largest):
    """The batch script of some rows. If they are more than an array may have tasks, a task has
    several, in turn."""
    each = -(-len(rows) // largest)
    tasks = -(-len(rows) // each)
    scene = folder.description()["script"]
    words = ["masonry_study.row", "--scene", scene, folder.path]
    runner = shlex.join([sys.executable, "-P", "-m", *words])
    return f"""#!/bin/bash
#SBATCH --job-name=study
#SBATCH --array=0-{tasks - 1}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:USR1@{LEAST}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
rows=({' '.join(map(str, rows))})
exec {runner} "${{rows[@]:$((SLURM_ARRAY_TASK_ID * {each})):{each}}}"
"""


def submit(folder, runs, words):
    """Submit one job array over the rows that are missing. Returns the exit status.

    :param words: options of sbatch
    """
    before = waiting(folder)
    if before:
        raise Refused(
            f"--slurm: job array {before} still has tasks of this study: wait for them, or scancel"
            f" {before}"
        )
    rows = [n for n in range(1, runs + 1) if not folder.isDone(n)]
    rows = sorted(folder.chains.lowest(rows))  # a task goes on with higher levels
    if not rows:
        say("all rows are ended: --gather writes study.csv")
        return 0
    config = _asked(["scontrol", "show", "config"])
    found = re.search(r"MaxArraySize\s*=\s*(\d+)", config)
    largest = max(1, int(found[1] if found else ARRAY) - 1)
    written(folder.of(SCRIPT), script(folder, rows, largest))
    log = f"--output={folder.of(batch.ROWS)}/slurm-%a.out"
    where = f"--chdir={folder.path}", *words, folder.of(SCRIPT)
    job = _asked(["sbatch", "--parsable", log, *where]).strip().split(";")[0]
    written(folder.of(JOB), job + "\n")
    say(
        f"{len(rows)} rows in job array {job}: squeue --jobs {job} shows it, --gather writes"
        " study.csv"
    )
    return 0
