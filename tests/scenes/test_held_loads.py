# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads that grow and the search for the one that is held; loads in later stages; pushes of any
direction."""

import base64

from hosted import *
from masonry._masonry import saveScene
from masonry.errors import Collapsed
from masonry.stages import gravity, growing

import held_loads

STONE = materials.dry(friction=0.7, normalStiffness=1e11, density=2600)
WEIGHT = 2600 * 9.81 * 0.3 * 0.3 * 0.6  # of the stack [N]


def stack(folder, **settings):
    """Three stones, 0.3 m wide and 0.6 m high, on a base: the scene, and its highest stone."""
    scene = standing(folder, bricks.stack(3, (0.3, 0.3, 0.2)), STONE, **settings)
    return scene, scene.handle(2, name="stone")


def atRest(*where, **settings):
    """The same after its settling."""
    scene, stone = stack(*where, **settings)
    scene.settle()
    return scene, stone


def found(scene, name):
    return [a["value"] for a in scene.answers if a["name"] == name]


def last(scene, column):
    return scene.results.column(column)[-1]


@mark.parametrize("name", held_loads.QUICK)
def test_a_held_load_is_that_of_limit_analysis(name):
    cells, met = held_loads.row(name, slow=False)
    assert met, cells


@mark.parametrize("rate", [0.2, 4.0])
def test_the_rate_of_the_growth_hardly_counts(tmp_path, rate):
    s, stone = atRest(tmp_path)
    assert s.accelerate(1.5, rate=rate) == COLLAPSED
    s.finish()
    (held,), (lost,) = (found(s, n) for n in ("factor_held", "factor_not_held"))
    assert held < 0.5 * 1.001 and lost > 0.5 * 0.999  # b/h, when it tips
    assert lost - held <= 0.005 * lost * 1.001
    run, curve = readRun(tmp_path), s.curve()
    assert (np.diff(curve["time_s"]) > 0).all()  # no row twice
    assert run["factor"] == held == s.factor
    assert {mark["y"] for mark in run["figure"]["marks"]} == {held, lost}
    rows = [n for span in run["figure"]["rows"] for n in range(*span)]
    # the line is the growth: the load over the displacement of the stone
    assert curve["load_factor"][rows[-1]] > held
    assert curve["displacement_mm"][rows[-1]] > 1


def test_a_structure_that_stands_has_a_load_that_was_held_and_no_other(tmp_path):
    s, stone = atRest(tmp_path)
    assert s.accelerate(0.2, rate=0.4) == AT_REST
    assert s.lean(0.3) == AT_REST  # it stands yet
    assert (np.diff(s.curve()["time_s"]) > 0).all()  # no row twice
    assert found(s, "factor_held") == [approx(0.2, rel=0.01), 0.3]
    assert found(s, "factor_not_held") == [None, None]


def test_loads_of_later_stages_replace_others_and_can_be_bracketed(tmp_path):
    s, stone = stack(tmp_path)
    s.load(stone, (0, 0, -1000))
    s.settle()
    down = lambda: -1e3 * last(s, "base_force_z_kN")
    assert down() == approx(WEIGHT + 1000, rel=1e-3)
    assert s.load(stone, (0, 0, -3000)) == AT_REST
    assert down() == approx(WEIGHT + 3000, rel=1e-3)
    carries = lambda f: s.load(stone, (f, 0, -3000)) == AT_REST
    # it tips about its foot: the force is 0.5 m above the ground
    tips = (WEIGHT + 3000) * 0.15 / 0.5
    low, high = s.bracket(carries, 0.5 * tips, 1.5 * tips)
    assert low * 0.99 < tips < high * 1.01


def test_a_scene_steps_back_from_a_load_of_a_kind_that_it_had_not(tmp_path):
    s, stone = atRest(tmp_path)
    assert s.load(stone, (5000, 0, 0)) == COLLAPSED
    s.stepBack()
    assert s.settle() == AT_REST
    assert -1e3 * last(s, "base_force_z_kN") == approx(WEIGHT, rel=1e-3)
    assert abs(last(s, "base_force_x_kN")) < 1e-4 * WEIGHT


class Fragile:
    """In place of a scene: a structure that carries loads below its capacity, less what it is
    thrown beyond by a step of the load, and stands again only after a step back."""

    share, stands, limitAnalysisOnly = 1, True, False
    collapsed = property(lambda self: not self.stands)

    def __init__(self, capacity, thrown):
        self.capacity, self.thrown, self.tried, self.load = capacity, thrown, [], 0.0
        self.running = SimpleNamespace(entered=0, state=SimpleNamespace(answers={}))

    def carries(self, load):
        assert self.stands, f"the trial of {load} began with what the one before left"
        self.tried.append(load)
        self.stands = load + self.thrown * (load - self.load) < self.capacity
        self.load, self.before = load, self.load
        return self.stands

    def stepBack(self):
        if not self.stands:
            self.stands, self.load = True, self.before


@mark.parametrize("capacity", [0.21, 0.33, 0.5, 0.77, 0.99])
@mark.parametrize("thrown", [0.0, 0.05, 1.0])
def test_the_upper_end_of_a_bracket_does_not_hang_on_the_steps_of_the_load(capacity, thrown):
    fragile = Fragile(capacity, thrown)
    low, high = 0.01, 1.0
    assert fragile.carries(low)
    low, high = gravity.bracket(fragile, fragile.carries, low, high, within=0.02)
    assert low < capacity and high - low <= 0.02 * high
    assert high + thrown * (high - low) >= capacity
    assert fragile.stands and len(fragile.tried) < 40
    values = [one["value"] for one in fragile.running.state.answers["0 bracket"]]
    assert values == [low, high]
    with raises(ValueError, match="does not carry 1, the lower end"):
        gravity.bracket(fragile, fragile.carries, 1.0, 2.0)
    assert fragile.stands


def test_a_fall_is_counted_from_the_state_to_which_the_scene_steps_back(tmp_path):
    s, stone = atRest(tmp_path)
    state = O.bodies[stone.body].state
    far, fast = Vector3(0.1, 0, 0), Vector3(1, 0, 0)  # a third of the stone, and m/s
    state.pos += far
    s.model.atRest = saveScene("null")
    state.pos += far
    s.stepBack()
    state.vel = fast
    s.model.motion.checkFall()  # it is where it was at rest, so it has not fallen yet
    assert s.model.motion.fastest() > 1 and s.model.motion.fastest(0.05) < 0.1
    state.pos += far
    assert s.model.motion.fastest(0.05) > 1
    with raises(Collapsed, match="brick 2 .* has moved by .100, 0, 0. mm"):
        s.model.motion.checkFall()


@mark.parametrize(
    "grow, expected",
    [
        # the highest stone slides
        (lambda s, t: s.grow({t: (3000, 0, 0)}), 1e-3 * 0.7 * WEIGHT / 3),
        # on all of its face
        (lambda s, t: s.grow({}, pressure=2e4), 1e-3 * WEIGHT * 0.15 / 0.3 / (0.3 * 0.6)),
    ],
)
def test_growing_loads_hold_what_statics_says(tmp_path, grow, expected):
    s, stone = stack(tmp_path)
    s.args.lean = False  # bounds are found beside the run
    s.settle()
    assert grow(s, stone) == COLLAPSED
    s.finish()
    assert s.factor == approx(expected, rel=0.01)
    entry = [e for e in readRun(tmp_path)["bounds"] if "factor" in e][-1]
    assert s.factor < 1.002 * entry["factor"] < 1.02 * expected


def test_supports_of_later_stages_take_their_reaction(tmp_path):
    s, stone = atRest(tmp_path)
    s.hold(stone, "x")
    assert s.lean(0.6) == AT_REST  # it would fall without
    held = last(s, "stone_force_x_kN")
    both = last(s, "base_force_x_kN") + held
    # of the held stone itself nothing goes through joints
    assert both == approx(0.6e-3 * WEIGHT * 2 / 3, rel=0.01)
    assert held > 0.1 * both
    s.release(stone, "x")
    assert s.settle() == COLLAPSED


def test_a_lean_that_is_held_is_noted_with_its_factor_and_displacement(tmp_path):
    s, stone = stack(tmp_path)
    s.args.lean = False  # bounds are found beside the run
    s.settle()
    place = lambda: last(s, "stone_x_mm")
    x = [place()]
    for factor in (0.3, 0.2):
        assert s.lean(factor) == AT_REST
        x.append(place())
    assert s.running.state.held == {"acceleration towards x": 0.3}
    assert s.model.loading.loadFactor == last(s, "load_factor") == 0.2
    assert s.load(stone, (100, 0, 0)) == AT_REST
    s.finish()
    # both leans count from where the first one began, and the force from where it began itself
    moved = [x[1] - x[0], x[2] - x[0], place() - x[2]]
    assert found(s, "displacement_held") == approx(moved, rel=1e-3)
    assert readRun(tmp_path)["figure"]["y_label"] == "load [kN]"
    assert moved[0] > 1.2 * moved[1] > 0


def test_suction_pulls_with_the_pressure_times_the_face(tmp_path):
    s, stone = atRest(tmp_path)
    pulled = lambda: 1e3 * last(s, "base_force_x_kN")
    assert s.wind(-500, (1, 0, 0)) == AT_REST
    assert pulled() == approx(-500 * 0.3 * 0.6, rel=0.01)
    # one from the other side is beside it, and another from this side in its place
    assert s.wind(200, (-1, 0, 0)) == AT_REST
    assert pulled() == approx(-700 * 0.3 * 0.6, rel=0.01)
    assert s.wind(300, (1, 0, 0)) == AT_REST
    assert pulled() == approx(100 * 0.3 * 0.6, rel=0.02)
    for towards in ((1, 0, 0), (-1, 0, 0)):
        assert s.wind(-300, towards) == AT_REST
        assert s.wind(0, towards) == AT_REST
    assert abs(pulled()) < 1


def test_a_later_press_has_its_stress_with_the_weight_of_the_platen(tmp_path):
    s, _ = stack(tmp_path)
    top = s.platen("top", height=0.2)
    s.press(top, 0.05e6)
    s.settle()
    down = lambda: -1e3 * last(s, "base_force_z_kN")
    assert down() == approx(0.05e6 * 0.3 * 0.3 + WEIGHT, rel=5e-3)
    assert s.model.supports.weightOf(top) > 0.02 * down()
    assert s.press(top, 0.1e6) == AT_REST
    assert down() == approx(0.1e6 * 0.3 * 0.3 + WEIGHT, rel=5e-3)


def test_what_is_held_in_a_later_stage_stops_and_stays_held(tmp_path):
    s, stone = atRest(tmp_path, plane=False)
    state = O.bodies[stone.body].state
    s.hold(stone, "yZ")
    state.vel, state.angVel = Vector3(1, 0, 2), Vector3(3, 4, 0)
    s.hold(stone, "xY")
    assert set(state.blockedDOFs) == set("xyYZ")
    assert state.vel == Vector3(0, 0, 2) and state.angVel == Vector3(3, 0, 0)


def test_a_support_moves_at_its_rate_and_stands_then(tmp_path):
    s, _ = atRest(tmp_path)
    base = s.targets["base"]
    place = lambda: (last(s, "base_x_mm"), last(s, "base_z_mm"))
    s.move(base, x=3, z=-4, rate=20)
    assert O.bodies[base.body].state.vel == Vector3.Zero
    assert place() == approx((3, -4), rel=1e-6)
    s.move(base, z=1, rate=20)
    assert place() == approx((3, -3), rel=1e-6)
    x, z, t = (np.diff(s.curve()[n]) for n in ("base_x_mm", "base_z_mm", "time_s"))
    speeds = np.hypot(x, z)[t > 0] / t[t > 0]
    assert speeds.max() == approx(20, rel=1e-3)
    # from the first row of each stage, which is at its beginning but for a five-hundredth
    assert found(s, "displacement_of_base") == approx([5, 1], rel=0.01)


@mark.parametrize("direction", [(0, 0, -1), (0.6, 0, -0.8), (-1, 0, 0)])
def test_a_push_is_counted_in_its_direction_without_dead_weight(tmp_path, direction):
    s, stone = stack(tmp_path, rate=2)
    s.load(stone, (50, 0, -1000))
    s.settle()
    s.push(stone, 0.06, direction=direction)
    s.finish()
    run, curve = readRun(tmp_path), s.curve()
    top, base = curve["top_shear_kN"], curve["base_shear_kN"]
    assert base[-1] == approx(top[-1], rel=0.05, abs=0.01)
    assert abs(base[1]) < 0.02 * max(base)  # no weight in it
    both = np.minimum(top, base).max()
    assert run["peak_at_both_ends_kN"] == approx(both, rel=1e-8)
    assert not run["too_fast"] and run["initial_stiffness_kN_per_mm"] > 0


def test_a_bound_changes_nothing_of_the_scene(tmp_path):
    s, stone = atRest(tmp_path)
    entry = s.bound(stone, direction=(1, 0, 0))
    assert entry["factor"] == approx(0.7e-3 * WEIGHT / 3, rel=0.01)
    assert s.lean(0.6) == COLLAPSED  # no drive holds the stone


def test_a_bound_lets_dead_loads_grow_with_what_is_named(tmp_path):
    scene, stone = stack(tmp_path, preset="bound")
    scene.load(stone, (0, 0, -1000))
    scene.settle()
    scene.grow({stone: (1000, 0, 0)}, dead=True)
    (bound,) = scene.bounds.entries.values()
    # it tips about its foot: λ 1000 N 0.5 m = (W + (1 + λ) 1000 N) 0.15 m
    assert bound["factor"] == approx((WEIGHT + 1000) * 0.15 / 350, rel=1e-3)


def test_a_driven_platen_is_a_support_in_limit_analysis(tmp_path):
    s, _ = stack(tmp_path)
    s.platen("top", rotation="held", drive="xz")
    s.settle()
    assert "nothing gives way" in s.bound(towards=(1, 0, 0))["note"]
    assert {"top_force_x_kN", "top_force_z_kN"} <= set(s.curve())


def test_pushes_along_two_lines_have_numbers_of_the_last(tmp_path):
    s, stone = stack(tmp_path, rate=2)
    lower = s.handle(1, name="lower")
    s.settle()
    s.push(stone, 0.05, direction=(0, 0, -1))
    first = len(s.results.rows)
    s.push(lower, 0.05)
    s.finish()
    run, curve = readRun(tmp_path), s.curve()
    assert run["figure"]["rows"] == [[first, len(s.results.rows)]]
    both = np.minimum(curve["base_shear_kN"], curve["top_shear_kN"])
    peak = run["peak_at_both_ends_kN"]
    assert peak == approx(max(both[first:]), rel=1e-8) and max(both) > peak


def test_a_very_short_push_ends_where_it_should_and_asks_for_the_unit(tmp_path, capsys):
    s, stone = atRest(tmp_path, rate=0.1)
    assert s.push(stone, 0.002) == DONE
    assert "until 0.002 mm: is it in mm, not m?" in capsys.readouterr().out
    assert last(s, "displacement_mm") == approx(0.002, rel=0.06)


def test_a_result_of_the_script_is_an_answer(tmp_path, capsys):
    s, stone = stack(tmp_path)
    with raises(ValueError, match="comes after the first stage"):
        s.result("height", 1.0)
    s.settle()
    s.result("height", 0.6, "m")
    s.result("height", 0.7, "m")
    s.result("nothing", math.nan)
    s.finish()
    answers = {a["name"]: a["value"] for a in readRun(tmp_path)["answers"]}
    assert answers["height"] == 0.7 and answers["nothing"] is None
    assert "script: height 0.7 m\n" in capsys.readouterr().out


def test_a_search_begins_again_at_the_largest_load_at_rest_that_does_not_buckle(monkeypatch):
    """States at rest are looked at in halves, none that is known not to buckle, and none twice."""
    text = lambda n: base64.b64encode(str(n).encode()).decode()
    loaded, said = [], []
    monkeypatch.setattr(growing, "loadScene", lambda state: loaded.append(int(state)))
    monkeypatch.setattr(growing, "buckles", lambda scene: loaded[-1] >= 7)
    monkeypatch.setattr(growing, "say", said.append)
    running = SimpleNamespace(state=SimpleNamespace(stage="grow"))
    scene = SimpleNamespace(model=None, running=running)
    rests = [[float(n), 0.0, text(n)] for n in range(10)]
    at = growing.Growing(rests=rests, steady=2.0, tried=[0.0] * 12, fell="it fell", last=12.0)
    at.failure = growing.Failure(9.01, source=9.0)
    load = SimpleNamespace(factor=lambda share: 12.0)
    assert growing._Search(scene, at, load, 0.01)._begin()
    assert loaded[:-1] == [9, 5, 7, 6] and at.held.factor == 6 and at.failure.factor == 7
    assert at.failure.reason is growing.Reason.BUCKLES and at.buckled
    assert at.trial.source == 6 and at.trial.factor == 6.5 and loaded[-1] == 6
    assert said == [
        "grow: 7 is held, but buckles: a small push sideways grows, 6 does not; the search begins"
        " again below it"
    ]


@mark.parametrize("stage", ["grow", "load"])
def test_a_perfect_column_holds_no_more_than_its_buckling_load(tmp_path, stage):
    """A chain of n rigid blocks on elastic joints with the rotational stiffness k buckles at 4 k/h
    sin²(π/(4 n + 2)), in space along y, where it is thinner."""
    n, side, stiffness, plane = 10, 0.2, 5e8, stage == "grow"
    wide = side if plane else 1.5 * side
    joint = MasonryJoint(elastic=True, normalStiffness=stiffness, shearStiffness=2e8)
    light = materials.Masonry(MasonryMat(young=2e10, poisson=0.2, density=200), {"bed": joint})
    blocks = bricks.stack(n, (wide, side, side))
    scene = standing(tmp_path, blocks, light, plane=plane)
    head = scene.handle((wide / 2, side / 2, n * side - 0.01))
    scene.settle()
    turning = stiffness * wide * side**3 / 12
    euler = 4 * turning / side * np.sin(np.pi / (4 * n + 2)) ** 2
    if stage == "grow":
        scene.grow({head: (0, 0, -3 * euler)}, within=0.02)
        held, lost = found(scene, "factor_held")[0], found(scene, "factor_not_held")[0]
        assert 0.97 * euler < 1e3 * held < euler < 1e3 * lost < 1.03 * euler
    else:
        ends = [scene.load(head, (0, 0, -share * euler)) for share in (0.97, 1.03)]
        assert ends == [AT_REST, MOVING]


# -- what is held does not hang on the rate --------------------------------------------------------


def towerOnSoil(folder, rate):
    """On springs without tension, where the rocking gets slower the nearer the load is to what is
    held."""
    stones = materials.dry(friction=0.9, density=1000, normalStiffness=3e9, young=1e13)
    scene = Scene(
        "tower",
        bricks.stack(1, (3.6, 3.6, 20.0)),
        stones,
        arguments=["--lean", "--out", str(folder)],
        plane=True,
    )
    scene.platen("bottom", springs={"z": 2e9}, uplift=True, height=0.2)
    scene.settle()
    return scene, lambda: scene.tilt(12, rate=8 * rate, within=WITHIN)


def columnUnderAnEccentricLoad(folder, rate):
    scene = standing(folder, bricks.stack(8, (0.2, 0.2, 0.2)), SOFT)
    head = scene.handle((0.15, 0.1, 1.59))
    scene.settle()
    return scene, lambda: scene.grow({head: (0, 0, -6e5)}, over=1 / rate, within=WITHIN)


def parapet(folder, rate):
    scene = standing(folder, bricks.stack(6, (0.1, 0.1, 0.2)), SOFT)
    scene.settle()
    return scene, lambda: scene.accelerate(0.3, rate=rate, within=WITHIN)


def pressOverRollers(folder, rate):
    scene = standing(folder, bricks.stack(6, (0.2, 0.2, 0.2)), SOFT)
    top = scene.platen("top", height=0.05)
    scene.press(top, 0.02e6)
    scene.settle()
    return scene, lambda: scene.accelerate(0.5, rate=rate, within=WITHIN)


SOFT = materials.dry(friction=0.7, normalStiffness=1e9, density=2000)
WITHIN = 0.01  # of both brackets


@mark.parametrize("make", [towerOnSoil, columnUnderAnEccentricLoad, parapet, pressOverRollers])
def test_what_is_held_does_not_hang_on_the_rate(make, tmp_path):
    ends = []
    for rate in (0.05, 1.0):
        scene, grow = make(tmp_path / str(rate), rate)
        grow()
        ends.append([found(scene, f"factor_{name}held")[-1] for name in ("", "not_")])
        scene.finish()
    (low, high), (other, above) = ends
    assert max(low, other) <= min(high, above) * (1 + WITHIN), ends
