# SPDX-License-Identifier: GPL-2.0-or-later
"""The growth of a load, and the search for the load that is held, on structures that are known."""

import base64

from hosted import *
from masonry.model.motion import REST
from masonry.errors import Collapsed
from masonry.stages import growing
from masonry.stages.growing import Reason
from masonry.stages.rest import CONSECUTIVE_CHECKS, EVERY, REST_ENERGY_RATIO, Waiting, rampTime

# -- the growth ------------------------------------------------------------------------------------


class Load:
    """A load of one number, its factor."""

    towards = None

    def __init__(self, most=1.0):
        self.most, self.values = most, []

    def at(self, began, share):
        return [share * self.most]

    def put(self, values):
        self.values += values

    def factor(self, share):
        return share * self.most

    def shareOf(self, factor):
        return factor / self.most


def standing(scaling=1.0, height=0.6):
    """In place of a scene: what the growth and the search ask of it."""
    box = SimpleNamespace(high=(0, 0, height), low=(0, 0, 0))
    nothing = lambda *words, **more: None
    running = SimpleNamespace(
        advance=nothing,
        show=nothing,
        record=nothing,
        flush=nothing,
        mark=nothing,
        state=SimpleNamespace(stage="grow"),
        readings=SimpleNamespace(time=None),
    )
    motion = SimpleNamespace(checkFall=nothing, fastest=lambda far: 0.0)
    made = SimpleNamespace(
        loading=SimpleNamespace(loadFactor=0.0),
        supports=SimpleNamespace(arching=lambda across: (0.0, 0.0)),
        motion=motion,
    )
    args = SimpleNamespace(density_scaling=scaling)
    return SimpleNamespace(args=args, description=box, running=running, model=made, share=1)


def test_a_growth_takes_longer_with_scaled_masses_and_has_the_load_of_the_middle():
    """Times go with the root of the masses, so that the growth is as slow beside the waves in the
    blocks."""
    O.dt = 1e-3
    load = Load(most=3.0)
    made = growing._Growth(standing(scaling=4.0), growing.Growing(), load, 2.0)
    assert made.whole == approx(4.0)
    made._before(1000, 2000)  # from 1 to 2 s
    assert load.values == [approx(3.0 * 1.5 / 4.0)]
    assert made.model.loading.loadFactor == load.values[-1]
    made._before(3999, 4100)
    assert load.values[-1] == 3.0  # no more than the whole


def test_states_of_a_growth_are_evenly_apart_and_not_too_many(monkeypatch):
    scene, at = standing(), growing.Growing(kept=[[0.0, ""]])
    scene.model.motion.fastest = lambda: 0.0
    monkeypatch.setattr(growing, "saveScene", lambda name: b"state")
    growth = growing._Growth(scene, at, None, 1.0)
    for scene.model.loading.loadFactor in range(1, 1000):
        growth._after()
        assert len(at.kept) <= growing.MOST_KEPT
    factors = [factor for factor, _ in at.kept]
    assert len(set(np.diff(factors))) == 1 and len(factors) > growing.MOST_KEPT / 2 - 1


# -- a trial ---------------------------------------------------------------------------------------


def trial(rests, source=0.2, goal=0.5, scaling=1.0, speeds=None, slowest=0.0):
    """A trial in which the checks find the structure at rest or not, as a function of their number
    says. Returns why it was not held, the trial and the load at each check."""
    O.dt = 1e-4
    scene, load, number = standing(scaling), Load(), iter(range(10**6))
    going = growing.Trial(source=source, factor=goal)
    scene.model.supports.unrest = lambda: (
        (0.0, 0.0) if rests(next(number)) else (2 * REST, 2 * REST_ENERGY_RATIO)
    )
    scene.model.supports.slowest = lambda: slowest
    if speeds:
        scene.model.motion.fastest = lambda far: speeds(going.done)
    reason = growing._Search(scene, growing.Growing(trial=going), load, 0.01)._wait()
    return reason, going, load.values, scene


@mark.parametrize("source, goal", [(0.2, 0.5), (0.5, 0.2), (0.3, 0.3)])
def test_a_trial_leads_smoothly_to_its_load_and_waits_for_rest_there(source, goal):
    reason, going, values, made = trial(lambda n: True, source, goal)
    assert reason is None and made.model.loading.loadFactor == approx(goal)
    ramp = int(rampTime(made.args) / O.dt)
    assert going.done == (math.ceil(ramp / EVERY) + CONSECUTIVE_CHECKS - 1) * EVERY
    low, high = sorted((source, goal))
    assert all(low - 1e-12 <= v <= high + 1e-12 for v in values)
    steps = [(b - a) * (goal - source) for a, b in zip([source, *values], values)]
    assert min(steps) >= 0 and values[-CONSECUTIVE_CHECKS:] == [approx(goal)] * CONSECUTIVE_CHECKS


