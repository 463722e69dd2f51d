# SPDX-License-Identifier: GPL-2.0-or-later
"""Waiting for rest: the stage ``settle``, and what ``lean`` shares with it."""

import math
from dataclasses import dataclass
from typing import Annotated, Any

from yade import O, Vector3

from .._masonry import ElasticSolution, loadScene, saveScene
from ..arguments import oneOf
from ..model import period
from ..model.motion import REST, SWUNG
from ..errors import Collapsed, Refused
from ..terminal import say
from ..scene.resuming import saidBefore
from .answers import AT_REST, MOVING
from .stage import Duration, stage

RAMP = 0.02  # [s] in which loads and velocities grow: ten periods of a wave through a wall
REST_ENERGY_RATIO = 1e-5  # largest kinetic over elastic energy of a structure at rest [-]
CONSECUTIVE_CHECKS = 3  # that find a structure at rest, before it is said to be
#: Share of its largest kinetic energy that a structure has lost when it is at rest, unless it has
#: hardly any, over the elastic energy: what has just begun to move is not at rest [-].
SLOWED, STILL = 0.75, 1e-9
#: A wait goes on beyond its time while the kinetic energy of a half of it is below this share of
#: that in the half before [-].
DYING = 0.5
EVERY = 100  # steps between two checks
#: Steps in which a part of the loads is put on, a third at most, and after which it is seen whether
#: a block has fallen far: few if time steps are long.
CHECK_INTERVALS = 1, 2, 5, 10, 20, 50, EVERY
#: Periods on springs to the ground in which loads grow, so that a structure sinks slowly.
PERIODS = 4.0
WAITED = 10.0  # periods on springs for which a trial waits at least
SLENDER = 8.0  # height over the least width from which a settled structure may buckle [-]
SWINGING = 4.0  # [s] in the scene: settle() waits at least so long after the release of a drive
#: Elastic solution: largest error of its forces [-]; how often all is moved at most; energy lost in
#: joints that count as elastic over that stored [-].
EXACT, CORRECTIONS, LOST = 1e-9, 20, 1e-6
SETTLING = 0.5  # most local damping of deformable units in settle(): with more they creep to rest


def rampTime(args: Any) -> float:
    """Time in which loads and velocities grow [s]: waves in heavier blocks are slower."""
    return RAMP * args.density_scaling**0.5


def growthTime(scene: Any) -> float:
    """Time in which a load is put on a structure [s]: longer for tall ones."""
    box = scene.description
    return rampTime(scene.args) * max(1.0, (box.high[2] - box.low[2]) / 3)


