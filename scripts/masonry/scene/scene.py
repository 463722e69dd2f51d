# SPDX-License-Identifier: GPL-2.0-or-later
"""Anybody's structures: bricks between platens, loaded in stages.

A scene reads from top to bottom::

    from masonry import Scene, bricks, materials

    wall = bricks.Wall(length=3.08, height=2.43, openings=[bricks.Opening(x=1.1, z=0.81, width=0.88, height=0.972)])
    scene = Scene("pier_with_window", wall, materials.calciumSilicate())
    base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
    scene.press(top, 0.3e6)                   # [Pa]
    scene.settle()
    scene.cycle(top, [2, 4, 8], repeats=2)    # [mm]
    scene.finish()

What comes before the first stage describes: platens, supports, loads, what is recorded. Stages run in turn
(:mod:`masonry.scene.stages`). Each returns how it ended: one of ``AT_REST``, ``MOVING``, ``DONE`` and ``COLLAPSED``. After a
collapse the stages that follow are left out. ``finish`` writes what :mod:`masonry.run.results` lists. All options of the
command line work, ``--help`` explains them: ``--preset``, ``--rate``, ``--set``, ``--out``, ``--resume`` and the others;
``--until`` or ``--history`` replace what the first push or cycle of the scene says.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import math
import os
import sys
import time
from typing import (
    Annotated,
    Any,
    Callable,
    Concatenate,
    Iterable,
    Iterator,
    ParamSpec,
    Protocol,
    Sequence,
    TypeVar,
    overload,
)

from .._masonry import loadScene, saveScene
from ..arguments import LONGEST_NAME, Direction, Level, Name, Numbers
from ..arguments import isA, listOf, number, oneOf, shown, text, validated
from .. import notebook
from ..assembly.blocks import vector
from ..assembly.structure import Structure
from ..basics import GRAVITY, Interrupted, Refused, say, withoutCollector
from ..bricks import Bricks
from ..run import accuracy, batch
from ..run.ending import end
from ..run.presets import BOUND
from ..run.results import Results
from ..run.run import Run
from . import (
    connections,
    contact,
    facts,
    loads,
    options,
    probing,
    records,
    showing,
    stages,
    supports,
)
from .bounds import EVERY, GIVEN_UP, SMALL, Bounds, nameInDomain, nameOfLean, nameOfPush
from .description import Description
from .ground import readRecord
from .materials import Masonry, linesOf, loadingBlock
from .outcome import Outcome
from .parsing import Parser
from .resuming import State
from .stages import AT_REST, STAGES, gravity, prepare
from .stages.answers import Answer
from .targets import Loaded, MovingPlaten, Target
from .words import RESULT, SHAKES, Call, Script


SOON = 1.0  # [s] in which a run that is interrupted waits for its bound
OWN = "0"  # the stage of the results of the script, which all stages follow


def finding(value: Any, first: Any = None) -> Any:
    """The kind of a number that was found, or None or what is not a number if it was not."""
    missing = value is None or isinstance(value, float) and math.isnan(value)
    return value if missing else number()(value)


P = ParamSpec("P")
Q = ParamSpec("Q")
R = TypeVar("R", covariant=True)


class _Either(Protocol[P, R, Q]):
    """What a script can call that takes one list of arguments before the first stage, and another one after it."""

    @overload
    def __call__(  # type: ignore[misc]  # both may be called without arguments, as far as mypy knows
        self, *args: P.args, **settings: P.kwargs
    ) -> R:
        ...

    @overload
    def __call__(self, *args: Q.args, **settings: Q.kwargs) -> str:
        ...


class _EitherWord(Protocol[P, R, Q]):
    """The same, of the class of a scene."""

    def __get__(self, scene: Any, cls: Any = None) -> _Either[P, R, Q]:
        ...


def _either(
    describes: Callable[Concatenate[Any, P], R],
    stage: Callable[Concatenate[Any, Q], str],
) -> _EitherWord[P, R, Q]:
    """A word that describes before the first stage, and is a stage after it."""

    @functools.wraps(describes)
    def either(scene: Any, *args: Any, **settings: Any) -> Any:
        word: Any = stage if scene.model else describes
        return word(scene, *args, **settings)

    either.__doc__ = (
        f"{describes.__doc__}\n\n    After the first stage: {stage.__doc__}"
    )
    return either


def ofFolder(value: Any, first: Any = None) -> str:
    """The kind of a name of a scene, which names a folder, too."""
    fine = isinstance(value, str) and value.strip(". ") and value.isprintable()
    if not fine or "/" in value or len(value.encode()) > LONGEST_NAME:
        raise ValueError(f"{shown(value)} must be a text that can name a folder")
    return value


def blocksOf(value: Any, first: Any = None) -> list[Any]:
    """The kind of the bricks of a scene."""
    try:
        found = list(value)
        found[0].corners[0][2]
    except Exception:  # of a class of the user's own
        raise ValueError(f"{shown(value)} must be a list of blocks, as masonry.bricks makes them") from None  # fmt: skip
    return found


class Scene:
    """A structure of bricks, how it is held and loaded, and the stages of its test; the module shows how to write one.

    It has a :class:`~masonry.scene.description.Description`; when its first stage begins it gets a
    :class:`~masonry.assembly.structure.Structure`, its ``model`` in YADE; and a :class:`~masonry.run.run.Run`, ``running``,
    takes the steps.

    :param name: of the folder of results, ``results/<name>``
    :param bricks: blocks: :class:`masonry.bricks.Bricks`, or anything that gives blocks with ``corners``, ``brick``,
        ``part`` and ``kind``
    :param materials: :class:`masonry.scene.materials.Masonry`
    :param title: of the figures; None: the name
    :param plane: whether blocks move in the x-z plane only, which is faster; None: if all bricks are one leaf in it
    :param gravity: [m/s²], downwards
    :param columns: names of the columns of curve.csv, beside the energies and the section at the base; None: all that there
        are
    :param functors: as of :func:`masonry.assembly.engines.engines`
    :param arguments: options as :func:`masonry.scene.options.parser` gives them, or a list of words; None: those of the
        command line
    :param allowGaps: whether bricks that nearly share a face stand apart on purpose, and have no joint
    :param collapse: what a run does when the structure falls: ``"end"``, there, or ``"follow"``. Then joints without bond whose
        blocks have slid by 2 % of the joint or turned by 1° become contacts during the whole run, a stage that ends in a
        collapse goes on until the rubble is at rest, and ``shake`` and ``run`` go on whatever falls. Rigid bricks only. The
        contact has stiffness and residual friction of the bed joint; ``--set contact.friction=0.7`` and the like change it.
        Blocks fall on the ground, a block that the scene adds below everything else
    :param usual: options of this scene, for example ``rate=50`` [mm/s] or ``dt_fraction=0.4``. They hold unless the command
        line, or the list of words, gives the same option; a note says so then
    :raises Refused: if something is wrong, with all problems at once. A script that does not catch it ends with exit
        status 2
    """

    present: Scene | None = None  # the scene that stands in YADE

    @validated
    def __init__(
        self,
        name: Annotated[str, ofFolder],
        bricks: Annotated[Iterable[Any], blocksOf],
        materials: Annotated[Masonry, isA(Masonry, "masonry.materials.Masonry")],
        title: str | None = None,
        plane: bool | None = None,
        gravity: Annotated[float, number("m/s²", 0, 1e6)] = GRAVITY,
        columns: Annotated[Sequence[str], listOf(text)] | None = None,
        functors: bool = False,
        arguments: Any = None,
        allowGaps: bool = False,
        collapse: Annotated[str, oneOf("end", "follow")] = "end",
        **usual: Any,
    ) -> None:
        #: what it was made with, its name first, for :meth:`resume`
        self._made = (name, bricks, materials, title, plane, gravity, columns, functors), dict(allowGaps=allowGaps, collapse=collapse)  # fmt: skip
        self.description = Description(
            name,
            bricks,
            materials,
            title,
            plane,
            gravity,
            columns,
            functors,
            allowGaps=allowGaps,
            collapse=collapse,
        )
        arguments = options.ofScene(name, arguments, usual)
        self.name, self.args = name, arguments
        #: what --accuracy found, :class:`masonry.run.accuracy.Asked`, or None
        self.accuracy = self._askAccuracy()
        if arguments.crack_surfaces == "off":
            self.description.bricks = list(Bricks(self.description.bricks).whole())
        self.description.deformable = arguments.blocks == "deformable"
        self.script = Script()
        self.calls = []  # every word that was said
        self.staging = False  # whether a stage is being carried out
        self.bracketing = (
            False  # whether bracket() looks for a load, so that no collapse is followed
        )
        self.running = Run(name, arguments, self.script.words)
        # when it is built
        self.model: Any = None
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

    def _askAccuracy(self):
        """As :func:`masonry.run.accuracy.ask`. Ends the script in order where there is no answer."""
        parser, found = Parser.last
        fromLine = found is self.args and sys.argv and os.path.isfile(sys.argv[0])
        try:
            return accuracy.ask(
                self.name, self.args, sys.argv[0] if fromLine else None, sys.argv[1:]
            )
        except Refused as refused:
            if notebook.isHere():
                raise
            say(refused, sys.stderr)
            raise SystemExit(2) from None
        except Interrupted:
            say("interrupted: the runs that are over are kept, and the same command goes on")  # fmt: skip
            raise SystemExit(130) from None

    # -- what describes it ----------------------------------------------------------------------------------------

    platen, watch, handle = supports.platen, supports.watch, supports.handle
    drift, column = records.drift, records.column
    joint, section, view = records.joint, records.section, records.view
    tie, spring = connections.tie, connections.spring
    ground = contact.ground
    overlay = connections.overlay
    # Their names are those of stages, too, which are meant after the first stage.
    hold = _either(supports.hold, stages.hold)
    press = _either(loads.press, stages.press)
    load = _either(loads.load, stages.load)
    wind = _either(loads.wind, stages.wind)

    @property
    def targets(self) -> dict[str, Target]:
        """Platens and bricks that are held, loaded or watched, by their names."""
        return self.description.targets

    # -- how it goes ----------------------------------------------------------------------------------------------

    settle, release, move = stages.settle, stages.release, stages.move
    push, cycle, follow = stages.push, stages.cycle, stages.follow
    drive, pressJoint = stages.drive, stages.pressJoint
    tilt, accelerate, lean = stages.tilt, stages.accelerate, stages.lean
    growLoad, growWind = stages.growLoad, stages.growWind
    growPress, shake, run = stages.growPress, stages.shake, stages.run
    bracket = gravity.bracket

    curve = showing.curve

    def _repr_html_(self) -> str:
        """The scene in a notebook: what is built before the first stage, else cracks, curve and results."""
        return showing.asHtml(self)

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
        """What the stages were run for, in their order: a list of dicts, as of
        :class:`masonry.scene.stages.answers.Answer`, with the ``stage`` and its ``number``.
        """
        kept, entered = self.running.at.answers, self.running.entered
        numbers = [number for number in sorted(kept, key=int) if int(number) <= entered]
        return [one for number in numbers for one in kept[number]]

    @validated
    def result(
        self,
        name: Name,
        value: Annotated[float | None, finding],
        unit: str = "-",
        how: str = "the script found it",
    ) -> None:
        """Keep a number of one's own with the answers of the stages: in run.json, on the terminal and as a column of study.csv.

        :param name: letters, digits and underscores; another result of this name is replaced
        :param value: a number; None, or what is not a number, if it was not found
        :param unit: ``"-"`` if it has none
        :param how: how it was found, a sentence
        :raises ValueError: with all problems
        """
        if not self.model:
            raise ValueError(f"result {name}: it comes after the first stage")
        self.calls.append(Call(Scene.result, (name, value, unit, how), {}))
        at, before = self.running.at, self.running.scriptBefore
        later = [word for word, _ in before[len(self.script.words) + 1 :]]
        if self._saidBefore(RESULT, name=name) and any(w != RESULT for w in later):
            return  # it was found in the state of that time
        value = None if value is None or math.isnan(value) else float(value)
        kept = [one for one in at.answers.get(OWN, []) if one["name"] != name]
        answer = {
            "stage": "script",
            "number": 0,
            **vars(Answer(name, unit, value, how)),
        }
        at.answers = {**at.answers, OWN: [*kept, answer]}

    @property
    def factor(self) -> float:
        """The largest load factor under which the structure came to rest in the last stage that found one, for example the
        horizontal over the vertical acceleration of :meth:`accelerate` [-]; not a number if no stage has found one.
        """
        found = [a["value"] for a in self.answers if a["name"] == "factor_held"]
        return next((value for value in reversed(found) if value is not None), math.nan)

    def checkOpen(self, name: str) -> None:
        """Refuse a stage of a scene that is finished, or gone because another one was built. Raises ValueError."""
        if self.finished:
            raise ValueError(f"{name}: the scene is finished")
        if self.model and self.isGone:
            raise ValueError(
                f"{name}: scene {self.name} is gone, because another one was built since; finish one scene before "
                "the next begins"
            )

    @functools.cached_property
    def masonry(self) -> Masonry:
        """The materials for the options of this run: :class:`masonry.scene.materials.Masonry`. Raises Refused."""
        connectors = self.description.settable()
        masonry = self.description.materials.variant(self.args, [*connectors])
        problems = self.description.problems(masonry)
        if self.args.points and self.description.functors:
            problems.append(f"--points {self.args.points}: with functors joints keep three points; leave functors=False")  # fmt: skip
        problems += self._wrongRecord()
        if self.description.contact:
            problems += contact.problems(self.description, self.args)
        options.check(self.args, masonry, problems, self.description.plane, connectors)
        self.assumed = masonry.assumed()
        return masonry

    def _wrongRecord(self):
        """What is wrong with the record of ``--record``, a list: it is read before anything is built."""
        if self.args.record is None:
            return []
        try:
            readRecord(batch.beside(self.args.record), None, self.args.scale)
        except Refused as refused:
            return [f"--record: {str(refused).removeprefix('shake: ')}"]
        return []

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
        self.columns = description.columns(model, bool(args.history))
        self.model = model
        self.running.open(self.columns, facts.properties(description, self.masonry))
        self.bounds = Bounds(model, self.running.at)
        self.running.takeFound = self._takeFound
        self.outcome = Outcome(self)
        with self.running.clock("setup"), self.running.breakable(), withoutCollector():
            model.build(loadingBlock())
            self._prepare()
        self._noteCourse()
        self.running.start(model, self.outcome.space(), State(self))
        Scene.present = self
        atexit.unregister(self._remind)  # of a run that goes on
        atexit.register(self._remind)

    def _noteCourse(self):
        """Say that the bricks are not those for which the stiffness of the joints was made."""
        course, bricks = self.description.materials.course, self.description.bricks
        heights = {max(p[2] for p in b.corners) - min(p[2] for p in b.corners) for b in bricks}  # fmt: skip
        if course and not any(abs(h - course) < 0.01 * course for h in heights):
            found = ", ".join(f"{1e3 * h:.4g}" for h in sorted(heights)[:5])
            say(
                f"note: the joints are for courses of {1e3 * course:.4g} mm, mortar included, and the bricks have {found} mm: "
                "give bricks the same unit= and joint= as the materials"
            )

    def _prepare(self):
        """Make the engines that stages had made before the checkpoint of a run that is resumed."""
        names, begun = {stage.__name__ for stage in STAGES}, False
        for word, said in self.running.scriptBefore:
            begun = begun or word in names
            if begun:
                prepare(self, word, said)

    def probe(self, stage: str, traits: Any, arguments: Any) -> Any:
        """Say what a study must know of the scene, and end; see :func:`masonry.scene.probing.probe`."""
        return probing.probe(self, stage, traits, arguments)

    def keepState(self, ended: str) -> str:
        """Keep the state of a structure that is at rest for :meth:`stepBack`. Returns how the stage ended."""
        if ended == AT_REST:
            self.model.atRest = saveScene("null")
            self.model.motion.restart()
        return ended

    def stepBack(self) -> None:
        """Take the scene back to its last state at rest, also after a collapse. The load that was held then acts again, also the
        one that a growth or a bracket has found. Rows of curve.csv stay."""
        with self.noted(Scene.stepBack):
            self._stepBack()

    def _stepBack(self):
        """As :meth:`stepBack`."""
        if self.only:
            return
        known = self.model is not None and self.model.atRest is not None
        before, at = self.running.scriptBefore, len(self.script.words)
        if self.running.takesUp and at < len(before):  # it had none yet
            known = before[at][1].get("known", known)
        said = self._saidBefore("stepBack", known=known)
        if not known:
            raise ValueError(
                "stepBack: the scene has not been at rest in this run of the script"
            )
        self.running.collapsed, self.ended = False, AT_REST
        self.results.run.pop("collapse", None)
        if said:
            return
        loadScene(self.model.atRest)
        self.running.mark()
        self.model.motion.restart()

    def _saidBefore(self, word, **said):
        """Note a word that is no stage. Returns whether the script of a run that is resumed said it before the checkpoint."""
        self.script.add(word, said)
        if not self.running.takesUp:
            return False
        self.script.compare(self.running.scriptBefore)
        return len(self.script.words) <= len(self.running.scriptBefore)

    @validated
    def bound(
        self,
        target: Loaded | None = None,
        direction: Direction = (1, 0, 0),
        towards: Level | None = None,
    ) -> Any:
        """Limit analysis of the scene as it stands, with a collapse without dilatancy: see :mod:`masonry.limit`.

        Stages that push or lean find their bound by themselves, if there are at most 3000 joints; this is for other
        loads, and for larger structures.

        :param target: what is pushed, as of :meth:`push`, along ``direction``; its factor is the force of the push [kN]
        :param towards: horizontal direction of an acceleration, whose factor is in g; give this or ``target``
        :returns: the entry of run.json: a dict with ``factor``, ``exact`` and the others that :mod:`masonry.run.results`
            lists
        """
        if (target is None) == (towards is None):
            raise ValueError("bound: give either target or towards")
        try:
            with self.noted(Scene.bound, target, direction, towards), self.running.listening():  # fmt: skip
                return self._bound(target, direction, towards)
        except Interrupted as error:
            return self.failed(error)

    def _bound(self, target, direction, towards):
        """As :meth:`bound`."""
        self.begin()
        self.bounds.take(True)
        if self.collapsed:
            raise ValueError(
                "bound: the structure has fallen; stepBack() goes back to its last state at rest"
            )
        before = self._saidBefore("bound", target=getattr(target, "name", ""))
        if target is not None:
            direction = vector(direction, "bound: direction").normalized()
            known = self.bounds.entries.get(nameOfPush(target, direction))
            if before and known:
                return known
            return self._find("push", target, direction, lowerUpTo=EVERY)
        towards = gravity.sideways(self, towards, "bound")
        known = self.bounds.entries.get(nameOfLean(towards))
        if before and known:
            return known
        return self._find("lean", towards, lowerUpTo=EVERY)

    @validated
    def domain(
        self,
        target: MovingPlaten,
        normal: Annotated[Numbers, listOf(number("kN", 0, 1e9, above=True))],
        direction: Level = (1, 0, 0),
    ) -> list[dict[str, Any]]:
        """The N-V domain of a pier: limit analysis of a push under several normal forces, as :meth:`bound` for one.

        The loads of the scene stay as they are; only for limit analysis the vertical force on the platen is replaced. So it says
        nothing new where the platen is held along z. :func:`masonry.capacity.domain` reads what was found, and
        ``/usr/bin/python3 -m masonry.capacity --domain`` draws it, with the peaks of runs as points.

        :param target: a platen that is pushed, with a :meth:`press` that says where the normal force acts
        :param normal: forces with which the platen presses on what is below, its weight included: a list [kN]
        :param direction: of the push, horizontal
        :returns: the entries of run.json: a list of dicts as of :meth:`bound`, with ``pressed_kN``, the force that was given, and
            ``normal_kN``, the force at the supports, with the weight of what is above them
        :raises ValueError: if the platen is not pressed, or is held along z
        """
        try:
            with self.noted(Scene.domain, target, normal, direction), self.running.listening():  # fmt: skip
                return self._domain(target, normal, direction)
        except Interrupted as error:
            return self.failed(error)

    def _domain(self, target, normal, direction):
        """As :meth:`domain`."""
        if target.pressed is None:
            raise ValueError(f"domain: {target.name} is not pressed: press({target.name}, ...) before the first stage says where the normal force acts")  # fmt: skip
        self.begin()
        self.bounds.take(True)
        if "z" in (target.freedom or "") or self.model.loading.isDriven(target, "z"):
            raise ValueError(f"domain: {target.name} is held along z, so its normal force is no load that could be replaced")  # fmt: skip
        if self.collapsed:
            raise ValueError(
                "domain: the structure has fallen; stepBack() goes back to its last state at rest"
            )
        before = self._saidBefore("domain", target=target.name, normal=list(normal))
        direction = vector(direction, "domain: direction").normalized()
        names = [nameInDomain(target, direction, one) for one in normal]
        known = [self.bounds.entries.get(name) for name in names]
        if before and all(known):
            return known
        return self._find("domain", target, normal, direction, lowerUpTo=SMALL)

    def _find(self, kind, *load, lowerUpTo, beside=False):
        """Find a bound, which Ctrl-C and SIGTERM end at once: a method of :class:`masonry.scene.bounds.Bounds`."""
        with self.running.breakable():
            return getattr(self.bounds, kind)(*load, lowerUpTo=lowerUpTo, beside=beside)

    def _takeFound(self, wait):
        """Take the bound that is found beside the run; a run that is interrupted does not wait long for it."""
        began, running = time.monotonic(), self.running
        late = lambda: running.interrupted and time.monotonic() - began > SOON
        self.bounds.take(wait, late)
        if not (running.interrupted or self.args.lean):
            with contextlib.suppress(OSError):  # it is said when figures are drawn
                self.outcome.prepare()

    def findBound(self, kind: str, *load: Any) -> None:
        """Find the bound of a stage, which pushes or leans, as :meth:`_find`."""
        resumed = self.running.redoes and self.running.takesUp
        missing = any(e.get("note") == GIVEN_UP for e in self.bounds.entries.values())
        if self.args.lean and not self.only or resumed and not missing:
            return  # in a stage that goes on it was found when that began
        upTo = SMALL if self.only else 0
        self._find(kind, *load, lowerUpTo=upTo, beside=not self.only)

    # -- the end --------------------------------------------------------------------------------------------------

    def finish(self) -> None:
        """End the run: the last frame, run.json, the figures. A run that was not in order exits with its status."""
        if probing.asked() and self.model:
            probing.probe(self, "finish", None, {})
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
        if not (error or self.only or any(word in SHAKES for word, _ in self.script.words)):  # fmt: skip
            given = [o for o, usual in (("record", None), ("scale", 1)) if getattr(self.args, o, usual) != usual]  # fmt: skip
            for option in given:
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
    def noted(
        self, word: Callable[..., Any], *args: Any, **settings: Any
    ) -> Iterator[None]:
        """Note a word that is carried out in a block, for :meth:`resume`: also one that is refused, but ends no run."""
        call = Call(word, args, settings)
        self.calls.append(call)
        try:
            yield
        except ValueError:
            call.refused = not self.finished
            raise

    def resume(self) -> str:
        """Go on with a run that was interrupted, as from a following cell of a notebook: the stage that was interrupted is carried
        out to its end, from the checkpoint that the interruption left.

        Every word of the scene is said again, as ``--resume`` of a script does it, so the result is the same to the last bit.
        Of a search that the script makes by itself or by :meth:`bracket`, this is the step that was interrupted.

        :returns: how that stage ended
        :raises ValueError: if the scene was not interrupted, or left no checkpoint
        """
        if not (self.finished and self.running.kept):
            raise ValueError(
                f"resume: scene {self.name} has no run that was interrupted and left a checkpoint"
            )
        folder, calls, given = self.results.directory, self.calls, self.args
        (name, *made), beside = self._made
        arguments = given.parser.parse_args(["--resume", folder])
        vars(self).clear()
        self.__init__(name, *made, arguments, **beside)  # type: ignore[misc]
        ended = None
        for call in calls:
            with contextlib.suppress(*[ValueError] * call.refused):
                ended = call.word(self, *call.args, **call.settings)
            if (
                call.found is not None
            ):  # the script knows the record that it gave before
                self.description.replace(ended, call.found)
        return ended

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
                f"note: {self.name}: the script ended without scene.finish(); there is no run.json, and no figure"
            )
