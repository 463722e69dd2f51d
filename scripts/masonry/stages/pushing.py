# SPDX-License-Identifier: GPL-2.0-or-later
"""How the drive of a push goes, row by row."""

import math
from dataclasses import dataclass, field
from typing import Sequence

from yade import O

from ..model.period import firstPeriod
from ..errors import Collapsed, NotResumed, Refused
from ..terminal import say
from ..numbers import curves
from ..numbers.quantities import IMBALANCE
from ..run.option_table import USUAL
from ..scene.history import aim, pathLength, turns
from .rest import REST, REST_ENERGY_RATIO, rampTime

ROW_EVERY = 0.01  # [mm] of a push between rows of curve.csv
SHORT = 0.05  # [mm]: a shorter push has rows that are closer together
ARRIVED = 2e-3  # [mm] before a turning point: the drive turns there, since it brakes on the way
GROWING = 20  # rows at least while the velocity of the drive grows
LONGEST = 20  # the longest first period that is looked for, over rampTime() [-]
FRAMES = 200  # for ParaView along a history, beside those at its turning points and zeros
#: [mm] over which the force is averaged that decides on a collapse, but at least over the first
#: period, or over the longest that was looked for if none was found.
AVERAGED = 1.0
#: Path of the drive over that of the target whose displacement counts, at which a push is over [-].
UNFOLLOWED = 10
SUDDEN = 0.1  # loss of force over the peak, within 0.1 mm, that few bricks cause at once [-]
DAMPED = 0.1  # share of damping in what loops lose, above which it is a warning [-]


@dataclass
class Pushing:
    """What a push remembers. Pairs are of the negative and the positive side, positive outwards."""

    origin: list | None = None  # Loading.topDisplacement() when the push began [m]
    now: float = 0.0  # time of the last row [s]
    moved: float = 0.0  # displacement there [mm]
    passed: int = 0  # points of the history that lie behind
    last: float = 0.0  # displacement of the last of them [mm]
    start: float = 0.0  # when it began, if it counts from an earlier push [mm]
    path: float = 0.0  # length of the path to the last point [mm]
    driven: float = 0.0  # what the drive has gone, to and fro [mm]
    period: float = 0.0  # the first one when the push began [s]; 0 if none was found
    slowest: float = 0.0  # that period, or the longest that was looked for [s]
    places: list = field(default_factory=list)  # of the blocks then, while it grows [m]
    turned: bool = False  # whether the drive has turned since the push began
    moving: bool = False  # whether the last push still moved the structure when this one began
    since: float = 0.0  # time from which the velocity grows [s]
    growth: float = 0.0  # velocity then, in the present direction, over the full one [-]
    #: Time [s] and base shear [kN] of the last rows, over which AVERAGED takes the mean.
    recent: Sequence[Sequence[float]] = ()
    peaks: Sequence[float] = (0.0, 0.0)  # largest mean so far [kN]
    peaksAt: Sequence[float] = (0.0, 0.0)  # displacement there [mm]
    reach: Sequence[float] = (0.0, 0.0)  # farthest turning point so far [mm]
    nextFrame: float = 0.0  # length of the path up to the next ParaView frame [mm]
    farthest: float = 0.0  # displacement since it turned [mm]
    drivenTo: float = 0.0  # what the drive had gone then [mm]
    turnedBack: bool = False  # whether the wall has not been farther for long

    def travelled(self, direction):
        """Length of the path so far [mm]."""
        return self.path + direction * (self.moved - self.last)

    def note(self, shear, span):
        """Keep the peaks, with the base shear of the last row [kN]. Returns its mean over a time
        [s], or None before that is over: a vibration dips below any share of its peak, and a spike
        when the drive begins is no strength."""
        over = [one for one in self.recent if one[0] <= self.now - span]
        self.recent = [*over[-1:], *self.recent[len(over) :], [self.now, shear]]
        if not over:
            return None
        mean = sum(force for _, force in self.recent) / len(self.recent)
        side = mean > 0
        if abs(mean) > self.peaks[side]:
            self.peaks = _exchanged(self.peaks, side, abs(mean))
            outwards = self.moved if side else -self.moved
            self.peaksAt = _exchanged(self.peaksAt, side, outwards)
        return mean

    def turnsBack(self, goal):
        """Whether the drive has gone as far as the whole present path, and :data:`AVERAGED` at
        least, since the wall was farthest on it, for the first time."""
        if goal.direction * (self.moved - self.farthest) > 0:
            self.farthest, self.drivenTo = self.moved, self.driven
        length = max(AVERAGED, abs(goal.displacement - self.last))
        back = self.driven - self.drivenTo > length and not self.turnedBack
        self.turnedBack = self.turnedBack or back
        return back

    def retreats(self, direction, whole):
        """Whether the wall is a tenth of the whole path [mm], and 1 mm at least, behind where it
        turned or began."""
        return self.path - self.travelled(direction) > max(1.0, 0.1 * whole)

    def hasLost(self, direction, shear, top):
        """Whether the wall is farther out than ever before, a millimetre beyond the peak, and both
        the mean base shear and the present force of the drive [kN] are below a fifth of it. A slow
        wave can take the base alone below any share of a peak. A force that has not pointed to this
        side yet, as of a cycle that begins aside, has no peak to lose."""
        side, out = direction > 0, direction * self.moved
        if not self.peaks[side]:
            return False
        if shear is None or out <= max(self.reach[side], self.peaksAt[side] + 1):
            return False
        return max(direction * shear, direction * top) < 0.2 * self.peaks[side]

    def passOn(self, goals):
        """Go on to the next point of the path. Returns whether there is one, and whether the drive
        turns."""
        turned = False
        while True:
            goal = goals[self.passed]
            brake = math.inf if goal.brake is None else goal.brake
            near = abs(brake - goal.displacement) <= ARRIVED
            missing = goal.direction * (goal.displacement - self.moved)
            if missing > (ARRIVED if near else 0):
                return True, turned
            if self.passed + 1 == len(goals):
                return False, turned
            self.path += abs(goal.displacement - self.last)
            self.passed, self.last = self.passed + 1, goal.displacement
            if goals[self.passed].direction != goal.direction:
                side, out = goal.direction > 0, goal.direction * goal.displacement
                self.reach = _exchanged(self.reach, side, max(self.reach[side], out))
                self.growth, turned, self.turned = -self.growth, True, True
                self.farthest, self.drivenTo = self.moved, self.driven


