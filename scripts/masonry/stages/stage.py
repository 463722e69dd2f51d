# SPDX-License-Identifier: GPL-2.0-or-later
"""What stages of a scene share: how they begin and end, their traits, and how time passes in those
that last for a given time."""

import functools
import os
from dataclasses import dataclass
from typing import Annotated, Any, Callable, Concatenate, ParamSpec

from yade import O

from .. import notebook
from ..arguments import number, validated
from ..errors import Collapsed, NotAccurate
from ..terminal import say
from ..run import batch
from ..run.accuracy import STAGES
from ..scene.resuming import enter
from ..scene.script import argumentsOf
from .answers import COLLAPSED, DONE, FALL, FALLEN
from .falling import followFall, writeTable
from .falling import answers as answersOfFall

ROWS = 500  # of curve.csv in a stage that lasts for a given time
FRAMES = 20  # for ParaView in such a stage

#: Kinds of arguments: a time that is not longer than a day, and one above 0 [s].
Time = Annotated[float, number("s", 0, 86400)]
Duration = Annotated[float, number("s", 0, 86400, above=True)]

P = ParamSpec("P")
#: A stage: a function of the scene and what the user says, which returns how it ended.
Stage = Callable[Concatenate[Any, P], str]


@dataclass(frozen=True)
class Traits:
    """What the rest of the package must know of a kind of stage.

    :param bounded: whether ``--preset bound`` finds the bound of its load; other stages are left
        out then
    :param farther: names of the arguments that say how far it goes: a run that is resumed in this
        stage may change them
    :param options: options of the command line that the stage uses, by the names of their values
    :param grows: whether presses, dead loads and wind grow in it
    :param real: whether it runs in real time, whatever falls, in a scene whose collapse is followed
    :param check: function of the scene and what the user says, which raises Refused before the
        scene is built
    :param answers: function of the scene, and of one that gives the values of a column in the rows
        of the stage, or an empty list, by its head; it gives some
        :class:`~masonry.stages.answers.Answer`
    """

    bounded: bool = False
    farther: tuple = ()
    options: tuple = ()
    grows: bool = False
    real: bool = False
    check: Callable | None = None
    answers: Callable = lambda scene, rows: []


def stage(**traits: Any) -> Callable[[Stage[P]], Stage[P]]:
    """Make a stage of a function of the scene and what the user says, which is checked as by
    :func:`masonry.arguments.validated`; the keywords are those of :class:`Traits`.

    The stage builds the scene if it is the first, is left out after a collapse, and ends the run in
    order on errors.
    """

    def made(said: Stage[P]) -> Stage[P]:
        act = validated(said)

        @functools.wraps(act)
        def staged(scene: Any, *args: P.args, **settings: P.kwargs) -> str:
            if scene.staging:  # it is a part of another stage
                return _carryOut(scene, act, known, args, settings)
            if notebook.isHere() and not scene.finished:
                # a word that is wrong can be corrected in the cell: it is no end of the run
                _check(scene, act, known, args, settings)
            scene.staging = True
            try:
                with scene.noted(staged, *args, **settings), scene.running.listening():
                    return _carryOut(scene, act, known, args, settings)
            finally:
                scene.staging = False

        known = Traits(**traits)
        vars(staged).update(traits=known)
        return staged

    return made


def _check(scene, act, traits, args, settings):
    """What the user says to a stage, as its kinds return it. Raises Refused."""
    (_, *args), settings = act.checked((scene, *args), settings)
    if scene.args.accuracy and act.__name__ not in STAGES:
        raise NotAccurate(
            "--accuracy: it is about peak and work of a push, and this scene has the stage"
            f" {act.__name__}; scenes with it have the stages {', '.join(STAGES)} alone"
        )
    if traits.check:
        traits.check(scene, *args, **settings)
    return args, settings


def _carryOut(scene, act, traits, args, settings):
    running, before, name = scene.running, None, act.__name__
    scene.checkOpen(name)
    loaded = scene.description.loaded()
    if not scene.model and loaded and not traits.grows:
        raise ValueError(
            f"{name}: the loads on {', '.join(loaded)} grow in settle(): call that first"
        )
    try:
        args, settings = _check(scene, act, traits, args, settings)
        scene.begin()
        if batch.PROBE in os.environ:
            return scene.probe(name, traits, argumentsOf(act, scene, args, settings))
        scene.script.note(act, scene, args, settings, traits.farther)
        farther = not running.advanced and scene.script.compare(running.scriptBefore)
        if scene.collapsed:
            say(
                f"note: {name} is left out, because the structure has fallen; stepBack() takes it"
                " to its last state at rest"
            )
            return COLLAPSED
        if scene.limitAnalysisOnly and not traits.bounded:
            say(f"note: --preset bound: no run, {name} is left out")
            return DONE
        before = running.entered
        over = enter(scene, before + 1, farther)
        if over:  # before the run was resumed: it ends as it did then
            if over in FALLEN:
                running.collapsed = True
                running.results.run["collapse"] = running.at.fall
            scene.ended = over
            return COLLAPSED if scene.collapsed else over
        running.loading = traits.grows and not scene.grown
        scheme, follows = scene.model.scheme, scene.description.contact is not None
        scheme.dampByOptions()
        scheme.joints.impacts = traits.real
        if follows:
            scheme.keepStable()
        if follows and running.redoes and running.at.stage == FALL:
            return _follow(scene, name)
        running.endsAtFall = follows and not traits.real
        scene.ended = ended = act(scene, *args, **settings)
        if follows:
            scene.model.checkFallen()
        _noteEnd(running, before, ended)
        if not traits.farther:
            running.checkpoints.mark()
        _answer(scene, name, traits, before)
        return ended
    except Collapsed as collapse:
        return _fall(scene, name, traits, before, str(collapse))
    except BaseException as error:
        if before is not None and running.entered == before:
            # it has done nothing, and a run that goes on need not say it again
            scene.script.commands.pop()
        return scene.failed(error)