@dataclass
class Waiting:
    """What is remembered of a wait for rest."""

    done: int = 0  # steps so far
    quiet: int = 0  # checks that found the structure at rest, one after the other
    halves: int = 0  # of the time for which it is waited that are over
    peak: float = 0.0  # largest kinetic over elastic energy in the present half [-]
    before: float = 0.0  # and in the one before

    def isAtRest(self, missing, moving, isGrown):
        """Note a check: what :meth:`masonry.model.restraints.Supports.unrest` found, and whether
        the load is there. Returns whether enough checks, one after the other, found rest."""
        self.peak = max(self.peak, moving)
        slowed = moving <= max(STILL, (1 - SLOWED) * max(self.peak, self.before))
        rests = missing < REST and moving < REST_ENERGY_RATIO and slowed and isGrown
        self.quiet = self.quiet + 1 if rests else 0
        return self.quiet == CONSECUTIVE_CHECKS

    def isGivenUp(self, longest):
        """Whether the time [s] for which it is waited is over, and the motion does not die away."""
        half = max(1, int(0.5 * longest / O.dt) // EVERY) * EVERY
        if self.done % half:
            return False
        self.halves += 1
        dies = self.peak < DYING * self.before
        self.before, self.peak = self.peak, 0.0
        return self.halves > 1 and not dies


@dataclass
class Resting(Waiting):
    """What a stage remembers that waits for rest."""

    begun: list | None = None  # the load when it began to be put on
    goal: float = 0.0  # factor of the load that is put on [-]
    level: float | None = None  # of what was pushed, when the loads had grown [m]
    solved: bool = False  # whether the stage began with the elastic solution


def buckles(scene: Any) -> bool:
    """Whether a small push sideways grows on a structure that is at rest."""
    running = scene.running
    with running.clock("steps"), running.breakable():
        for axis in "x" if scene.description.plane else "xy":
            grows, steps = period.buckles(scene.model, Vector3(axis == "x", axis == "y", 0))
            running.state.steps += steps
            if grows:
                return True
    return False


def isSlender(scene: Any) -> bool:
    """Whether a structure is so high over its width, or on springs, that it may buckle."""
    box = scene.description
    wide, deep, high = (b - a for a, b in zip(box.low, box.high))
    least = wide if box.plane else min(wide, deep)
    return high >= SLENDER * least or scene.model.supports.slowest() > 0


@stage(bounded=True, grows=True)
def settle(
    scene: Any,
    longest: Duration | None = None,
    damping: Annotated[str, oneOf("local", "combined")] | None = None,
    record: bool = True,
) -> str:
    """Let gravity, presses and dead loads act until the structure is at rest.

    At rest the supports carry all loads, and the horizontal ones alone, but for half a per cent,
    and hardly anything moves. Presses and dead loads grow when it is called first; they stay when
    it is called again, for example after :meth:`release`. What then falls slowly needs ``longest``.

    Where all joints stay elastic, there is one equilibrium, which the first call finds by the
    stiffness matrix, and steps only check.

    :param longest: time in the scene after which it is given up [s]; None: 0.4 s, and longer for
        tall structures, for soft springs under platens, and after the release of a drive
    :param damping: kind of damping in this stage, ``"local"`` or ``"combined"``; None: that of the
        options. Local damping, of 0.5 at most in deformable units, takes the vibrations out sooner,
        and holds a mechanism back
    :param record: whether its end is a row of curve.csv
    :returns: ``AT_REST``; ``MOVING`` if it is not at rest by then, or buckles; ``COLLAPSED``
    """
    if scene.limitAnalysisOnly:
        scene.model.loading.grow(1.0)
        scene.grown = True
        return AT_REST
    model = scene.model
    grown, scene.grown = scene.grown, True
    grow = (lambda x: None) if grown else model.loading.grow
    at = scene.running.stage("settle", Resting())
    if damping:
        most = SETTLING if model.zones and damping == "local" else 1.0
        model.scheme.damp(min(most, scene.args.damping), damping)
    if not (grown or scene.running.isResumed and scene.running.resumedHere):
        scene.running.state.stages[-1]["solved"] = at.solved = solve(scene)
    return waitForRest(scene, at, longest, grow, record=record, buckling=isSlender(scene))


def solve(scene: Any) -> bool:
    """Put gravity and all loads on a structure that has not moved, and take it to its equilibrium,
    if all joints stay elastic on the way, so that it is the only one, and no block moves as far as
    in a fall. Returns whether; else the scene is as before."""
    model, running = scene.model, scene.running
    if model.contacts or scene.description.functors:
        return False
    dt, before, scheme, solved = O.dt, saveScene("null"), model.scheme, False
    try:
        with running.clock("steps"):
            model.loading.grow(1.0)
            O.dt = period.INSTANT
            scheme.scaleMasses(0.0)
            O.step()
            solution, errors = ElasticSolution(), []
            while not solved and len(errors) < CORRECTIONS:
                errors.append(solution.move())
                O.step()
                lost, stored = model.energies()
                if lost > LOST * stored or model.motion.isFar():
                    break
                solved = errors[-1] <= EXACT * errors[0]
            running.state.steps += 1 + len(errors)
    except (RuntimeError, ValueError):  # something falls, or can move without resistance
        pass
    if not solved:
        model.loading.grow(0.0)
        loadScene(before)
    scheme.scaleMasses(scheme.massScaling)
    O.dt = dt
    return solved


def waitForRest(scene, at, longest, grow, over=0.0, record=True, buckling=False, dying=False):
    """Let something grow, then wait until the structure is at rest. Returns how that ended.

    :param longest: time after which it is given up [s]; None: 20 times that in which it grows
    :param grow: function of how much of the time in which it grows is over, 0 to 1 [-]
    :param over: time in which it grows at least [s]
    :param record: whether the end is a row of curve.csv
    :param buckling: whether a structure at rest must not buckle, else it is ``MOVING``
    :param dying: whether it is waited longer while the motion dies away
    """
    model, running = scene.model, scene.running
    slowest = model.supports.slowest()
    ramp = max(growthTime(scene), over, PERIODS * slowest)
    growing = max(1, int(ramp / O.dt))
    every = max(n for n in CHECK_INTERVALS if n == 1 or n <= growing / 3)
    swinging = SWINGING * scene.args.density_scaling**0.5 * (model.motion.far == SWUNG)
    longest = longest or max(20 * ramp, WAITED * slowest, swinging)
    if math.isinf(O.dt):
        raise Refused("every brick is held, so nothing can move")
    most = int(longest / O.dt)
    if most < 1:
        raise Refused(
            f"longest {longest:g} s, after which the wait for rest ends, must be above the time"
            f" step, {O.dt:.3g} s"
        )
    if at.solved:  # the time of growth is over, and a check sees it at rest
        begun = (growing // EVERY + 1) * 2 * EVERY
        most += begun
        if not at.done:
            at.done, at.quiet = begun, CONSECUTIVE_CHECKS - 1
    while (dying or at.done < most or at.done % EVERY) and at.quiet < CONSECUTIVE_CHECKS:
        load = min(1.0, (at.done + every) / growing)
        grow(load)
        running.advance(every)
        at.done += every
        if at.done % EVERY:
            model.motion.checkFall(SWUNG)
            continue
        missing, moving = model.supports.unrest()
        grown = at.done > (1.2 if over else 1.1) * growing
        at.isAtRest(missing, moving, grown)
        if load == 1:
            model.motion.checkFall()
            if at.level is None:
                at.level = model.loading.level()
            if model.loading.hasSunk(at.level):
                raise Collapsed("the platen has come down by half a course")
        ends = dying and at.isGivenUp(longest) or not dying and at.done >= most
        running.show(
            min(1, at.done / most),
            lambda: (
                f"{'elastic solution, ' * at.solved}{100 * missing:.2f} % of the loads not carried,"
                f" kinetic energy {moving:.1e} of the elastic"
            ),
            at.quiet == CONSECUTIVE_CHECKS or ends,
        )
        if ends:
            break
    if at.quiet < CONSECUTIVE_CHECKS:
        missing, moving = model.supports.unrest()
        say(
            f"note: the structure is not at rest after {at.done * O.dt:.2f} s:"
            f" {100 * missing:.2f} % of the load is missing at the supports, kinetic over elastic"
            f" energy is {moving:.1e}; longest=... [s] waits longer"
        )
    ended = AT_REST if at.quiet == CONSECUTIVE_CHECKS else MOVING
    if buckling and ended == AT_REST and buckles(scene):
        say(
            "note: the structure buckles under this load: a small push sideways grows, so it counts"
            " as moving"
        )
        ended = MOVING
    model.engage()
    if record:
        running.record()
    running.flush()
    if ended == AT_REST:
        model.atRest = saveScene("null")  # for stepBack()
        model.motion.restart()
    return ended


def stepBack(scene: Any) -> None:
    """Take the scene back to its last state at rest, also after a collapse, with the load that was
    held then, also by a growth or a bracket. Rows of curve.csv stay."""
    with scene.noted(stepBack):
        if scene.limitAnalysisOnly:
            return
        running, model = scene.running, scene.model
        known = model is not None and model.atRest is not None
        before, at = running.scriptBefore, len(scene.script.commands)
        if running.isResumed and at < len(before):  # it had none yet
            known = before[at][1].get("known", known)
        isEarlier = saidBefore(scene, "stepBack", known=known)
        if not known:
            raise Refused("stepBack: the scene has not been at rest in this run of the script")
        running.collapsed, scene.ended = False, AT_REST
        scene.results.run.pop("collapse", None)
        if not isEarlier:
            loadScene(model.atRest)
            running.checkpoints.setRollbackPoint()
            model.motion.restart()
