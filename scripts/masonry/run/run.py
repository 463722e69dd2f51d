# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in stages, in a folder of results, with checkpoints from which it can be taken up again.

A stage steps by :meth:`Run.advance` alone. What it must know to go on after a checkpoint is a dataclass that it gives
to :meth:`Run.stage`. In a run that is resumed, stages that were over are left out (:mod:`masonry.scene.resuming`). The
stage in which the checkpoint was made is entered with the scene and its memory as they were right after the steps of an
``advance``, and its first ``advance`` takes the steps that were left, or none. So a stage changes its memory after it
has advanced, and what it does before it advances may be done twice.
"""

import contextlib
import os
import signal
import sys
import time
from types import SimpleNamespace

import yade.config
from yade import O
from yade.wrapper import MasonryVtkRecorder

from .. import notebook
from .._masonry import commit, version
from ..assembly import threads

from ..background import Failed, Task

from ..basics import Collapsed, Interrupted, Refused, Unwritable, listen, say, stopListening  # fmt: skip
from . import batch
from .checkpoints import NAME, saveCheckpoint
from .place import Place, Saved, otherVersion, restored
from .plotting import live
from .presets import presetNote, presetOf
from .progress import Progress
from .results import Results

FLUSH_EVERY = 0.2  # [s] of wall-clock time: rows are on the disk after it
SHOW_EVERY = 0.05  # [s] of wall-clock time: what is shown on the terminal is not older
LOOK_EVERY = 0.5  # [s] of wall-clock time: within slow steps a checkpoint that is due is made no later
#: A frame that takes longer is written beside the run [s]; the copy of the process that does it takes some milliseconds.
SLOW_FRAME = 0.02
MOST_NOTES = 1000  # that a run keeps
#: Options that say where results are, and are no part of what was run.
ASIDE = ("resume", "out", "saved")


def hostNow():
    """What the last digits of a run can depend on."""
    return {
        "build": commit,
        "masonry": version,
        "YADE": yade.config.version,
        "threads": threads.allowed(),
    }


class Run:
    """A run in stages; the module says how to use it. :func:`masonry.run.ending.end` ends it in order.

    Results of an earlier run in the folder are replaced when there is a first row or frame, or at the end. A run that is
    interrupted or fails before leaves them as they are.

    :param name: name of the scene; its results go to ``results/<name>`` if the options do not say otherwise
    :param args: the options of :func:`masonry.scene.options.parser`
    :param script: what the script says, as data: a list that grows
    """

    def __init__(self, name, args, script=()):
        self.name, self.args, self.script = name, args, script
        self.status = 0  # exit status of the scene
        self.at, self._saved = Place(), None
        self.results = self.vtk = self.preset = None
        self.collapsed = self.interrupted = False
        self.kept = False  # whether it was interrupted and left a checkpoint at its end
        self.progress = Progress()
        self.advanced = False  # whether this process has taken steps of it
        self.entered = 0  # number of the stage that was entered last
        #: whether the present stage is that in which the checkpoint of a resumed run was made
        self.redoes = False
        #: whether the present stage ends when a block has fallen, in a scene whose collapse is followed
        self.endsAtFall = False
        #: whether the present stage lets the dead loads grow, and is no test yet
        self.loading = False
        self._memory = SimpleNamespace()  # of that stage
        self._frame = None  # the task that writes a frame beside the run
        self._frameTook = 0.0  # the last one, if the run has written it itself [s]
        #: function that takes what is found beside the run: with True it waits for that
        self.takeFound = lambda wait: None
        self._live = None  # adds a row to yade.plot
        self._readings = []  # rows that are not in curve.csv yet
        self._safe = None  # what a checkpoint keeps, None while steps are taken
        self._now = now = time.perf_counter()  # [s] at the end of the last steps
        self._kept = self._flushed = self._recorded = self._shown = now  # [s]
        self._recordedTime = None  # in the scene, of the last row that was read [s]
        self._handlers = {}  # of signals, as they were before
        self._breaks = False  # whether these end at once what is done

    # -- beginning ------------------------------------------------------------------------------------------------

    def open(self, columns, properties):
        """Open the folder, and read the checkpoint of a run that is resumed. No file is written yet.

        :param columns: :class:`masonry.assembly.columns.Column` objects
        :param properties: of the scene, as :func:`masonry.scene.facts.properties` gives them
        """
        args = self.args
        self._values = [column.value for column in columns]
        heads = [column.head for column in columns]
        self._live = live(heads)
        folder = args.out or os.path.join("results", self.name)
        if batch.PROBE in os.environ:  # there is no run, and nothing shall be left
            folder = os.environ[batch.PROBE] + ".results"
        self.results = Results(folder, heads, bool(args.resume), self.name)
        if batch.VARIABLE in os.environ and batch.ended(folder):
            self.results.release()  # another one ran this row since the options were read
            say(f"{folder} has the results of this row")
            raise SystemExit(0)
        if args.resume:
            self._saved = getattr(args, "saved", None) or Saved(args.resume)
            if self._saved.scene != self.name:
                raise Refused(
                    f"--resume: {args.resume} holds a run of {self._saved.scene}, this is {self.name}"
                )
            self.at = self._saved.place()
        self._takeSignals()
        listen(self.hear)
        self.preset = presetOf(args, self.name, properties)
        if self.preset:
            say(presetNote(self.preset))

    def start(self, model, space, state):
        """Take up the model that now stands in YADE, in the state of the checkpoint if the run is resumed.

        :param model: :class:`masonry.assembly.structure.Structure`
        :param space: bytes that the run writes at least, and those that it will probably write
        :param state: what a checkpoint keeps of the scene beside its state in YADE:
            :class:`masonry.scene.resuming.State`
        """
        self.model, self.state = model, state
        self.results.checkSpace(*space)
        if self._saved:
            width = len(self._values)
            if any(len(row) != width for row in self._saved.rows):
                raise Refused(f"--resume: its rows are not of {width} columns")
            self._saved.load()
            self.state.takeRest(self.at)
            self.at.resumed.append(O.time)
            self._saved.compareHost(hostNow())
        self._recorder = MasonryVtkRecorder(
            directory=self.results.directory, times=self.at.frames
        )
        self.vtk = None if self.args.no_vtk or self.args.lean else self._recorder

    @contextlib.contextmanager
    def clock(self, part):
        """Count the wall-clock time of a block as that of a part of the run."""
        began = time.perf_counter()
        yield
        self.at.seconds[part] += time.perf_counter() - began

    @property
    def resumes(self):
        """Whether the run goes on from a checkpoint."""
        return self._saved is not None

    @property
    def scriptBefore(self):
        """What the script said up to the checkpoint of a run that is resumed, as data."""
        return self._saved.script if self._saved else []

    @property
    def optionsBefore(self):
        """The options of the run that is resumed, as data."""
        return self._saved.options

    def hear(self, text):
        """Keep a note or a warning with the stage and the time in the scene in which it was said first. A run that is resumed
        says again what it said."""
        stages = self.at.stages
        stage = stages[self.entered - 1][0] if 0 < self.entered <= len(stages) else ""
        # before the first stage, another scene may stand in YADE
        time_s = O.time if self.entered else 0.0
        note = dict(stage=stage, number=self.entered, time_s=time_s, text=text)
        known = {one["text"] for one in self.at.notes}
        if text not in known and len(self.at.notes) < MOST_NOTES:
            self.at.notes = [*self.at.notes, note]

    def note(self, kind, name, opposite=""):
        """Note what the next stage loads, as of :class:`masonry.run.place.Place`."""
        self.at.loads = {**self.at.loads, str(self.entered + 1): [kind, name, opposite]}

    @property
    def memory(self):
        """What the stage remembers that was entered last."""
        return self._memory

    @property
    def takesUp(self):
        """Whether the run is resumed, and has taken no steps since."""
        return self.resumes and not self.advanced

    def continueFrom(self, number, redoes):
        """In a run that is resumed and has taken no steps yet, let rows and frames be those of the beginning of a stage; of the
        stage of the checkpoint, those of the checkpoint.

        :param number: of the stage
        :param redoes: whether it is the stage of the checkpoint
        """
        at, rows = self.at, self._saved.rows
        self.redoes = redoes
        if redoes:
            rows, at.frames = rows[: at.rows], at.frames[: at.frameCount]
            self._recorder.times = at.frames
        elif number <= len(at.stages):
            rows = rows[: at.stages[number - 1][3]]
        self.results.rows[:] = rows
        if rows and self.results.columns[0] == "time_s":
            self._recordedTime = rows[-1][0]

    def takeUp(self):
        """From here on files are written; those of a run that is resumed are cut back to its checkpoint."""
        if self._saved:
            at = self.at
            # a stage acts before it advances: that was done before the steps of the checkpoint
            if self.redoes and str(at.begun) not in at.ended:
                self._saved.load()
                self.state.put(at.now)
            elif not self.state.restored:
                self.state.put(at.now)
            try:
                self.results.takeUp(
                    [*self.results.rows], len(at.frames), self._saved.seconds
                )
                if self.at.frames:
                    self._recorder.collect()
            except (OSError, RuntimeError, Unwritable) as error:
                raise Refused(f"--resume: {error}") from None
        self.advanced = True

    # -- what stages call -----------------------------------------------------------------------------------------

    def stage(self, name, memory):
        """Enter the next stage. Returns its memory; None if it is a part of the stage of the checkpoint, and was over then.

        :param name: what it is called on the terminal
        :param memory: what the stage must know to go on, as it is at the beginning: a dataclass of values that JSON can
            hold. Checkpoints keep it.
        """
        self.entered += 1
        resumed = self.redoes and not self.advanced
        if resumed and self.entered < self.at.number:
            return None
        if resumed:
            if self.at.stage != name:
                raise otherVersion(f"stage '{self.at.stage}'")
            memory = restored(memory, self.at.memory)
        else:
            self.at.number, self.at.stage = self.entered, name
            rows = len(self.results.rows) + len(self._readings)
            before = [name, self.at.steps, self.at.seconds["steps"], rows]
            self.at.stages = [*self.at.stages, before]
        self._memory = memory
        return memory

    def advance(self, steps, one=None):
        """Take time steps, and leave a checkpoint if one is due.

        Ctrl-C and SIGTERM are obeyed after the present step. A checkpoint is made after the last step, and between steps
        only if they are slow, see LOOK_EVERY.

        Raises Interrupted after Ctrl-C and SIGTERM, and Collapsed if a block has fallen (help(masonry.MasonryEnergy)).

        :param steps: how many
        :param one: function that makes one step, of its number in this call, from 0; None: YADE makes it
        """
        at = self.at
        if self.advanced or not self._saved:
            self.advanced, at.left = True, steps
        elif self.redoes:
            # the scene of a checkpoint is that after some of the steps or all
            if at.left > steps:
                raise otherVersion(f"{at.left} of {steps} steps are left")
            self.takeUp()
        else:
            self.takeUp()
            at.left = steps
        while True:
            self._take(steps, one)
            self._keepSafe()
            if self._now - self._kept > 60 * self.args.checkpoint_every:
                self.checkpoint()
            if self.interrupted:
                raise Interrupted()
            if not at.left:
                break
        if self.endsAtFall:
            self.model.checkFallen()

    def _take(self, steps, one):
        """Take steps that are left of an advance, for some time, or until the user interrupts."""
        at, step = self.at, O.step
        number, self._safe = steps - at.left, None
        now = began = time.perf_counter()
        try:
            while number < steps and not self.interrupted:
                one(number) if one else step()
                number += 1
                now = time.perf_counter()
                if now - began > LOOK_EVERY:
                    break
        except RuntimeError:
            if self.model.energy.collapsedBlock < 0:
                raise
            raise Collapsed(self.model.energy.collapse) from None
        finally:
            self._now = now
            at.seconds["steps"] += now - began
            at.steps += number - (steps - at.left)
            at.left = steps - number

    def _keepSafe(self):
        """Note what a checkpoint of this moment keeps, beside the scene."""
        at = self.at
        self._safe = {
            "begun": at.begun,
            "before": at.before,
            "number": at.number,
            "stage": at.stage,
            "memory": vars(self._memory).copy(),
            "steps": at.steps,
            "left": at.left,
            "rows": len(self.results.rows) + len(self._readings),
            "frameCount": len(at.frames),
            "stages": at.stages,
        }

    def markFall(self):
        """As :meth:`mark`, of a structure that was seen to fall between two steps; what fell within one has no checkpoint."""
        if self._safe:
            self.mark()

    def mark(self):
        """Note what a checkpoint of this moment keeps, after a stage has put the scene into another state."""
        self.at.left = 0
        self._keepSafe()

    def record(self):
        """Read the model for a row of curve.csv. Returns the reading.

        Readings wait for 0.2 s of wall-clock time at most, and not beyond a checkpoint or the end, before they become
        rows. So only a kill can lose them, and a run that is resumed after a kill makes them again.
        """
        began = time.perf_counter()
        reading = self.model.read()
        for sentence in self.model.connectors.news():
            say(f"note: {sentence}")
        self._readings.append([value(reading) for value in self._values])
        self._recordedTime = reading.time
        now = time.perf_counter()
        self.at.seconds["rows"] += now - began
        # the next reading is expected as long after this one as this one after the last
        if now - self._flushed + now - self._recorded > FLUSH_EVERY:
            self.flush()
        self._recorded = now
        return reading

    def flush(self):
        """Write the readings that wait as rows of curve.csv. Raises as :meth:`masonry.run.results.Results.append` does."""
        began = time.perf_counter()
        rows, self._readings = self._readings, []
        self.results.append(rows)
        for row in rows if self._live else []:
            self._live(row)
        self.takeFound(False)
        self._flushed = time.perf_counter()
        self.at.seconds["rows"] += self._flushed - began

    def frame(self, final=False):
        """Write a frame for ParaView, if the user wants any: beside the run if the last one was slow.

        :param final: whether it is the last one, which is whole when this returns
        """
        if self.vtk:
            self.flush()
            self.results.begin()
            began = time.perf_counter()
            self.awaitFrame()
            if self._frameTook > SLOW_FRAME and not final:
                self._frame = Task(self._frameBeside)
                self.vtk.times = [*self.vtk.times, O.time]
            else:
                now = time.perf_counter()
                try:
                    self.vtk()
                except RuntimeError as error:
                    raise Unwritable(str(error)) from None
                self._frameTook = time.perf_counter() - now
            self.at.seconds["frames"] += time.perf_counter() - began
            self.at.frames = list(self.vtk.times)

    def _frameBeside(self):
        """Write a frame in a copy of the process."""
        try:
            self.vtk()
        except RuntimeError as error:
            raise Unwritable(str(error)) from None
        yield True

    def awaitFrame(self):
        """Wait until the frame is whole that is written beside the run. Raises Unwritable if it could not be written: then
        the run has gone on, and the frame is none of its frames."""
        task, self._frame = self._frame, None
        try:
            if task:
                task.result()
        except (Failed, Unwritable) as failed:
            lost = self.vtk.times[-1]
            self.vtk.times = self.at.frames = list(self.vtk.times[:-1])
            if self._safe:
                count = min(self._safe["frameCount"], len(self.at.frames))
                self._safe["frameCount"] = count
            raise Unwritable(f"the frame at {lost:.6g} s is lost: {failed}") from None

    def show(self, fraction, detail, final=False):
        """Show on the terminal how far the present stage has come, if it is time to.

        :param fraction: how much of the stage is done, 0 to 1 [-]
        :param detail: function without arguments that gives the text to show
        :param final: whether the stage ends here; this is always shown
        """
        if final or self._now - self._shown > SHOW_EVERY:
            at = self.at
            rate = at.steps / at.seconds["steps"] if at.steps else 0.0
            self.progress.show(at.stage, fraction, detail, rate, final)
            self._shown = self._now

    # -- checkpoints ----------------------------------------------------------------------------------------------

    def checkpoint(self):
        """Save the state after the last steps. Returns whether it could; a disk that refuses it does not end the run."""
        if not (self.args.checkpoint_every and self._safe):
            return False
        self.flush()
        self.takeFound(True)
        self.awaitFrame()
        if len(self.results.rows) < self._safe["rows"] or self.results.earlier:
            return False
        self.results.begin()
        kept = self.state.kept()
        if self._safe["begun"] != self.at.begun:  # the present stage has taken no steps
            kept["now"] = self.at.before
        progress = dict(
            scene=self.name,
            options={
                name: value
                for name, value in vars(self.args).items()
                if name not in ASIDE
            },
            at={**vars(self.at), **kept, **self._safe},
            rows=self.results.rows,
            script=self.script,
            seconds=self.results.seconds(),
            host=hostNow(),
        )
        self._kept = time.perf_counter()
        path = self.results.path(NAME)
        try:
            saveCheckpoint(path, progress)
            return True
        except (OSError, ValueError, MemoryError) as error:
            stays = "; an earlier one stays" if os.path.exists(path) else ""
            say(
                f"warning: no checkpoint could be written to {path}: {error}{stays}",
                sys.stderr,
            )
            return False

    # -- the end --------------------------------------------------------------------------------------------------

    def recordedAt(self):
        """Time of the last row that was read [s], or None."""
        return self._recordedTime

    def fall(self, what):
        """Note that the structure has fallen."""
        self.collapsed = True
        self.results.run["collapse"] = self.at.fall = what
        say(f"collapsed: {what}")

    @contextlib.contextmanager
    def breakable(self):
        """Let Ctrl-C and SIGTERM end a block at once, by Interrupted. It must change nothing that a checkpoint keeps; elsewhere
        these are obeyed between steps."""
        self._breaks = True
        try:
            if self.interrupted:
                raise Interrupted()
            yield
        finally:
            self._breaks = False

    @contextlib.contextmanager
    def listening(self):
        """Obey Ctrl-C and SIGTERM in a block, in order. In a script the run obeys them from its beginning to its end; in a
        notebook only while one of its words is carried out, and what else a cell does is interrupted as usual.
        """
        if self.results and not self._handlers and notebook.isHere():
            self._takeSignals()
        try:
            yield
        finally:
            if notebook.isHere():
                self._giveSignals()

    def _takeSignals(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            self._handlers[number] = signal.signal(number, self._interrupt)

    def _giveSignals(self):
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        self._handlers = {}

    def _interrupt(self, number, frame):
        self.interrupted = True
        if self._breaks:
            self._breaks = False
            raise Interrupted()

    def release(self):
        """Let other runs have the folder, and others the signals."""
        stopListening(self.hear)
        if self._frame:
            self._frame.end()
        if self.results:
            self.results.release()
        self._giveSignals()
