# SPDX-License-Identifier: GPL-2.0-or-later
"""Horizontal acceleration and a tilting ground: ``tilt``, ``accelerate`` and ``lean``, and the
search with ``bracket``."""

import math
from typing import Annotated, Any, Callable

from yade import Vector3

from ..arguments import Level, number, validated
from ..model.loading import smooth
from ..units import GRAVITY
from ..errors import Refused, checkPlane
from ..model.load_names import nameOfLean
from .bounds import findBound
from .growing import TRIAL, WITHIN, Tried, ends, follow, found, grow
from .rest import WAITED, Resting, waitForRest
from .answers import AT_REST, MOVING, Answer, keep
from .stage import Duration, stage

LEAN_GROWS = 0.2  # [s] in which a lean grows


class Acting:
    """A load that can grow, from a share of 0 to 1, where its factor is ``most``.

    Its kinds have ``now()``, their present values as a list of numbers, ``put(values)``, and
    ``at(began, share)``, their values at a share [-], from those at the beginning.

    :param name: under which its bound is found
    :param unit: of the factor
    :param towards: direction along which displacements are counted
    """

    target = None  # the platen or brick on which it acts, if it is one

    def __init__(self, name, most, unit, towards=None):
        self.name, self.most, self.unit, self.towards = name, most, unit, towards

    def factor(self, share):
        """The load factor at a share [-]."""
        return share * self.most

    def shareOf(self, factor):
        """The share at which it has a load factor [-]."""
        return factor / self.most


class Acceleration(Acting):
    """A horizontal acceleration that grows to ``most`` [g] beside what acts already."""

    def __init__(self, model, most, towards, name, unit="g"):
        super().__init__(name, most, unit, towards)
        self.model = model

    def now(self):
        return list(self.model.scheme.now)

    def put(self, values):
        self.model.scheme.setGravity(Vector3(*values))

    def at(self, began, share):
        more = self.factor(share) * GRAVITY * self.towards
        return list(Vector3(*began) + more / self.model.args.density_scaling)


class Leaning(Acceleration):
    """A horizontal acceleration [g] in place of what acts beside gravity."""

    def at(self, began, share):
        return super().at([0, 0, -self.model.gravity], share)


class Tilting(Acceleration):
    """Gravity that turns by an angle [rad], with what acts beside it. The factor is the tangent of
    the angle."""

    def __init__(self, model, angle, towards, name):
        super().__init__(model, math.tan(angle), towards, name, "-")
        self.angle = angle

    def at(self, began, share):
        whole, along, up = Vector3(*began), self.towards, Vector3.UnitZ
        angle = share * self.angle
        level, down = whole.dot(along), -whole.dot(up)
        turned = math.sin(angle) * along - math.cos(angle) * up
        raised = math.cos(angle) * along + math.sin(angle) * up
        return list(whole - level * along + down * up + down * turned + level * raised)

    def factor(self, share):
        angle = share * self.angle
        return math.tan(angle) if angle < math.pi / 2 else math.inf

    def shareOf(self, factor):
        return math.atan(factor) / self.angle


def putOnAnswers(scene, rows):
    """The load that was put on, as held or not held."""
    asked, unit = scene.running.memory.goal, scene.loadUnit
    end, load = Tried(asked, 1e3 * scene.model.loading.alongNow()), f"{asked:.4g} {unit}"
    if scene.ended == AT_REST:
        end.arching = scene.model.supports.arching(scene.model.loading.direction)
        return ends(scene, end, "the structure came to rest under it", None, f"it held {load}")
    why = f"the structure did not come to rest under {load}"
    return ends(scene, None, why, end, why)


def sideways(scene, towards, name):
    """A horizontal direction as a unit vector. Raises ValueError."""
    checkPlane(scene.description, towards, name)
    return Vector3(*towards).normalized()


def _before(scene):
    """Gravity and accelerations when the present stage began [m/s²]."""
    running = scene.running
    isContinued = running.resumedHere and running.isResumed
    return isContinued and running.state.memory.get("begun") or list(scene.model.scheme.now)


Width = Annotated[float, number("", 1e-4, 1, below=True)]  # of a bracket


@stage(bounded=True, answers=found)
def tilt(
    scene: Any,
    degrees: Annotated[float, number("degrees", 0, 90, above=True, below=True)],
    towards: Level = (1, 0, 0),
    rate: Annotated[float, number("degrees/s", 1e-6, 1e6)] = 1.0,
    within: Width = WITHIN,
) -> str:
    """Tilt the ground, until the structure falls or the angle is reached; then search for the tilt
    that it holds. The tilt stays, and adds to what acts already.

    Gravity turns, with the accelerations that act. Forces of :meth:`load`, :meth:`press` and
    :meth:`pressure` keep their directions in the axes of the scene: weights that shall lean are
    blocks, for example a :class:`masonry.bricks.Floor`.

    :param towards: horizontal direction in which the structure leans
    :param rate: [degrees/s]
    :param within: width of the bracket that the search leaves, over its upper end [-]
    :returns: ``COLLAPSED`` if the structure fell, else ``AT_REST`` if it came to rest under the
        whole load, else ``DONE``. ``scene.factor`` is the largest horizontal over vertical
        acceleration that it held, by :mod:`masonry.stages.growing`; the scene stays as it was
        at the end of the growth
    :raises Refused: if there is no gravity
    """
    towards = sideways(scene, towards, "tilt")
    if not scene.model.scheme.now.norm() > 0:
        raise Refused("tilt: there is no gravity that turns; forces of load() and press() do not")
    findBound(scene, "lean", towards, True, _before(scene))
    name = nameOfLean(towards, tilts=True)
    load = Tilting(scene.model, math.radians(degrees), towards, name)
    return grow(scene, "tilt", load, degrees / rate, within)


