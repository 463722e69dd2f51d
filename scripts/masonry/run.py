"""A run: stages one after another, in a folder of results, with checkpoints from which it can be taken up again.

A scene reads like this, with any model and any stages::

    with Run("my_scene", args) as run:
        model = run.build(MyModel(args))
        firstStage(run, model)
        secondStage(run, model)
    raise SystemExit(run.status)

A stage is a function that steps by :meth:`Run.advance` alone. What it must know to go on after a checkpoint is a
dataclass that it gives to :meth:`Run.stage`. In a run that is resumed, stages that were over are left out. The stage in
which the checkpoint was made is entered with the scene and its memory as they were right after the steps of an
``advance``, and its first ``advance`` takes the steps that were left, or none. So a stage changes its memory after it has
advanced, and what it does before it advances may be done twice.
"""

import contextlib
import os
import signal
import socket
import sys
import time
from dataclasses import dataclass, field
from types import SimpleNamespace

import yade.config
from yade import O
from yade.wrapper import MasonryVtkRecorder

from . import batch
from ._masonry import commit, version
from .checkpoints import NAME, alike, loadCheckpoint, readProgress, saveCheckpoint
from .columns import meanings, names
from .errors import Collapsed, Interrupted, Refused, Unwritable
from .options import UNITS
from .plotting import live
from .presets import presetNote, presetOf
from .progress import Progress, say
from .results import Results

PARTS = "setup", "steps", "rows", "frames"  # of a run's time
OFF = 0.01  # of the work done: a larger error of the energy balance is a warning
COLLAPSE = "collapsed:"  # how MasonryEnergy begins its message when a block has fallen
FLUSH_EVERY = 0.2  # [s] of wall-clock time: rows are on the disk after it
SHOW_EVERY = 0.05  # [s] of wall-clock time: what is shown on the terminal is not older
LOOK_EVERY = 0.5  # [s] of wall-clock time: within slow steps a checkpoint that is due waits no longer


@dataclass
class Place:
    """How far a run has come, beside the state of the scene."""

    number: int = 0  # of the present stage, from 1
    stage: str = ""  # its name
    memory: dict = field(default_factory=dict)  # what the stage must know to go on
    steps: int = 0  # taken so far
    left: int = 0  # of the present advance that are not taken yet
    #: Of every stage so far: its name, and the steps and their seconds of wall-clock time before it.
    stages: list = field(default_factory=list)
    seconds: dict = field(default_factory=lambda: dict.fromkeys(PARTS, 0.0))
    frames: list = field(default_factory=list)  # times of the ParaView frames [s]
    origins: dict = field(default_factory=dict)  # where pushes began, by their name
    bounds: dict = field(default_factory=dict)  # what limit analysis found, by the load
    supportsMoved: bool = False  # whether a stage has moved supports
    resumed: list = field(default_factory=list)  # times at which it was taken up [s]


