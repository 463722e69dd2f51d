# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads that grow until the structure falls, and the search for the load that it holds.

A structure under a growing load falls late: it must first move. It also begins to move early, where
joints give way little by little. So the run finds by trials what it carries. During the growth it
keeps states to go back to. It then restores one of these states, keeps the load constant, and waits
for rest: the load is held if the structure comes to rest under it. Between the largest load that
was held and the smallest that was not it goes on in halves, from the state at rest under the first.
A load that is put on in a large step can throw a structure over that would hold it. So at the end
the load that was not held is tried again from the state at rest just below it, if that was not its
trial already. If it is held now, the search goes on above it. So it matters neither how fast the
load grew, nor which loads were tried.

A perfectly symmetric structure comes to rest under loads far above that at which it buckles. So the
largest load that was held is checked with a small push to the side
(:func:`masonry.model.period.buckles`). A load that a long trial held is checked at once, and so is
the state at rest from which a long trial began. If the push grows, the load is not held. The search
then begins again at the states at rest below it, and every later trial is checked so.
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
from ..model.motion import FALLEN
from ..errors import Collapsed
from ..run.checkpoints import record
from ..terminal import say
from .rest import EVERY, WAITED, Waiting, buckles, growthTime
from .answers import AT_REST, DONE, Answer
from .stage import Timed, timed

WITHIN = 0.005  # width of the bracket, over its upper end [-]
#: Share of the whole growth: below it the bracket is as wide as there.
LEAST = 0.05
#: [s] in the scene after which a trial is given up, or later on soft springs, and while the motion
#: dies away
TRIAL = 4.0
MOST_KEPT, LEAST_KEPT = 128, 8  # states that are kept during a growth
#: Of all of them, and of all states at rest; checkpoints of the growth and the search have both.
KEPT_BYTES = 100e6
#: A trial is not held as soon as a block has moved as far as one that has fallen, has at least this
#: share of its speed [-], and is twice as fast as the fastest one in the first half of the trial
#: (:meth:`masonry.model.motion.Motion.fastest`). Blocks at a crack that opens suddenly can be as
#: fast, but have not moved so far.
SURE = 0.25
BOUND_SHARE = 0.95  # of an exact bound: when less is held, a note says so
ARCHING = 0.05  # share of the load from which a note says that supports carry a thrust [-]
SETTING_OFF = 3.0  # the structure has left rest where its speed is so many times the usual one [-]


class Reason(StrEnum):
    """Why a load is not held."""

    FELL = "it fell"
    ACCELERATED = "it moved faster and faster"
    MOVING = "its motion did not die away"
    BUCKLES = "it buckles: a small push sideways grows"


@dataclass
class Tried:
    """A load that was tried."""

    factor: float = 0.0
    displacement: float = 0.0  # along the load [mm]
    #: of a load that was held: :meth:`masonry.model.restraints.Supports.arching`
    arching: Sequence[float] = (0.0, 0.0)


@dataclass
class Failure(Tried):
    """A load that was not held."""

    #: Factor of the state at rest from which its trial began; below 0 if that was none.
    source: float = -1.0
    reason: Reason = Reason.FELL

    def __post_init__(self):
        self.reason = Reason(self.reason)  # a checkpoint has its text