def _exchanged(pair, side, value):
    """A pair with another value on one side; a checkpoint may hold the old pair."""
    return [pair[0], value] if side else [value, pair[1]]


def drivePush(scene, name, args, began, continued=False, held=False):
    """Drive the pushed target to ``--until`` or along ``--history``, with rows and frames.

    The velocity grows evenly from rest to ``--rate`` within one first period of the structure,
    which is measured then, so that no swing of that period is left. If not all blocks are driven,
    nothing is damped while it grows: numerical damping would act as more mass. Where the history
    turns, and where a push follows another one without rest, the velocity changes within whole
    periods, :func:`rampTime` at least, because open joints make periods longer. Where no period is
    found both take :func:`rampTime`. The drive brakes by the displacement of curve.csv, so the wall
    turns within 0.01 mm of the turning points. Other points are passed at full speed, and so is the
    end, unless it is that of a file.

    Where the drive is slower, the time between rows is the same or less. Frames of a history are
    also at its turning points and zeros, unless the frame before is less than half of their spacing
    away. A wall has collapsed as :func:`_lost` says.

    :param args: the options of the run, with the ``until``, ``history`` and ``rate`` of this push
    :param began: name under which the run keeps where the push began
    :param continued: whether displacements count from there
    :param held: whether the drive of a push before held the structure
    """
    run, model = scene.running, scene.model
    drive = model.loading.push
    at = run.stage(name, Pushing())
    goals = _entered(scene, name, args, at, began, continued, held)
    whole, spacing = pathOf(args, at.start), frameSpacing(args)
    every = max(1, int(rowSpacing(args) / (args.rate * O.dt)))

    def detail():
        until = "" if args.history else f" of {args.until:g}"
        path = f"{travelled:.1f} of {whole:g} mm, at " if args.history else ""
        return f"{path}{at.moved:6.2f}{until} mm  {shear:7.2f} kN"

    moves, undamped = True, None
    while moves:
        goal = goals[at.passed]
        model.loading.goal = at.passed + 1, goal.displacement
        growth, start, steps = _pace(at, goal, args, every)
        slow = at.turned or at.moving
        free = bool(at.period) and not slow and growth < 1 and not drive.damped
        if free != undamped:
            undamped = free
            model.scheme.damp(0.0, "local") if free else model.scheme.dampByOptions()
        full = goal.direction * args.rate * 1e-3  # [m/s]
        drive.velocity = full * growth
        # A velocity that grew in stairs would make the pushed block swing in time with them.
        if start < growth:
            drive.ramp = run.state.left or steps
            drive.acceleration = full * (growth - start) / (steps * O.dt)
        run.advance(steps)
        at.driven += 0.5 * args.rate * (abs(start) + abs(growth)) * steps * O.dt
        reading = run.record()
        before = at.moved
        at.now, at.moved = reading.time, 1e3 * reading.along
        if at.places and (growth == 1.0 or growth <= start):
            moved = model.loading.alongNow() - 1e-3 * at.start
            weight = model.motion.baseWeight(at.places, model.loading.direction, moved)
            _keepVibration(run, at.period, weight or 0.0, at.now)
            at.places = []
        shear, travelled = 1e-3 * reading.baseShear, at.travelled(goal.direction)
        mean = at.note(shear, max(at.slowest, AVERAGED / args.rate))
        how = _lost(model, at, reading, goal.direction, mean, whole)
        if args.history:
            at.since, at.growth = at.now, growth
        run.show(max(0, travelled / whole), detail)
        if at.turnsBack(goal):
            say(
                f"note: {name}: {model.loading.control.name}, whose displacement counts, turned"
                f" back at {at.farthest:.3g} mm, and the drive goes on, up to"
                f" {UNFOLLOWED * whole:g} mm; another control= may say more"
            )
        moves, turned = at.passOn(goals)
        moves = moves and not how
        early = args.history and (turned or before * at.moved < 0)
        if moves and travelled >= at.nextFrame - (spacing / 2 if early else 0):
            run.frame()
            at.nextFrame = (travelled if early else at.nextFrame) + spacing
    run.show(1, detail, final=True)
    run.flush()
    if how:
        raise Collapsed(f"at {at.moved:.2f} mm {how}")


