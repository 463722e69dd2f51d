# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in stages, in a folder of results, with checkpoints from which it can be resumed.

A stage steps by :meth:`Run.advance` alone. What it must know to go on after a checkpoint is its
memory, a dataclass that it gives to :meth:`Run.stage`. A checkpoint is made at the end of an
``advance`` or between its steps. A resumed run leaves out the stages that were over. The stage of
the checkpoint starts from its beginning with the stored memory, and its first ``advance`` does the
remaining steps (perhaps none). So a stage changes its memory after it has advanced, and what it
does before it advances may be done twice.
"""

import contextlib
import os
import time
from types import SimpleNamespace

from yade import O

from ..numbers.columns import CRACKS
from ..auxiliary import Auxiliary
from ..errors import Collapsed, Interrupted, NotResumed, Unwritable
from ..terminal import listen, say, stopListening
from . import batch
from .checkpoints import Checkpoints, Saved, otherVersion, restored
from .frame_writer import Frames
from .run_state import RunState, StageContext
from .presets import presetNote, presetOf
from .progress import Progress
from .readings import Readings
from .results import Results
from .signals import Signals

SHOW_EVERY = 0.05  # [s] of wall-clock time between two lines on the terminal
LOOK_EVERY = 0.5  # [s] of wall-clock time, after which a checkpoint may come between slow steps
#: Steps between two searches for the widest crack, which then take a hundredth of the time of steps
#: in which joints yield.
CRACKS_EVERY = 300


class Run:
    """A run in stages; :func:`masonry.run.ending.end` ends it in order. Results of an earlier run
    stay until there is a first row or frame, or the end.

    :param name: name of the scene; its results go to ``results/<name>`` if the options do not say
        otherwise
    :param args: the options of :func:`masonry.scene.options.parser`
    :param script: what the script says, as data: a list that grows
    """

    def __init__(self, name, args, script=()):
        self.name, self.args, self.script = name, args, script
        self.status = 0  # exit status of the scene
        self.state, self.saved = RunState(), None
        self.results = self.readings = self.frames = self.preset = None
        self.collapsed = False
        self.signals = Signals()
        self.breakable, self.listening = self.signals.breakable, self.signals.listening
        self.kept = False  # whether it was interrupted and left a checkpoint at its end
        self.progress = Progress()
        self.advanced = False  # whether this process has taken steps of it
        # the stage that was entered last: its number, and what it remembers
        self.entered, self.memory = 0, SimpleNamespace()
        self.resumedHere = False  # whether the run was resumed from a checkpoint inside this stage
        self.context = StageContext()
        #: function that takes the results of a task beside the run; True waits for them
        self.takeFound = lambda wait: None
        self.checkpoints = Checkpoints(self)
        self._now = time.perf_counter()  # at the end of the last steps [s]
        self._shown = self._now  # when progress was shown last [s]

    # -- beginning ---------------------------------------------------------------------------------

    def open(self, columns, properties):
        """Open the folder, and read the checkpoint of a run that is resumed. No file is written
        yet.

        :param properties: :func:`masonry.scene.summary.properties`
        """
        args, heads = self.args, [column.head for column in columns]
        folder = args.out or os.path.join("results", self.name)
        if batch.PROBE in os.environ:  # there is no run, and nothing shall be left
            folder = os.environ[batch.PROBE] + ".results"
        self.results = Results(folder, heads, bool(args.resume), self.name)
        self.readings = Readings(columns, self.results)
        if batch.VARIABLE in os.environ and batch.ended(folder):
            self.results.release()  # another one ran this row since the options were read
            say(f"{folder} has the results of this row")
            raise SystemExit(0)
        if args.resume:
            self.saved = getattr(args, "saved", None) or Saved(args.resume)
            self.state = self.saved.runState(self.name, len(heads))
        self.signals.begin()
        listen(self.recordNote)
        self.preset = presetOf(args, properties)
        if self.preset:
            say(presetNote(self.preset))

    def start(self, model, space, sceneState):
        """Take the model that now stands in YADE, in the state of the checkpoint if the run is
        resumed.

        :param space: bytes that the run writes at least, and those that it will probably write
        :param sceneState: :class:`masonry.run.checkpoints.SceneState`
        """
        self.model, self.sceneState = model, sceneState
        self.results.checkSpace(*space)
        if self.saved:
            self.saved.load()
            sceneState.takeRest(self.state)
            self.state.resumed.append(O.time)
            self.saved.compareHost()
        if not (self.args.no_vtk or self.args.lean):
            self.frames = Frames(self.results.directory, self.state)

    @contextlib.contextmanager
    def clock(self, part):
        """Count the wall-clock time of a block as that of a part of the run."""
        began = time.perf_counter()
        yield
        self.state.seconds[part] += time.perf_counter() - began

    @property
    def interrupted(self):
        return self.signals.interrupted

    @property
    def scriptBefore(self):
        """What the script said up to the checkpoint of a run that is resumed, as data."""
        return self.saved.script if self.saved else []

    def recordNote(self, text):
        """Keep a note or a warning with the present stage and the time in the scene."""
        # before the first stage, another scene may stand in YADE
        self.state.recordNote(text, self.entered, O.time if self.entered else 0.0)

    def auxiliary(self, what):
        return Auxiliary(what, self.fail)

    def fail(self, note, trace):
        """Keep the note and the traceback of what has failed beside the run."""
        say(f"note: {note}")
        self.results.log(f"{note}\n{trace}\n")
        self.results.amend(notes=self.state.notes)

    def note(self, kind, name, opposite="", control="", path=None):
        """Note what the next stage loads, and the ``path`` of a push, as in
        :class:`masonry.run.run_state.RunState`."""
        load, number = [kind, name, opposite] + [control] * bool(control), str(self.entered + 1)
        self.state.loads = {**self.state.loads, number: load}
        if path:
            self.state.paths = {**self.state.paths, number: path}

    @property
    def isResumed(self):
        """Whether the run is resumed, and has taken no steps since."""
        return self.saved is not None and not self.advanced

    def cutBackTo(self, number, resumedHere):
        """In a resumed run, let rows and frames be those of the beginning of a stage, or of the
        checkpoint if the run was resumed inside this stage."""
        state, rows = self.state, self.saved.rows
        self.resumedHere = resumedHere
        if resumedHere:
            rows, state.frames = rows[: state.rows], state.frames[: state.frameCount]
        elif number <= len(state.stages):
            rows = rows[: state.stages[number - 1]["first_row"]]
        self.results.rows[:] = rows
        if rows and self.results.columns[0] == "time_s":
            self.readings.time = rows[-1][0]

    def beginWriting(self):
        """Write files from here on; those of a resumed run are cut back to its checkpoint."""
        if self.saved:
            state, ofScene = self.state, self.sceneState
            # a stage acts before it advances: that was done before the steps of the checkpoint
            again = self.resumedHere and str(state.begun) not in state.ended
            if again:
                self.saved.load()
            if again or not ofScene.isRestored:
                ofScene.put(state.now)
            try:
                self.results.resume([*self.results.rows], len(state.frames), self.saved.seconds)
                if self.frames:
                    self.frames.collect()
            except (OSError, RuntimeError, Unwritable) as error:
                raise NotResumed(f"--resume: {error}") from None
        self.advanced = True

    # -- what stages call --------------------------------------------------------------------------

    def stage(self, name, memory):
        """Enter the next stage. Returns its memory; None if it is a part of the stage of the
        checkpoint, and was over then.

        :param name: what it is called on the terminal
        :param memory: of the stage at its beginning: a dataclass of values that JSON can hold, and
            of :func:`masonry.run.checkpoints.record`
        """
        self.entered += 1
        state, resumed = self.state, self.resumedHere and not self.advanced
        if resumed and self.entered < state.number:
            return None
        if resumed:
            if state.stage != name:
                raise otherVersion(f"stage '{state.stage}'")
            memory = restored(memory, state.memory)
        else:
            state.number, state.stage = self.entered, name
            before = dict(steps=state.steps, seconds=state.seconds["steps"])
            begun = dict(stage=name, **before, first_row=self.readings.count)
            state.stages = [*state.stages, begun]
        self.memory = memory
        return memory

    def advance(self, steps):
        """Take time steps, and leave a checkpoint if one is due after the last of them, or between
        slow ones (LOOK_EVERY).

        :raises Interrupted: after the present step, if the user sent Ctrl-C or SIGTERM
        :raises Collapsed: if a block has fallen (help(masonry.MasonryEnergy))
        """
        state = self.state
        self.model.loading.keepLoadLine()
        # the scene of a checkpoint is that after some of the steps or all
        isRest = self.isResumed and self.resumedHere
        if isRest and state.left > steps:
            raise otherVersion(f"{state.left} of {steps} steps are left")
        if self.isResumed:
            self.beginWriting()
        if not isRest:
            self.advanced, state.left = True, steps
        while True:
            self._take(steps)
            self.checkpoints.save()
            if self._now - self.checkpoints.since > 60 * self.args.checkpoint_every:
                self.checkpoints.write()
            if self.interrupted:
                raise Interrupted()
            if not state.left:
                break
        if self.model.contacts:
            self.model.stopLost()
        if self.context.endsAtFall:
            self.model.checkFallen()

    def _take(self, steps):
        """Take steps that are left of an advance, until LOOK_EVERY or an interruption."""
        state, step = self.state, O.step
        number, self.checkpoints.saved = steps - state.left, None
        now = began = time.perf_counter()
        try:
            while number < steps and not self.interrupted:
                step()
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
            state.seconds["steps"] += now - began
            state.steps += number - (steps - state.left)
            state.left = steps - number

    def record(self):
        """Read the model for a row of curve.csv. Returns the reading."""
        state, head = self.state, CRACKS.head
        with self.clock("rows"):
            due = not state.widest or abs(O.iter - state.widest[0]) >= CRACKS_EVERY
            if due and head in self.results.columns:
                state.widest = [O.iter, self.model.widestCrack()]
            self.model.widest = state.widest[-1] if state.widest else 0.0
            reading = self.readings.add(self.model)
        if self.readings.isDue():
            self.flush()
        return reading

    def flush(self):
        """Write the rows that wait. Raises as :meth:`masonry.run.results.Results.append` does."""
        with self.clock("rows"):
            self.readings.write()
            self.takeFound(False)

    def frame(self, final=False):
        """Write a frame for ParaView, if the user wants any; the final one is whole at once."""
        if self.frames:
            self.flush()
            self.results.begin()
            self.awaitFrame()
            with self.clock("frames"), self.auxiliary("a frame for ParaView"):
                self.frames.add(final)

    def awaitFrame(self):
        """Wait for a frame that is written beside the run. Raises Unwritable."""
        with self.clock("frames"), self.auxiliary("a frame for ParaView"):
            self.frames.wait()

    def show(self, fraction, detail, final=False):
        """Show how far the stage has come: :meth:`masonry.run.progress.Progress.show`."""
        if final or self._now - self._shown > SHOW_EVERY:
            state = self.state
            rate = state.steps / state.seconds["steps"] if state.steps else 0.0
            self.progress.show(state.stage, fraction, detail, rate, final)
            self._shown = self._now

    # -- the end -----------------------------------------------------------------------------------

    def fall(self, what):
        """Note that the structure has fallen."""
        self.collapsed = True
        self.results.run["collapse"] = self.state.fall = what
        say(f"collapsed: {what}")

    def release(self):
        stopListening(self.recordNote)
        if self.frames:
            self.frames.end()
        if self.results:
            self.results.release()
        self.signals.end()