@dataclass
class Trial(Waiting):
    """A trial that is going on."""

    source: float = 0.0  # factor of the state from which it begins
    factor: float = 0.0
    fromRest: bool = False  # whether that state is at rest
    speeds: Sequence[float] = ()  # Motion.fastest after 1, 2, 4, ... checks [-]

    @property
    def isLong(self):
        """Whether it began at rest, and half of the time for which it waits at least is over."""
        return self.fromRest and self.halves > 0


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
    since: int = 0  # how many of them were made before the search began again
    #: Of all loads that were held, growing: the factor, the displacement [mm], and the state at
    #: rest under it, as text.
    rests: Sequence[Any] = ()
    arching: Sequence[Any] = ()  # of these loads: the factor, and as in Tried
    steady: float = -1.0  # the largest of them that was seen not to buckle
    failure: Failure | None = record(Failure)  # the smallest load that was not held
    #: Trials above a load that was not held first, but is held from the state at rest below it.
    climbs: int = 0
    trial: Trial | None = record(Trial)

    @property
    def held(self):
        """The largest load that was held, or None."""
        if not self.rests:
            return None
        factor, moved, _ = self.rests[-1]
        found = (values for at, *values in reversed(self.arching) if at == factor)
        return Tried(factor, moved, next(found, (0.0, 0.0)))


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
    supports, thrust = scene.model.supports, f"{name}: thrust"
    if name not in origins:
        before = [*supports.alongWall(load.towards)]
        scene.running.state.origins = origins = {**origins, name: origin, thrust: before}
    supports.unloaded = origins[thrust]


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
    thrust, share = held.arching if held else (0.0, 0.0)
    if share < ARCHING:
        return
    how = "reactions along the wall, which came with the load, of held bricks at its two ends"
    yield Answer("thrust_held", "kN", thrust, f"{how}, at rest")
    how = "thrust times its largest rise over the moment of the whole load on the span, 8 N r/(F L)"
    yield Answer("arching_share_held", "-", share, how)
    if not scene.bracketing:
        say(
            f"note: what is held along the wall at its ends carries a thrust of {thrust:.3g} kN:"
            f" arching and clamping between abutments give up to {100 * share:.0f} % of the load"
            ' that is held; hold(brick, axes="y") holds an edge of a wall along x out of its plane'
            " alone"
        )


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
            if reason is Reason.BUCKLES:
                self._beginBelow()
                continue
            factor, isLong = at.trial.factor, at.trial.isLong
            if reason is None and at.buckled and self._buckles(factor):
                reason = Reason.BUCKLES
            self._note(reason)
            if reason is None and isLong and factor > at.steady and self._buckles(factor):
                self._beginBelow()

    def end(self):
        """Take the scene to where the stage ends, and return how it ended."""
        at, running = self.at, self.running
        stands = not at.fell and at.failure is None and at.held
        at.rests = at.rests[-1:]
        if at.held:
            self.model.atRest = base64.b64decode(at.rests[-1][2])
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
        if at.held is None or at.buckled or at.held.factor <= at.steady:
            return False
        _load(at.rests[-1][2])
        return self._buckles(at.held.factor) and self._beginBelow()

    def _beginBelow(self):
        """Begin again below the largest load that was held, which buckles: at the largest one under
        which the state at rest does not. Returns whether there is a trial."""
        at = self.at
        low = sum(factor <= at.steady for factor, _, _ in at.rests) - 1
        high = len(at.rests) - 1
        while high - low > 1:
            middle = (low + high) // 2
            factor, _, state = at.rests[middle]
            _load(state)
            if self._buckles(factor):
                high = middle
            else:
                low = middle
        at.failure = Failure(*at.rests[high][:2], reason=Reason.BUCKLES)
        at.rests, at.trial = at.rests[: low + 1], None
        at.buckled, at.climbs, at.since = True, 0, len(at.tried)
        does = f", {at.held.factor:.4g} does not" if at.held else ""
        self._say(
            f"{at.failure.factor:.4g} is held, but buckles: a small push sideways grows{does}; the"
            " search begins again below it"
        )
        return self._choose()

    def _choose(self):
        """As :meth:`_begin`, before the load that was held is checked for buckling."""
        at, held = self.at, self.at.held
        if not at.tried and not at.fell:
            return self._start(Trial(source=at.last, factor=at.last))  # the structure still stands
        if not at.fell and held and held.factor >= at.last:
            return False
        if at.climbs and at.failure is None:
            most = self.load.factor(1.0)
            goal = min(held.factor * (1 + self.within * 2**at.climbs), most)
            return held.factor < most and self._startFromRest(goal)
        index = None if at.climbs or held and at.buckled else self._ofGrowth()
        if index is not None:
            factor, state = at.kept[index]
            return self._start(Trial(source=factor, factor=factor), state)
        if held is None:
            return False
        if at.failure is None:
            _load(at.lastState)
            at.failure = Failure(at.last, 1e3 * self.model.loading.alongNow())
        lost = at.failure.factor
        if lost - held.factor > self.within * max(lost, LEAST * at.last):
            return self._startFromRest(0.5 * (held.factor + lost))
        final = at.failure.reason is Reason.BUCKLES or at.failure.source == held.factor
        return not final and self._startFromRest(lost)

    def _start(self, trial, state=None):
        """Begin a trial from a state, or from the present one. Returns True."""
        self.at.trial = trial
        if state is not None:
            _load(state)
        return True

    def _startFromRest(self, factor):
        """Begin a trial from the state at rest under the load that was held. Returns True."""
        source, _, state = self.at.rests[-1]
        return self._start(Trial(source=source, factor=factor, fromRest=True), state)

    def _ofGrowth(self):
        """Number of the kept state from which the next trial begins, or None if there is none
        between the ends of the bracket."""
        at = self.at
        factors = [factor for factor, _ in at.kept]
        step = 2 ** max(0, len(at.tried) - at.since - 1)
        # numbers of the last state up to what was held, and of the first from what was not
        low = at.held and bisect.bisect_right(factors, at.held.factor) - 1
        high = sum(not at.failure or factor < at.failure.factor for factor in factors)
        if low is None:
            return max(0, min(self._guess(factors), high - step)) if high else None
        if at.failure is None:
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

    def _buckles(self, factor):
        """Whether the structure buckles in its present state, at rest under a load."""
        if buckles(self.scene):
            return True
        self.at.steady = max(self.at.steady, factor)
        return False

    def _sourceBuckles(self):
        """Whether the state at rest from which the trial began buckles."""
        at, now = self.at, _present()
        _load(at.rests[-1][2])
        found = self._buckles(at.trial.source)
        _load(now)
        return found

    def _say(self, what):
        say(f"{self.running.state.stage}: {what}")

    # -- a trial -----------------------------------------------------------------------------------

    def _wait(self):
        """Hold the load of the trial, and wait. Returns None if the structure came to rest under
        it, else why it is not held; ``BUCKLES`` if the state at rest from which it began does."""
        at, trial, scene, model = self.at, self.at.trial, self.scene, self.model
        slowest = model.supports.slowest()
        growing = max(1, int(max(growthTime(scene), slowest) / O.dt))
        longest = max(TRIAL * scene.args.density_scaling**0.5, WAITED * slowest)
        while True:
            x = min(1.0, (trial.done + EVERY) / growing)
            factor = trial.source + smooth(x) * (trial.factor - trial.source)
            self.load.put(self.load.at(at.begun, self.load.shareOf(factor)))
            model.loading.loadFactor = factor
            try:
                self.running.advance(EVERY)
                trial.done += EVERY
                model.motion.checkFall()
            except Collapsed:
                return Reason.FELL
            # what is soft needs time to move away
            isGrown = x == 1 and trial.done >= growing + slowest / O.dt
            if trial.isAtRest(*model.supports.unrest(), isGrown):
                return None
            if self._accelerates(model.motion.fastest(FALLEN)):
                return Reason.ACCELERATED
            if trial.isGivenUp(longest):
                return Reason.MOVING
            if trial.isLong and trial.source > at.steady and self._sourceBuckles():
                return Reason.BUCKLES

    def _accelerates(self, speed):
        """Whether the fastest block is fast, and twice as fast as in the first half of the wait."""
        trial = self.at.trial
        checks = trial.done // EVERY
        if checks & (checks - 1) == 0:
            trial.speeds = [*trial.speeds, speed]
        before = trial.speeds[max(0, checks.bit_length() - 2)]
        return checks > 8 and speed > SURE and speed > 2 * before

    def _note(self, reason):
        """Keep how the trial ended: None if its load was held."""
        at, trial = self.at, self.at.trial
        end = trial.factor, 1e3 * self.model.loading.alongNow()
        at.tried, at.trial = [*at.tried, trial.factor], None
        detail = f"trial {len(at.tried)}: {trial.factor:.4g} "
        if reason is None:
            state = _present()
            most = max(LEAST_KEPT, int(KEPT_BYTES / len(state)))
            at.rests = [*at.rests, [*end, state]][-most:]
            arching = self.model.supports.arching(self.load.towards)
            at.arching = [*at.arching, [trial.factor, *arching]]
            at.climbs += bool(at.climbs)
            isRefuted = at.failure and trial.factor >= at.failure.factor
            if isRefuted:
                at.failure, at.climbs = None, 1
            detail += "held" + (f", {at.failure.factor:.4g} not" if at.failure else "")
        else:
            isRefuted = False
            if at.failure is None or trial.factor < at.failure.factor or trial.fromRest:
                source = trial.source if trial.fromRest else -1.0
                at.failure = Failure(*end, source=source, reason=reason)
            detail += f"not held ({reason})"
            detail += f", {at.held.factor:.4g} held" if at.held else ""
        self.running.show(1, lambda: detail, True)
        if isRefuted:
            self._say(
                f"{trial.factor:.4g} was not held in a larger step of the load, but is held from"
                " the state at rest just below it; the search goes on above it"
            )
