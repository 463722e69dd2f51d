# SPDX-License-Identifier: GPL-2.0-or-later
"""Horizontal acceleration and a tilting ground: ``tilt``, ``accelerate`` and ``lean``, and the search with ``bracket``."""

import math
from dataclasses import dataclass

from yade import O, Vector3

from ...assembly.blocks import vector
from ...basics import GRAVITY, Collapsed, say
from .rest import Resting, waitForRest
from .stage import AT_REST, DONE, MOVING, Answer, stage
from .timed import Timed, checkedRate, timed

LEAN_GROWS = 0.2  # [s] in which a lean grows
LEANING = 4.0  # [s] after which a lean is given up
#: Two velocities over that of a block that has fallen, the second four times the first: see leftRest.
SLOW = 1 / 36, 1 / 9


@dataclass
class Growing(Timed):
    """What a stage remembers in which an acceleration grows."""

    #: Of every row so far: time [s], horizontal over vertical acceleration [-], and how fast the fastest block was over
    #: one that has fallen [-].
    rows: list = ()


def factorReached(scene, rows):
    """The horizontal over the vertical acceleration at which the structure left rest, or that of the end."""
    if scene.collapsed:
        how = (
            "where the structure left rest: its motion, followed back to its beginning. A structure that yields "
            "gradually can carry more; bracket() finds what it carries at rest"
        )
        return [Answer("factor_at_leaving_rest", "-", scene.factor, how)]
    how = (
        "the largest that was reached; the structure did not fall, but it may be moving"
    )
    return [Answer("factor_reached", "-", scene.factor, how)]


def factorHeld(scene, rows):
    """The acceleration under which the structure came to rest."""
    if scene.ended == AT_REST:
        how = "the structure came to rest under it"
        return [Answer("factor_held", "-", scene.factor, how)]
    how = f"the structure did not come to rest under a factor of {scene.factor:.4g}"
    return [Answer("factor_held", "-", None, how)]


def sideways(scene, towards, name):
    """A horizontal direction as a unit vector. Raises ValueError."""
    towards = vector(towards, f"{name}: direction")
    if towards[2] or not towards.norm():
        raise ValueError(f"{name}: the direction must be horizontal, got {towards}")
    if scene.description.plane and towards[1]:
        raise ValueError(
            f"{name}: the scene is in the x-z plane; Scene(..., plane=False) is in space"
        )
    return towards.normalized()


@stage(bounded=True, answers=factorReached)
def tilt(scene, degrees, towards=(1, 0, 0), rate=1.0):
    """Tilt the ground, and with it gravity, until the structure falls or the angle is reached.

    :param towards: horizontal direction in which the structure leans
    :param rate: [degrees/s]
    :returns: ``COLLAPSED`` or ``DONE``; ``scene.factor`` is the horizontal over the vertical acceleration at
        which the structure left rest, if it has fallen: its motion is followed back to its beginning, because it falls
        only later. Else it is that of the end. :meth:`bracket` finds the largest factor by another way, at rest
    """
    towards = sideways(scene, towards, "tilt")
    angle = math.radians(degrees)
    if not 0 < angle < math.pi:
        raise ValueError(f"tilt: {degrees} degrees must be above 0, below 180")
    scene.findBound("lean", towards, True)
    down = scene.description.gravity

    def gravity(share):
        return down * (
            math.sin(share * angle) * towards - math.cos(share * angle) * Vector3.UnitZ
        )

    return _grow(scene, "tilt", degrees / checkedRate(rate, "tilt"), gravity)


@stage(bounded=True, answers=factorReached)
def accelerate(scene, most, towards=(1, 0, 0), rate=0.5):
    """Let a horizontal acceleration grow evenly, until the structure falls or ``most`` is reached.

    :param most: [g]
    :param towards: horizontal direction of the force on the blocks
    :param rate: [g/s]
    :returns: as of :meth:`tilt`
    """
    towards = sideways(scene, towards, "accelerate")
    if not 0 < most < math.inf:
        raise ValueError(f"accelerate: {most} g must be above 0")
    scene.findBound("lean", towards)
    down = scene.description.gravity * Vector3.UnitZ

    def gravity(share):
        return share * most * GRAVITY * towards - down

    return _grow(scene, "accelerate", most / checkedRate(rate, "accelerate"), gravity)


