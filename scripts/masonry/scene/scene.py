# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene: bricks between platens, loaded in stages, as ``help(masonry)`` shows.

Commands before the first stage describe: platens, supports, loads, what is recorded. Stages
(:mod:`masonry.stages`) return how they ended: ``AT_REST``, ``MOVING``, ``DONE`` or ``COLLAPSED``;
after a collapse those that follow are left out. ``finish`` writes what :mod:`masonry.run.results`
lists. ``--help`` explains the options; ``--until`` or ``--history`` replace what the first push or
cycle says.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import math
import os
from typing import Annotated, Any, Callable, Iterable, Iterator, Sequence

from ..arguments import LONGEST_NAME
from ..arguments import isA, listOf, number, oneOf, shown, text, validated
from .. import notebook, stages, wings
from ..model.structure import Structure
from ..units import GRAVITY
from ..errors import Interrupted, Refused
from ..terminal import say
from ..memory import withoutCollector
from ..bricks import Bricks
from ..run import batch
from ..run.checkpoints import SceneState
from ..run.ending import end
from ..run.presets import BOUND
from ..run.results import Results
from ..run.run import Run
from ..stages import STAGES, answers, bounding, gravity, prepare, rest
from ..stages.ahead import lookAhead
from ..stages.bounds import boundsOf, takeFound
from . import connections, contact, loads, options, platens, records, summary
from .description import Description
from ..materials import Masonry, linesOf, loadingBlock
from .outcome import ResultSummary
from .resuming import resume
from .targets import Target
from .script import SHAKES, Call, Script, either


def _ofFolder(value, context=None):
    fine = isinstance(value, str) and value.strip(". ") and value.isprintable()
    if not fine or "/" in value or len(value.encode()) > LONGEST_NAME:
        raise Refused(f"{shown(value)} must be a text that can name a folder")
    return value


def _blocksOf(value, context=None):
    try:
        found = list(value)
        found[0].corners[0][2]
    except Exception:  # of a class of the user's own
        raise Refused(
            f"{shown(value)} must be a list of blocks, as masonry.bricks makes them"
        ) from None
    return found


