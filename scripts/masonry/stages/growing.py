# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads that grow until the structure falls, and the search for the load that it holds.

A structure under a growing load falls late: it must first move. It also begins to move early, where
joints give way little by little. So the run finds by trials what it carries. During the growth it
keeps states to go back to. It then restores one of these states, keeps the load constant, and waits
for rest: the load is held if the structure comes to rest under it. Between the largest load that
was held and the smallest that was not it goes on in halves, from the state at rest under the first.
At the end the load that was not held is tried once more from that state, in which nothing moves: so
it does not matter how fast the load grew.

A perfectly symmetric structure comes to rest under loads far above that at which it buckles. So the
largest load that was held is checked with a small push to the side
(:func:`masonry.model.period.buckles`). If that grows, the load is not held, and every later
trial is checked so.
"""

import base64
import bisect
import statistics
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Sequence

from yade import O

from .._masonry import loadScene, saveScene
from ..model.loading import smooth
from ..model.motion import FALLEN, REST
from ..errors import Collapsed
from ..run.checkpoints import record
from ..terminal import say
from .rest import CONSECUTIVE_CHECKS, EVERY, REST_ENERGY_RATIO, WAITED, buckles, growthTime
from .answers import AT_REST, DONE, Answer
from .stage import Timed, timed

WITHIN = 0.005  # width of the bracket, over its upper end [-]
#: Share of the whole growth: below it the bracket is as wide as there.
LEAST = 0.05
#: [s] in the scene after which a trial is given up, or later on soft springs
TRIAL = 4.0
MOST_KEPT, LEAST_KEPT = 128, 8  # states that are kept during a growth
KEPT_BYTES = 100e6  # of all of them, which checkpoints of the growth and the search have
#: A trial is not held as soon as a block has moved as far as one that has fallen, has at least this
#: share of its speed [-], and is twice as fast as the fastest one in the first half of the trial
#: (:meth:`masonry.model.motion.Motion.fastest`). Blocks at a crack that opens suddenly can be as
#: fast, but have not moved so far.
SURE = 0.25
BOUND_SHARE = 0.95  # of an exact bound: when less is held, a note says so
SETTING_OFF = 3.0  # the structure has left rest where its speed is so many times the usual one [-]


class Reason(StrEnum):
    """Why a load is not held."""

    FELL = "it fell"
    ACCELERATED = "it moved faster and faster"
    MOVING = "it was still moving when the trial ended"
    BUCKLES = "it buckles: a small push sideways grows"


@dataclass
class Tried:
    """A load that was tried."""

    factor: float = 0.0
    displacement: float = 0.0  # along the load [mm]


@dataclass
class Failure(Tried):
    """A load that was not held."""

    fromRest: bool = False  # whether its trial began at rest
    reason: Reason = Reason.FELL

    def __post_init__(self):
        self.reason = Reason(self.reason)  # a checkpoint has its text


@dataclass
class Trial:
    """A trial that is going on."""

    source: float = 0.0  # factor of the state from which it begins
    factor: float = 0.0
    fromRest: bool = False  # whether that state is at rest
    steps: int = 0  # so far
    quiet: int = 0  # checks that found the structure at rest, one after the other
    speeds: Sequence[float] = ()  # Motion.fastest after 1, 2, 4, ... checks [-]


@dataclass
class Growing(Timed):
    """What a stage remembers in which a load grows."""

    begun: list | None = None  # the load when the stage began
    #: Of every row so far: time [s], load factor [-], and how fast the fastest block was over one
    #: that has fallen [-].
    rows: Sequence[Any] = ()
    kept: Sequence[Any] = ()  # pairs of load factor and state, as text
    spacing: int = 1  # rows from one kept state to the next
    fell: str = ""  # how the structure fell
    last: float = -1.0  # factor at the end of the growth, or below 0 before that [-]
    lastState: str = ""  # the state then, as text
    # -- of the search
    finished: bool = False
    #: Whether the largest load that was held was seen to buckle; from then on every trial is
    #: checked so.
    buckled: bool = False
    tried: Sequence[float] = ()  # factors of all trials so far
    held: Tried | None = record(Tried)  # the largest load that was held
    heldState: str = ""  # at rest under it
    failure: Failure | None = record(Failure)  # the smallest load that was not
    #: Trials above a load that was not held when it grew, but is held from rest.
    climbs: int = 0
    trial: Trial | None = record(Trial)


def grow(scene, name, load, duration, within=WITHIN):
    """Let a :class:`~masonry.stages.gravity.Acting` grow evenly until the structure falls or
    it has its whole, then search for the one that is held.

    :param duration: [s], with true masses
    :param within: width of the bracket, over its upper end [-]
    """
    if scene.limitAnalysisOnly:
        return DONE
    running, scene.loadUnit = scene.running, load.unit
    running.note("growth", load.name)
    follow(scene, f"stage {running.entered + 1}", load)
    _noteDrives(scene, name)
    at = running.stage(name, Growing())
    if at.begun is None:
        at.begun = load.now()
    if at.last < 0:
        _Growth(scene, at, load, duration).run()
    within = within if scene.share == 1 else max(within, 0.5)
    search = _Search(scene, at, load, within)
    search.run()
    if at.held:
        scene.bounds.take(True)
        scene.bounds.hold(load.name, at.held.factor)
        _compare(scene, name, load, at)
    if at.failure and at.held:
        unit = "" if load.unit == "-" else f" {load.unit}"
        say(
            f"{name}: held at {at.held.factor:.5g}{unit}, not held at"
            f" {at.failure.factor:.5g}{unit} ({at.failure.reason})"
        )
    return search.end()


def _noteDrives(scene, name):
    """Say which bricks a push has left under its drive."""
    for target in scene.targets.values():
        along = [a for a in "xyz" if scene.model.loading.pushOf(target, a)]
        if along and target.brick is not None:
            say(
                f"note: {name}: the drive of a push holds {target.name} along {', '.join(along)},"
                " without numerical damping, so trials may come to rest late or not at all;"
                f" release({target.name}, {''.join(along)!r}) lets it go"
            )


def _compare(scene, name, load, at):
    """Say if much less is held than rigid blocks would carry."""
    entry = scene.bounds.entries.get(load.name, {})
    if at.failure and entry.get("exact") and at.held.factor < BOUND_SHARE * entry["factor"]:
        less = 100 * (1 - at.held.factor / entry["factor"])
        say(
            f"note: {name}: rigid blocks would carry {entry['factor']:.4g}, and the run held"
            f" {less:.0f} % less: joints that are soft let the structure lean before it falls. Try"
            " stiffer joints (normalStiffness), and more points (--points)"
        )


def follow(scene, name, load):
    """From now on record the displacement of what is watched along a load, from where it was when
    that began; the run keeps this under a name."""
    target, origins = scene.description.followed(load.target), scene.running.state.origins
    origin = scene.model.loading.follow(target, load.towards, origins.get(name))
    if target and name not in origins:
        scene.running.state.origins = {**origins, name: origin}


def found(scene, rows):
    """The largest load that was held when a load grew, and the smallest that was not."""
    at = scene.running.memory
    if not isinstance(at, Growing):
        return []
    what = (
        "trials of the run itself, each under a constant load from a state at rest or of the growth"
    )
    held = f"the largest load factor under which the structure came to rest; {what}"
    lost = f"the load ended at {at.last:.4g} while the structure stood"
    if at.held is None:
        held = "the structure came to rest under no load that was tried"
        if at.tried:
            held += f", of {len(at.tried)} from {min(at.tried):.4g} on"
    if at.failure:
        lost = (
            f"the smallest load factor under which it did not come to rest: {at.failure.reason};"
            f" {what}"
        )
    return ends(scene, at.held, held, at.failure, lost)


def ends(scene, held, whyHeld, failure, whyFailed):
    """The answers of a stage that looks for the load that is held.

    :param held: a :class:`Tried` that was held, or None; ``whyHeld``: how it was found, or why not
    :param failure: a :class:`Tried` that was not held, or None; ``whyFailed``: how it was found, or
        why not
    """
    target = scene.model.loading.followed
    for name, end, how, when in (
        ("held", held, whyHeld, "at rest"),
        ("not_held", failure, whyFailed, "when it was seen not to come to rest"),
    ):
        yield Answer(f"factor_{name}", scene.loadUnit, end.factor if end else None, how)
        if end and target:
            how = f"of {target.name} along the load since that began, {when}"
            yield Answer(f"displacement_{name}", "mm", end.displacement, how)


def _present():
    """The present state as text."""
    return base64.b64encode(saveScene("null")).decode()


def _load(text):
    loadScene(base64.b64decode(text))


class _Growth:
    """The growth of a load, with the states that are kept during it."""

    def __init__(self, scene, at, load, duration):
        self.scene, self.at, self.load = scene, at, load
        self.model = scene.model
        self.whole = duration * scene.args.density_scaling**0.5

    def run(self):
        """Let the load grow."""
        at, scene, model = self.at, self.scene, self.model
        if not at.kept:
            at.kept = [[0.0, _present()]]
        try:
            timed(scene, at, scene.share * self.whole, self._before, self._after)
            self._put(scene.share)
        except Collapsed as collapse:
            at.fell = str(collapse)
        at.last = model.loading.loadFactor
        try:
            at.lastState = _present()
        except ValueError:  # a number of what has fallen may no longer be finite
            at.lastState = at.kept[-1][1]

    def _before(self, done, beyond):
        self._put(min(1.0, 0.5 * (done + beyond) * O.dt / self.whole))

    def _put(self, share):
        self.load.put(self.load.at(self.at.begun, share))
        self.model.loading.loadFactor = self.load.factor(share)

    def _after(self):
        at, factor = self.at, self.model.loading.loadFactor
        # a checkpoint may hold the old lists
        at.rows = [*at.rows, [O.time, factor, self.model.motion.fastest()]]
        if len(at.rows) % at.spacing == 0:
            at.kept = [*at.kept, [factor, _present()]]
            most = KEPT_BYTES / len(at.kept[-1][1])
            if len(at.kept) > min(MOST_KEPT, max(LEAST_KEPT, most)):
                at.kept, at.spacing = at.kept[::2], 2 * at.spacing
        self.model.motion.checkFall()


class _Search:
    """The search for the largest load that is held, trial by trial."""

    def __init__(self, scene, at, load, within):
        self.scene, self.at, self.load, self.within = scene, at, load, within
        self.model, self.running = scene.model, scene.running

    def run(self):
        """Make trials until the bracket is narrow, or nothing is left to try."""
        at = self.at
        while not at.finished and (at.trial or self._begin()):
            reason = self._wait()
            if reason is None and at.buckled and self._buckles():
                reason = Reason.BUCKLES
            self._note(reason)

    def end(self):
        """Take the scene to where the stage ends, and return how it ended."""
        at, running = self.at, self.running
        stands = not at.fell and at.failure is None and at.held
        if at.held:
            self.model.atRest = base64.b64decode(at.heldState)
        if stands:
            if running.readings.time != O.time:
                running.record()
            running.flush()
        else:
            if not at.finished:
                _load(at.lastState)
            self.model.loading.loadFactor = at.last
        at.kept, at.lastState, at.finished = [], "", True
        if at.fell:
            raise Collapsed(at.fell)
        return AT_REST if stands else DONE

    # -- which trial comes next --------------------------------------------------------------------

    def _begin(self):
        """Begin the next trial. Returns whether there is one."""
        at = self.at
        if self._choose():
            return True
        if at.held is None or at.buckled or not self._buckles():
            return False
        at.buckled, at.climbs = True, 0
        at.failure = Failure(**vars(at.held), fromRest=True, reason=Reason.BUCKLES)
        at.held = None
        return self._choose()

    def _choose(self):
        """As :meth:`_begin`, before the load that was held is checked for buckling."""
        at, held = self.at, self.at.held
        if not at.tried and not at.fell:
            return self._start(Trial(at.last, at.last))  # the structure still stands
        if not at.fell and held and held.factor >= at.last:
            return False
        if at.climbs and at.failure is None:
            most = self.load.factor(1.0)
            goal = min(held.factor * (1 + self.within * 2**at.climbs), most)
            return held.factor < most and self._startFromRest(goal)
        index = None if at.climbs else self._ofGrowth()
        if index is not None:
            factor, state = at.kept[index]
            return self._start(Trial(factor, factor), state)
        if held is None:
            return False
        if at.failure is None:
            _load(at.lastState)
            at.failure = Failure(at.last, 1e3 * self.model.loading.alongNow())
        lost = at.failure.factor
        if lost - held.factor > self.within * max(lost, LEAST * at.last):
            return self._startFromRest(0.5 * (held.factor + lost))
        return not at.failure.fromRest and self._startFromRest(lost)

    def _start(self, trial, state=None):
        """Begin a trial from a state, or from the present one. Returns True."""
        self.at.trial = trial
        if state is not None:
            _load(state)
        return True

    def _startFromRest(self, factor):
        """Begin a trial from the state at rest under the load that was held. Returns True."""
        return self._start(Trial(self.at.held.factor, factor, True), self.at.heldState)

    def _ofGrowth(self):
        """Number of the kept state from which the next trial begins, or None if there is none
        between the ends of the bracket."""
        at = self.at
        factors, step = [factor for factor, _ in at.kept], 2 ** max(0, len(at.tried) - 1)
        # numbers of the last state up to what was held, and of the first from what was not
        low = at.held and bisect.bisect_right(factors, at.held.factor) - 1
        high = at.failure and sum(factor < at.failure.factor for factor in factors)
        if low is None and high is None:
            return self._guess(factors)
        if low is None:
            return max(0, high - step) if high else None
        if high is None:
            return min(len(factors) - 1, low + step) if low + 1 < len(factors) else None
        lost = at.failure.factor
        wide = lost - at.held.factor > self.within * lost
        return (low + high) // 2 if wide and low + 1 < high else None

    def _guess(self, factors):
        """Number of the last kept state before the structure leaves rest."""
        speeds = [speed for _, _, speed in self.at.rows]
        n = len(speeds) - 1
        while n > 0 and speeds[n] > SETTING_OFF * statistics.median(speeds[:n]):
            n -= 1
        reached = self.at.rows[n][1] if speeds else 0.0
        return max(0, bisect.bisect_right(factors, reached) - 1)

    def _buckles(self):
        """Whether the structure that is at rest under the load that was held last buckles."""
        if not self.at.trial:
            _load(self.at.heldState)
        return buckles(self.scene)

    # -- a trial -----------------------------------------------------------------------------------

    def _wait(self):
        """Hold the load of the trial, and wait. Returns None if the structure came to rest under
        it, else why it is not held."""
        at, trial, scene, model = self.at, self.at.trial, self.scene, self.model
        slowest = model.supports.slowest()
        growing = max(1, int(max(growthTime(scene), slowest) / O.dt))
        longest = max(TRIAL * scene.args.density_scaling**0.5, WAITED * slowest)
        most = int(longest / O.dt)
        while True:
            x = min(1.0, (trial.steps + EVERY) / growing)
            factor = trial.source + smooth(x) * (trial.factor - trial.source)
            self.load.put(self.load.at(at.begun, self.load.shareOf(factor)))
            model.loading.loadFactor = factor
            try:
                self.running.advance(EVERY)
                trial.steps += EVERY
                model.motion.checkFall()
            except Collapsed:
                return Reason.FELL
            missing, moving = model.supports.unrest()
            rests = missing < REST and moving < REST_ENERGY_RATIO and x == 1
            trial.quiet = trial.quiet + 1 if rests else 0
            if trial.quiet == CONSECUTIVE_CHECKS:
                return None
            if self._accelerates(model.motion.fastest(FALLEN)):
                return Reason.ACCELERATED
            if trial.steps >= most:
                return Reason.MOVING

    def _accelerates(self, speed):
        """Whether the fastest block is fast, and twice as fast as in the first half of the wait."""
        trial = self.at.trial
        checks = trial.steps // EVERY
        if checks & (checks - 1) == 0:
            trial.speeds = [*trial.speeds, speed]
        before = trial.speeds[max(0, checks.bit_length() - 2)]
        return checks > 8 and speed > SURE and speed > 2 * before

    def _note(self, reason):
        """Keep how the trial ended: None if its load was held."""
        at, trial = self.at, self.at.trial
        end = trial.factor, 1e3 * self.model.loading.alongNow()
        if reason is None:
            at.held, at.heldState = Tried(*end), _present()
            at.climbs += bool(at.climbs)
            if at.failure and trial.factor >= at.failure.factor:
                at.failure, at.climbs = None, 1
        elif at.failure is None or trial.factor < at.failure.factor or trial.fromRest:
            at.failure = Failure(*end, trial.fromRest, reason)
        at.tried, at.trial = [*at.tried, trial.factor], None
        ends = [f"held {at.held.factor:.4g}"] if at.held else []
        ends += [f"not held {at.failure.factor:.4g}"] if at.failure else []
        detail = f"trial {len(at.tried)}: {', '.join(ends)}"
        self.running.show(1, lambda: detail, True)
