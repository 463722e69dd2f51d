# SPDX-License-Identifier: GPL-2.0-or-later
"""What stages of a scene share: how they begin and end, their traits, and how time passes in those
that last for a given time."""

import functools
import os
from dataclasses import dataclass
from enum import Enum
from typing import Annotated, Any, Callable, Concatenate, ParamSpec, TypeVar

from yade import O

from .. import notebook
from ..arguments import number, validated
from ..errors import Collapsed, NotAccurate, Refused
from ..terminal import say
from ..model.overturning import NEAR
from ..run import batch
from ..run.accuracy import STAGES
from ..run.checkpoints import stateOf
from ..run.run_state import StageContext
from ..scene.script import PUSHES, argumentsOf, asData
from .answers import COLLAPSED, DONE, FALL, FALLEN, keep
from .falling import followFall, writeTable
from .falling import answers as answersOfFall

ROWS = 500  # of curve.csv in a stage that lasts for a given time
FRAMES = 20  # for ParaView in such a stage
#: Share of a load from which a note says that continuous beds would hold less [-], and how many
#: times as large it must be for another note.
OVERESTIMATE, AGAIN = 0.01, 1.3

#: Kinds of arguments: a time that is not longer than a day, and one above 0 [s].
Time = Annotated[float, number("s", 0, 86400)]
Duration = Annotated[float, number("s", 0, 86400, above=True)]

P = ParamSpec("P")
R = TypeVar("R")
#: A stage: a function of the scene and what the user says, which returns how it ended.
Stage = Callable[Concatenate[Any, P], str]


@dataclass(frozen=True)
class Traits:
    """Properties of a kind of stage.

    :param bounded: whether ``--preset bound`` finds the bound of its load, and does not skip it
    :param extendable: names of the arguments that set the end of the stage; a resumed run may give
        larger ones
    :param options: options of the command line that the stage uses, by the names of their values
    :param grows: whether presses, dead loads and wind grow in it
    :param dynamic: whether it runs in real time, and goes on whatever falls if a collapse is
        followed
    :param check: function of the scene and what the user says, which raises Refused before the
        scene is built
    :param answers: function of the scene, and of one that gives the values of a column in the rows
        of the stage, or an empty list, by its head; it gives some
        :class:`~masonry.stages.answers.Answer`
    """

    bounded: bool = False
    extendable: tuple = ()
    options: tuple = ()
    grows: bool = False
    dynamic: bool = False
    check: Callable | None = None
    answers: Callable = lambda scene, rows: []


def stage(**traits: Any) -> Callable[[Stage[P]], Stage[P]]:
    """Make a stage of a function of the scene and what the user says, which is checked as by
    :func:`masonry.arguments.validated`; keywords as in :class:`Traits`. The first stage builds the
    scene; errors end the run in order."""

    def made(said: Stage[P]) -> Stage[P]:
        act = validated(said)

        @functools.wraps(act)
        def staged(scene: Any, *args: P.args, **settings: P.kwargs) -> str:
            command = _Command(scene, act, known)
            if notebook.isHere() and not scene.finished:
                # a word that is wrong can be corrected in the cell: it is no end of the run
                command.check(args, settings)
            with scene.noted(staged, *args, **settings), scene.running.listening():
                return command.carryOut(args, settings)

        known = Traits(**traits)
        vars(staged).update(traits=known)
        return staged

    return made


def combines(act: Callable[Concatenate[Any, P], R]) -> Callable[Concatenate[Any, P], R]:
    """A command of several stages: what it refuses itself ends the run in order, as in a stage."""

    @functools.wraps(act)
    def command(scene: Any, *args: P.args, **settings: P.kwargs) -> R:
        try:
            return act(scene, *args, **settings)
        except Refused as refused:
            if notebook.isHere() or scene.finished:
                raise
            scene.failed(refused)
            raise

    return command


class SkipReason(Enum):
    """Why a stage is left out."""

    PROBED = "a study asks what the scene knows"
    FALLEN = "the structure has fallen"
    BOUND_ONLY = "there is no run, but limit analysis alone"
    DONE_BEFORE = "it was over before the run was resumed"