@mark.parametrize("scaling", [1.0, 4.0])
def test_a_trial_without_checks_at_rest_in_a_row_is_given_up_in_its_time(scaling):
    reason, going, _, _ = trial(lambda n: n % CONSECUTIVE_CHECKS, scaling=scaling)
    assert reason is Reason.MOVING
    assert going.done * O.dt == approx(
        growing.TRIAL * math.sqrt(scaling), rel=EVERY * O.dt / growing.TRIAL
    )


@mark.parametrize(
    "kinetic, halves, rests",
    [
        # the energy at a time [s], how often half of TRIAL is waited for, and whether it rests then
        (lambda t: 1.0, 2, False),
        (lambda t: math.exp(t), 2, False),
        (lambda t: 0.6 ** (t / (growing.TRIAL / 2)), 2, False),
        (lambda t: 1e-3 * 0.4 ** (t / (growing.TRIAL / 2)), 6, True),
        # what creeps away out of rest
        (lambda t: 0.9 * REST_ENERGY_RATIO * t / growing.TRIAL, 2, False),
    ],
)
def test_a_wait_ends_when_motion_does_not_die_away(kinetic, halves, rests):
    O.dt, wait, atRest = 1e-4, Waiting(), False
    while not atRest:
        wait.done += EVERY
        atRest = wait.isAtRest(0.0, kinetic(wait.done * O.dt), True)
        if wait.isGivenUp(growing.TRIAL):
            break
    assert atRest == rests
    assert wait.halves == halves - rests


def test_a_trial_puts_its_load_on_in_a_slow_period_and_waits_for_ten():
    reason, going, values, _ = trial(lambda n: False, 0.0, 1.0, slowest=2.0)
    assert reason is Reason.MOVING and going.done * O.dt == approx(20.0)
    assert values.index(1.0) + 1 == approx(2.0 / (O.dt * EVERY))


def test_a_trial_ends_when_the_structure_moves_faster_and_faster():
    faster = lambda steps: 2 * growing.SURE * steps / 3000  # SURE after 15 checks
    reason, going, _, _ = trial(lambda n: False, speeds=faster)
    assert reason is Reason.ACCELERATED
    assert 1500 < going.done < 3500  # at once when it is fast, and faster than twice
    slower = lambda steps: 4 * growing.SURE if steps < 900 else 2 * growing.SURE
    assert trial(lambda n: False, speeds=slower)[0] is Reason.MOVING
    # blocks that the load itself moves, in the eight checks in which it is put on, have not fallen
    swing = lambda steps: growing.SURE * 2 ** (steps / EVERY) if steps < 8 * EVERY else 0
    assert trial(lambda n: n > 8, speeds=swing)[0] is None


# -- the search ------------------------------------------------------------------------------------


def search(
    patch, capacity, moving, fell, setsOff, growth, buckling=math.inf, thrown=0.0, long=False
):
    """A search on a structure that holds loads below its capacity from rest, less ``thrown`` times
    the step of the load, and below another one from a state in which it moves, and that buckles
    from a third load on; trials may be ``long``. Returns its memory, the scene and the trials:
    factor, whether it began at rest, the state it began with, and whether it was held."""
    last, states = growth["last"], growth["states"]
    here, trials = {"state": None, "factor": last}, []
    text = lambda factor: base64.b64encode(repr(factor).encode()).decode()
    load, made = Load(most=1.2 * last), standing()
    made.model.atRest = None
    # [m]: as many mm as the factor
    made.model.loading.alongNow = lambda: 1e-3 * here["factor"]
    factors = [last * n / states for n in range(states + 1)]
    at = growing.Growing(
        fell="it fell" if fell else "",
        last=last,
        lastState=text(last),
        kept=[[f, text(f)] for f in factors],
        rows=[[f, f, 1.0 if f < setsOff * last else 50.0] for f in factors[1:]],
    )

    class Known(growing._Search):
        def _wait(self):
            at.trial.halves = int(long)
            goal, fromRest = at.trial.factor, at.trial.fromRest
            step = goal - at.trial.source
            held = goal + thrown * step < capacity if fromRest else goal < moving
            trials.append((goal, fromRest, here["state"], held))
            here["factor"], here["state"] = goal, repr(goal).encode()
            return None if held else Reason.FELL

        def _buckles(self, factor):
            assert here["factor"] == factor
            return factor >= buckling

    back = lambda state: here.update(state=state, factor=float(state))
    patch.setattr(growing, "loadScene", back)
    patch.setattr(growing, "saveScene", lambda name: repr(here["factor"]).encode())
    found = Known(made, at, load, growth["within"])
    found.run()
    return at, made, trials, found


