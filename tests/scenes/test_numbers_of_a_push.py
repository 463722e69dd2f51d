# SPDX-License-Identifier: GPL-2.0-or-later
"""The numbers of a push are of the push alone: what stands, acts or went before beside it changes
none. Each has its own rows, and begins with the first of them."""

from hosted import *
from scipy.integrate import trapezoid

#: A pier whose joints are elastic, of blocks [m].
SIDE, COURSE, COUNT = 0.3, 0.1, 8
PIER = bricks.stack(COUNT, (SIDE, 0.2, COURSE))
ELASTIC = materials.Masonry(
    MasonryMat(young=2e10, poisson=0.2, density=2000),
    {"bed": MasonryJoint(elastic=True, normalStiffness=1e10, shearStiffness=5e9)},
)


def pushedWith(folder, before, after, *words, built=PIER, control=None, **base):
    """The numbers of a push of a pier to a millimetre, in a run with other commands before and
    after its first stage; ``base``: of the platen on which it stands."""
    scene = lean(folder, built, ELASTIC, *words, rate=20)
    scene.platen("bottom", **base)
    top = scene.handle(COUNT - 1, "top")
    before(scene)
    scene.settle(longest=30)
    after(scene)
    scene.push(top, 1, control=control and scene.targets[control])
    scene.finish()
    return readRun(folder)


NOTHING = lambda s: None
MIDDLE = (SIDE / 2, 0.1, COUNT * COURSE / 2)


def pushBack(s):
    s.push(s.targets["top"], 1, direction=(-1, 0, 0))
    s.release(s.targets["top"], "x")
    s.settle(longest=2)


def sink(s):
    s.move(s.targets["base"], z=-80, rate=50)
    s.settle(longest=2)


