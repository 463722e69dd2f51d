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

What comes before the first stage describes: platens, supports, loads, what is recorded (:mod:`masonry.scene.description`). Stages
run in turn: ``settle``, ``push``, ``cycle``, ``follow``, ``drive``, ``pressJoint``, ``release``, ``move``, ``tilt``,
``accelerate``, ``lean``, ``shake``, ``run``. Each returns how it ended: one of :data:`AT_REST`, :data:`MOVING`,
:data:`DONE` and :data:`COLLAPSED`. After a collapse the stages that follow are left out.
``finish`` writes what :mod:`masonry.run.results` lists. All options of the command line work, ``--help`` explains them:
``--preset``, ``--rate``, ``--set``, ``--out``, ``--resume`` and the others; ``--until`` or ``--history`` replace what the
first push or cycle of the scene says.
"""

import atexit
import functools
import math
import os
import sys
from dataclasses import dataclass
from types import SimpleNamespace

from yade import O, Vector3

from ..run import batch
from . import history, loading, options
from .._masonry import loadScene, saveScene
from .bounds import EVERY, SMALL
from ..bricks import Bricks
from .description import Described, JointRecord, Target
from ..basics import Collapsed, GRAVITY, Interrupted, Refused, say
from .ground import readRecord
from ..run.presets import BOUND
from .probing import probe
from ..run.run import Run
from ..assembly.blocks import vector
from .structure import Structure

AT_REST, MOVING, DONE, COLLAPSED = "at rest", "moving", "done", "collapsed"

LEAN_GROWS = 0.2  # [s] in which a lean grows
LEANING = 4.0  # [s] after which a lean is given up
ROWS = 500  # of curve.csv in a stage that is no push
FRAMES = 20  # for ParaView in such a stage
SETTLING = 0.5  # most local damping of deformable units in settle(): with more they creep to rest
#: Two velocities over that of a block that has fallen, the second four times the first: see _leftRest.
SLOW = 1 / 36, 1 / 9
#: Stages of which --preset bound finds the bound.
BOUNDED = ("settle", "push", "cycle", "follow", "lean", "tilt", "accelerate")
#: Stages that may go farther when a run is resumed.
LONGER = ("push", "cycle", "follow", "move", "run")


def _stage(act):
    """A stage: builds the scene if it is the first, is left out after a collapse, and ends the run in order on errors."""

    @functools.wraps(act)
    def staged(self, *args, **settings):
        if self.finished:
            raise ValueError(f"{act.__name__}: the scene is finished")
        if self.model and Scene.present is not self:
            raise ValueError(
                f"{act.__name__}: scene {self.name} is gone, because another one was built since; finish one scene before "
                "the next begins"
            )
        loaded = [t.name for t in self.targets.values() if t.pressed or t.force]
        loaded += ["the faces (wind)"] * bool(self.winds)
        if not self.model and loaded and act.__name__ != "settle":
            raise ValueError(
                f"{act.__name__}: the loads on {', '.join(loaded)} grow in settle(): call that first"
            )
        try:
            self._begin()
            if batch.PROBE in os.environ:
                return probe(self, act.__name__, settings)
            self._say(act.__name__, args, settings)
            if not self._goesOn:
                self._compare()
            if self.collapsed:
                return COLLAPSED
            if self.only and act.__name__ not in BOUNDED:
                say(f"note: --preset bound: no run, {act.__name__} is left out")
                return DONE
            return act(self, *args, **settings)
        except Collapsed as collapse:
            self.ended = COLLAPSED
            self.fall(str(collapse))
            try:
                if self._recordedAt() != O.time:
                    self.record()
                self.flush()
            except FloatingPointError:
                pass  # what has fallen may have left finite numbers
            return COLLAPSED
        except BaseException as error:
            return self._failed(error)

    return staged


class Scene(Described, Run):
    """A structure of bricks, how it is held and loaded, and the stages of its test; the module shows how to write one.

    :param name: of the folder of results, ``results/<name>``
    :param bricks: blocks: :class:`masonry.bricks.Bricks`, or anything that gives blocks with ``corners``, ``brick``,
        ``part`` and ``kind``
    :param materials: :class:`masonry.scene.materials.Masonry`
    :param title: of the figures; None: the name
    :param plane: whether blocks move in the x-z plane only, which is faster; None: if all bricks are one leaf in it
    :param gravity: [m/s²], downwards
    :param columns: names of the columns of curve.csv, beside the energies; None: all that there are
    :param functors: as of :func:`masonry.assembly.blocks.engines`
    :param arguments: options as :func:`masonry.scene.options.parser` gives them, or a list of words; None: those of the
        command line
    :param usual: options whose default is another one in this scene, for example ``rate=50`` [mm/s] or ``dt_fraction=0.4``
    :raises Refused: if something is wrong, with all problems at once. A script that does not catch it ends with exit
        status 2
    """

    present = None  # the scene that stands in YADE

    def __init__(
        self,
        name,
        bricks,
        materials,
        title=None,
        plane=None,
        gravity=GRAVITY,
        columns=None,
        functors=False,
        arguments=None,
        **usual,
    ):
        if not isinstance(name, str) or not name.strip(".") or "/" in name:
            raise Refused(
                f"scene: name must be a text that can name a folder, got {name!r}"
            )
        self.describe(name, bricks, materials, title, plane, gravity, columns)
        if arguments is None or isinstance(arguments, (list, tuple)):
            told = sys.modules.get("__main__")
            parser = options.parser(getattr(told, "__doc__", None), until=None)
            known = {action.dest for action in parser._actions}
            if set(usual) - known:
                raise Refused(
                    f"scene {name}: no option {', '.join(sorted(set(usual) - known))}; there are {', '.join(sorted(known))}"
                )
            parser.set_defaults(**usual)
            arguments = parser.parse_args(arguments)
            for option, value in usual.items():
                if arguments.preset and getattr(arguments, option) != value:
                    say(
                        f"note: --preset {arguments.preset}: {option} is {getattr(arguments, option)}, the scene has {value}"
                    )
        super().__init__(name, arguments)
        if arguments.crack_surfaces == "off":
            self.bricks = list(Bricks(self.bricks).whole())
        self.functors = functors
        self.finished = False
        #: of displacements and times [-]
        self.share = 0.1 if arguments.quick else 1.0
        #: horizontal over vertical acceleration [-]: at the end of the last tilt(), accelerate() or lean(), or, if the
        #: structure fell in tilt() or accelerate(), that at which it left rest
        self.factor = 0.0
        self.replaced = False  # whether --until or --history have been used
        self.ended = None
        self._kept = None  # the last state at rest
        #: largest horizontal over vertical acceleration under which it was at rest [-]
        self.stood = 0.0
        #: whether there is no run, but limit analysis alone
        self.only = arguments.preset == BOUND
        self._grown = False  # whether presses and dead loads have their whole
        self._entered_with = False

    # -- running --------------------------------------------------------------------------------------------------

    def __enter__(self):
        self._entered_with = True
        return self

    def __exit__(self, kind, error, trace):
        if self.finished:
            return False
        self.finished = True
        if not error and not self.model:
            return False
        done = super().__exit__(kind, error, trace)
        if self.status and (done or not error):
            raise SystemExit(self.status)
        return done

    def finish(self):
        """End the run: the last frame, run.json, the figures. A run that was not in order exits with its status."""
        if batch.PROBE in os.environ and self.model:
            probe(self, "finish", {})
        if not (self.finished or self._entered_with):
            self.__exit__(None, None, None)

    def _failed(self, error):
        """End in order after an error of a stage. In a ``with`` block that does it."""
        if isinstance(error, Interrupted):
            self.ended = "interrupted"
        if self._entered_with:
            raise error
        if not self.__exit__(type(error), error, error.__traceback__):
            raise error

    def _recordedAt(self):
        """Time of the last reading [s], or None."""
        if self._readings:
            return self._readings[-1].time
        rows = self.results.rows
        return rows[-1][0] if rows else None

    def _begin(self):
        if not self.model:
            self.build(Structure(self))
            Scene.present = self
            atexit.register(self._remind)

    def _say(self, name, args, settings):
        """Note a word of the script."""
        named = (Target, JointRecord)
        told = lambda v: v.name if isinstance(v, named) else "f" if callable(v) else v
        words = [
            name,
            [told(v) for v in args],
            {k: told(v) for k, v in settings.items()},
        ]
        self.script.append(repr(words))

    def _compare(self):
        """Refuse a script that says something else than that of the run that is resumed, up to its checkpoint, but for how
        far the stage goes in which that was made."""
        known = (self._told or {}).get("script", [])
        for at, (was, now) in enumerate(zip(known, self.script)):
            name = was.split("'")[1]
            last = (
                at == len(known) - 1 and name in LONGER and now.startswith(f"['{name}'")
            )
            if was != now and not last:
                raise Refused(
                    f"--resume: a run goes on as it began: the script said {was}, now it says {now}"
                )

    def _remind(self):
        if not self.finished:
            say(
                f"note: {self.name}: the script ended without scene.finish(); there is no run.json, and no figure"
            )

    # -- stages ---------------------------------------------------------------------------------------------------

    @_stage
    def settle(self, longest=None, damping=None, record=True):
        """Let gravity, presses and dead loads act until the structure is at rest.

        At rest the supports carry what is above them but for half a per cent, and hardly anything moves. Presses and dead
        loads grow when it is called first; they stay when it is called again, for example after :meth:`release`.

        :param longest: time in the scene after which it is given up [s]; None: 0.4 s, and longer for tall structures
        :param damping: kind of damping in this stage, ``"local"`` or ``"combined"``; None: that of the options. Local
            damping, of 0.5 at most in deformable units, takes the vibrations out sooner, and holds a mechanism back
        :param record: whether its end is a row of curve.csv
        :returns: :data:`AT_REST`; :data:`MOVING` if it is not at rest by then; :data:`COLLAPSED`
        """
        if damping not in (None, "local", "combined"):
            raise ValueError(
                f"settle: damping must be 'local' or 'combined', got {damping!r}"
            )
        if self.only:
            self.ended = AT_REST
            return AT_REST
        model, args = self.model, self.args
        grow, self._grown = (lambda x: None) if self._grown else model.grow, True
        memory = self.stage("settle", _Resting())
        if memory is None:
            return self._keep(AT_REST)
        if damping:
            most = SETTLING if model.zones and damping == "local" else 1.0
            model.damp(min(most, args.damping), damping)
        ended = self._rest(memory, longest, grow, record=record)
        if damping:
            model.damp(args.damping, args.damping_kind)
        return ended

    def _rest(self, at, longest, grow, over=0.0, record=True):
        """Let something grow, then wait until the structure is at rest.

        :param grow: function of how much of the time in which it grows is over, 0 to 1 [-]
        :param over: time in which it grows at least [s]
        """
        model, ramp = self.model, loading.ramp(self.args)
        ramp *= max(1.0, (self.high[2] - self.low[2]) / 3)
        ramp = max(ramp, over)
        every = 100
        growing = max(1, int(ramp / O.dt))
        most = int((longest or 20 * ramp) / O.dt)
        while at.done < most and at.quiet < 3:
            load = min(1.0, (at.done + every) / growing)
            grow(load)
            self.advance(every)
            at.load, at.done = load, at.done + every
            missing, moving = model.unrest()
            rests = abs(missing) < loading.REST and moving < 1e-5
            rests = rests and at.done > (1.2 if over else 1.1) * growing
            at.quiet = at.quiet + 1 if rests else 0
            if load == 1:
                model.tellFall()
                if model.target and model.hasSunk():
                    raise Collapsed("the platen has come down by half a course")
            self.show(
                at.done / most,
                lambda: f"unbalanced {100 * missing:+.2f} %, kinetic/elastic {moving:.1e}",
                at.quiet == 3 or at.done >= most,
            )
        if at.quiet < 3:
            say(
                f"note: the structure is not at rest after {at.done * O.dt:.2f} s: {100 * missing:.2f} % of the load is "
                f"missing at the supports, kinetic over elastic energy is {moving:.1e}"
            )
        self.ended = AT_REST if at.quiet == 3 else MOVING
        if record:
            self.record()
        self.flush()
        return self._keep(self.ended)

    def _keep(self, ended):
        if ended == AT_REST and (self._goesOn or not self._told):
            self._kept = saveScene("null")
        return ended

    def stepBack(self):
        """Take the scene back to its last state at rest, also after a collapse. Rows of curve.csv stay."""
        if self.only:
            return
        if self._kept is None:
            raise ValueError(
                "stepBack: the scene has not been at rest in this run of the script"
            )
        loadScene(self._kept)
        self.collapsed, self.ended = False, AT_REST
        self.results.run.pop("collapse", None)
        self.model.rearm()

    @_stage
    def push(self, target, until=None, direction=(1, 0, 0), rate=None, goOn=False):
        """Push a target at a constant velocity, as the drive of a testing machine does.

        :param target: a platen that moves, or a :meth:`handle`
        :param until: displacement from where the push begins [mm]; the drive then stops and holds. ``--until`` and
            ``--history`` replace it; None: one of these must be given
        :param direction: of the push
        :param rate: [mm/s]; None: ``--rate``
        :param goOn: whether displacements count on from where the push before began, of this target in this direction, and
            not from where the target is now
        """
        if isinstance(until, (int, float)):
            until *= self.share
        return self._drive("push", target, dict(until=until), direction, rate, goOn)

    @_stage
    def cycle(
        self, target, amplitudes, repeats=1, direction=(1, 0, 0), rate=None, goOn=False
    ):
        """Push a target to and fro: each amplitude A is a cycle from 0 to +A, to -A and back to 0.

        :param amplitudes: [mm], a list
        :param repeats: how often each of them
        :param goOn: as of :meth:`push`
        """
        text = ",".join(f"{self.share * a:g}x{repeats}" for a in amplitudes)
        return self._drive("cycle", target, dict(history=text), direction, rate, goOn)

    @_stage
    def follow(self, target, path, direction=(1, 0, 0), rate=None, goOn=False):
        """Push a target through the displacements of a CSV file, which has a column ``displacement_mm``.

        :param goOn: as of :meth:`push`
        """
        return self._drive(
            "follow", target, dict(history=str(path)), direction, rate, goOn
        )

    def _drive(self, name, target, aims, direction, rate, goOn):
        if not isinstance(target, Target) or not target.loaded:
            raise ValueError(
                f"{name}: only a platen that moves or a handle() can be pushed"
            )
        args = SimpleNamespace(**vars(self.args))
        own = bool(args.until or args.history) and not self.replaced
        self.replaced = True
        if own and args.until:
            args.until *= self.share
        if not own:
            args.until, args.history = aims.get("until"), None
            if "history" in aims:
                try:
                    args.history = history.parse(aims["history"])
                except ValueError as error:
                    raise Refused(f"{name}: {error}") from None
            elif not (
                isinstance(args.until, (int, float)) and 0 < args.until <= history.MOST
            ):
                raise Refused(
                    f"{name}: until {args.until!r} must be above 0 and at most {history.MOST:g} mm; the direction says "
                    "where to"
                )
        args.rate = args.rate if rate is None else _rate(rate, name)
        model = self.model
        way = vector(direction, f"{name}: direction").normalized()
        model.pushTo(target, way, name)
        model.pushed = args
        began = f"{target.name} {[round(v, 9) for v in way]}"
        if goOn and began not in self.at.origins:
            raise ValueError(
                f"{name}: goOn: {target.name} has not been pushed along {tuple(way)} before"
            )
        self._findBound("push", way, bool(args.history))
        if self.only:
            self.ended = DONE
            return DONE
        loading.push(self, model, name, args, began, goOn)
        model.loads["push"].velocity = 0
        self.ended = DONE
        return DONE

    @_stage
    def drive(self, target, x=0.0, y=0.0, z=0.0):
        """Drive a target along an axis at ``--rate`` from the first step on, for example two bricks and their joint.

        The rows of curve.csv are closer together at the beginning, where the peaks are. The drives of other axes hold
        what they hold.

        :param x: displacement along x [mm], and likewise ``y`` and ``z``: one of them. It may be a function without
            arguments that gives it when the stage begins
        """
        ways = {
            axis: way for axis, way in zip("xyz", (x, y, z)) if callable(way) or way
        }
        if (
            not isinstance(target, Target)
            or len(ways) != 1
            or [*ways][0] not in target.drives
        ):
            raise ValueError(
                f"drive: give one displacement other than 0, along an axis that has a drive; {_drivesOf(target)}"
            )
        ((axis, way),) = ways.items()
        return self._driveBy(target, axis, lambda: 1e-3 * self.share * _called(way))

    def _driveBy(self, target, axis, distance):
        """Drive a target along an axis by a distance that a function gives [m]."""
        loading.drive(
            self, self.model.loads[f"{target.name}_drive_{axis}"], axis, distance
        )
        self.ended = DONE
        return DONE

    def pressJoint(self, target, joint, stress):
        """Bring a bed joint to a mean normal stress by a drive along z, then hold that by its force: nothing swings.

        :param target: a platen with a drive along z, above bricks on one column
        :param joint: as :meth:`joint` gave it
        :param stress: [Pa], negative if it presses; one that crushes the joint is refused
        """
        if not isinstance(target, Target) or "z" not in target.drives:
            raise ValueError(f"pressJoint: needs a drive along z; {_drivesOf(target)}")
        joints = self.materials.variant(self.args).joints
        options.applySettings(joints, self.args.set)
        bed = joints["bed"]
        if bed.cap and not bed.elastic and -stress >= bed.compressiveStrength:
            told = (
                f"pressJoint: {1e-6 * stress:g} MPa crushes the bed joint, whose compressive strength is "
                f"{1e-6 * bed.compressiveStrength:g} MPa"
            )
            return self._failed(Refused(told))
        return self._pressJoint(target, joint, stress)

    @_stage
    def _pressJoint(self, target, joint, stress):
        way = stress / joint.normalStiffness
        self._driveBy(target, "z", lambda: way)
        if stress:
            # other joints and deformable bricks have taken their part of the way
            rest = lambda: way * (stress / joint.normalStress() - 1)
            self._driveBy(target, "z", rest)
        return self._release(target, "z", (0, 0, stress * joint.area))

    @_stage
    def release(self, target, axes, force=None):
        """Take a support away, or let the drive of a platen go. What follows is the next stage's, for example ``settle``.

        :param target: a brick or platen that is held, or a platen with a drive
        :param axes: along which it becomes free, some of xyz, and about which, XYZ
        :param force: three numbers [N] of a load that stays in place of a drive; None: none
        """
        return self._release(target, axes, force)

    def _release(self, target, axes, force):
        problems, model = [], self.model
        if not isinstance(target, Target):
            raise ValueError(f"release: not a target: {target!r}")
        state = O.bodies[target.body].state
        if self.plane:  # nothing moves along the others
            axes = "".join(a for a in axes if a in "xzY") or axes
        for axis in axes:
            drive = model.driveOf(target, axis)
            if drive:
                drive.driven, drive.velocity = False, 0
                drive.force = vector(force or (0, 0, 0), "release: force [N]")
            elif axis in state.blockedDOFs and (axis in "xzY" or not self.plane):
                state.blockedDOFs = state.blockedDOFs.replace(axis, "")
            else:
                problems.append(f"release: {target.name} is not held along {axis}")
        if force is not None and not any(model.driveOf(target, a) for a in axes):
            problems.append("release: only in place of a drive a force can stay")
        if problems:
            raise ValueError("\n".join(problems))
        return DONE

    @_stage
    def move(self, target, x=0.0, y=0.0, z=0.0, rate=None):
        """Move a fixed target by a displacement [mm], in a straight line: settlement or spreading of a support.

        It starts and stops smoothly.

        :param rate: [mm/s]; None: ``--rate``
        """
        return self._prescribe("move", target, (x, y, z), rate)

    def _prescribe(self, name, target, way, rate):
        if not isinstance(target, Target) or not target.fixed:
            raise ValueError(
                f"{name}: only a platen or brick that is held can be moved"
            )
        at = self.stage(name, _Timed())
        way = self.share * vector(way, f"{name}: displacement [mm]")
        if at is None:
            return DONE
        if self.plane and way[1]:
            raise ValueError(
                f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
            )
        loose = [a for a, w in zip("xyz", way) if w and a not in target.freedom]
        if loose:
            raise ValueError(
                f"{name}: {target.name} is not held along {', '.join(loose)}"
            )
        rate = self.args.rate if rate is None else _rate(rate, name)
        distance, rate = 1e-3 * way.norm(), 1e-3 * rate
        if not distance > 0:
            raise ValueError(f"{name}: the displacement must not be zero")
        ramp = min(loading.ramp(self.args), distance / rate)
        duration = distance / rate + ramp

        def place(time):  # along the way [m], with velocity that grows evenly
            if time < ramp:
                return rate * time * time / (2 * ramp)
            if time > duration - ramp:
                return distance - rate * max(0.0, duration - time) ** 2 / (2 * ramp)
            return rate * (time - ramp / 2)

        state, along = O.bodies[target.body].state, way.normalized()

        def before(done, beyond):
            began, ends = done * O.dt, min(duration, beyond * O.dt)
            speed = (place(ends) - place(min(began, duration))) / (
                (beyond - done) * O.dt
            )
            state.vel = speed * along

        self._timed(at, duration, before)
        self.at.supportsMoved = True
        state.vel = Vector3.Zero
        return DONE

    @_stage
    def tilt(self, degrees, towards=(1, 0, 0), rate=1.0):
        """Tilt the ground, and with it gravity, until the structure falls or the angle is reached.

        :param towards: horizontal direction in which the structure leans
        :param rate: [degrees/s]
        :returns: :data:`COLLAPSED` or :data:`DONE`; ``scene.factor`` is the horizontal over the vertical acceleration at
            which the structure left rest, if it has fallen: its motion is followed back to its beginning, because it falls
            only later. Else it is that of the end. :meth:`bracket` finds the largest factor by another way, at rest
        """
        towards = self._sideways(towards, "tilt")
        angle = math.radians(degrees)
        if not 0 < angle < math.pi:
            raise ValueError(f"tilt: {degrees} degrees must be above 0, below 180")
        self._findBound("lean", towards, True)

        def gravity(share):
            return self.gravity * (
                math.sin(share * angle) * towards
                - math.cos(share * angle) * Vector3.UnitZ
            )

        return self._lean("tilt", degrees / _rate(rate, "tilt"), gravity)

    @_stage
    def accelerate(self, most, towards=(1, 0, 0), rate=0.5):
        """Let a horizontal acceleration grow evenly, until the structure falls or ``most`` is reached.

        :param most: [g]
        :param towards: horizontal direction of the force on the blocks
        :param rate: [g/s]
        :returns: as of :meth:`tilt`
        """
        towards = self._sideways(towards, "accelerate")
        if not 0 < most < math.inf:
            raise ValueError(f"accelerate: {most} g must be above 0")
        self._findBound("lean", towards)

        def gravity(share):
            return share * most * GRAVITY * towards - self.gravity * Vector3.UnitZ

        return self._lean("accelerate", most / _rate(rate, "accelerate"), gravity)

    def _sideways(self, towards, name):
        towards = vector(towards, f"{name}: direction")
        if towards[2] or not towards.norm():
            raise ValueError(f"{name}: the direction must be horizontal, got {towards}")
        if self.plane and towards[1]:
            raise ValueError(
                f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
            )
        return towards.normalized()

    def bound(self, target=None, direction=(1, 0, 0), towards=None):
        """Limit analysis of the scene as it stands, with a collapse without dilatancy: see :mod:`masonry.limit`.

        Stages that push or lean find their bound by themselves, if there are at most 3000 joints; this is for other
        loads, and for larger structures.

        :param target: what is pushed, as of :meth:`push`, along ``direction``; its factor is the base shear [kN]
        :param towards: horizontal direction of an acceleration, whose factor is in g; give this or ``target``
        :returns: the entry of run.json: a dict with ``factor``, ``exact`` and the others that :mod:`masonry.run.results` lists
        """
        if (target is None) == (towards is None):
            raise ValueError("bound: give either target or towards")
        self._begin()
        bounds = self.model.bounds
        if target is not None:
            self.model.pushTo(
                target, vector(direction, "bound: direction").normalized()
            )
            return bounds.push(self.model.way, False, lowerUpTo=EVERY)
        return bounds.lean(self._sideways(towards, "bound"), lowerUpTo=EVERY)

    def _findBound(self, kind, *load):
        """Find the bound of a stage."""
        if self.args.lean and not self.only:
            return
        getattr(self.model.bounds, kind)(*load, lowerUpTo=SMALL if self.only else 0)

    def _lean(self, name, duration, gravity):
        if self.only:
            self.ended = DONE
            return DONE
        at = self.stage(name, _Leaning())
        if at is None:
            return DONE
        whole = duration * self.args.density_scaling**0.5

        def before(done, beyond):
            self.model.setGravity(
                gravity(min(1.0, 0.5 * (done + beyond) * O.dt / whole))
            )

        def after():
            row = [O.time, self.model.factor(), self.model.haste()]
            at.rows = [*at.rows, row]  # a checkpoint may hold the old list
            self.model.tellFall()

        try:
            self._timed(at, self.share * whole, before, after)
            self.factor = self.stood = self.model.factor()
        except Collapsed:
            self.factor = self.stood = _leftRest(at.rows, self.model.factor())
            say(f"left rest at {self.factor:.4g} of the vertical acceleration")
            raise
        return DONE

    @_stage
    def shake(
        self,
        accelerations,
        every=None,
        direction=(1, 0, 0),
        scale=1.0,
        unit=None,
        after=0.0,
        damping=0.0,
        massDamping=0.0,
        stiffnessDamping=0.0,
    ):
        """Shake the ground by a record.

        The scene moves with the ground: every block feels the negative ground acceleration, and all displacements are
        those relative to the ground, whose motion is exact. Time is real, so masses must not be scaled. Between the
        samples the acceleration changes evenly.

        Joints that slide, crack and crush take energy. The default adds no other damping, since none is measured for
        masonry that rocks. :func:`rayleigh` gives the two viscous ones from a damping ratio.

        :param accelerations: a list, or the path of a text file with one or two columns: acceleration, or time
            [s] and acceleration
        :param every: time between two samples [s]; of a file with times it may be None
        :param direction: of the ground's motion, horizontal
        :param scale: factor on the accelerations
        :param unit: of the accelerations: ``"m/s²"``, ``"g"`` or ``"cm/s²"``; None: m/s², and a record whose peak looks like
            another unit is refused
        :param after: time that follows the record [s]
        :param damping: numerical damping constant of the options' kind [-]
        :param massDamping: viscous, of the motion relative to the ground [1/s]
        :param stiffnessDamping: viscous, of the joints [s]; it shortens the time step
        """
        values, every = readRecord(accelerations, every, scale, unit)
        direction = self._sideways(direction, "shake")
        if self.args.density_scaling != 1:
            raise Refused("--density-scaling: a scene that is shaken runs in real time")
        at = self.stage("shake", _Timed())
        if at is None:
            return DONE
        model = self.model
        model.damp(damping, self.args.damping_kind)
        model.integrator.massDamping = massDamping
        model.dampJoints(stiffnessDamping)
        down = -self.gravity * Vector3.UnitZ

        def before(done, beyond):
            place = (done + 0.5) * O.dt / every
            first = int(place)
            if first + 1 < len(values):
                share = place - first
                a = (1 - share) * values[first] + share * values[first + 1]
            else:
                a = 0.0
            model.setGravity(down - scale * a * direction)

        duration = (len(values) - 1) * every + after
        self._timed(at, self.share * duration, before, each=1)
        model.setGravity(down)
        return DONE

    @_stage
    def run(self, seconds, damping=None):
        """Let time pass.

        :param seconds: time in the scene [s]
        :param damping: damping constant during it [-]; None: that of the options
        """
        at = self.stage("run", _Timed())
        if at is None:
            return DONE
        if not 0 < seconds < math.inf:
            raise ValueError(f"run: {seconds} s must be above 0")
        if damping is not None:
            self.model.damp(damping, self.args.damping_kind)
        self._timed(at, self.share * seconds, lambda done, beyond: None)
        return DONE

    def _timed(self, at, duration, before, after=None, each=None):
        """Steps for a duration [s], with rows and frames evenly in time.

        :param before: function of the number of steps so far and after the next stretch, called before each stretch
        :param after: called after each row
        :param each: steps of a stretch; None: 20, or fewer
        """
        length = max(1, round(duration / O.dt))
        stretch = each or max(1, min(20, length // ROWS))
        perRow = max(stretch, length // ROWS // stretch * stretch)
        perFrame = max(1, length // FRAMES)
        while at.done < length:
            goal = min(length, (at.done // perRow + 1) * perRow)
            if stretch == 1:
                before(at.done, at.done + 1)
                self._stepping(at, goal, before)
            else:
                beyond = min(goal, at.done + stretch)
                before(at.done, beyond)
                self.advance(beyond - at.done)
                at.done = beyond
            if at.done < goal:
                continue
            self.record()
            self.show(
                at.done / length, lambda: f"{at.done * O.dt:.3f} of {duration:.3f} s"
            )
            if at.done >= at.nextFrame:
                self.frame()
                at.nextFrame += perFrame
            if after:
                after()
        self.show(1, lambda: f"{duration:.3f} s", final=True)
        self.flush()
        self.ended = DONE

    def _stepping(self, at, goal, before):
        """Steps up to a goal, with ``before`` ahead of each of them."""
        step, first = O.step, at.done

        def one(number):
            before(first + number, first + number + 1)
            step()

        self.advance(goal - first, one)
        at.done = goal

    def bracket(self, carries, low, high, within=0.01):
        """Find the largest load that the structure carries, by halving: each trial starts from the last state at rest.

        :param carries: function of a load factor that sets loads and stages, and returns whether the structure is at
            rest under it, for example ``lambda f: scene.lean(f) == AT_REST``
        :param low: a factor that it carries, ``high`` one that it does not
        :param within: width of the bracket at the end, relative to ``high``
        :returns: the two ends of the bracket
        :raises ValueError: if the structure does not carry ``low``, or carries ``high``
        """
        if not 0 <= low < high < math.inf:
            raise ValueError(
                f"bracket: low {low} must be at least 0 and below high {high}"
            )
        if not carries(low):
            raise ValueError(
                f"bracket: the structure does not carry {low:g}, the lower end"
            )
        if carries(high):
            raise ValueError(f"bracket: the structure carries {high:g}, the upper end")
        self.stepBack()
        within = within if self.share == 1 else max(within, 0.5)
        while high - low > within * high:
            middle = 0.5 * (low + high)
            if carries(middle):
                low = middle
            else:
                high = middle
                self.stepBack()
        return low, high

    @_stage
    def lean(self, factor, towards=(1, 0, 0), longest=None):
        """Put a horizontal acceleration on the structure, and wait until it is at rest or falls.

        :param factor: [g]
        :param longest: time in the scene after which it is given up [s]; None: 4 s
        """
        towards = self._sideways(towards, "lean")
        self._findBound("lean", towards)
        if self.only:
            carried = self.model.bounds.describe().get("bound_acceleration", 0.0)
            self.ended = AT_REST if factor <= carried else MOVING
            return self.ended
        at, model = self.stage("lean", _Resting()), self.model
        if at is None:
            return AT_REST
        if at.gravity is None:
            at.gravity = list(model.now)
        began = Vector3(*at.gravity)
        ends = factor * GRAVITY * towards - self.gravity * Vector3.UnitZ
        ends /= self.args.density_scaling
        self.factor = factor
        ended = self._rest(
            at,
            longest or LEANING,
            lambda x: model.setGravity(began + x * x * (3 - 2 * x) * (ends - began)),
            over=LEAN_GROWS,
        )
        if ended == AT_REST:
            self.stood = max(self.stood, factor)
        return ended


@dataclass
class _Resting:
    done: int = 0
    quiet: int = 0
    load: float = 0.0
    gravity: list = None  # when a lean began [m/s²]


@dataclass
class _Timed:
    done: int = 0
    nextFrame: int = 0


@dataclass
class _Leaning(_Timed):
    #: Of every row so far: time [s], horizontal over vertical acceleration [-], and how fast the fastest block was over
    #: one that has fallen [-].
    rows: list = ()


def _leftRest(rows, now):
    """The factor at which a structure left rest under a load that grew evenly, from the rows until it fell.

    What a growing load sets in motion is accelerated in proportion to time at first, so that the root of its velocity
    grows evenly. The line through two of its values, when the block that fell was slow yet, leads back to the beginning.

    :param rows: as of :class:`_Leaning`
    :param now: factor at which it was told
    """
    times = []
    for level in SLOW:
        for one, two in zip(rows[-2::-1], rows[:0:-1]):
            if one[2] < level <= two[2]:
                low, high = math.sqrt(one[2]), math.sqrt(two[2])
                share = (math.sqrt(level) - low) / (high - low)
                times.append(one[0] + share * (two[0] - one[0]))
                break
    if len(times) < 2:
        return now
    began = times[0] - (
        times[1] - times[0]
    )  # the root doubles from one level to the other
    began = max(began, rows[0][0])
    for one, two in zip(rows, rows[1:]):
        if one[0] <= began <= two[0]:
            share = (began - one[0]) / (two[0] - one[0])
            return one[1] + share * (two[1] - one[1])
    return now


def _called(value):
    return value() if callable(value) else value


def _drivesOf(target):
    name = getattr(target, "name", repr(target))
    drives = ", ".join(getattr(target, "drives", "") or "") or "none"
    return f"drives of {name}: {drives}"


def _rate(rate, name):
    if not (isinstance(rate, (int, float)) and 0 < rate < math.inf):
        raise ValueError(f"{name}: rate {rate!r} must be a number above 0")
    return rate
