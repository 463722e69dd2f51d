# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs rows of a study: ``/usr/bin/python3 -P -m masonry_study.row --scene FILE DIR NUMBER...``,
for a study on this machine, a task of Slurm, or GNU parallel.

A row of an incremental analysis is followed by the higher levels of its record, until the structure
falls. A row that was run is left out, one that was stopped goes on from its checkpoint, and one
that somebody else is running is left alone. ``DIR/rows/NUMBER.log`` has what it says. The exit
status is 0 if all rows are ended.

The scene is a program, and the folder of a study is data. So the user names the scene, unless it is
in the folder itself, and it must be the file with which the study began.
"""

import argparse
import contextlib
import functools
import hashlib
import json
import os
import signal
import socket
import subprocess
import sys
import time

if __name__ == "__main__":
    os.environ["OMP_NUM_THREADS"] = "1"  # which numpy reads

from masonry import background, host
from masonry.run import batch
from masonry.errors import FolderLocked, NotResumed, Refused
from masonry.terminal import say
from masonry.folders import inside
from masonry.numbers.files import readRun, readWhole
from .gathering import STUDY, TABLE, Folder, reason, rowsOf
from .incremental import FOLDER

REFUSED = 2  # exit status of a scene that refuses its input
ATTEMPTS = 20  # of a row at most, while its folder is held or its checkpoint refused
TAIL = 4000  # bytes at the end of a log in which the reason of a failure is looked for


class RowRunner:
    """Runs rows, and stops in order when it is asked to.

    :param scene: its file, as the user has named it; None: that of study.json, if it is in the
        folder
    :raises Refused: if the folder is not as a study leaves it, or the scene is another one
    """

    def __init__(self, path, scene=None):
        self.folder = Folder(path)
        self.folder.check()
        self.script = _sceneOf(self.folder, scene)
        rowsOf(self.folder)
        self.stopped = 0  # number of the signal that ended it
        self._child = None
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
            signal.signal(number, self._stop)

    def _stop(self, number, frame):
        self.stopped = self.stopped or number
        if self._child:
            self._child.send_signal(signal.SIGTERM)

    def run(self, number):
        """Run a row, unless it is done. Returns the exit status."""
        folder = self.folder
        if folder.isDone(number):
            return 0
        self._checkRecord(number)
        os.makedirs(folder.of(batch.ROWS), exist_ok=True)
        if folder.isHeld(number):
            return REFUSED  # somebody else runs it, and writes this log
        # what an attempt took that left a checkpoint belongs to the price of the row
        resumes = os.path.exists(folder.checkpoint(number))
        spent = folder.lastJob(number).get("seconds", 0) if resumes else 0
        began = time.monotonic()
        with open(folder.row(number) + ".log", "wb", opener=inside) as log:
            status = self._attempts(number, log)
        seconds = round(spent + time.monotonic() - began, 3)
        record = dict(host=socket.gethostname(), status=status, seconds=seconds)
        record["told"] = "" if status == 0 else self._reason(number)
        if status == 0 or not (folder.isHeld(number) or folder.isEnded(number)):
            path = folder.job(number) + f".{os.getpid()}"
            with open(path, "w", opener=inside) as f:
                json.dump(record, f)
            os.replace(path, folder.job(number))
        return 0 if folder.isEnded(number) else status

    def _checkRecord(self, number):
        """Refuse a record that is not the one with which the study began."""
        chains = self.folder.chains
        if not chains.plan:
            return
        one = chains.plan["records"][chains.record(number)]
        path = self.folder.of(FOLDER, one["name"] + ".txt")
        if _fingerprint(path) != one["sha256"]:
            raise Refused(
                f"{path} is not the record with which the study began; remove it, and begin the"
                " study again"
            )

    def _attempts(self, number, log):
        """Run it, once more from the beginning if its checkpoint is refused. Returns the exit
        status."""
        folder, checkpoint = self.folder, self.folder.checkpoint(number)
        for _ in range(ATTEMPTS):
            resumes = os.path.exists(checkpoint)
            status = self._runScene(number, log)
            if self.stopped:
                return 130
            if status == 0 and not folder.isEnded(number):
                return 1
            if status != REFUSED or folder.isEnded(number) or folder.isHeld(number):
                return status
            kind, _ = self._child.refusal()
            if kind == FolderLocked.__name__:  # that run has just ended, or was killed
                time.sleep(0.2)
            elif resumes and kind == NotResumed.__name__:
                os.replace(checkpoint, checkpoint + ".refused")
            else:
                return status
        return status

    def _runScene(self, number, log):
        host.load()
        env = {batch.VARIABLE: f"{self.folder.of(TABLE)}:{number + 1}"}
        act = functools.partial(host.runScript, self.script, [])
        self._child = background.Program(act, log, env, os.path.dirname(self.script))
        if self.stopped:
            self._child.send_signal(signal.SIGTERM)
        return self._child.wait()

    def _reason(self, number):
        """Why a row failed: what run.json has, what was refused, or the end of the log."""
        with contextlib.suppress(Refused):
            if error := readRun(self.folder.row(number)).get("error"):
                return error
        lines = [line.strip() for line in self._child.refusal()[1].splitlines()]
        log = self.folder.row(number) + ".log"
        with contextlib.suppress(OSError), open(log, "rb") as f:
            f.seek(max(0, os.fstat(f.fileno()).st_size - TAIL))
            lines = lines or reason(f.read().decode(errors="replace"))
        return "; ".join(lines[-3:])


def _sceneOf(folder, named):
    """The path of the scene that rows run. Raises Refused if the user has not named it, or if it
    has changed."""
    record = folder.description()
    path = os.path.abspath(named or record["script"])
    within = os.path.join(os.path.realpath(folder.path), "")
    if not named and not os.path.realpath(path).startswith(within):
        raise Refused(
            f"{folder.of(STUDY)} names the scene {path}, which is outside the folder of the study:"
            " a scene is a program, so name it yourself, with --scene FILE before the folder"
        )
    if _fingerprint(path, "the scene ") != record.get("scene_sha256"):
        raise Refused(
            f"the scene {path} is another file than the one with which the study in"
            f" {folder.path} began"
        )
    return path


def _fingerprint(path, what=""):
    try:
        return hashlib.sha256(readWhole(path)).hexdigest()
    except OSError as error:
        raise Refused(f"cannot read {what}{path}: {error.strerror}") from None


def parser():
    p = argparse.ArgumentParser(
        prog="python3 -P -m masonry_study.row", description="Run rows of a study."
    )
    scene = "the scene; not needed if it is in the folder of the study"
    p.add_argument("--scene", metavar="FILE", help=scene)
    p.add_argument("study", metavar="DIR", help="folder of the study")
    p.add_argument("rows", metavar="NUMBER", nargs="+", type=int, help="of a row, from 1")
    return p


def main(words):
    try:
        return _runRows(parser().parse_args(words))
    except Refused as refused:
        say(refused, sys.stderr)
        return REFUSED
    except OSError as error:
        say(f"cannot write {error.filename}: {error.strerror}", sys.stderr)
        return 1


def _runRows(args):
    runner = RowRunner(args.study, args.scene)
    chains = runner.folder.chains
    beyond = [str(n) for n in args.rows if not 1 <= n <= chains.runs]
    if beyond:
        raise Refused(f"no row {', '.join(beyond)}: {args.study} has {chains.runs}")
    say(f"note: this runs {runner.script}")
    worst = 0
    for number in dict.fromkeys(n for row in args.rows for n in (row, *chains.higher(row))):
        status = runner.run(number)
        if status:
            why = runner.folder.lastJob(number).get("told") or f"exit status {status}"
            say(f"row {batch.named(number)}: {why}", sys.stderr)
        worst = max(worst, status if status >= 0 else 128 - status)
        if runner.stopped:
            task = os.environ.get("SLURM_JOB_ID")
            if runner.stopped == signal.SIGUSR1 and task:  # it ran out of time
                subprocess.run(["scontrol", "requeue", task])
            return 130
    return worst


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
