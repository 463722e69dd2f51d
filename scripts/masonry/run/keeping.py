# SPDX-License-Identifier: GPL-2.0-or-later
"""The checkpoints that a run leaves by itself."""

import os
import sys
import time

import yade.config

from .._masonry import commit, version
from ..model import threads
from ..terminal import say
from .checkpoints import NAME, saveCheckpoint

#: Options that say where results are, and are no part of what was run.
ASIDE = ("resume", "out", "saved")


def hostNow():
    """What the last digits of a run can depend on."""
    software = {"build": commit, "masonry": version, "YADE": yade.config.version}
    return {**software, "threads": threads.ofYade()}


class Checkpoints:
    """Notes what a checkpoint keeps beside the scene, and writes it."""

    def __init__(self, run):
        self._run = run
        self.safe = None  # what a checkpoint keeps; None while steps are taken
        self.since = time.perf_counter()  # when one was written last [s]

    def keep(self):
        """Note what a checkpoint of this moment keeps, beside the scene."""
        run, at = self._run, self._run.at
        names = "begun", "before", "number", "stage", "steps", "left", "stages"
        self.safe = {name: getattr(at, name) for name in names}
        self.safe.update(memory=vars(run.memory).copy(), frameCount=len(at.frames))
        self.safe["rows"] = run.readings.count

    def mark(self):
        """As :meth:`keep`, after a stage has put the scene into another state."""
        self._run.at.left = 0
        self.keep()

    def markFall(self):
        """As :meth:`mark`, of a structure that was seen to fall between two steps; what fell within
        one has no checkpoint."""
        if self.safe:
            self.mark()

    def write(self):
        """Save the state after the last steps. Returns whether it could; a disk that refuses it
        does not end the run."""
        run, safe = self._run, self.safe
        if not (run.args.checkpoint_every and safe):
            return False
        run.flush()
        run.takeFound(True)
        if run.frames:
            run.awaitFrame()
            safe["frameCount"] = min(safe["frameCount"], len(run.at.frames))
        if len(run.results.rows) < safe["rows"] or run.results.earlier:
            return False
        run.results.begin()
        kept = run.state.kept()
        if safe["begun"] != run.at.begun:  # the present stage has taken no steps
            kept["now"] = run.at.before
        progress = dict(
            scene=run.name,
            options={n: v for n, v in vars(run.args).items() if n not in ASIDE},
            at={**vars(run.at), **kept, **safe},
            rows=run.results.rows,
            script=run.script,
            seconds=run.results.seconds(),
            host=hostNow(),
        )
        self.since, path = time.perf_counter(), run.results.path(NAME)
        try:
            saveCheckpoint(path, progress)
            return True
        except (OSError, ValueError, MemoryError) as error:
            stays = "; an earlier one stays" if os.path.exists(path) else ""
            why = f"no checkpoint could be written to {path}: {error}{stays}"
            say(f"warning: {why}", sys.stderr)
            return False
