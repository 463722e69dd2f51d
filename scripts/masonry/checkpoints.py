"""Checkpoints: a scene's state on disk, from which a run goes on as if it had never stopped.

The pair :func:`saveCheckpoint`, :func:`loadCheckpoint` serves any scene; :class:`Resumable` is what the walls and the
couplet make of it.
"""

import json
import os
import sys
import time
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace

import yade.config
from yade import O
from yade.wrapper import MasonryVtkRecorder

from . import commit
from ._masonry import loadScene, savedText, saveScene
from .options import Refused
from .results import Progress, Results, Unwritable, say

NAME = "run.checkpoint"  # in the folder of a run
PARTS = "setup", "steps", "rows", "frames"  # of a run's time


def saveCheckpoint(path, extra=None):
    """Save the state of the scene beside the file of that name, and put it in its place when it is safely on the disk.

    Kept are time, bodies, joints, and the engines of this plugin; with :func:`loadCheckpoint` the run goes on from
    there bit for bit. Other engines, as a PyRunner, stay as the script makes them. A kill or a full disk at any moment
    leaves the old file or the new one, whole.

    :param path: file to write; ``path + ".new"`` stands beside it for a moment
    :param extra: what your script must know to go on: anything that JSON can hold
    :raises ValueError: if the state has left finite numbers; nothing is written then
    :raises OSError: if the disk refuses; the old file stays
    """
    data = saveScene(json.dumps(extra, allow_nan=False))
    beside = path + ".new"
    try:
        with open(beside, "wb") as f:
            f.write(data)
            f.flush()
            os.fsync(f.fileno())
        os.replace(beside, path)
    except OSError:
        if os.path.lexists(beside):
            os.remove(beside)
        raise
    folder = os.open(os.path.dirname(os.path.abspath(path)), os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def loadCheckpoint(path):
    """Give the scene, built by the same script with the same parameters, the state of a checkpoint.

    :returns: the ``extra`` of :func:`saveCheckpoint`
    :raises ValueError: if the file is damaged, or of another scene or version; the scene stays as it is
    :raises OSError: if it cannot be read
    """
    return _read(path, loadScene)


def readCheckpoint(path):
    """The ``extra`` of a checkpoint alone; checks that the file is whole. Errors as of :func:`loadCheckpoint`."""
    return _read(path, savedText)


def _read(path, textOf):
    with open(path, "rb") as f:
        data = f.read()
    try:
        return json.loads(textOf(data))
    except ValueError as error:
        raise ValueError(f"{path} {error}") from None


def readRun(directory):
    """What the checkpoint of a run tells of it, as a dict; raises Refused if a run cannot be taken up there."""
    path = os.path.join(directory, NAME)
    try:
        told = readCheckpoint(path)
    except (OSError, ValueError) as error:
        raise Refused(f"--resume: {error}") from None
    known = dict(scene=str, options=dict, at=dict, rows=list, seconds=float)
    if not isinstance(told, dict) or any(
        not isinstance(told.get(key), kind) for key, kind in known.items()
    ):
        raise Refused(f"--resume: {path} was not left by a wall or couplet")
    return told


@dataclass
class Place:
    """How far a run has come, beside the scene's state: all that its stages must know to go on."""

    stage: str = ""
    steps: int = 0
    seconds: dict = field(default_factory=lambda: dict.fromkeys(PARTS, 0.0))
    frames: list = field(default_factory=list)  # times of the ParaView frames [s]
    resumed: list = field(default_factory=list)  # times at which it was taken up [s]


class Resumable:
    """A run in stages, in a folder of results, that leaves checkpoints and can be taken up from the last.

    A subclass names its methods in ``stages``, builds its scene between ``__init__`` and :meth:`_begin`, steps by
    :meth:`_advance` alone, fills ``results.run`` in ``_describe()`` and tells in ``_report()``. In a run that is
    resumed the stage is entered with ``at`` as it was after the steps of an ``_advance``, in the state that they led
    to, and the first ``_advance`` does nothing. So a stage counts in ``at`` after it has advanced, and what it does
    before may be done twice.
    """

    def __init__(self, name, args, columns, at):
        self.name, self.args, self.at = name, args, at
        at.stage = self.stages[0]
        self.told = readRun(args.resume) if args.resume else None
        if self.told:
            if self.told["scene"] != name:
                raise Refused(
                    f"--resume: {args.resume} holds a run of {self.told['scene']}, this is {name}"
                )
            try:
                self.at = type(at)(**self.told["at"])
            except TypeError as error:
                raise Refused(
                    f"--resume: of another version of the plugin: {error}"
                ) from None
            if self.at.stage not in self.stages:
                raise Refused(
                    f"--resume: of another version of the plugin: stage '{self.at.stage}'"
                )
        self.results = Results(
            args.out or os.path.join("results", name), columns, bool(args.resume)
        )
        self.progress = Progress()
        self.advanced = False  # whether the next steps are done already
        self.safe, self.saved = None, time.monotonic()

    def _begin(self):
        """To be called when the scene is built: takes up what is resumed."""
        if self.told:
            self._takeUp()
        recorder = MasonryVtkRecorder(
            directory=self.results.directory, times=self.at.frames
        )
        try:
            if self.at.frames:
                recorder.collect()
        except RuntimeError as error:
            raise Refused(f"--resume: {error}") from None
        self.vtk = None if self.args.no_vtk else recorder

    def _takeUp(self):
        try:
            loadCheckpoint(self.results.path(NAME))
            self.results.takeUp(
                self.told["rows"], len(self.at.frames), self.told["seconds"]
            )
        except (ValueError, TypeError, OSError, Unwritable) as error:
            raise Refused(f"--resume: {error}") from None
        self.at.resumed.append(O.time)
        self.advanced = True
        for what, now in self._host().items():
            if self.told.get(what) != now:
                say(
                    f"note: the checkpoint was made with {what} {self.told.get(what)}, this run has {now}: "
                    "it may differ in last digits from one without a break"
                )

    @staticmethod
    def _host():
        return {
            "build": commit,
            "YADE": yade.config.version,
            "threads": O.numThreads,
        }

    def _advance(self, steps):
        """Run steps, then leave a checkpoint if one is due; raises Interrupted after Ctrl-C and SIGTERM."""
        if self.advanced:
            self.advanced = False
        else:
            self.safe = None
            with self._timed("steps"):
                for _ in range(steps):
                    O.step()
            self.at.steps += steps
        self.safe = replace(self.at), len(self.results.rows)
        if time.monotonic() - self.saved > 60 * self.args.checkpoint_every:
            self.checkpoint()
        self.results.checkInterrupt()

    @contextmanager
    def _timed(self, part):
        began = time.perf_counter()
        yield
        self.at.seconds[part] += time.perf_counter() - began

    def _rate(self):
        return self.at.steps / self.at.seconds["steps"] if self.at.steps else 0.0

    def _frame(self):
        if self.vtk:
            with self._timed("frames"):
                try:
                    self.vtk()
                except RuntimeError as error:
                    raise Unwritable(str(error)) from None
            self.at.frames = list(self.vtk.times)

    def checkpoint(self):
        """Save the state after the last steps; returns whether it could. A disk that refuses does not end the run."""
        if not (self.args.checkpoint_every and self.safe):
            return False
        at, rows = self.safe
        told = dict(
            scene=self.name,
            options={
                name: value
                for name, value in vars(self.args).items()
                if name not in ("resume", "out")
            },
            at=asdict(at),
            rows=self.results.rows[:rows],
            seconds=self.results.seconds(),
            **self._host(),
        )
        self.saved = time.monotonic()
        path = self.results.path(NAME)
        try:
            saveCheckpoint(path, told)
            return True
        except (OSError, ValueError) as error:
            say(
                f"warning: no checkpoint could be written to {path}: {error}; an earlier one stays",
                sys.stderr,
            )
            return False

    def finish(self):
        """Last frame, run.json, even if there was no room for the frame, and report, from whatever was computed."""
        try:
            if self.results.rows:
                self._frame()
        finally:
            self._describe()
            self.results.close()
        self._report()
