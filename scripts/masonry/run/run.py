# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in stages, in a folder of results, with checkpoints from which it can be taken up again.

A stage steps by :meth:`Run.advance` alone. What it must know to go on after a checkpoint is a
dataclass that it gives to :meth:`Run.stage`. In a run that is resumed, stages that were over are
left out (:mod:`masonry.scene.resuming`). The stage in which the checkpoint was made is entered with
the scene and its memory as they were right after the steps of an ``advance``, and its first
``advance`` takes the steps that were left, or none. So a stage changes its memory after it has
advanced, and what it does before it advances may be done twice.
"""

import contextlib
import os
import time
from types import SimpleNamespace

from yade import O


from ..numbers.columns import CRACKS
from ..auxiliary import Auxiliary
from ..errors import Collapsed, Interrupted, NotResumed, Unwritable
from ..terminal import listen, say
from ..terminal import stopListening
from . import batch
from .keeping import Checkpoints, hostNow
from .frame_writer import Frames
from .run_state import RunState, Saved, otherVersion, restored
from .plotting import live
from .presets import presetNote, presetOf
from .progress import Progress
from .readings import Readings
from .results import Results
from .signals import Signals

SHOW_EVERY = 0.05  # [s] of wall-clock time: what is shown on the terminal is not older
LOOK_EVERY = (
    0.5  # [s] of wall-clock time: within slow steps a checkpoint that is due is made no later
)
# steps after which the widest crack is looked for again: a hundredth of the time of steps in which
# joints yield
LOOKED = 300


class Run:
    """A run in stages; the module says how to use it. :func:`masonry.run.ending.end` ends it in
    order.

    Results of an earlier run in the folder are replaced when there is a first row or frame, or at
    the end. A run that is interrupted or fails before leaves them as they are.

    :param name: name of the scene; its results go to ``results/<name>`` if the options do not say
        otherwise
    :param args: the options of :func:`masonry.scene.options.parser`
    :param script: what the script says, as data: a list that grows
    """

    def __init__(self, name, args, script=()):
        self.name, self.args, self.script = name, args, script
        self.status = 0  # exit status of the scene
        self.at, self.saved = RunState(), None
        self.results = self.readings = self.frames = self.preset = None
        self.collapsed = False
        self.signals = Signals()
        self.breakable, self.listening = self.signals.breakable, self.signals.listening
        self.kept = False  # whether it was interrupted and left a checkpoint at its end
        self.progress = Progress()
        self.advanced = False  # whether this process has taken steps of it
        # of the stage that was entered last: its number, and what it remembers
        self.entered, self.memory = 0, SimpleNamespace()
        self.redoes = False  # whether the checkpoint of a resumed run was made in it
        self.endsAtFall = (
            False  # whether it ends when a block has fallen, where a collapse is followed
        )
        self.loading = False  # whether it lets the dead loads grow, and is no test yet
        #: function that takes what is found beside the run: with True it waits for that
        self.takeFound = lambda wait: None
        self.checkpoints = Checkpoints(self)
        self._now = time.perf_counter()  # at the end of the last steps [s]
        self._shown = self._now  # when progress was shown last [s]

    # -- beginning ---------------------------------------------------------------------------------

    def open(self, columns, properties):
        """Open the folder, and read the checkpoint of a run that is resumed. No file is written
        yet.

        :param properties: of the scene, as :func:`masonry.scene.summary.properties` gives them
        """
        args, heads = self.args, [column.head for column in columns]
        folder = args.out or os.path.join("results", self.name)
        if batch.PROBE in os.environ:  # there is no run, and nothing shall be left
            folder = os.environ[batch.PROBE] + ".results"
        self.results = Results(folder, heads, bool(args.resume), self.name)
        self.readings = Readings(columns, self.results, live(heads))
        if batch.VARIABLE in os.environ and batch.ended(folder):
            self.results.release()  # another one ran this row since the options were read
            say(f"{folder} has the results of this row")
            raise SystemExit(0)
        if args.resume:
            self.saved = getattr(args, "saved", None) or Saved(args.resume)
            if self.saved.scene != self.name:
                raise NotResumed(
                    f"--resume: {args.resume} holds a run of {self.saved.scene}, this is"
                    f" {self.name}"
                )
            self.at = self.saved.place()
        self.signals.begin()
        listen(self.hear)
        self.preset = presetOf(args, properties)
        if self.preset:
            say(presetNote(self.preset))

    def start(self, model, space, state):
        """Take up the model that now stands in YADE, in the state of the checkpoint if the run is
        resumed.

        :param space: bytes that the run writes at least, and those that it will probably write
        :param state: what a checkpoint keeps of the scene beside its state in YADE:
            :class:`masonry.scene.resuming.State`
        """
        self.model, self.state = model, state
        self.results.checkSpace(*space)
        if self.saved:
            width = len(self.results.columns)
            if any(len(row) != width for row in self.saved.rows):
                raise NotResumed(f"--resume: its rows are not of {width} columns")
            self.saved.load()
            self.state.takeRest(self.at)
            self.at.resumed.append(O.time)
            self.saved.compareHost(hostNow())
        if not (self.args.no_vtk or self.args.lean):
            self.frames = Frames(self.results.directory, self.at)

    @contextlib.contextmanager
    def clock(self, part):
        """Count the wall-clock time of a block as that of a part of the run."""
        began = time.perf_counter()
        yield
        self.at.seconds[part] += time.perf_counter() - began

    @property
    def interrupted(self):
        """Whether the user has interrupted the run."""
        return self.signals.interrupted

    @property
    def scriptBefore(self):
        """What the script said up to the checkpoint of a run that is resumed, as data."""
        return self.saved.script if self.saved else []

    def hear(self, text):
        """Keep a note or a warning with the stage and the time in the scene in which it was said
        first. A run that is resumed says again what it said."""
        # before the first stage, another scene may stand in YADE
        self.at.hear(text, self.entered, O.time if self.entered else 0.0)

    def auxiliary(self, what):
        """A block that computes something beside the run, which an unexpected error there does not
        end; ``what`` names it in the note."""
        return Auxiliary(what, self.fail)

    def fail(self, note, trace):
        """Keep the note and the traceback of what has failed beside the run."""
        say(f"note: {note}")
        self.results.log(f"{note}\n{trace}\n")
        self.results.amend(notes=self.at.notes)

    def note(self, kind, name, opposite="", control=""):
        """Note what the next stage loads, as in :class:`masonry.run.run_state.RunState`."""
        load = [kind, name, opposite] + [control] * bool(control)
        self.at.loads = {**self.at.loads, str(self.entered + 1): load}

    @property
    def takesUp(self):
        """Whether the run is resumed, and has taken no steps since."""
        return self.saved is not None and not self.advanced

    def continueFrom(self, number, redoes):
        """In a run that is resumed and has taken no steps yet, let rows and frames be those of the
        beginning of the stage of a number; of the stage of the checkpoint, which ``redoes`` says,
        those of the checkpoint.
        """
        at, rows = self.at, self.saved.rows
        self.redoes = redoes
        if redoes:
            rows, at.frames = rows[: at.rows], at.frames[: at.frameCount]
        elif number <= len(at.stages):
            rows = rows[: at.stages[number - 1][3]]
        self.results.rows[:] = rows
        if rows and self.results.columns[0] == "time_s":
            self.readings.time = rows[-1][0]

    def takeUp(self):
        """From here on files are written; those of a run that is resumed are cut back to its
        checkpoint."""
        if self.saved:
            at = self.at
            # a stage acts before it advances: that was done before the steps of the checkpoint
            again = self.redoes and str(at.begun) not in at.ended
            if again:
                self.saved.load()
            if again or not self.state.restored:
                self.state.put(at.now)
            try:
                rows = [*self.results.rows]
                self.results.takeUp(rows, len(at.frames), self.saved.seconds)
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
        :param memory: what the stage must know to go on, as it is at the beginning: a dataclass of
            values that JSON can hold. Checkpoints keep it.
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
            at, rows = self.at, self.readings.count
            at.number, at.stage = self.entered, name
            at.stages = [*at.stages, [name, at.steps, at.seconds["steps"], rows]]
        self.memory = memory
        return memory

    def advance(self, steps, one=None):
        """Take time steps, and leave a checkpoint if one is due.

        Ctrl-C and SIGTERM are obeyed after the present step. A checkpoint is made after the last
        step, and between steps only if they are slow, see LOOK_EVERY.

        Raises Interrupted after Ctrl-C and SIGTERM, and Collapsed if a block has fallen
        (help(masonry.MasonryEnergy)).

        :param one: function that makes one step, of its number in this call, from 0; None: YADE
            makes it
        """
        at = self.at
        self.model.loading.keepLoadLine()
        takesUp = self.takesUp
        # the scene of a checkpoint is that after some of the steps or all
        if takesUp and self.redoes and at.left > steps:
            raise otherVersion(f"{at.left} of {steps} steps are left")
        if takesUp:
            self.takeUp()
        if not (takesUp and self.redoes):
            self.advanced, at.left = True, steps
        while True:
            self._take(steps, one)
            self.checkpoints.keep()
            if self._now - self.checkpoints.since > 60 * self.args.checkpoint_every:
                self.checkpoints.write()
            if self.interrupted:
                raise Interrupted()
            if not at.left:
                break
        if self.endsAtFall:
            self.model.checkFallen()

    def _take(self, steps, one):
        """Take steps that are left of an advance, for some time, or until the user interrupts."""
        at, step = self.at, O.step
        number, self.checkpoints.safe = steps - at.left, None
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

    def record(self):
        """Read the model for a row of curve.csv. Returns the reading."""
        at, head = self.at, CRACKS.head
        with self.clock("rows"):
            due = not at.widest or abs(O.iter - at.widest[0]) >= LOOKED
            if due and head in self.results.columns:
                at.widest = [O.iter, self.model.widestCrack()]
            self.model.widest = at.widest[-1] if at.widest else 0.0
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
        """Write a frame for ParaView, if the user wants any; the ``final`` one is whole when this
        returns."""
        if self.frames:
            self.flush()
            self.results.begin()
            self.awaitFrame()
            with self.clock("frames"), self.auxiliary("a frame for ParaView"):
                self.frames.add(final)

    def awaitFrame(self):
        """Wait for a frame that is written beside the run. Raises Unwritable if the disk refused
        it."""
        with self.clock("frames"), self.auxiliary("a frame for ParaView"):
            self.frames.wait()

    def show(self, fraction, detail, final=False):
        """Show on the terminal how far the present stage has come, if it is time to:
        :meth:`masonry.run.progress.Progress.show`."""
        if final or self._now - self._shown > SHOW_EVERY:
            at = self.at
            rate = at.steps / at.seconds["steps"] if at.steps else 0.0
            self.progress.show(at.stage, fraction, detail, rate, final)
            self._shown = self._now

    # -- the end -----------------------------------------------------------------------------------

    def fall(self, what):
        """Note that the structure has fallen."""
        self.collapsed = True
        self.results.run["collapse"] = self.at.fall = what
        say(f"collapsed: {what}")

    def release(self):
        """Let other runs have the folder, and others the signals."""
        stopListening(self.hear)
        if self.frames:
            self.frames.end()
        if self.results:
            self.results.release()
        self.signals.end()