#: What is said before and after the first stage, and how else the pier differs.
BESIDE = {
    "wind": (lambda s: s.wind(3000, (1, 0, 0)), NOTHING, {}),
    "wind against the push": (lambda s: s.wind(3000, (-1, 0, 0)), NOTHING, {}),
    "dead load": (lambda s: s.load(s.handle(MIDDLE), (500, 0, 0)), NOTHING, {}),
    "load on what is pushed": (NOTHING, lambda s: s.load(s.targets["top"], (-500, 0, 0)), {}),
    "load as a stage": (
        lambda s: s.handle(3, "m"),
        lambda s: s.load(s.targets["m"], (500, 0, 0)),
        {},
    ),
    "acceleration": (NOTHING, lambda s: s.lean(0.1), {}),
    "settlement": (NOTHING, sink, {}),
    "rests": (NOTHING, lambda s: [s.settle(longest=1) for _ in range(3)], {}),
    "push back": (NOTHING, pushBack, {}),
    "other control": (lambda s: s.watch(COUNT - 1, name="seen"), NOTHING, dict(control="seen")),
    "soft soil": (NOTHING, NOTHING, dict(springs={"z": 1e4})),
    "another structure": (
        lambda s: s.load(s.handle(2 * COUNT - 1, "other"), (300, 0, -1000)),
        NOTHING,
        dict(built=PIER + PIER.moved(2, 0, 0)),
    ),
    "push of another structure": (
        lambda s: s.handle(2 * COUNT - 1, "other"),
        lambda s: (s.push(s.targets["other"], 0.3), s.settle(longest=2)),
        dict(built=PIER + PIER.moved(2, 0, 0)),
    ),
}
NUMBERS = (
    "peak_at_both_ends_kN",
    "peak_base_shear_kN",
    "base_shear_end_kN",
    "displacement_at_peak_mm",
    "displacement_end_mm",
    "drift_at_peak_mrad",
    "initial_stiffness_kN_per_mm",
    "first_period_s",
)


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The numbers of the push alone."""
    O.reset()
    numbers = pushedWith(tmp_path_factory.mktemp("plain"), NOTHING, NOTHING)
    letGo()
    O.reset()
    return numbers


@mark.parametrize("case", BESIDE)
def test_what_is_beside_a_push_changes_none_of_its_numbers(plain, scene, tmp_path, case):
    before, after, how = BESIDE[case]
    found = pushedWith(tmp_path, before, after, **how)
    if case == "another structure":  # it swings more slowly, and the period is that of both
        found["first_period_s"] = plain["first_period_s"]
    # the last row is within 0.01 mm of the end, and loads bend the pier a little
    expected = {name: approx(plain[name], rel=0.015) for name in NUMBERS}
    assert {name: found[name] for name in NUMBERS} == expected
    for name in ("dynamic_imbalance", "sudden_loss", "force_drop"):
        assert found[name] == approx(plain[name], abs=0.01)
    for name in ("displacement_at_first_crack_mm", "collapse", "too_fast", "drop_at_mm"):
        assert found[name] == plain[name]
    # the force works on what it pushes, not on another control
    assert found.get("push_work_J", plain["push_work_J"]) == approx(plain["push_work_J"], rel=0.03)
    assert ("push_work_J" in found) == (case != "other control")


# -- one run, many stages --------------------------------------------------------------------------


def wall(folder, size=(0.66, 0.486), rate=20):
    """A wall that a platen pushes, and this platen."""
    scene = standing(folder, bricks.Wall(*size), materials.calciumSilicate(), rate=rate)
    top = scene.platen("top", rotation="held")
    scene.press(top, 0.3e6)
    scene.settle()
    return scene, top


def rowsOf(scene, number):
    """Columns of curve.csv in the rows of a stage of a number, from 1."""
    folder = scene.results.directory
    firsts = [one["first_row"] for one in readRun(folder)["stages"]] + [None]
    return {n: v[firsts[number - 1] : firsts[number]] for n, v in readCurve(folder).items()}


@mark.parametrize(
    "ways, entry",
    [
        ([("push", 0.2), ("push", 0.1)], "push_work_J"),
        ([("cycle", 0.1), ("push", 0.3)], "push_work_J"),
        ([("push", 0.1), ("cycle", 0.2)], "loop_work_J"),
    ],
)
def test_every_push_has_the_numbers_of_its_own_rows(tmp_path, ways, entry):
    scene, top = wall(tmp_path)
    for name, far in ways:
        getattr(scene, name)(top, [far] if name == "cycle" else far)
    scene.finish()
    run, rows = readRun(tmp_path), rowsOf(scene, 3)
    assert run[entry] == approx(trapezoid(rows["base_shear_kN"], rows["displacement_mm"]))
    assert run["displacement_end_mm"] == approx(rows["displacement_mm"][-1])
    assert run.get("sudden_loss", 0) < 0.1 and run["first_period_s"] > 0  # a turn is no loss
    assert [one["continued"] for one in run["stages"]] == [False] * 3


def test_a_continued_push_goes_on_with_the_curve_and_the_sum_of_its_works(tmp_path):
    scene, top = wall(tmp_path)
    scene.push(top, 0.2)
    scene.release(top, "x")
    scene.settle()
    scene.push(top, 0.4, continued=True)
    scene.finish()
    run = readRun(tmp_path)
    parts = [rowsOf(scene, number) for number in (2, 5)]
    works = [trapezoid(one["base_shear_kN"], one["displacement_mm"]) for one in parts]
    assert run["push_work_J"] == approx(sum(works))
    # what was let go and is pushed again has lost no force
    assert run["drop_at_mm"] is None and run["displacement_at_fall_mm"] is None
    assert run["figure"]["rows"][0][0] == run["stages"][1]["first_row"]


def test_a_push_back_begins_with_the_force_that_its_drive_held(tmp_path):
    scene, top = wall(tmp_path)
    scene.push(top, 0.1)
    scene.settle(longest=1)
    scene.push(top, 0.3, direction=(-1, 0, 0))
    scene.finish()
    run, rows = readRun(tmp_path), rowsOf(scene, 4)
    assert rows["top_shear_kN"][0] == approx(rows["base_shear_kN"][0], rel=0.01)
    assert rows["top_shear_kN"][0] < -5
    assert not run["too_fast"] and run["first_period_s"] > 0
    assert 150 < run["initial_stiffness_kN_per_mm"] < 180  # 167 of the first push


@mark.parametrize(
    "rate, said",
    [(800, ["push (stage 2) is too fast", "push (stage 2): the force fell by"]), (20, [])],
)
def test_the_warnings_of_an_earlier_push_name_it(tmp_path, rate, said):
    scene, top = wall(tmp_path)
    scene.push(top, 1, rate=rate)
    scene.release(top, "x")
    scene.settle()
    scene.push(top, 0.2)
    scene.finish()
    warnings = readRun(tmp_path)["warnings"]
    assert len(warnings) == len(said) and all(map(str.startswith, warnings, said))


def test_cycles_that_turn_before_the_drive_has_its_rate_have_the_stiffness_of_a_push(tmp_path):
    found = []
    for n, how in enumerate(("push", "cycle")):
        scene, top = wall(tmp_path / how, (0.88, 0.81), 50)
        scene.push(top, 0.6) if how == "push" else scene.cycle(top, [0.05], unit="%")
        scene.finish()
        found.append(readRun(tmp_path / how))
        O.reset()
    push, cycle = (run["initial_stiffness_kN_per_mm"] for run in found)
    assert cycle == approx(push, rel=0.05)
    turn = np.argmax(readCurve(tmp_path / "cycle")["displacement_mm"])
    assert found[1]["velocity_grown_at_s"] < readCurve(tmp_path / "cycle")["time_s"][turn]


@mark.parametrize("unit, ends", [("%", "0.004115 to 205.8 %, over a height of 0.486 m")])
def test_limits_of_drifts_are_drifts(tmp_path, unit, ends):
    for amplitude in (1e-4, 300):
        scene, top = wall(tmp_path / f"{amplitude}")
        with raises(Refused, match=f"cycle: amplitude {amplitude:g} % must be from {ends}"):
            scene.cycle(top, [amplitude], unit=unit)
        letGo()
        O.reset()


# -- what is pushed, and what is counted -----------------------------------------------------------


@mark.parametrize("pushed", ["target", "pattern"])
def test_a_control_changes_no_force(tmp_path, pushed):
    """A press over rollers stands over what presses it, whatever is counted."""
    peaks = []
    for controlled in (False, True):
        stone = materials.dry(friction=0.8, normalStiffness=5e9, density=2000)
        blocks = bricks.stack(6, (0.2, 0.2, 0.2))
        scene = standing(tmp_path / f"{controlled}", blocks, stone, rate=50)
        top = scene.platen("top", rotation="free")
        middle = scene.handle((0.1, 0.1, 0.5), name="middle")
        scene.press(top, 2e5, riding=False)
        scene.settle()
        what = middle if pushed == "target" or not controlled else {middle: 1.0}
        scene.push(what, 5, control=top if controlled else None)
        scene.finish()
        curve, run = scene.curve(), readRun(tmp_path / f"{controlled}")
        at = [np.interp(far, curve["middle_x_mm"], curve["base_shear_kN"]) for far in (0.5, 1)]
        peaks.append(at)
        line = 0.1 - 1e-3 * curve["top_x_mm"][-1]
        press = scene.model.loading.loads["top_press"].point
        assert press[0] == approx(line, abs=1e-4)
        # it is not the platen that is pushed
        assert "wall" not in run
        assert run["figure"]["x"]["label"].startswith(
            f"displacement of {'top' if controlled else 'middle'}"
        )
        letGo()
        O.reset()
    assert peaks[0] == approx(peaks[1], rel=1e-6)


def test_what_has_grown_beside_a_press_keeps_its_line_too(tmp_path):
    moments = []
    for grown in (0, 1e5):
        scene = standing(tmp_path / f"{grown}", PIER, ELASTIC, rate=50)
        top = scene.platen("top", rotation="free")
        scene.press(top, 2e5 - grown, riding=False)
        scene.settle()
        if grown:
            scene.grow({top: grown}, over=0.02)
        scene.push(top, 5)
        moments.append(scene.curve()["base_M_y_kNm"][-1])
        letGo()
        O.reset()
    assert moments[0] == approx(moments[1], rel=1e-3)


def test_a_pattern_is_counted_by_its_mean_on_which_its_force_works(tmp_path):
    scene = standing(tmp_path, PIER, ELASTIC, rate=20)
    scene.watch(0, name="foot")  # which hardly moves
    scene.settle()
    scene.push("masses", 0.5)
    loading = scene.model.loading
    before = loading.target, loading.control.recorded, loading.state()
    mean = np.mean([O.bodies[n].state.displ()[0] for n in scene.model.ids])
    loading.putState(loading.state())
    assert loading.control is loading.target is loading.followed is not before[0]
    assert loading.state() == before[2] and loading.control.recorded == approx(before[1])
    assert loading.alongNow() == approx(1e-3 * scene.curve()["displacement_mm"][-1])
    scene.finish()
    curve, run = scene.curve(), readRun(tmp_path)
    assert curve["displacement_mm"][-1] == approx(0.5, abs=0.02) == 1e3 * mean
    work = trapezoid(curve["base_shear_kN"][1:], curve["displacement_mm"][1:])
    assert run["push_work_J"] == approx(work, rel=1e-6)
    assert run["recorded_height_m"] == approx(COUNT * COURSE / 2)


def test_a_control_that_turns_back_is_named(tmp_path):
    """The lower part of a pier stops when the upper one slides."""
    slippery = materials.dry(friction=0.1, normalStiffness=2e10, density=2400)
    scene = standing(tmp_path, PIER, slippery, rate=50)
    top, middle = scene.handle(-1, "top"), scene.handle(2, "middle")
    scene.settle()
    scene.push({top: 1, middle: 1}, 0.5, control=middle)
    scene.finish()
    run = readRun(tmp_path)
    said = [note["text"] for note in run["notes"]]
    assert any("middle, whose displacement counts, turned back at 0." in text for text in said)
    assert "another part gives way" in run["collapse"] and "middle, which was at" in run["collapse"]


# -- waits and supports ----------------------------------------------------------------------------


def test_a_press_on_soft_soil_sinks_and_holds(tmp_path):
    stone = materials.dry(normalStiffness=2e10, density=2000)
    scene = lean(tmp_path, bricks.stack(4, (0.3, 0.2, 0.07)), stone)
    scene.platen("bottom", springs={"z": 5e4})
    top = scene.platen("top", rotation="free", drive="x")
    scene.press(top, 1e4)
    assert scene.settle(longest=10) == AT_REST
    assert scene.press(top, 6e4, longest=10) == AT_REST
    assert scene.curve()["top_z_mm"][-1] < -60  # half a course is 35 mm
    assert scene.settle(longest=5) == AT_REST


@mark.parametrize("rate, much", [(60, True), (2, False)])
def test_a_move_says_what_inertia_takes_of_its_reactions(tmp_path, rate, much):
    """Supports that spread fast drag half an arch with them."""
    arch = bricks.Arch(0.3, 1.0, 11, radius=2.0, skewback=0.3)
    scene = lean(tmp_path, arch, materials.dry(normalStiffness=2e10), rate=rate)
    left, right = scene.hold(11, name="left"), scene.hold(12, name="right")
    scene.settle()
    scene.move(right, x=5)
    forces = [scene.curve()[f"{name}_force_x_kN"][-1] for name in ("left", "right")]
    (share,) = (a["value"] for a in scene.answers if a["name"] == "dynamic_imbalance")
    assert share == approx(abs(sum(forces)) / max(map(abs, forces)), rel=0.02)
    said = [note["text"] for note in scene.running.state.notes]
    assert any("of a reaction inertia is" in text for text in said) == much
    scene.move(right, x=-0.5)
    *_, moved = (a["value"] for a in scene.answers if a["name"] == "displacement_of_right")
    assert moved == approx(0.5, abs=0.001)  # in this stage
    scene.finish()


def test_head_joints_without_bond_turn_with_their_beds(tmp_path):
    """They open, and are no joints about which the wall turns: continuous beds hold no less."""
    scene = lean(
        tmp_path,
        bricks.Wall(1.1, 0.405),
        materials.calciumSilicate(),
        *"--set head.tensileStrength=0 --set head.cohesion=0".split(),
        rate=50,
    )
    scene.platen("bottom")
    top = scene.platen("top", drive="x")
    scene.press(top, 0.5e6)
    scene.settle()
    scene.push(top, 1.5)
    assert scene.model.scheme.joints.overestimate == 0
    scene.finish()
