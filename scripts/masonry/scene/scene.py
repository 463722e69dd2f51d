# SPDX-License-Identifier: GPL-2.0-or-later
"""Anybody's structures: bricks between platens, loaded in stages.

A scene reads from top to bottom::

    from masonry import Scene, bricks, materials

    window = bricks.Opening(x=1.1, z=0.81, width=0.88, height=0.972)
    wall = bricks.Wall(length=3.08, height=2.43, openings=[window])
    scene = Scene("pier_with_window", wall, materials.calciumSilicate())
    base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
    scene.press(top, 0.3e6)                   # [Pa]
    scene.settle()
    scene.cycle(top, [2, 4, 8], repeats=2)    # [mm]
    scene.finish()

What comes before the first stage describes: platens, supports, loads, what is recorded. Stages run
in turn (:mod:`masonry.stages`). Each returns how it ended: one of ``AT_REST``, ``MOVING``,
``DONE`` and ``COLLAPSED``. After a collapse the stages that follow are left out. ``finish`` writes
what :mod:`masonry.run.results` lists. All options of the command line work, ``--help`` explains
them: ``--preset``, ``--rate``, ``--set``, ``--out``, ``--resume`` and the others; ``--until`` or
``--history`` replace what the first push or cycle of the scene says.
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
from ..errors import Interrupted
from ..terminal import say
from ..memory import withoutCollector
from ..bricks import Bricks
from ..run import batch
from ..run.ending import end
from ..run.presets import BOUND
from ..run.results import Results
from ..run.run import Run
from ..stages import STAGES, answers, bounding, gravity, prepare, rest
from ..stages.bounds import boundsOf, takeFound
from . import connections, contact, facts, loads, options, platens, records
from .description import Description
from ..materials import Masonry, linesOf, loadingBlock
from .outcome import Outcome
from .resuming import State, resume
from .targets import Target
from .script import SHAKES, Call, Script, either


def _ofFolder(value, context=None):
    """Validator of a name of a scene, which names a folder, too."""
    fine = isinstance(value, str) and value.strip(". ") and value.isprintable()
    if not fine or "/" in value or len(value.encode()) > LONGEST_NAME:
        raise ValueError(f"{shown(value)} must be a text that can name a folder")
    return value


def _blocksOf(value, context=None):
    """Validator of the bricks of a scene."""
    try:
        found = list(value)
        found[0].corners[0][2]
    except Exception:  # of a class of the user's own
        raise ValueError(
            f"{shown(value)} must be a list of blocks, as masonry.bricks makes them"
        ) from None
    return found


class Scene:
    """A structure of bricks, how it is held and loaded, and the stages of its test; the module
    shows how to write one.

    It has a :class:`~masonry.scene.description.Description`; when its first stage begins it gets a
    :class:`~masonry.model.structure.Structure`, its ``model`` in YADE; and a
    :class:`~masonry.run.run.Run`, ``running``, takes the steps.

    :param name: of the folder of results, ``results/<name>``
    :param bricks: blocks: :class:`masonry.bricks.Bricks`, or anything that gives blocks with
        ``corners``, ``brick``, ``part`` and ``kind``
    :param materials: :class:`masonry.materials.Masonry`
    :param title: of the figures; None: the name
    :param plane: whether blocks move in the x-z plane only, which is faster; None: if all bricks
        are one leaf in it
    :param gravity: [m/s²], downwards
    :param columns: names of the columns of curve.csv, beside the energies and the section at the
        base; None: all that there are
    :param functors: as in :func:`masonry.model.engines.engines`
    :param arguments: options as :func:`masonry.scene.options.parser` gives them, or a list of
        words; None: those of the command line
    :param allowGaps: whether bricks that nearly share a face stand apart on purpose, and have no
        joint
    :param collapse: what a run does when the structure falls: ``"end"``, there, or ``"follow"``.
        Then joints without bond whose blocks have slid by 2 % of the joint or turned by 1° become
        contacts during the whole run, a stage that ends in a collapse goes on until the rubble is
        at rest, and ``shake`` and ``run`` go on whatever falls. Rigid bricks only. The contact has
        stiffness and residual friction of the bed joint; ``--set contact.friction=0.7`` and the
        like change it. Blocks fall on the ground, a block that the scene adds below everything else
    :param sceneOptions: options of this scene, for example ``rate=50`` [mm/s] or
        ``dt_fraction=0.4``. They hold unless the command line, or the list of words, gives the same
        option; a note says so then
    :raises Refused: if something is wrong, with all problems at once. A script that does not catch
        it ends with exit status 2
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
        #: what it was made with, its name first, for :meth:`resume`
        made = name, bricks, materials, title, plane, gravity, columns, functors
        self._made = made, dict(allowGaps=allowGaps, collapse=collapse)
        self.description = Description(*made, allowGaps=allowGaps, collapse=collapse)
        arguments = options.ofScene(name, arguments, sceneOptions)
        self.name, self.args = name, arguments
        #: what --accuracy found, :class:`masonry.run.accuracy.AuxiliaryRuns`, or None
        self.accuracy = options.askAccuracy(name, arguments)
        if arguments.crack_surfaces == "off":
            self.description.bricks = list(Bricks(self.description.bricks).whole())
        self.description.deformable = arguments.blocks == "deformable"
        self.script = Script()
        self.calls = []  # every word that was said
        self.staging = False  # whether a stage is being carried out
        # whether bracket() looks for a load, so that no collapse is followed
        self.bracketing = False
        self.running = Run(name, arguments, self.script.words)
        self.model: Any = None  # when it is built, and so are the next two
        self.bounds: Any = None
        self.outcome: Any = None
        self.columns: list[Any] = []  # of curve.csv
        self.finished = False
        #: of displacements, times and loads that grow [-]
        self.share = 0.1 if arguments.quick else 1.0
        self.ended: str | None = None  # how the last stage ended
        #: what was not given of the materials, when the scene is built: an entry of run.json
        self.assumed: list[dict[str, Any]] = []
        self.pushed: Any = None  # options of the last push
        self.loadUnit = "-"  # of the load that a stage put on or let grow last
        self.grown = False  # whether presses and dead loads have their whole
        #: whether there is no run, but limit analysis alone
        self.only = arguments.preset == BOUND
        self._entered = False  # whether a ``with`` block ends it

    platen, watch, handle = platens.platen, platens.watch, platens.handle
    drift, column = records.drift, records.column
    joint, section, view = records.joint, records.section, records.view
    tie, spring, overlay = connections.tie, connections.spring, connections.overlay
    ground = contact.ground
    # Their names are those of stages, too, which are meant after the first stage.
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
        """The columns of curve.csv so far: a :class:`masonry_view.notebook.Curve`, arrays of numpy
        by name with their units.

        :raises ValueError: before the first stage, since there is no row yet
        """
        return wings.find("curve")(self)

    def _repr_html_(self):
        """The scene in a notebook: what is built, or what has come out of it."""
        return wings.find("_repr_html_")(self) if wings.isInstalled("_repr_html_") else None

    def probe(self, stage: str, traits: Any, arguments: dict[str, Any]) -> Any:
        """Write what a study must know of a scene that is built; see
        :func:`masonry_study.probing.probe`."""
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
        """The folder of results: :class:`masonry.run.results.Results`, when the scene is built."""
        return self.running.results

    @property
    def answers(self) -> list[dict[str, Any]]:
        """What the stages were run for, in their order: a list of dicts, as in
        :class:`masonry.stages.answers.Answer`, with the ``stage`` and its ``number``.
        """
        kept, entered = self.running.at.answers, self.running.entered
        numbers = [number for number in sorted(kept, key=int) if int(number) <= entered]
        return [one for number in numbers for one in kept[number]]

    @property
    def factor(self) -> float:
        """The largest load factor under which the structure came to rest in the last stage that
        found one, for example the horizontal over the vertical acceleration of :meth:`accelerate`
        [-]; not a number if no stage has found one.
        """
        found = [a["value"] for a in self.answers if a["name"] == "factor_held"]
        return next((value for value in reversed(found) if value is not None), math.nan)

    def checkOpen(self, name: str) -> None:
        """Refuse a stage of a scene that is finished, or gone because another one was built. Raises
        ValueError."""
        if self.finished:
            raise ValueError(f"{name}: the scene is finished")
        if self.model and self.isGone:
            raise ValueError(
                f"{name}: scene {self.name} is gone, because another one was built since; finish"
                " one scene before the next begins"
            )

    @functools.cached_property
    def masonry(self) -> Masonry:
        """The materials for the options of this run: :class:`masonry.materials.Masonry`.
        Raises Refused."""
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
        if description.contact and not description.ground():
            contact.addGround(description)
        model = Structure(description, self.masonry, args)
        for line in linesOf(self.assumed, self.masonry.brief):
            say(line)
        records.recordBase(description)
        records.viewAlongY(description)
        self.columns = description.columns(model, bool(args.history))
        self.model = model
        self.running.open(self.columns, facts.properties(description, self.masonry))
        self.bounds = boundsOf(self)
        self.running.takeFound = functools.partial(takeFound, self)
        self.outcome = Outcome(self)
        with self.running.clock("setup"), self.running.breakable(), withoutCollector():
            model.build(loadingBlock())
            # the engines that stages had made before the checkpoint of a run that is resumed
            names, begun = {stage.__name__ for stage in STAGES}, False
            for word, arguments in self.running.scriptBefore:
                begun = begun or word in names
                if begun:
                    prepare(self, word, arguments)
        facts.noteCourse(description)
        self.running.start(model, self.outcome.space(), State(self))
        Scene.present = self
        atexit.unregister(self._remind)  # of a run that goes on
        atexit.register(self._remind)

    def finish(self) -> None:
        """End the run: the last frame, run.json, the figures. A run that was not in order exits
        with its status."""
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
        if not (error or self.only or any(word in SHAKES for word, _ in self.script.words)):
            for option, default in (("record", None), ("scale", 1)):
                if getattr(self.args, option, default) != default:
                    say(f"warning: --{option} was not used: the scene was not shaken")
        with self.running.listening():
            done = end(self.running, self, error)
        if self.status and (done or not error):
            if notebook.isHere():
                folder = self.results.directory if self.running.kept else None
                raise notebook.ended(self.name, self.status, folder, error) from None
            raise SystemExit(self.status)
        return done

    @contextlib.contextmanager
    def noted(self, word: Callable[..., Any], *args: Any, **settings: Any) -> Iterator[None]:
        """Note a word that is carried out in a block, for :meth:`resume`: also one that is refused,
        but ends no run."""
        call = Call(word, args, settings)
        self.calls.append(call)
        try:
            yield
        except ValueError:
            call.refused = not self.finished
            raise

    def failed(self, error: BaseException) -> Any:
        """End in order after an error of a stage. In a ``with`` block that does it."""
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