def _grow(scene, name, duration, gravity):
    """Let gravity change evenly.

    :param duration: [s], with true masses
    :param gravity: function of the share of the duration that is over, 0 to 1 [-], that gives gravity [m/s²]
    """
    if scene.only:
        scene.ended = DONE
        return DONE
    model = scene.model
    at = scene.running.stage(name, Growing())
    if at is None:
        return DONE
    whole = duration * scene.args.density_scaling**0.5

    def before(done, beyond):
        share = min(1.0, 0.5 * (done + beyond) * O.dt / whole)
        model.setGravity(gravity(share) / scene.args.density_scaling)

    def after():
        row = [O.time, model.factor(), model.motion.fastest()]
        at.rows = [*at.rows, row]  # a checkpoint may hold the old list
        model.motion.checkFall()

    try:
        timed(scene, at, scene.share * whole, before, after)
        scene.factor = scene.stood = model.factor()
    except Collapsed:
        scene.factor = scene.stood = restEnded(at.rows, model.factor())
        say(f"left rest at {scene.factor:.4g} of the vertical acceleration")
        raise
    return DONE


@stage(bounded=True, answers=factorHeld)
def lean(scene, factor, towards=(1, 0, 0), longest=None):
    """Put a horizontal acceleration on the structure, and wait until it is at rest or falls.

    :param factor: [g]
    :param longest: time in the scene after which it is given up [s]; None: 4 s
    """
    towards = sideways(scene, towards, "lean")
    scene.findBound("lean", towards)
    if scene.only:
        carried = scene.bounds.describe().get("bound_acceleration", 0.0)
        scene.ended = AT_REST if factor <= carried else MOVING
        return scene.ended
    at, model = scene.running.stage("lean", Resting()), scene.model
    if at is None:
        return AT_REST
    if at.gravity is None:
        at.gravity = list(model.now)
    began = Vector3(*at.gravity)
    ends = factor * GRAVITY * towards - scene.description.gravity * Vector3.UnitZ
    ends /= scene.args.density_scaling
    scene.factor = factor
    ended = waitForRest(
        scene,
        at,
        longest or LEANING,
        lambda x: model.setGravity(began + x * x * (3 - 2 * x) * (ends - began)),
        over=LEAN_GROWS,
    )
    if ended == AT_REST:
        scene.stood = max(scene.stood, factor)
    return ended


def bracket(scene, carries, low, high, within=0.01):
    """Find the largest load that the structure carries, by halving: each trial starts from the last state at rest.

    :param carries: function of a load factor that sets loads and stages, and returns whether the structure is at
        rest under it, for example ``lambda f: scene.lean(f) == AT_REST``
    :param low: a factor that it carries, ``high`` one that it does not
    :param within: width of the bracket at the end, relative to ``high``
    :returns: the two ends of the bracket
    :raises ValueError: if the structure does not carry ``low``, or carries ``high``
    """
    if not 0 <= low < high < math.inf:
        raise ValueError(f"bracket: low {low} must be at least 0 and below high {high}")
    if not carries(low):
        raise ValueError(
            f"bracket: the structure does not carry {low:g}, the lower end"
        )
    if carries(high):
        raise ValueError(f"bracket: the structure carries {high:g}, the upper end")
    scene.stepBack()
    within = within if scene.share == 1 else max(within, 0.5)
    while high - low > within * high:
        middle = 0.5 * (low + high)
        if carries(middle):
            low = middle
        else:
            high = middle
            scene.stepBack()
    return low, high


def restEnded(rows, now):
    """The factor at which a structure left rest under a load that grew evenly, from the rows until it fell.

    What a growing load sets in motion is accelerated in proportion to time at first, so that the root of its velocity
    grows evenly. The line through two of its values, when the block that fell was slow yet, leads back to the beginning.

    :param rows: as of :class:`Growing`
    :param now: factor at the time when the fall was noticed
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
    # the root doubles from one level to the other
    began = times[0] - (times[1] - times[0])
    began = max(began, rows[0][0])
    for one, two in zip(rows, rows[1:]):
        if one[0] <= began <= two[0]:
            share = (began - one[0]) / (two[0] - one[0])
            return one[1] + share * (two[1] - one[1])
    return now