class _Command:
    """A stage that the script asks for: it is prepared, then skipped or executed."""

    def __init__(self, scene, act, traits):
        self.scene, self.running, self.act, self.traits = scene, scene.running, act, traits
        self.name = act.__name__
        self.before = None  # how many stages the run had entered when it began

    def carryOut(self, args, settings):
        """Carry the stage out. Returns how it ended."""
        scene = self.scene
        scene.checkOpen(self.name)
        loaded = scene.description.loaded()
        if not scene.model and loaded and not self.traits.grows:
            raise Refused(
                f"{self.name}: the loads on {', '.join(loaded)} grow in settle(): call that first"
            )
        try:
            args, settings = self.check(args, settings)
            scene.begin()
            said = argumentsOf(self.act, scene, args, settings)
            extended = self._prepare(said)
            if reason := self._skipReason(extended):
                return self._skip(reason, said)
            return self._execute(args, settings)
        except Collapsed as collapse:
            return self._endFallen(str(collapse))
        except BaseException as error:
            if self.running.entered == self.before:
                # it has done nothing, and a run that goes on need not say it again
                scene.script.commands.pop()
            return scene.failed(error)

    def check(self, args, settings):
        """What the user says, as its validators return it. Raises Refused."""
        scene = self.scene
        (_, *args), settings = self.act.checked((scene, *args), settings)
        if scene.args.accuracy and self.name not in STAGES:
            raise NotAccurate(
                "--accuracy: it is about peak and work of a push, and this scene has the stage"
                f" {self.name}; scenes with it have the stages {', '.join(STAGES)} alone"
            )
        if self.traits.dynamic and scene.args.density_scaling != 1:
            raise Refused(
                f"--density-scaling {scene.args.density_scaling:g}: {self.name} runs in real time,"
                " with true masses"
            )
        if self.traits.check:
            self.traits.check(scene, *args, **settings)
        return args, settings

    def _prepare(self, said):
        """Note the stage as a command of the script. Returns whether a resumed run goes on with it
        beyond its former end."""
        script, running = self.scene.script, self.running
        script.add(self.name, asData(said), self.traits.extendable)
        extended = running.isResumed and script.compare(running.scriptBefore)
        if running.isResumed and script.isFirst(PUSHES):  # options set the end of this push
            was, now = running.saved.options, asData(vars(self.scene.args))
            extended = extended or any(was.get(n) != now[n] for n in ("until", "history"))
        self.before = running.entered
        return extended and self.before + 1 == running.state.begun

    def _skipReason(self, extended):
        """Why the stage is left out, or None."""
        scene, running = self.scene, self.running
        if batch.PROBE in os.environ:
            return SkipReason.PROBED
        if scene.collapsed:
            return SkipReason.FALLEN
        if scene.limitAnalysisOnly and not self.traits.bounded:
            return SkipReason.BOUND_ONLY
        ended = str(self.before + 1) in running.state.ended
        if self._isBefore() and ended and not extended:
            return SkipReason.DONE_BEFORE
        return None

    def _isBefore(self):
        """Whether the stage begins before the checkpoint of a run that is resumed."""
        return self.running.isResumed and not self.running.resumedHere

    def _skip(self, reason, said):
        """Leave the stage out. Returns how it ended."""
        scene, running = self.scene, self.running
        if reason is SkipReason.PROBED:
            return scene.probe(self.name, self.traits, said)
        if reason is SkipReason.FALLEN:
            say(
                f"note: {self.name} is left out, because the structure has fallen; stepBack() takes"
                " it to its last state at rest"
            )
            return COLLAPSED
        if reason is SkipReason.BOUND_ONLY:
            say(f"note: --preset bound: no run, {self.name} is left out")
            return DONE
        scene.ended, running.entered = running.state.ended[str(self.before + 1)]
        running.cutBackTo(running.entered + 1, False)
        if scene.ended in FALLEN:
            running.collapsed = True
            running.results.run["collapse"] = running.state.fall
        return COLLAPSED if scene.collapsed else scene.ended

    def _execute(self, args, settings):
        """Carry out the stage or the rest of it. Returns how it ended."""
        scene, running, traits, state = self.scene, self.running, self.traits, self.running.state
        if self._isBefore():
            resumedHere = self.before + 1 == state.begun
            running.cutBackTo(self.before + 1, resumedHere)
            if not running.sceneState.isRestored:
                running.sceneState.put(state.before if resumedHere else state.now)
        state.begun, state.before = self.before + 1, stateOf(scene)
        scheme, follows = scene.model.scheme, scene.description.contact is not None
        scheme.dampByOptions(traits.dynamic)
        scheme.joints.impacts = traits.dynamic
        if follows:
            scheme.keepStep()
            scheme.keepStable()
        running.context = StageContext(loadsGrow=traits.grows and not scene.grown)
        if follows and running.resumedHere and state.stage == FALL:
            return self._follow()
        running.context.endsAtFall = follows and not traits.dynamic
        scene.ended = ended = self.act(scene, *args, **settings)
        if follows:
            scene.model.checkFallen()
            self._noteEdge()
        self._noteEnd(ended)
        if not traits.extendable:
            running.checkpoints.setRollbackPoint()
        self._answer()
        return ended

    def _endFallen(self, what):
        """End the stage, or follow the fall, when the structure has fallen; ``what``, and how
        far."""
        scene, running = self.scene, self.running
        scene.ended = COLLAPSED
        follows = scene.description.contact is not None and not scene.bracketing
        if not follows:  # else it ends with the fall
            self._noteEnd(COLLAPSED)
        running.fall(what)
        try:
            if running.readings.time != O.time:
                running.record()
            running.flush()
            running.checkpoints.recordFall()
        except FloatingPointError:
            follows = False  # what has fallen may have left finite numbers
            self._noteEnd(COLLAPSED)
        self._answer()
        return self._follow() if follows else COLLAPSED

    def _follow(self):
        """Follow the fall until all is at rest, also if the run was resumed in it."""
        scene, running = self.scene, self.running
        try:
            running.context.endsAtFall = False
            if running.resumedHere and not running.advanced:  # all before the fall is over
                running.entered = running.state.number - 1
                running.fall(running.state.fall)
            scene.ended = COLLAPSED
            try:
                scene.ended = followFall(scene, tilted=self.name == "tilt")
            except Collapsed as collapse:
                say(f"note: the fall is followed no farther: {collapse}")
            found = answersOfFall(scene, scene.ended, running.memory.begun)
            keep(scene, str(running.entered), FALL, running.entered, found)
            writeTable(scene)
            self._noteEnd(scene.ended)
            running.checkpoints.setRollbackPoint()
            return COLLAPSED
        except BaseException as error:
            return scene.failed(error)

    def _noteEnd(self, ended):
        state = self.running.state
        state.ended = {**state.ended, str(self.before + 1): [ended, self.running.entered]}

    def _answer(self):
        """Keep the answers of the stage, if it was not carried out before the run was resumed."""
        scene, running = self.scene, self.running
        if scene.limitAnalysisOnly or running.entered == self.before:
            return
        if not scene.description.functors:
            self._noteOpened()
        results, first = running.results, running.state.stages[self.before]["first_row"]
        rows = lambda head: results.column(head)[first:] if head in results.columns else []
        number = self.before + 1
        keep(scene, str(number), self.name, number, self.traits.answers(scene, rows))

    def _noteEdge(self):
        """Say if a structure that stands has been near the edge of a fall."""
        share = self.scene.model.overturning.share()
        share = max(share, getattr(self.running.memory, "overturned", 0.0))
        if share >= NEAR:
            say(
                f"note: {self.name}: what stands had gone {100 * share:.0f} % of the way to"
                " overturning, so the end is near the edge of a fall: another time step"
                " (--dt-fraction), or a load that is a little larger, may turn it"
            )

    def _noteOpened(self):
        """Say if dry joints have opened whose few points may hold more than their beds."""
        state, less = self.running.state, self.scene.model.scheme.joints.overestimate
        if less < max(OVERESTIMATE, AGAIN * state.overestimate):
            return
        state.overestimate = less
        say(
            f"note: {self.name}: dry joints opened that turn about their edges, as those of rigid"
            f" blocks: on continuous beds (normalStiffness) a load makes the structure fall about"
            f" {100 * less:.0f} % earlier by estimate; --points 14 follows how such beds open"
        )