def _fall(scene, name, traits, before, what):
    """End a stage in which the structure has fallen, or go on with the fall; ``what`` has fallen,
    and how far."""
    running = scene.running
    scene.ended = COLLAPSED
    follows = scene.description.contact is not None and not scene.bracketing
    if not follows:  # else it ends with the fall
        _noteEnd(running, before, COLLAPSED)
    running.fall(what)
    try:
        if running.readings.time != O.time:
            running.record()
        running.flush()
        running.checkpoints.markFall()
    except FloatingPointError:
        follows = False  # what has fallen may have left finite numbers
        _noteEnd(running, before, COLLAPSED)
    _answer(scene, name, traits, before)
    return _follow(scene, name) if follows else COLLAPSED


def _follow(scene, name):
    """Go on with a structure that has fallen until it is at rest, in a stage or in a run that is
    resumed while it falls."""
    running, begun = scene.running, scene.running.at.begun
    try:
        running.endsAtFall = False
        if running.redoes and not running.advanced:  # all before the fall is over
            running.entered = running.at.number - 1
            running.fall(running.at.fall)
        scene.ended = COLLAPSED
        try:
            scene.ended = followFall(scene, tilted=name == "tilt")
        except Collapsed as collapse:
            say(f"note: the fall is followed no farther: {collapse}")
        found = answersOfFall(scene, scene.ended, running.memory.begun)
        _keepAnswers(running, FALL, running.entered, found)
        writeTable(scene)
        _noteEnd(running, begun - 1, scene.ended)
        running.checkpoints.mark()
        return COLLAPSED
    except BaseException as error:
        return scene.failed(error)


def _noteEnd(running, before, ended):
    running.at.ended = {**running.at.ended, str(before + 1): [ended, running.entered]}


def _answer(scene, name, traits, before):
    """Keep the answers of a stage that was carried out now, and not before the run was resumed;
    ``before``: how many stages the run had entered before it."""
    running = scene.running
    if scene.limitAnalysisOnly or before is None or running.entered == before:
        return
    results, first = running.results, running.at.stages[before][3]
    rows = lambda head: results.column(head)[first:] if head in results.columns else []
    _keepAnswers(running, name, before + 1, traits.answers(scene, rows))


def _keepAnswers(running, stage, number, answers):
    kept = [{"stage": stage, "number": number, **vars(one)} for one in answers]
    running.at.answers = {**running.at.answers, str(number): kept}


@dataclass
class Timed:
    """What a stage remembers that lasts for a given time."""

    done: int = 0  # steps so far
    nextFrame: int = 0  # number of the step after which a frame is due


def timed(scene, at, duration, before, after=None, each=None):
    """Steps for a duration [s], with rows and frames evenly in time.

    :param before: function of the number of steps so far and after the next stretch, called before
        each stretch
    :param after: called after each row
    :param each: steps of a stretch; None: 20, or fewer
    """
    running, step = scene.running, O.step
    length = max(1, round(duration / O.dt))
    stretch = each or max(1, min(20, length // ROWS))
    perRow = max(stretch, length // ROWS // stretch * stretch)
    perFrame = max(1, length // FRAMES)

    def alone(number):  # a step with its own ``before``
        before(at.done + number, at.done + number + 1)
        step()

    while at.done < length:
        goal = min(length, (at.done // perRow + 1) * perRow)
        beyond = min(goal, at.done + stretch)
        before(at.done, beyond)
        beyond = goal if stretch == 1 else beyond
        running.advance(beyond - at.done, alone if stretch == 1 else None)
        at.done = beyond
        if at.done < goal:
            continue
        running.record()
        text = lambda: f"{at.done * O.dt:.3f} of {duration:.3f} s"
        running.show(at.done / length, text)
        if at.done >= at.nextFrame:
            running.frame()
            at.nextFrame += perFrame
        if after:
            after()
    running.show(1, lambda: f"{duration:.3f} s", final=True)
    running.flush()
    return DONE