@stage(bounded=True, answers=found)
def accelerate(
    scene: Any,
    most: Annotated[float, number("g", 0, 1e3, above=True)],
    towards: Level = (1, 0, 0),
    rate: Annotated[float, number("g/s", 1e-6, 1e6)] = 0.5,
    within: Width = WITHIN,
) -> str:
    """Let a horizontal acceleration grow evenly beside what acts already, until the structure falls
    or ``most`` is reached; then search for that which it holds.

    :param most: [g]
    :param towards: horizontal direction of the force on the blocks
    :param rate: [g/s]; the rest as in :meth:`tilt`
    """
    towards = sideways(scene, towards, "accelerate")
    findBound(scene, "lean", towards, False, _before(scene))
    load = Acceleration(scene.model, most, towards, nameOfLean(towards))
    return grow(scene, "accelerate", load, most / rate, within)


@stage(bounded=True, answers=putOnAnswers)
def lean(
    scene: Any,
    factor: Annotated[float, number("g", 0, 1000)],
    towards: Level = (1, 0, 0),
    longest: Duration | None = None,
) -> str:
    """Put a horizontal acceleration on the structure, in place of the accelerations and tilts that
    act, and wait until it is at rest or falls. It stays in the stages that follow, and adds to what
    they put on.

    :param factor: [g]
    :param longest: time in the scene after which it is given up [s]; None: 4 s, and longer while
        the motion dies away
    """
    towards = sideways(scene, towards, "lean")
    findBound(scene, "lean", towards)
    load = Leaning(scene.model, factor, towards, nameOfLean(towards))
    return putOn(scene, "lean", load, longest, LEAN_GROWS)


def putOn(scene, name, load, longest, over=0.0):
    """Let a load grow within a short time, and wait until the structure is at rest or falls. With
    ``--preset bound`` it stays if limit analysis finds that it is carried.

    :param longest: [s]; None: :data:`masonry.stages.growing.TRIAL`, longer on soft springs, and
        while the motion dies away
    :param over: time in which it grows at least [s]
    """
    if scene.limitAnalysisOnly:
        carried = scene.bounds.entries.get(load.name, {}).get("factor", 0.0)
        if load.name not in scene.bounds.endless and load.most > carried:
            return MOVING
        load.put(load.at(load.now(), 1.0))
        return AT_REST
    running, model, scene.loadUnit = scene.running, scene.model, load.unit
    running.note("lean", load.name)
    on, towards = load.target.name if load.target else "", load.towards
    follow(scene, f"{name} {on}{[round(v, 9) for v in towards]}", load)
    at = running.stage(name, Resting())
    at.goal = load.factor(1.0)
    if at.begun is None:
        at.begun = load.now()
    first, ends = at.begun, load.at(at.begun, 1.0)

    def growing(x):
        share = smooth(x)
        load.put([was + share * (end - was) for was, end in zip(first, ends)])
        model.loading.loadFactor = share * at.goal

    dying, vertical = longest is None, abs(towards[2]) > 0.5
    longest = longest or max(TRIAL, WAITED * model.supports.slowest())
    ended = waitForRest(scene, at, longest, growing, over, buckling=vertical, dying=dying)
    if ended == AT_REST:
        scene.bounds.hold(load.name, at.goal)
    return ended


@validated
def bracket(
    scene: Any,
    carries: Callable[[float], bool],
    low: Annotated[float, number("", 0)],
    high: Annotated[float, number("", 0, above=True)],
    within: Width = 0.01,
) -> tuple[float, float]:
    """Find the largest load that the structure carries, by halving from the last state at rest.

    A large step of the load can throw a structure over that would carry it. So at the end the
    upper end is tried again from the state at rest under the lower one; if it is carried now, the
    search goes on above it. Both ends are answers of the run, ``factor_held`` and
    ``factor_not_held``.

    :param carries: function of a load factor that sets loads and stages, and returns whether the
        structure is at rest under it, for example ``lambda f: scene.lean(f) == AT_REST``
    :param low: a factor that it carries, ``high`` one that it does not
    :param within: width of the bracket at the end, relative to ``high``
    :returns: the two ends of the bracket
    :raises ValueError: if the structure does not carry ``low``, or carries ``high``
    """
    if not low < high:
        raise Refused(f"bracket: low {low} must be below high {high}")
    if scene.collapsed:
        scene.stepBack()
    scene.bracketing = True
    try:
        if not carries(low):
            scene.stepBack()
            raise Refused(f"bracket: the structure does not carry {low:g}, the lower end")
        within = within if scene.share == 1 else max(within, 0.5)
        trial, failures = high, []  # loads that were not carried, with those below them then
        while True:
            if not carries(trial):
                failures.append((trial, low))
                scene.stepBack()
            else:
                low = trial
                failures = [one for one in failures if one[0] > low]
            if not failures:
                raise Refused(f"bracket: the structure carries {low:g}, the upper end")
            lost, source = failures[-1]
            if lost - low > within * lost:
                trial = 0.5 * (low + lost)
            elif source < low:
                trial = lost
                failures.pop()
            else:
                break
        how = "factor for the function of bracket() that the structure"
        held = Answer("factor_held", "-", low, f"the largest {how} carried")
        failed = Answer("factor_not_held", "-", lost, f"the smallest {how} did not carry")
        if not scene.limitAnalysisOnly:
            # of no stage: how many trials there are differs from row to row of a study
            keep(scene, f"{scene.running.entered} bracket", "bracket", 0, [held, failed])
        return low, lost
    finally:
        scene.bracketing = False
