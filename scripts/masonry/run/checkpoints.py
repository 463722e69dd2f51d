# SPDX-License-Identifier: GPL-2.0-or-later
"""Checkpoints: the state of a scene on disk, from which a run goes on as if it had never stopped.

:func:`saveCheckpoint` and :func:`loadCheckpoint` serve any scene. A run in stages leaves its
checkpoints by :class:`Checkpoints`; :class:`Saved` is one that is read back. They keep the state in
YADE, :class:`SceneState`, the :class:`masonry.run.run_state.RunState` and the rows of curve.csv.
"""

import base64
import contextlib
import json
import os
import sys
import time
import zlib
from dataclasses import field, fields, is_dataclass
from types import SimpleNamespace
from typing import Any

import yade.config

from .._masonry import commit, loadScene, savedText, saveScene, version
from ..arguments import FilePath, shown, validated
from ..errors import NotResumed
from ..folders import replaced
from ..model import threads
from ..numbers.files import readWhole
from ..terminal import say
from .run_state import RunState

NAME = "run.checkpoint"  # in the folder of a run
COMPRESSED = b"x"  # begins what zlib has compressed
#: Options that say where results are, and are no part of what was run.
NO_OPTIONS = "resume", "out", "saved"


@validated
def saveCheckpoint(path: FilePath, extra: Any = None) -> None:
    """Save the state of the scene in a file, so that :func:`loadCheckpoint` goes on from it bit for
    bit.

    Saved are the time, the bodies, the joints, and the engines of this plugin. Other engines, for
    example a PyRunner, stay as the script makes them. A kill or a full disk at any moment leaves
    the old file or the new one, whole.

    :param path: file to write; ``path + ".new"`` is beside it for a moment
    :param extra: what your script must know to go on: anything that JSON can hold
    :raises ValueError: if a number of the state is not finite; nothing is written then
    :raises OSError: if the file cannot be written, or one of both is a symbolic link; the old one
        stays
    """
    try:
        kept = json.dumps(extra, allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise ValueError(
            f"saveCheckpoint: extra {shown(extra)} must be what JSON can hold: {error}"
        ) from None
    data = saveScene(kept)
    with replaced(path, "wb") as f:
        f.write(zlib.compress(data, 1))
    folder = os.open(os.path.dirname(os.path.abspath(path)), os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


@validated
def loadCheckpoint(path: FilePath) -> Any:
    """Give the scene, built by the same script with the same parameters, the state of a checkpoint.

    :returns: the ``extra`` of :func:`saveCheckpoint`
    :raises ValueError: if the file is damaged, or of another scene or version; the scene stays as
        it is
    :raises OSError: if it cannot be read
    """
    data, extra = readState(path)
    with _says(path):
        loadScene(data)
    return extra


@validated
def readCheckpoint(path: FilePath) -> Any:
    """The ``extra`` of a checkpoint alone. Raises what :func:`loadCheckpoint` raises."""
    return readState(path)[1]


def readState(path: FilePath) -> tuple[bytes, Any]:
    """The bytes of a checkpoint, as ``loadScene`` takes them, and its ``extra``. Raises as
    :func:`readCheckpoint`."""
    with _says(path):
        data = readWhole(path)
        if data[:1] == COMPRESSED:  # else as saveScene gives it, as in files of before
            whole = zlib.decompressobj()
            data = whole.decompress(data)
            if not whole.eof:
                raise ValueError("is cut short: its compressed bytes do not end")
        return data, json.loads(savedText(data))


@contextlib.contextmanager
def _says(path):
    """Let every error in the contents of a checkpoint be a ValueError that names the file."""
    try:
        yield
    except MemoryError:
        raise ValueError(f"{path} is too large for the memory") from None
    except zlib.error as error:
        raise ValueError(f"{path} is damaged: {error}") from None
    except (ValueError, OverflowError) as error:
        raise ValueError(f"{path} {error}") from None


# -- what stages remember --------------------------------------------------------------------------


def record(cls):
    """A field of a memory that is None or a dataclass object, whose fields all have defaults."""
    return field(default=None, metadata={"record": cls})


def contentsOf(memory):
    """The values of a memory by their names, as JSON can hold them."""
    of = lambda value: contentsOf(value) if is_dataclass(value) else value
    return {name: of(value) for name, value in vars(memory).items()}


def restored(example, values):
    """A dataclass object like an example with the values of a checkpoint. Raises NotResumed if it
    has other fields."""
    compareNames(values, vars(example))
    described = fields(example) if is_dataclass(example) else ()
    records = {one.name: one.metadata["record"] for one in described if one.metadata}
    of = lambda n, v: restored(records[n](), v) if n in records and v else v
    return type(example)(**{name: of(name, value) for name, value in values.items()})


def compareNames(values, example):
    """Refuse entries of a checkpoint that have other names than in this version."""
    if unlike := values.keys() ^ example.keys():
        raise otherVersion(f"its {', '.join(sorted(unlike))}")


def otherVersion(why):
    return NotResumed(f"--resume: of another version of the plugin: {why}")


# -- the state of a scene --------------------------------------------------------------------------


def stateOf(scene):
    """What stages have set of a scene in Python, as JSON can hold it."""
    of = ("until", "history", "rate") if scene.pushed else ()
    return {
        "model": scene.model.state(),
        "grown": scene.grown,
        "loadUnit": scene.loadUnit,
        "pushed": {name: getattr(scene.pushed, name) for name in of},
    }


def putState(scene, state):
    scene.model.putState(state["model"])
    scene.grown, scene.loadUnit = state["grown"], state["loadUnit"]
    pushed = state["pushed"]
    scene.pushed = SimpleNamespace(**{**vars(scene.args), **pushed}) if pushed else None


class SceneState:
    """What a checkpoint keeps of a scene that is built, beside its state in YADE."""

    def __init__(self, scene):
        self._scene, self._model = scene, scene.model
        self.isRestored = False  # whether the scene has the state of a checkpoint again

    def entries(self):
        """Entries of :class:`RunState`."""
        atRest = base64.b64encode(self._model.atRest or b"").decode()
        of = {"places": self._model.motion.places, "far": self._model.motion.far}
        return {"now": stateOf(self._scene), "atRest": atRest, **of}

    def put(self, state):
        putState(self._scene, state)
        self.isRestored = True

    def takeRest(self, state):
        """Take the last state at rest from a :class:`RunState`."""
        if state.atRest:
            self._model.atRest = base64.b64decode(state.atRest)
        self._model.motion.places, self._model.motion.far = state.places, state.far


# -- the checkpoints of a run ----------------------------------------------------------------------


def hostNow():
    """What the last digits of a run can depend on."""
    software = {"build": commit, "masonry": version, "YADE": yade.config.version}
    return {**software, "threads": threads.ofYade()}


class Checkpoints:
    """The checkpoints that a run leaves: what they keep beside the scene, and when they are
    written."""

    def __init__(self, run):
        self._run = run
        self.saved = (
            None  # entries of RunState at the last whole moment; None while steps are taken
        )
        self.since = time.perf_counter()  # when one was written last [s]

    def save(self):
        """Note what a checkpoint of this moment keeps, beside the scene."""
        run, state = self._run, self._run.state
        names = "begun", "before", "number", "stage", "steps", "left", "stages"
        self.saved = {name: getattr(state, name) for name in names}
        self.saved.update(memory=contentsOf(run.memory), frameCount=len(state.frames))
        self.saved["rows"] = run.readings.count

    def setRollbackPoint(self):
        """:meth:`save` after a stage has put the scene into another state."""
        self._run.state.left = 0
        self.save()

    def recordFall(self):
        """:meth:`setRollbackPoint` of a structure that was seen to fall between two steps; a fall
        within a step has none."""
        if self.saved:
            self.setRollbackPoint()

    def write(self):
        """Write what :meth:`save` has noted and the scene to the disk. Returns whether there is a
        checkpoint; a disk that refuses it does not end the run."""
        run, saved = self._run, self.saved
        if not (run.args.checkpoint_every and saved):
            return False
        run.flush()
        run.takeFound(True)
        if run.frames:
            run.awaitFrame()
            saved["frameCount"] = min(saved["frameCount"], len(run.state.frames))
        if len(run.results.rows) < saved["rows"] or run.results.earlier:
            return False
        run.results.begin()
        ofScene = run.sceneState.entries()
        if saved["begun"] != run.state.begun:  # the present stage has taken no steps
            ofScene["now"] = run.state.before
        contents = dict(
            scene=run.name,
            options={n: v for n, v in vars(run.args).items() if n not in NO_OPTIONS},
            state={**vars(run.state), **ofScene, **saved},
            rows=run.results.rows,
            script=run.script,
            seconds=run.results.seconds(),
            host=hostNow(),
        )
        self.since, path = time.perf_counter(), run.results.path(NAME)
        try:
            saveCheckpoint(path, contents)
            return True
        except (OSError, ValueError, MemoryError) as error:
            stays = "; an earlier one stays" if os.path.exists(path) else ""
            why = f"no checkpoint could be written to {path}: {error}{stays}"
            say(f"warning: {why}", sys.stderr)
            return False


class Saved:
    """A checkpoint that a run left, read from the disk once. Its attributes are the ``contents`` of
    :meth:`Checkpoints.write`.

    :raises NotResumed: if no run can be resumed there
    """

    def __init__(self, directory):
        self.directory = directory
        try:
            self._data, saved = readState(os.path.join(directory, NAME))
        except FileNotFoundError:
            raise NotResumed(
                f"--resume: {directory} has no {NAME}, which a run leaves unless it is --lean and"
                " has come to its end"
            ) from None
        except (OSError, ValueError) as error:
            raise NotResumed(f"--resume: {error}") from None
        names = "scene options state rows script seconds host".split()
        if not isinstance(saved, dict) or saved.keys() != {*names}:
            raise NotResumed(f"--resume: {directory}/{NAME} was not left by a run in stages")
        vars(self).update(saved)

    def runState(self, name, width):
        """How far the run of a scene had come, whose rows have ``width`` columns. Raises
        NotResumed."""
        if self.scene != name:
            raise NotResumed(
                f"--resume: {self.directory} holds a run of {self.scene}, this is {name}"
            )
        if any(len(row) != width for row in self.rows):
            raise NotResumed(f"--resume: its rows are not of {width} columns")
        return restored(RunState(), self.state)

    def load(self):
        """Give the scene, built by the same script, the state of the checkpoint. Raises
        NotResumed."""
        try:
            loadScene(self._data)
        except (ValueError, TypeError) as error:
            raise NotResumed(f"--resume: {self.directory}/{NAME} {error}") from None

    def compareHost(self):
        """Say what of the host is not as it was."""
        for what, value in hostNow().items():
            if self.host.get(what) != value:
                say(
                    f"note: the checkpoint was made with {what} {self.host.get(what)}, this run has"
                    f" {value}: it may differ in last digits from one without a break"
                )
