# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the rows of a study on this machine, with YADE's own yade-batch."""

import contextlib
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time

from ..run import batch
from ..basics import Interrupted, Refused, Unwritable, say
from ..folders import inside
from ..run.progress import Progress
from .gathering import TABLE

LOOK_EVERY = 0.5  # [s]
LOG = "study.log"  # of yade-batch, in the study's folder
FREE_SPACE = 5e6  # bytes that must be free on the disk for every run at a time: its results and a checkpoint
TRIES = 3  # starts of yade-batch in which no row comes to an end


def lines(numbers):
    """Lines of a table as yade-batch takes them, from the numbers of rows: 2-4,7."""
    parts, run = [], []
    for line in [*(n + 1 for n in sorted(numbers)), None]:
        if run and line != run[-1] + 1:
            parts.append(f"{run[0]}-{run[-1]}" if run[1:] else f"{run[0]}")
            run = []
        run.append(line)
    return ",".join(parts)


def yadeBatch():
    """Path of yade-batch. Raises Refused where it is missing."""
    path = shutil.which("yade-batch")
    if not path:
        raise Refused(
            "a study needs yade-batch: apt-get install --no-install-recommends yade"
        )
    return path


class Local:
    """Runs rows until each is ended or has failed.

    :param folder: :class:`masonry.study.gathering.Folder`
    :param runs: how many rows there are
    :param jobs: how many at a time
    """

    def __init__(self, folder, runs, jobs):
        self.folder, self.runs, self.jobs = folder, runs, jobs
        self.scene = folder.description()["script"]
        self.open = {n for n in range(1, runs + 1) if not folder.isDone(n)}
        self.failed, self.interrupted = {}, False
        self.progress = Progress()
        self._process, self._before = None, self._stamps()
        self._groups = []  # of processes: every yade-batch with its jobs
        self._shown = False  # whether the end has been shown

    def run(self):
        """Run them. Returns the numbers of rows that failed. Raises Interrupted after Ctrl-C and SIGTERM."""
        handlers = {
            n: signal.signal(n, self._interrupt)
            for n in (signal.SIGINT, signal.SIGTERM)
        }
        try:
            idle = 0
            while self.open and idle < TRIES and not self.interrupted:
                self._checkSpace()
                before = len(self.open)
                # a job goes on with the higher levels of its record
                lowest = self.folder.chains.lowest(self.open)
                mine = {n for n in lowest if not self.folder.isHeld(n)}
                if mine:
                    self._batch(mine)
                else:  # somebody else runs all that is left
                    time.sleep(LOOK_EVERY)
                self._look()
                idle = idle + bool(mine) if len(self.open) == before else 0
            if self.interrupted:
                self._stop()
                raise Interrupted()
            for number in self.open:
                self._fail(number, f"it did not come to its end in {TRIES} attempts")
        finally:
            for number, handler in handlers.items():
                signal.signal(number, handler)
        return self.failed

    def _interrupt(self, number, frame):
        self.interrupted = True

    def _batch(self, numbers):
        """One yade-batch over some rows, to its end."""
        self._before = self._stamps()
        runner = [sys.executable, "-P", "-m", "masonry.study.row"]
        command = [sys.executable, "-P", "-m", "masonry.study.yadebatch", yadeBatch()]
        command += ["-j", str(self.jobs), "--job-threads", "1", "--disable-pynotify"]
        command += ["--nice", "0", "--plot-update", "0", "--log", f"{batch.ROWS}/@.log"]
        command += ["--executable", shlex.join(runner), "--lines", lines(numbers)]
        # the scene of a row is that of the study; the name tells yade-batch that it is one
        command += [TABLE, "scene.py"]
        env = {**os.environ, "OMP_NUM_THREADS": "1", batch.SCENE: self.scene}
        env.pop(batch.VARIABLE, None)
        with open(self.folder.of(LOG), "ab", opener=inside) as log:
            self._process = subprocess.Popen(
                command,
                cwd=self.folder.path,
                env=env,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        self._groups.append(self._process.pid)
        while self._process.poll() is None and not self.interrupted:
            time.sleep(LOOK_EVERY)
            self._look(quick=True)
            self._checkSpace()

    def _checkSpace(self):
        """Stop a study whose disk is nearly full. Raises Unwritable."""
        free = shutil.disk_usage(self.folder.path).free
        if free < FREE_SPACE * self.jobs:
            self._stop()
            raise Unwritable(
                f"{self.folder.path} has {1e-6 * free:.1f} MB free, too little for {self.jobs} runs at a time: stopped"
            )

    def _stop(self):
        """Tell all jobs to stop, also those of a yade-batch that was killed, and wait until they have left checkpoints."""
        for group in self._groups:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(group, signal.SIGTERM)
        if self._process:
            self._process.wait()
        for _ in range(100):
            if not any(self.folder.isHeld(n) for n in self.open):
                break
            time.sleep(0.1)

    def _look(self, quick=False):
        """See which rows have come to an end, and tell.

        :param quick: look only where an attempt has ended
        """
        names = set(os.listdir(self.folder.of(batch.ROWS))) if quick else ()
        jobOf = lambda number: os.path.basename(self.folder.job(number))
        for number in sorted(self.open):
            if quick and jobOf(number) not in names:
                continue
            if number not in self.open:
                continue  # above the collapse of one before
            if self.folder.isEnded(number):
                self.open.remove(number)
                if self.folder.hasFallen(number):
                    self.open -= set(self.folder.chains.higher(number))
                continue
            last = self._job(number)
            if last and last["status"] > 0 and last["status"] != 130:
                self._fail(number, last["told"] or f"exit status {last['status']}")
        self.open -= set(self.failed)
        self._show(not self.open)

    def _show(self, final):
        if self._shown:
            return
        self._shown = final
        done = self.runs - len(self.open)
        failed = f", {len(self.failed)} failed" if self.failed else ""
        self.progress.show(
            "study",
            done / self.runs,
            lambda: f"{done - len(self.failed)} of {self.runs} rows{failed}",
            None,
            final,
        )

    def _job(self, number):
        """How an attempt at a row in this yade-batch ended, or None."""
        stamp = self._stamp(number)
        if stamp in (None, self._before.get(number)):
            return None
        return self.folder.lastJob(number) or None

    def _stamps(self):
        """What the records of earlier attempts are known by: a clock that jumps cannot say which are new."""
        return {number: self._stamp(number) for number in self.open}

    def _stamp(self, number):
        try:
            found = os.stat(self.folder.job(number))
        except OSError:
            return None
        return found.st_ino, found.st_mtime_ns

    def _fail(self, number, why):
        self.failed[number] = why
        say(
            f"\nrow {batch.named(number)} failed: {why}; see {self.folder.row(number)}.log"
        )