def _entered(scene, name, args, at, began, continued, held):
    """Begin a push, with its first row, frame and period, or go on with it. Returns the points of
    its path. Parameters as in :func:`drivePush`."""
    run, model = scene.running, scene.model
    first, origin = at.origin is None, at.origin
    if first:
        here = [*model.loading.topDisplacement(), model.loading.level()]
        origin = run.state.origins[began] if continued else here
        at.moved = at.last = at.start = at.farthest = 1e3 * (here[0] - origin[0])
    if not args.history and not args.until > at.moved:
        raise Refused(
            f"{name}: until {args.until:g} mm (--until {args.until:g}): the run is at"
            f" {at.moved:.2f} mm already"
        )
    goals = aim(args, at.start)
    if at.passed >= len(goals):
        raise NotResumed(f"--resume: its history has {at.passed} points and more")
    model.loading.goal = at.passed + 1, goals[at.passed].displacement
    model.loading.origin = at.origin = origin
    if first:
        run.state.origins = {**run.state.origins, began: origin}
        at.now = at.since = O.time
        missing, moving = model.supports.unrest()
        at.moving = held and (missing > REST or moving > REST_ENERGY_RATIO)
        at.moved = 1e3 * run.record().along
        run.frame()
        # a push that is shorter than its first period is no slow one
        longest = min(LONGEST * rampTime(args), pathOf(args, at.start) / args.rate)
        at.period = _measuredPeriod(scene, name, args, longest)
        at.slowest = at.period or longest
        at.places = model.motion.positions() if at.period else []
        _keepVibration(run, at.period, 0.0, 0.0)
        at.nextFrame = frameSpacing(args)
    return goals


def _lost(model, at, reading, direction, mean, whole):
    """Why a wall has collapsed, or None, by its mean base shear (:meth:`Pushing.note`) [kN] and the
    length of the whole path [mm]."""
    loading = model.loading
    if at.hasLost(direction, mean, 1e-3 * reading.topShear):
        return "less than a fifth of the peak of its force is left"
    if loading.hasSunk(loading.origin[3], reading.along * loading.direction[2]):
        return "the pushed point has come down by half a course"
    if at.driven > UNFOLLOWED * whole:
        return (
            f"another part gives way: the drive has gone {at.driven:.0f} mm, and"
            f" {loading.control.name}, which was at {at.farthest:.3g} mm, has not followed"
        )
    return "it moves against its push" if at.retreats(direction, whole) else None


def _measuredPeriod(scene, name, args, longest):
    """The first period along a push [s]; 0 with a note if none up to the longest is found [s]."""
    run, loading = scene.running, scene.model.loading
    # a drive of all blocks would hold the momentum by which the period is found
    loading.push.driven = not loading.push.damped
    try:
        with run.clock("setup"), run.breakable():
            period = firstPeriod(scene.model, loading.direction, longest)
    finally:
        loading.push.driven = True
    slower = args.density_scaling**0.5
    held = "" if loading.push.damped else " while the drive holds"
    if period:
        say(f"{name}: first period along it{held} {1e3 * period / slower:.3g} ms")
        return period
    say(
        f"note: {name}: no first period up to {1e3 * longest / slower:.3g} ms was found; the drive"
        f" gets to its rate within {1e3 * rampTime(args) / slower:.3g} ms"
    )
    return 0.0


