# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the rows of a study on this machine: ``/usr/bin/python3 -P -m masonry_study.local DIR JOBS``
imports YADE once, and runs each row by :mod:`masonry_study.row` in a copy of its process."""

import collections
import functools
import os
import shutil
import subprocess
import sys
import time

from masonry import background, host
from masonry.errors import Interrupted, Unwritable
from masonry.terminal import say
from masonry.folders import inside
from masonry.run import batch
from masonry.run.progress import Progress
from . import row
from .gathering import Folder
from .interrupts import STATUS

LOOK_EVERY = 0.5  # [s] between looks at rows that somebody else runs
LOG = "study.log"  # in the study's folder: what the programs say that run its rows
FREE_SPACE = 5e6  # bytes on the disk for the results and the checkpoint of every run at a time
MAX_ATTEMPTS = 3  # at a row that is killed each time
KEPT = "what was computed is kept, and the same command goes on when there is space"


def run(folder, jobs):
    """Run the rows of a study, ``jobs`` at a time, until each is ended or has failed, in a process
    without OpenTURNS, whose threads no copy of a process can have. Raises Interrupted after Ctrl-C
    and SIGTERM; another end before its time is said, and is SystemExit."""
    if not Local(folder, jobs).open:
        return
    words = [sys.executable, "-P", "-m", __name__, folder.path, str(jobs)]
    env = {**os.environ, "OMP_NUM_THREADS": "1"}
    how = dict(start_new_session=True, preexec_fn=background.endWithParent)
    begin = lambda words: subprocess.Popen(words, env=env, stdin=subprocess.DEVNULL, **how)
    background.carryOut([tuple(words)], begin, _programEnded, 1)


def _programEnded(words, program):
    if program.returncode == STATUS:
        raise Interrupted()
    if program.returncode < 0:
        say(f"{words[3]} was killed: the same command goes on", sys.stderr)
    if program.returncode:
        raise SystemExit(1)


class Local:
    """Runs the rows of a :class:`masonry_study.gathering.Folder`, ``jobs`` at a time, until each is
    ended or has failed."""

    def __init__(self, folder, jobs):
        record = folder.description()
        self.folder, self.runs, self.jobs = folder, record["study"]["runs"], jobs
        self.scene = record["script"]
        self.open = {n for n in range(1, self.runs + 1) if not folder.isDone(n)}
        self.failures, self.attempts = 0, collections.Counter()
        self.progress = Progress()

    def run(self):
        """Run them. Raises Interrupted after Ctrl-C and SIGTERM."""
        try:
            while self.open:
                # the program of a row goes on with the higher levels of its record
                lowest = self.folder.chains.lowest(self.open)
                mine = [n for n in sorted(lowest) if not self.folder.isHeld(n)]
                if not mine:  # somebody else runs all that is left
                    time.sleep(LOOK_EVERY)
                    self._look(self.open)
                background.carryOut(mine, self._begin, self._ended, self.jobs, self._show)
        except KeyboardInterrupt:
            raise Interrupted() from None

    def _begin(self, number):
        free = shutil.disk_usage(self.folder.path).free
        if free < FREE_SPACE * self.jobs:
            raise Unwritable(
                f"{self.folder.path} has {1e-6 * free:.1f} MB free, too little for {self.jobs} runs"
                " at a time: stopped"
            )
        words = ["--scene", self.scene, self.folder.path, str(number)]
        with open(self.folder.of(LOG), "ab", opener=inside) as log:
            return background.Program(functools.partial(row.main, words), log)

    def _ended(self, number, program):
        """See how far the program of a row has come, perhaps with the levels above."""
        rows = self.open.intersection([number, *self.folder.chains.higher(number)])
        self._look(rows)
        killed = not 0 <= program.returncode < 128
        for one in sorted(rows & self.open):
            if self.folder.isHeld(one):
                continue  # somebody else has begun to run it
            job = self.folder.lastJob(one)
            if not killed and job.get("status", 0) > 0:
                self._fail(one, job["told"] or f"exit status {job['status']}")
            elif one == number:
                self.attempts[one] += 1
                if self.attempts[one] == MAX_ATTEMPTS:
                    self._fail(one, f"it did not come to its end in {MAX_ATTEMPTS} attempts")

    def _look(self, rows):
        self.open -= {number for number in rows if self.folder.isDone(number)}

    def _show(self):
        done = self.runs - len(self.open)
        more = f", {self.failures} failed" if self.failures else ""
        text = lambda: f"{done - self.failures} of {self.runs} rows{more}"
        self.progress.show("study", done / self.runs, text, None, not self.open)

    def _fail(self, number, why):
        self.failures += 1
        self.open.remove(number)
        log = self.folder.row(number) + ".log"
        say(f"\nrow {batch.named(number)} failed: {why}; see {log}")


def main(path, jobs):
    host.load()
    try:
        Local(Folder(path), int(jobs)).run()
    except Interrupted:
        return STATUS
    except Unwritable as problem:
        say(f"{problem}; {KEPT}", sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