@dataclass
class Timed:
    """What a stage remembers that lasts for a given time, which it counts in ticks."""

    done: int = 0  # ticks so far
    nextFrame: int = 0  # number of the tick after which a frame is due
    tick: float = 0.0  # the time step when the stage began [s]; 0 before that
    began: float = 0.0  # when that was [s]
    step: float = 0.0  # the time step now, which may follow the state [s]
    overturned: float = 0.0  # largest Overturning.share() of the rows [-]


def timed(scene, at, duration, before=None, after=None, each=20):
    """Steps for a duration [s], with rows and frames evenly in time.

    :param before: function of the number of ticks so far and after the next stretch, called before
        each stretch of at most ``each``; None: a stretch ends with a row
    :param after: function that is called after each row
    """
    running = scene.running
    if not at.tick:
        at.tick, at.began, at.step = O.dt, O.time, O.dt
    length = max(1, round(duration / at.tick))
    perRow = stretch = max(1, length // ROWS)
    if before:
        stretch = min(each, perRow)
        perRow = perRow // stretch * stretch
    perFrame = max(1, length // FRAMES)
    while at.done < length:
        goal = min(length, (at.done // perRow + 1) * perRow)
        beyond = min(goal, at.done + stretch)
        if before:
            before(at.done, beyond)
        running.advance(max(1, round((beyond - at.done) * at.tick / at.step)))
        at.done, at.step = round((O.time - at.began) / at.tick), O.dt
        if at.done < goal:
            continue
        running.record()
        if overturning := scene.model.overturning:
            at.overturned = max(at.overturned, overturning.share())
        text = lambda: f"{at.done * at.tick:.3f} of {duration:.3f} s"
        running.show(at.done / length, text)
        if at.done >= at.nextFrame:
            running.frame()
            at.nextFrame += perFrame
        if after:
            after()
    running.show(1, lambda: f"{duration:.3f} s", final=True)
    running.flush()
    return DONE
