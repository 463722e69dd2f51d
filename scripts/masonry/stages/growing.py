# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads that grow until the structure falls, and the search for the load that it holds.

A structure under a growing load falls late: it must first move. It also begins to move early, where
joints give way little by little. So the run finds by trials what it carries. During the growth it
keeps states to go back to. Then it takes such a state, leaves the load as it is, and waits: the
load is held if the structure comes to rest under it. Between the largest load that was held and the
smallest that was not it goes on in halves, from the state at rest under the first. At the end the
load that was not held is tried once more from that state, in which nothing moves: so it does not
matter how fast the load grew.

A perfectly symmetric structure comes to rest under loads far above that at which it buckles. So the
largest load that was held is looked at with a small push to the side
(:func:`masonry.model.period.buckles`). If that grows, the load is not held, and every later
trial is looked at so.
"""

import base64
import bisect
import statistics
from dataclasses import dataclass
from typing import Any, Sequence

from yade import O

from .._masonry import loadScene, saveScene
from ..model.loading import smooth
from ..model.motion import FALLEN, REST
from ..errors import Collapsed
from ..terminal import say
from .rest import CALM, EVERY, LOOKS, WAITED, buckles, growthTime
from .answers import AT_REST, DONE, Answer
from .stage import Timed, timed

WITHIN = 0.005  # width of the bracket, over its upper end [-]
# of the whole growth: the width of a bracket below this load is that of a bracket at it [-]
LEAST = 0.05
#: [s] in the scene after which a trial is given up, or later on soft springs
TRIAL = 4.0
MOST_KEPT, LEAST_KEPT = 128, 8  # states that are kept during a growth
KEPT_BYTES = (
    100e6  # that they may have in all; a checkpoint during the growth or the search has them
)
#: A trial is not held as soon as a block has moved as far as one that has fallen, has at least this
#: share of its speed [-], and is twice as fast as the fastest one in the first half of the trial
#: (:meth:`masonry.model.motion.Motion.fastest`). Blocks at a crack that opens suddenly can be as
#: fast, but have not moved so far.
SURE = 0.25
#: How trials end that are not held.
WHY = (
    "it fell",
    "it moved faster and faster",
    "it was still moving when the trial ended",
    "it buckles: a small push sideways grows",
)
FAR = 0.95  # of an exact bound: when less is held, a note says so
SETTING_OFF = 3.0  # the structure has left rest where its speed is so many times the usual one [-]


@dataclass
class Growing(Timed):
    """What a stage remembers in which a load grows. A trial is a pair: the factor, and 1 if it was
    held, else 0."""

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
    over: int = 0  # 1 when it has ended, and only the last state at rest is kept
    #: 1 when the largest load that was held was seen to buckle; from then on every trial is looked
    #: at so.
    buckled: int = 0
    trials: Sequence[Any] = ()
    # factor and displacement [mm] of the largest load that was held
    held: list | None = None
    #: Of the smallest that was not, 1 if that trial began at rest, else 0, and how it ended: a
    #: number of WHY.
    lost: list | None = None
    #: Trials above a load that was not held when it grew, but is held from rest.
    climbs: int = 0
    heldState: str = ""  # at rest under the load that was held
    # -- of the present trial
    goal: float = -1.0  # its factor [-], or below 0 if none is going on
    source: float = 0.0  # factor of the state from which it begins [-]
    calm: int = 0  # 1 if that state is at rest, else 0
    taken: int = 0  # steps so far
    quiet: int = 0  # looks that found the structure at rest, one after the other
    ended: int = 0  # how the last one ended that was not held: a number of WHY
    marks: Sequence[Any] = ()  # velocities after 1, 2, 4, ... looks [-]


def grow(scene, name, load, duration, within=WITHIN):
    """Let a :class:`~masonry.stages.gravity.Acting` grow evenly until the structure falls or
    it has its whole, then search for the one that is held.

    :param duration: [s], with true masses; ``within``: width of the bracket, over its upper end [-]
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
        scene.bounds.hold(load.name, at.held[0])
        _compare(scene, name, load, at)
    if at.lost and at.held:
        unit = "" if load.unit == "-" else f" {load.unit}"
        say(
            f"{name}: held at {at.held[0]:.5g}{unit}, not held at"
            f" {at.lost[0]:.5g}{unit} ({WHY[at.lost[3]]})"
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
    """Say that much less is held than rigid blocks would carry."""
    entry = scene.bounds.entries.get(load.name, {})
    if at.lost and entry.get("exact") and at.held[0] < FAR * entry["factor"]:
        less = 100 * (1 - at.held[0] / entry["factor"])
        say(
            f"note: {name}: rigid blocks would carry {entry['factor']:.4g}, and the run held"
            f" {less:.0f} % less: joints that are soft let the structure lean before it falls. Try"
            " stiffer joints (normalStiffness), and more points (--points)"
        )


def follow(scene, name, load):
    """From now on record the displacement of what is watched along a load, from where it was when
    that began, which the run keeps under a name."""
    target, origins = scene.description.followed(load.target), scene.running.at.origins
    origin = scene.model.loading.follow(target, load.towards, origins.get(name))
    if target and name not in origins:
        scene.running.at.origins = {**origins, name: origin}


def found(scene, rows):
    """What a stage answers in which a load grew: the largest load that was held, and the smallest
    that was not."""
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
        if at.trials:
            held += f", of {len(at.trials)} from {min(at.trials)[0]:.4g} on"
    if at.lost:
        lost = (
            f"the smallest load factor under which it did not come to rest: {WHY[at.lost[3]]};"
            f" {what}"
        )
    return ends(scene, at.held, held, at.lost, lost)


def ends(scene, held, whyHeld, lost, whyLost):
    """The answers of a stage that looks for the load that is held.

    :param held: factor and displacement [mm] of a load that was held, or None, and how it was found
        or why not; ``lost``: likewise
    """
    target = scene.model.loading.followed
    for name, end, how, when in (
        ("held", held, whyHeld, "at rest"),
        ("not_held", lost, whyLost, "when it was seen not to come to rest"),
    ):
        yield Answer(f"factor_{name}", scene.loadUnit, end[0] if end else None, how)
        if end and target:
            how = f"of {target.name} along the load since that began, {when}"
            yield Answer(f"displacement_{name}", "mm", end[1], how)


def _text(state):
    return base64.b64encode(state).decode()


def _present():
    """The present state as text."""
    return _text(saveScene("null"))


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
        while not at.over:
            if at.goal < 0:
                chosen = self._next()
                if chosen is None and at.held and not at.buckled and self._buckles():
                    at.buckled, at.climbs = 1, 0
                    at.lost, at.held = [*at.held, 1, 3], None
                    continue
                if chosen is None:
                    return
                at.source, at.goal, state, at.calm = chosen
                at.taken, at.quiet, at.marks = 0, 0, []
                if state is not None:
                    _load(state)
            held = self._trial()
            if held and at.buckled and self._buckles():
                held, at.ended = False, 3
            end = [at.goal, 1e3 * self.model.loading.alongNow()]
            if held:
                at.held, at.heldState = end, _present()
                at.climbs += bool(at.climbs)
                if at.lost and at.goal >= at.lost[0]:
                    at.lost, at.climbs = None, 1
            elif at.lost is None or at.goal < at.lost[0] or at.calm:
                at.lost = [*end, at.calm, at.ended]
            at.trials = [*at.trials, [at.goal, int(held)]]
            at.goal = -1.0
            ends = [f"held {at.held[0]:.4g}"] if at.held else []
            ends += [f"not held {at.lost[0]:.4g}"] if at.lost else []
            detail = f"trial {len(at.trials)}: {', '.join(ends)}"
            self.running.show(1, lambda: detail, True)

    def end(self):
        """Take the scene to where the stage ends, and return how it ended."""
        at, running = self.at, self.running
        stands = not at.fell and at.lost is None and at.held
        if at.held:
            self.model.atRest = base64.b64decode(at.heldState)
        if stands:
            if running.readings.time != O.time:
                running.record()
            running.flush()
        else:
            if not at.over:
                _load(at.lastState)
            self.model.loading.loadFactor = at.last
        at.kept, at.lastState, at.over = [], "", 1
        if at.fell:
            raise Collapsed(at.fell)
        return AT_REST if stands else DONE

    # -- which trial comes next --------------------------------------------------------------------

    def _next(self):
        """The next trial: factor of the state from which it begins, its own factor, that state as
        text, or None if it is the present one, and 1 if it is at rest, else 0. None if there is
        nothing left to try.
        """
        at = self.at
        fromRest = lambda goal: (at.held[0], goal, at.heldState, 1)
        if not at.trials and not at.fell:
            return at.last, at.last, None, 0  # the structure still stands
        if not at.fell and at.held and at.held[0] >= at.last:
            return None
        if at.climbs and at.lost is None:
            goal = at.held[0] * (1 + self.within * 2**at.climbs)
            most = self.load.factor(1.0)
            return fromRest(min(goal, most)) if at.held[0] < most else None
        chosen = None if at.climbs else self._ofGrowth()
        if chosen or at.held is None:
            return chosen
        if at.lost is None:
            _load(at.lastState)
            at.lost = [at.last, 1e3 * self.model.loading.alongNow(), 0, 0]
        if at.lost[0] - at.held[0] > self.within * max(at.lost[0], LEAST * at.last):
            return fromRest(0.5 * (at.held[0] + at.lost[0]))
        return None if at.lost[2] else fromRest(at.lost[0])

    def _ofGrowth(self):
        """The next trial from a state of the growth, or None if there is none between the ends of
        the bracket."""
        at = self.at
        factors, step = [factor for factor, _ in at.kept], 2 ** max(0, len(at.trials) - 1)
        # numbers of the last state up to what was held, and of the first from what was not
        low = at.held and bisect.bisect_right(factors, at.held[0]) - 1
        high = at.lost and sum(factor < at.lost[0] for factor in factors)
        if low is None and high is None:
            index = self._guess(factors)
        elif low is None:
            index = max(0, high - step) if high else None
        elif high is None:
            index = min(len(factors) - 1, low + step) if low + 1 < len(factors) else None
        else:
            wide = at.lost[0] - at.held[0] > self.within * at.lost[0]
            index = (low + high) // 2 if wide and low + 1 < high else None
        if index is None:
            return None
        factor, state = at.kept[index]
        return factor, factor, state, 0

    def _guess(self, factors):
        """Number of the kept state with which the search begins: the last before the structure
        leaves rest."""
        speeds = [speed for _, _, speed in self.at.rows]
        n = len(speeds) - 1
        while n > 0 and speeds[n] > SETTING_OFF * statistics.median(speeds[:n]):
            n -= 1
        reached = self.at.rows[n][1] if speeds else 0.0
        return max(0, bisect.bisect_right(factors, reached) - 1)

    def _buckles(self):
        """Whether the structure that is at rest under the load that was held last buckles."""
        if self.at.goal < 0:
            _load(self.at.heldState)
        return buckles(self.scene)

    # -- a trial -----------------------------------------------------------------------------------

    def _trial(self):
        """Hold a load, and wait. Returns whether the structure came to rest under it."""
        at, scene, model = self.at, self.scene, self.model
        slowest = model.supports.slowest()
        growing = max(1, int(max(growthTime(scene), slowest) / O.dt))
        longest = max(TRIAL * scene.args.density_scaling**0.5, WAITED * slowest)
        most = int(longest / O.dt)
        while True:
            x = min(1.0, (at.taken + EVERY) / growing)
            factor = at.source + smooth(x) * (at.goal - at.source)
            self.load.put(self.load.at(at.begun, self.load.shareOf(factor)))
            model.loading.loadFactor = factor
            try:
                self.running.advance(EVERY)
                at.taken += EVERY
                model.motion.checkFall()
            except Collapsed:
                at.ended = 0
                return False
            missing, moving = model.supports.unrest()
            rests = missing < REST and moving < CALM and x == 1
            at.quiet = at.quiet + 1 if rests else 0
            if at.quiet == LOOKS:
                return True
            accelerates = self._accelerates(model.motion.fastest(FALLEN))
            if accelerates or at.taken >= most:
                at.ended = 1 if accelerates else 2
                return False

    def _accelerates(self, speed):
        """Whether the fastest block is fast, and at least twice as fast as in the first half of the
        trial."""
        at = self.at
        looks = at.taken // EVERY
        if looks & (looks - 1) == 0:
            at.marks = [*at.marks, speed]
        before = at.marks[max(0, looks.bit_length() - 2)]
        return looks > 8 and speed > SURE and speed > 2 * before