def _keepVibration(run, *values):
    """Keep the values of RunState.freeVibrations."""
    run.state.freeVibrations = {**run.state.freeVibrations, str(run.entered): [*values]}


def _rampOf(at, args, every, turns):
    """Time in which the velocity of the drive grows from 0 to the full one [s], and steps of a row
    then.

    :param every: steps of a row at full speed
    :param turns: whether the drive turns, or begins on what still moves
    """
    least = rampTime(args)
    if not at.period:
        return least, every
    ramp = at.period * (math.ceil(least / at.period) if turns else 1)
    every = max(1, min(every, int(ramp / (GROWING * O.dt))))
    row = every * O.dt
    return row * max(1, round(ramp / row)), every


def _pace(at, goal, args, every):
    """Velocities of the drive at the end and at the beginning of the next row, over the full one,
    and the steps of the row. Parameters as in :func:`_rampOf`.

    The velocity grows evenly, but can be braked before the next turn: at most √(2·a·s) at the
    distance s with the deceleration a.
    """
    growing, closer = _rampOf(at, args, every, at.turned or at.moving)
    braking, _ = _rampOf(at, args, every, True)
    start = _sum(at.growth, (at.now - at.since) / growing)
    row = every if start == 1.0 else closer
    growth = _sum(start, row * O.dt / growing)
    if goal.brake is None:
        return growth, start, row
    distance = max(0.0, goal.direction * (goal.brake - at.moved))
    slow = math.sqrt(2 * distance / (args.rate * braking))
    if slow < growth:
        start = growth = slow
    if growth > 0:
        row = max(1, min(row, int(distance / (args.rate * growth * O.dt))))
    return growth, start, row


def _sum(growth, more):
    """A velocity over the full one that has grown, exactly 1 after the sum of equal parts."""
    grown = growth + more
    return 1.0 if grown > 1 - 1e-9 else grown


def pathOf(args, start=0.0):
    """Length of the path of the drive from a displacement on, there and back [mm]."""
    points = args.history["points_mm"] if args.history else [args.until]
    return pathLength(points, start)


def rowSpacing(args):
    """Displacement between rows at full speed [mm]: :data:`ROW_EVERY`, or a twentieth of a shorter
    push."""
    return ROW_EVERY if args.history or args.until >= SHORT else args.until / 20


def rowCount(args):
    """Number of rows of a push, about. A turn takes as long as the path at full speed in a ramp."""
    turning = turns(args.history["points_mm"]) if args.history else 0
    return (pathOf(args) + turning * args.rate * rampTime(args)) / rowSpacing(args)


def frameSpacing(args):
    """Length of the path between ParaView frames, which is at least ``--vtk-every`` [mm]."""
    return max(args.vtk_every, pathOf(args) / FRAMES if args.history else 0)


def tooFast(args, imbalance, stage=""):
    """The warning of a push that is too fast, with a remedy: the imbalance grows with the rate.

    :param args: options of the last push
    :param stage: name of an earlier push, whose rate may be another; empty: the last push
    """
    slower = f"--rate {float(f'{args.rate * IMBALANCE / imbalance:.2g}'):g}"
    if stage:
        slower = f"{IMBALANCE / imbalance:.2g} of its rate"
    cure = "--damping-kind combined" if args.damping_kind == "local" else slower
    # If the step is 1/√2 of the limit without damping, the stiffest joints swing in four steps.
    # Combined damping then finds the same signs in every swing, and can brake a steady motion.
    default, fours = USUAL["dt_fraction"], 0.7 * math.sqrt(1 + args.damping)
    if args.dt_fraction > max(fours, default):
        cure = f"--dt-fraction {default:g}"
    return (
        f"{stage or 'the push'} is too fast: {100 * imbalance:.0f} % of the force does not reach"
        f" the supports, more than {100 * IMBALANCE:.0f} % spoil the peak; {cure} would do"
    )


def tooDamped(args, share):
    """The warning of loops that lose much by damping, which grows with the rate."""
    slower = float(f"{args.rate * DAMPED / share:.2g}")
    return (
        f"damping, not the wall, took {100 * share:.0f} % of what the loops lost; more than "
        f"{100 * DAMPED:.0f} % spoil the work of the cycles; try --rate {slower:g}"
    )


def tooSudden(args, loss, at):
    """The warning of a push whose force falls at once, by a share of its peak at a displacement
    [mm]."""
    check = "--preset accurate" if args.blocks == "rigid" else "--dt-fraction 0.78"
    return (
        f"the force fell by {100 * loss:.0f} % of its peak within {curves.SUDDEN:g} mm at"
        f" {at:.2f} mm: a few bricks gave way at once, and which ones can depend on the block"
        f" model, the points of joints and the time step; {check} is the cheapest check"
    )