class Run:
    """A run in stages; the module says how to use it.

    At the end of its block it finishes in order, whatever ended it, and ``status`` is the exit status of the scene: 0 at
    the end, 1 if a file cannot be written or if the structure has fallen in the stage ``settle``, before its test began, 2
    for refused input, 130 after Ctrl-C or SIGTERM. An error of the stages goes on to the caller when the results are
    finished.

    Results of an earlier run in the folder are replaced when there is a first row or frame, or at the end. A run that is
    interrupted or fails before leaves them as they are.

    :param name: name of the scene; its results go to ``results/<name>`` if the options do not say otherwise
    :param args: the options of :func:`masonry.options.parser`
    """

    def __init__(self, name, args):
        self.name, self.args, self.status = name, args, 0
        self.at, self._told = Place(), None
        self.model = self.results = self.vtk = None
        self.collapsed = self.interrupted = False
        self.progress = Progress()
        self._goesOn = False  # whether this run has advanced
        self._entered = 0  # number of the stage that was entered last
        self._memory = SimpleNamespace()  # of that stage
        self._live = None  # adds a row to yade.plot
        self._readings = []  # that are no rows of curve.csv yet
        self._safe = None  # what a checkpoint keeps, None while steps are taken
        self._now = now = time.perf_counter()  # [s] at the end of the last steps
        self._saved = self._flushed = self._recorded = self._shown = now  # [s]
        self._handlers = {}  # of signals, as they were before

    # -- beginning ------------------------------------------------------------------------------------------------

    def __enter__(self):
        return self

    def build(self, model):
        """Open the folder, build the model in YADE, and load the checkpoint of a run that is resumed. Returns the model.

        No file is written yet.

        :param model: a :class:`masonry.model.Model`
        """
        args = self.args
        self.model, columns = model, names(model.columns)
        self._values = [column.value for column in model.columns]
        self._live = live(columns)
        folder = args.out or os.path.join("results", self.name)
        if batch.PROBE in os.environ:  # there is no run, and nothing shall be left
            folder = os.environ[batch.PROBE] + ".results"
        self.results = Results(folder, columns, bool(args.resume), self.name)
        if batch.VARIABLE in os.environ and batch.ended(folder):
            self.results.release()  # another one ran this row since the options were read
            say(f"{folder} has the results of this row")
            raise SystemExit(0)
        if args.resume:
            self._readProgress()
        for number in (signal.SIGINT, signal.SIGTERM):
            self._handlers[number] = signal.signal(number, self._interrupt)
        self.preset = presetOf(args, self.name)
        if self.preset:
            say(presetNote(self.preset, self.name))
        began = time.perf_counter()
        model.build()
        self.at.seconds["setup"] += time.perf_counter() - began
        self.results.checkRoom(*model.room())
        if self._told:
            self._load()
        self._recorder = MasonryVtkRecorder(
            directory=self.results.directory, times=self.at.frames
        )
        self.vtk = None if args.no_vtk or args.lean else self._recorder
        return model

    def _readProgress(self):
        told = self._told = readProgress(self.args.resume)
        if told["scene"] != self.name:
            raise Refused(
                f"--resume: {self.args.resume} holds a run of {told['scene']}, this is {self.name}"
            )
        self.at = _restored(Place(), told["at"])
        at = self.at
        if not (
            set(at.seconds) == set(PARTS)
            and all(alike(seconds, 0.0) for seconds in at.seconds.values())
            and all(alike(stage, ["", 0, 0.0]) for stage in at.stages)
            and alike(at.frames + at.resumed, None)
        ):
            raise _otherVersion("the counters of the run")

    def _load(self):
        width = len(self.model.columns)
        if any(len(row) != width for row in self._told["rows"]):
            raise Refused(f"--resume: its rows are not of {width} columns")
        try:
            loadCheckpoint(self.results.path(NAME))
        except (ValueError, TypeError, OSError) as error:
            raise Refused(f"--resume: {error}") from None
        self.results.rows += self._told["rows"]
        self.at.resumed.append(O.time)
        for what, now in self._host().items():
            if self._told.get(what) != now:
                say(
                    f"note: the checkpoint was made with {what} {self._told.get(what)}, this run has {now}: "
                    "it may differ in last digits from one without a break"
                )

    def _goOn(self):
        """From here on files are written; those of a run that is resumed are cut back to its checkpoint."""
        if self._told:
            try:
                # what the stage did before it advanced was done before these steps
                if self.at.left:
                    loadCheckpoint(self.results.path(NAME))
                self.results.takeUp(
                    self._told["rows"], len(self.at.frames), self._told["seconds"]
                )
                if self.at.frames:
                    self._recorder.collect()
            except (TypeError, OSError, RuntimeError, Unwritable, ValueError) as error:
                raise Refused(f"--resume: {error}") from None
        self._goesOn = True

    # -- what stages call -----------------------------------------------------------------------------------------

    def stage(self, name, memory):
        """Enter the next stage. Returns its memory, or None if it was over before the run was resumed.

        :param name: what it is called on the terminal
        :param memory: what the stage must know to go on, as it is at the beginning: a dataclass of values that JSON can
            hold. Checkpoints keep it.
        """
        self._entered += 1
        if self._entered < self.at.number:
            return None
        if self._entered == self.at.number:
            if self.at.stage != name:
                raise _otherVersion(f"stage '{self.at.stage}'")
            memory = _restored(memory, self.at.memory)
        else:
            self.at.number, self.at.stage = self._entered, name
            before = [name, self.at.steps, self.at.seconds["steps"]]
            self.at.stages = [*self.at.stages, before]
        self._memory = memory
        return memory

    def advance(self, steps, one=None):
        """Take time steps, and leave a checkpoint if one is due.

        Ctrl-C and SIGTERM are obeyed after the present step. A checkpoint is made after the last step, and between steps
        only if they are slow, see LOOK_EVERY.

        Raises Interrupted after Ctrl-C and SIGTERM, and Collapsed if a block has fallen (help(MasonryEnergy)).

        :param steps: how many
        :param one: function that makes one step, of its number in this call, from 0; None: YADE makes it
        """
        at = self.at
        if self._goesOn or not self._told:
            self._goesOn, at.left = True, steps
        else:  # the scene of a checkpoint is that after some of the steps or all
            if at.left > steps:
                raise _otherVersion(f"{at.left} of {steps} steps are left")
            self._goOn()
        while True:
            self._take(steps, one)
            self._keepSafe()
            if self._now - self._saved > 60 * self.args.checkpoint_every:
                self.checkpoint()
            if self.interrupted:
                raise Interrupted()
            if not at.left:
                return

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
        except RuntimeError as error:
            before, collapsed, told = str(error).partition(COLLAPSE)
            if not collapsed:
                raise
            raise Collapsed(told.strip()) from None
        self._now = now
        at.seconds["steps"] += now - began
        at.steps += number - (steps - at.left)
        at.left = steps - number

    def _keepSafe(self):
        """Note what a checkpoint of this moment keeps, beside the scene."""
        at = self.at
        rows = len(self.results.rows) + len(self._readings)
        self._safe = rows, {
            "number": at.number,
            "stage": at.stage,
            "memory": vars(self._memory).copy(),
            "steps": at.steps,
            "left": at.left,
            "stages": at.stages,
            "frames": at.frames,
        }

    def record(self):
        """Read the model for a row of curve.csv. Returns the reading.

        Readings wait for 0.2 s of wall-clock time at most, and not beyond a checkpoint or the end, before they become
        rows. So only a kill can lose them, and a run that is resumed after a kill makes them again.
        """
        began = time.perf_counter()
        reading = self.model.read()
        self._readings.append(reading)
        now = time.perf_counter()
        self.at.seconds["rows"] += now - began
        # the next reading is expected as long after this one as this one after the last
        if now - self._flushed + now - self._recorded > FLUSH_EVERY:
            self.flush()
        self._recorded = now
        return reading

    def flush(self):
        """Write the readings that wait as rows of curve.csv. Raises as :meth:`masonry.results.Results.append` does."""
        began = time.perf_counter()
        rows = [
            [value(reading) for value in self._values] for reading in self._readings
        ]
        self._readings.clear()
        self.results.append(rows)
        for row in rows if self._live else []:
            self._live(row)
        self._flushed = time.perf_counter()
        self.at.seconds["rows"] += self._flushed - began

    def frame(self):
        """Write a frame for ParaView, if the user wants any."""
        if self.vtk:
            self.flush()
            self.results.begin()
            began = time.perf_counter()
            try:
                self.vtk()
            except RuntimeError as error:
                raise Unwritable(str(error)) from None
            self.at.seconds["frames"] += time.perf_counter() - began
            self.at.frames = list(self.vtk.times)

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

    @staticmethod
    def _host():
        return {
            "build": commit,
            "masonry": version,
            "YADE": yade.config.version,
            "threads": O.numThreads,
        }

    def checkpoint(self):
        """Save the state after the last steps. Returns whether it could; a disk that refuses it does not end the run."""
        if not (self.args.checkpoint_every and self._safe):
            return False
        self.flush()
        rows, place = self._safe
        if len(self.results.rows) < rows or self.results.earlier:
            return False
        self.results.begin()
        told = dict(
            scene=self.name,
            options={
                name: value
                for name, value in vars(self.args).items()
                if name not in ("resume", "out")
            },
            at={**vars(self.at), **place},
            rows=self.results.rows[:rows],
            script=getattr(self, "script", []),
            seconds=self.results.seconds(),
            **self._host(),
        )
        self._saved = time.perf_counter()
        path = self.results.path(NAME)
        try:
            saveCheckpoint(path, told)
            return True
        except (OSError, ValueError) as error:
            stays = "; an earlier one stays" if os.path.exists(path) else ""
            say(
                f"warning: no checkpoint could be written to {path}: {error}{stays}",
                sys.stderr,
            )
            return False

    # -- the end --------------------------------------------------------------------------------------------------

    def _interrupt(self, number, frame):
        self.interrupted = True

    def __exit__(self, kind, error, trace):
        try:
            return self._end(error)
        finally:
            if self.results:
                self.results.release()
            for number, handler in self._handlers.items():
                signal.signal(number, handler)

    def _end(self, error):
        """Finish in order after an error, or after none. Returns whether the error is dealt with."""
        if not self.results and not isinstance(error, Refused):
            return False
        try:
            if not error and not self._goesOn:
                self._goOn()
        except Refused as refused:
            error = refused
        if not self._goesOn:
            if isinstance(error, Refused):
                print(error, file=sys.stderr)
                self.status = 2
            return self.status == 2
        if error and not isinstance(error, Collapsed) and self.results.earlier:
            return self._leaveEarlier(error)
        stopped = []
        try:
            self.flush()
        except Unwritable as unwritable:
            stopped.append(unwritable)
        except FloatingPointError as broken:
            error = error or broken
        if isinstance(error, Interrupted):
            say("\ninterrupted: what was computed is kept")
        elif isinstance(error, Unwritable):
            stopped.append(error)
        elif isinstance(error, Collapsed):
            self.fall(str(error))
        elif error:
            self.results.run["error"] = str(error)
            self.checkpoint()
            self._finish()
            raise error
        if stopped:
            self.results.run["error"] = str(stopped[0])
        over = self.args.lean and not stopped and not self.interrupted
        kept = not over and self.checkpoint()
        try:
            self._finish()
            if over:
                with contextlib.suppress(OSError):
                    os.remove(self.results.path(NAME))
        except Unwritable as unwritable:
            stopped.append(unwritable)
        for text in dict.fromkeys(map(str, stopped)):
            say(f"{text}; what was written before is kept", sys.stderr)
        if kept and (stopped or self.interrupted):
            say(f"--resume {self.results.directory} goes on from here")
        fell = self.collapsed and self.at.stage == "settle"
        self.status = 1 if stopped or fell else 130 if self.interrupted else 0
        return True

    def _leaveEarlier(self, error):
        """End without results, so that those of an earlier run stay. Returns whether the error is dealt with."""
        self.status = 130 if isinstance(error, Interrupted) else 1
        say(
            f"note: {'interrupted' if self.status == 130 else 'ended'} before there was a row: nothing of this run is kept, "
            f"and {self.results.directory} still has the results of an earlier one"
        )
        if isinstance(error, Unwritable):
            say(str(error), sys.stderr)
        return isinstance(error, (Interrupted, Unwritable))

    def fall(self, told):
        """Note that the structure has fallen."""
        self.collapsed = True
        self.results.run["collapse"] = told
        say(f"collapsed: {told}")

    def _finish(self):
        """Write the last frame and run.json, which is written even if there is no room for the frame, and report."""
        try:
            try:
                if self.results.rows:
                    self.frame()
            finally:
                self._describe()
                self.results.close()
            self._report()
        finally:
            self.model.leave(self.results.directory)

    def _describe(self):
        """Fill run.json; the docstring of :mod:`masonry.results` lists its keys."""
        at, model, run = self.at, self.model, self.results.run
        run.update(
            scene=self.name,
            options=self._options(),
            option_units=UNITS,
            preset=self.preset,
            columns=meanings(model.columns),
            versions={
                "yade": yade.config.version,
                "python": sys.version.split()[0],
                "masonry": version,
            },
            commit=commit,
            threads=O.numThreads,
            host=socket.gethostname(),
            **model.describe(),
        )
        if self.results.rows:
            run.update(
                energy_balance_error=model.energy.largestError,
                energy_made=model.energy.largestMade,
                **model.summary(self.results.column),
            )
        run.update(
            collapsed=self.collapsed,
            interrupted=self.interrupted,
            resumed_at_s=at.resumed,
            steps=at.steps,
            stages=self._stages(),
            kinds=self.vtk.kinds if self.vtk else [],
            seconds={part: round(s, 3) for part, s in at.seconds.items()},
        )
        if at.steps:
            perStep = at.seconds["steps"] / at.steps
            run["microseconds_per_step"] = 1e6 * perStep
            run["nanoseconds_per_subcontact_step"] = 1e9 * perStep / model.subcontacts

    def _options(self):
        """The options, with a history as the user wrote it."""
        options = dict(vars(self.args))
        if options.get("history"):
            options["history"] = options["history"]["text"]
        return options

    def _stages(self):
        ends = [*self.at.stages[1:], ["", self.at.steps, self.at.seconds["steps"]]]
        return [
            {"stage": name, "steps": after[1] - steps, "seconds": after[2] - seconds}
            for (name, steps, seconds), after in zip(self.at.stages, ends)
        ]

    def _report(self):
        run = self.results.run
        if self.results.rows and not self.args.lean:
            self.model.draw(self.results.directory)
        off, made = run.get("energy_balance_error", 0), run.get("energy_made", 0)
        if made > OFF or (off > OFF and not self.model.energy.warned):
            say(
                f"warning: the energy balance is off by {100 * off:.1f} % of the work done, and joints that open or "
                f"close within a step made {100 * made:.1f} % of it: a smaller --dt-fraction or --rate or more --damping "
                "helps"
            )
        if self.results.rows:
            for line in self.model.report(run):
                say(line)
            say(
                f"{run['steps']} steps of {run['microseconds_per_step']:.0f} µs, {run['wall_clock_s']:.1f} s in all; "
                f"see {self.results.directory}"
            )
        if self.preset:
            say(presetNote(self.preset, self.name))


def _otherVersion(why):
    return Refused(f"--resume: of another version of the plugin: {why}")


def _restored(example, values):
    """A dataclass object with the values of a checkpoint. Raises Refused if these are not of the kind of the example's."""
    before = vars(example)
    wrong = [n for n, value in values.items() if n not in before or not alike(value, before[n])]  # fmt: skip
    if wrong:
        raise _otherVersion(f"its {', '.join(wrong)}")
    return type(example)(**{**before, **values})