#: The last load of a growth, how near the search shall come to what is held, and how many states
#: are kept.
GROWTH = dict(last=some.floats(0.5, 20.0), states=some.integers(1, 60))
GROWTH["within"] = some.sampled_from([0.002, 0.005, 0.05])
growths = some.fixed_dictionaries(GROWTH)


@settings(max_examples=150)
@given(
    some.floats(0.02, 1.5),
    some.floats(0.5, 1.0),
    some.floats(0.0, 1.2),
    growths,
    some.floats(0.0, 2.0),
    some.booleans(),
)
def test_a_search_brackets_what_is_held_whatever_it_tries(
    capacity, moves, setsOff, growth, thrown, long
):
    """What a structure holds hangs neither on how it moves while the load grows, nor on how far a
    step of the load throws it: the load that is not held was tried last from the state at rest
    just below it."""
    last, within = growth["last"], growth["within"]
    with pytest.MonkeyPatch.context() as patch:
        rest = capacity * last  # from rest it holds more than while it moves
        fell = rest <= last or moves * rest <= last
        moving = moves * rest
        at, made, trials, found = search(
            patch, rest, moving, fell, setsOff, growth, thrown=thrown, long=long
        )
        assert len(trials) < 90 and at.held
        held, lost = at.held.factor, at.failure and at.failure.factor
        assert held < rest and at.held.displacement == approx(held)
        for factor, fromRest, state, _ in trials:
            assert not fromRest or factor >= float(state)  # from what was held
        if lost is None:
            assert held == approx(last if not fell else 1.2 * last)
        else:
            assert lost + thrown * (lost - held) >= rest
            assert at.failure.displacement == approx(lost)
            assert lost - held <= within * max(lost, growing.LEAST * last) * (1 + 1e-9)
            assert at.failure.source == held
        if fell:
            with raises(Collapsed, match="it fell"):
                found.end()
            assert made.model.loading.loadFactor == last
        else:
            found.end()
        assert float(made.model.atRest) == approx(held)


@settings(max_examples=150)
@given(some.floats(0.02, 1.3), growths, some.booleans())
def test_a_search_brackets_a_load_that_buckles(buckles, growth, long):
    last, within = growth["last"], growth["within"]
    with pytest.MonkeyPatch.context() as patch:
        buckling = buckles * last
        at, _, trials, _ = search(patch, 9 * last, 9 * last, False, 1, growth, buckling, long=long)
        held, lost = at.held.factor, at.failure and at.failure.factor
        assert len(trials) < 60 and held < buckling
        if lost is None:
            assert held == approx(last)
        else:
            assert lost >= buckling and at.failure.reason is Reason.BUCKLES
            assert lost - held <= within * max(lost, growing.LEAST * last) * (1 + 1e-9)


def test_a_search_begins_where_rest_was_left_also_if_the_structure_stood_at_the_end():
    with pytest.MonkeyPatch.context() as patch:
        growth = dict(last=1.0, within=0.005, states=20)
        _, _, trials, _ = search(patch, 0.9, 0.8, False, 0.7, growth)
        assert [factor for factor, *_ in trials[:2]] == approx([1.0, 0.65])


def test_a_structure_that_never_rests_is_tried_down_to_no_load_and_has_no_number():
    with pytest.MonkeyPatch.context() as patch:
        growth = dict(last=1.0, within=0.005, states=20)
        at, made, trials, found = search(patch, 0.0, 0.0, True, 0.5, growth)
        assert at.held is None and at.failure.factor == 0
        with raises(Collapsed):
            found.end()
        assert made.model.atRest is None


@mark.parametrize(
    "held, exact, noted", [(0.94, True, True), (0.96, True, False), (0.5, False, False)]
)
def test_a_note_says_that_much_less_is_held_than_rigid_blocks_carry(capsys, held, exact, noted):
    entries = {"a": {"exact": exact, "factor": 1.0}}
    made = SimpleNamespace(bounds=SimpleNamespace(entries=entries))
    at = growing.Growing(rests=[[held, 0.0, ""]], failure=growing.Failure(0.99))
    growing._compare(made, "tilt", SimpleNamespace(name="a"), at)
    said = "and the run held 6 % less" in " ".join(capsys.readouterr().out.split())
    assert said == noted