class Scene:
    """A structure of bricks, how it is held and loaded, and the stages of its test.

    Its :class:`~masonry.scene.description.Description` becomes a
    :class:`~masonry.model.structure.Structure`, the ``model`` in YADE, when its first stage begins;
    a :class:`~masonry.run.run.Run`, ``running``, takes the steps.

    :param name: of the folder of results, ``results/<name>``
    :param bricks: blocks: :class:`masonry.bricks.Bricks`, or anything that gives blocks with
        ``corners``, ``brick``, ``part`` and ``kind``
    :param materials: :class:`masonry.materials.Masonry`
    :param title: of the figures; None: the name
    :param plane: whether blocks move in the x-z plane only, which is faster; None: if all bricks
        are one leaf in it
    :param gravity: [m/s²], downwards
    :param columns: names of the columns of curve.csv, beside the energies and the section at the
        base; None: all
    :param functors: as in :func:`masonry.model.engines.engines`
    :param arguments: options as :func:`masonry.scene.options.parser` gives them, or a list of
        words; None: those of the command line
    :param allowGaps: whether bricks that nearly share a face stand apart on purpose, and have no
        joint
    :param collapse: ``"end"``: the run ends when the structure falls; ``"follow"``, of rigid
        bricks: joints without bond whose blocks have slid by 2 % of the joint or turned by 1°
        become contacts, a stage that ends in a collapse goes on until the rubble is at rest, and
        ``shake`` and ``run`` go on whatever falls. The contact has stiffness and residual friction
        of the bed joint; ``--set contact.friction=0.7`` and the like change it. Blocks fall on the
        ground, a block that the scene adds below everything else
    :param sceneOptions: options of this scene, for example ``rate=50`` [mm/s]. The command line, or
        the list of words, wins, and a note says so
    :raises Refused: with all problems. A script that does not catch it ends with exit status 2
    """

    present: Scene | None = None  # the scene that stands in YADE

    @validated
    def __init__(
        self,
        name: Annotated[str, _ofFolder],
        bricks: Annotated[Iterable[Any], _blocksOf],
        materials: Annotated[Masonry, isA(Masonry, "masonry.materials.Masonry")],
        title: str | None = None,
        plane: bool | None = None,
        gravity: Annotated[float, number("m/s²", 0, 1e6)] = GRAVITY,
        columns: Annotated[Sequence[str], listOf(text)] | None = None,
        functors: bool = False,
        arguments: Any = None,
        allowGaps: bool = False,
        collapse: Annotated[str, oneOf("end", "follow")] = "end",
        **sceneOptions: Any,
    ) -> None:
        # what it was made with, for resume()
        self._made = name, bricks, materials, title, plane, gravity, columns, functors
        self._settings = {"allowGaps": allowGaps, "collapse": collapse}
        self.description = Description(*self._made, **self._settings)
        arguments = options.ofScene(name, arguments, sceneOptions)
        self.name, self.args = name, arguments
        #: what --accuracy found, :class:`masonry.run.accuracy.AuxiliaryRuns`, or None
        self.accuracy = options.askAccuracy(name, arguments)
        if arguments.crack_surfaces == "off":
            self.description.bricks = list(Bricks(self.description.bricks).whole())
        self.description.deformable = arguments.blocks == "deformable"
        self.script = Script()
        self.calls = []  # every command that was given
        self.bracketing = False  # bracket() looks for a load, so no collapse is followed
        self.running = Run(name, arguments, self.script.commands)
        self.model: Any = None  # until it is built, and so are the next two
        self.bounds: Any = None
        self.outcome: Any = None
        self.columns: list[Any] = []  # of curve.csv
        self.finished = False
        #: share of displacements, times and loads that grow [-]
        self.share = 0.1 if arguments.quick else 1.0
        self.ended: str | None = None  # how the last stage ended
        #: entry ``assumed`` of run.json, when the scene is built
        self.assumed: list[dict[str, Any]] = []
        self.pushed: Any = None  # options of the last push
        self.loadUnit = "-"  # of the load that a stage put on or let grow last
        self.grown = False  # presses and dead loads act whole
        #: there is no run, but limit analysis
        self.limitAnalysisOnly = arguments.preset == BOUND
        self._entered = False  # a ``with`` block ends it

    platen, watch, handle = platens.platen, platens.watch, platens.handle
    drift, column = records.drift, records.column
    joint, section, view = records.joint, records.section, records.view
    pier, spandrel = records.pier, records.spandrel
    tie, spring, overlay = connections.tie, connections.spring, connections.overlay
    ground = contact.ground
    # stages have these names after the first stage
    hold = either(platens.hold, stages.hold)
    press = either(loads.press, stages.press)
    load = either(loads.load, stages.load)
    wind = either(loads.wind, stages.wind)
    pressure = either(loads.pressure, stages.pressure)

    @property
    def targets(self) -> dict[str, Target]:
        """Platens and bricks that are held, loaded or watched, by their names."""
        return self.description.targets

    settle, release, move = stages.settle, stages.release, stages.move
    push, cycle, follow = stages.push, stages.cycle, stages.follow
    drive, pressJoint = stages.drive, stages.pressJoint
    tilt, accelerate, lean = stages.tilt, stages.accelerate, stages.lean
    grow, travel = stages.grow, stages.travel
    shake, run, period = stages.shake, stages.run, stages.period
    shakeAgain = stages.shakeAgain
    bracket, stepBack, resume = gravity.bracket, rest.stepBack, resume
    bound, domain, result = bounding.bound, bounding.domain, answers.result

    def curve(self) -> Any:
        """The columns of curve.csv so far: a :class:`masonry_view.notebook.Curve`. Raises
        ValueError before the first stage."""
        return wings.find("curve")(self)

    def _repr_html_(self):
        """The scene in a notebook: what is built, or what has come out of it."""
        return wings.find("_repr_html_")(self) if wings.isInstalled("_repr_html_") else None

    def probe(self, stage: str, traits: Any, arguments: dict[str, Any]) -> Any:
        return wings.find("probe")(self, stage, traits, arguments)

    @property
    def isGone(self) -> bool:
        """Whether another scene was built in YADE since this one."""
        return Scene.present is not self

    @property
    def status(self) -> int:
        """Exit status of the script, when the scene is finished."""
        return self.running.status

    @property
    def collapsed(self) -> bool:
        """Whether the structure has fallen."""
        return self.running.collapsed

    @property
    def results(self) -> Results:
        """The folder of results, when the scene is built."""
        return self.running.results

    @property
    def answers(self) -> list[dict[str, Any]]:
        """What the stages have found, in their order: dicts as in
        :class:`masonry.stages.answers.Answer`, with the ``stage`` and its ``number``."""
        kept, entered = self.running.state.answers, self.running.entered
        number = lambda key: int(key.partition(" ")[0])
        keys = [key for key in sorted(kept, key=number) if number(key) <= entered]
        return [one for key in keys for one in kept[key]]

    @property
    def factor(self) -> float:
        """The largest load factor [-] under which the structure came to rest, of the last stage
        that found one; else not a number."""
        found = [a["value"] for a in self.answers if a["name"] == "factor_held"]
        return next((value for value in reversed(found) if value is not None), math.nan)

    def checkOpen(self, name: str) -> None:
        """Refuse a scene that is finished, or gone because another one was built."""
        if self.finished:
            raise Refused(f"{name}: the scene is finished")
        if self.model and self.isGone:
            raise Refused(
                f"{name}: scene {self.name} is gone, because another one was built since; finish"
                " one scene before the next begins"
            )

    @functools.cached_property
    def masonry(self) -> Masonry:
        """The materials for the options of this run. Raises Refused."""
        connectors = self.description.settable()
        masonry = self.description.materials.variant(self.args, [*connectors])
        problems = self.description.problems(masonry)
        problems += contact.problems(self.description, self.args)
        options.check(self.args, masonry, connectors, problems)
        self.assumed = masonry.assumed()
        return masonry

    def begin(self) -> None:
        """Build the scene in YADE, if it does not stand there yet."""
        if self.model:
            return
        description, args = self.description, self.args
        if not self.running.isResumed:
            lookAhead(self)
        if description.contact and not description.ground():
            contact.addGround(description)
        model = Structure(description, self.masonry, args)
        for line in linesOf(self.assumed, self.masonry.brief):
            say(line)
        records.recordBase(description)
        records.viewAlongY(description)
        self.columns = description.columns(model, bool(args.history))
        self.model = model
        self.running.open(self.columns, summary.properties(description, self.masonry))
        self.bounds = boundsOf(self)
        self.running.takeFound = functools.partial(takeFound, self)
        self.outcome = ResultSummary(self)
        with self.running.clock("setup"), self.running.breakable(), withoutCollector():
            model.build(loadingBlock())
            # engines that stages had made before the checkpoint
            names, begun = {stage.__name__ for stage in STAGES}, False
            for word, arguments in self.running.scriptBefore:
                begun = begun or word in names
                if begun:
                    prepare(self, word, arguments)
        summary.noteCourse(description)
        summary.notePlatens(description, self.masonry)
        self.running.start(model, self.outcome.space(), SceneState(self))
        Scene.present = self
        atexit.register(self._remind)

    def finish(self) -> None:
        """End the run: the last frame, run.json, the figures. A run that was not in order ends the
        script with its status."""
        if batch.PROBE in os.environ and self.model:
            self.probe("finish", None, {})
        if not (self.finished or self._entered):
            self.__exit__(None, None, None)

    def __enter__(self) -> Scene:
        self._entered = True
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> bool:
        if self.finished:
            return False
        self.finished = True
        if not error and not self.model:
            return False
        if not (error or self.limitAnalysisOnly or self.script.has(SHAKES)):
            for option, default in (("record", None), ("scale", 1)):
                if getattr(self.args, option, default) != default:
                    say(f"warning: --{option} was not used: the scene was not shaken by shake()")
        with self.running.listening():
            done = end(self.running, self, error)
        if self.status and (done or not error):
            if notebook.isHere():
                folder = self.results.directory if self.running.kept else None
                raise notebook.ended(self.name, self.status, folder, error) from None
            raise SystemExit(self.status)
        return done

    @contextlib.contextmanager
    def noted(self, command: Callable[..., Any], *args: Any, **settings: Any) -> Iterator[None]:
        """Note a command that is carried out in a block, for :meth:`resume`: also one that is
        refused, but ends no run."""
        call = Call(command, args, settings)
        self.calls.append(call)
        try:
            yield
        except ValueError:
            call.refused = not self.finished
            raise

    def failed(self, error: BaseException) -> Any:
        """End in order after an error of a stage, or leave that to the ``with`` block."""
        if isinstance(error, Interrupted):
            self.ended = "interrupted"
        if self._entered:
            raise error
        if not self.__exit__(type(error), error, error.__traceback__):
            raise error

    def _remind(self):
        if not self.finished:
            say(
                f"note: {self.name}: the script ended without scene.finish(); there is no run.json,"
                " and no figure"
            )
