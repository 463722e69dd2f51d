# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python package: materials, options, presets, results, curves."""

from usual import *
import resource
from masonry import materials
from masonry.background import Task
from masonry.numbers import columns
from masonry.numbers import curves, files
from masonry.run import presets, results
from masonry.scene import options, targets
from masonry.materials.settings import applySettings, setting
from masonry.errors import Unwritable


# -- materials -------------------------------------------------------------------------------------


def test_the_published_set_is_the_paper_s_table_2():
    joints = materials.calciumSilicateJoints()
    assert list(joints) == ["support", "bed", "head", "crack"]
    bed, head = joints["bed"], joints["head"]
    kn = 4800e6 * 1973.7e6 / (0.01 * (4800e6 - 1973.7e6))  # eq. (26)
    assert bed.normalStiffness == approx(kn, rel=1e-3)
    assert bed.shearStiffness == approx(kn / (2 * 1.16), rel=1e-3)
    assert (bed.tensileStrength, bed.cohesion, bed.friction) == (0.1e6, 0.11e6, 0.43)
    assert (bed.compressiveStrength, head.compressiveStrength) == (7.55e6, 5.93e6)
    assert bed.compressiveFractureEnergy == 15000 and bed.peakRatio == 68.5
    assert head.compressiveFractureEnergy == 31500
    assert joints["support"].elastic and not joints["crack"].cap


# -- options ---------------------------------------------------------------------------------------


def parse(*words):
    return options.parser("a wall", until=12).parse_args(words)


def test_settings_change_the_named_property_only():
    joints = materials.calciumSilicateJoints()
    words = "bed.tensileStrength=5e4 head.cap=off bed.tensionTable=1:0,2:1".split()
    applySettings(joints, parse(*(f"--set={word}" for word in words)).set)
    assert [joints[n].tensileStrength for n in ("bed", "head")] == [5e4, 1e5]
    assert not joints["head"].cap and joints["bed"].tensionTable == [(1, 0), (2, 1)]


def test_all_wrong_settings_are_reported_at_once():
    joints = materials.calciumSilicateJoints()
    words = "bed.Friction=1 bed.cap=maybe bed.cohesion=much crack.name=x".split()
    with raises(Refused) as refused:
        applySettings(joints, [setting(word) for word in words])
    for part in (
        "bed.Friction: a MasonryJoint has no such property, did you mean friction?",
        "--set bed.cap=maybe: must be on or off",
        "--set bed.cohesion=much: must be a number",
        "--set crack.name: a MasonryJoint has no such property",
    ):
        assert part in str(refused.value)


@mark.parametrize("name", options.PRESETS)
def test_a_preset_stands_for_its_options(name):
    args = parse("--preset", name, "--until", "3", "--no-vtk", "--out", "x")
    assert options.PRESETS[name].items() <= vars(args).items()
    assert presets.presetOf(args, LIKE)["overrides"] == []


@mark.parametrize(
    "words, dropped",
    [
        (["--rate", "7"], ["rate"]),
        (["--damping", "0.5", "--divisions", "3"], ["divisions", "damping"]),
        (["--set", "bed.cohesion=1e5"], ["set"]),
        (["--crack-surfaces", "off"], ["crack_surfaces"]),
        (["--history", "2"], ["history"]),
        (["--rate", "100", "--crack-surfaces", "on"], []),  # the preset's own values
    ],
)
def test_an_option_beside_a_preset_wins_and_drops_the_promise(words, dropped):
    preset = presets.presetOf(parse("--preset", "fast", *words), LIKE)
    note = presets.presetNote(preset)
    assert preset["overrides"] == dropped
    isDropped = preset["promise"] is None, "without a promise" in note
    assert isDropped == (bool(dropped), bool(dropped))
    assert all("--" + name.replace("_", "-") in note for name in dropped)


#: Of a wall that is like those on which ``fast`` was measured.
LIKE = {name: 0.5 * (least + most) for name, (least, most) in presets.RANGE.items()}


@mark.parametrize(
    "name, like, promise, sentence",
    [
        ("fast", LIKE, presets.PROMISE, "their peak within 6 % and their work within 7 %"),
        ("fast", None, None, "moves in space"),
        ("accurate", LIKE, None, "--accuracy 2 finds"),
    ],
)
def test_fast_promises_the_errors_of_the_walls_that_a_wall_is_like(name, like, promise, sentence):
    preset = presets.presetOf(parse("--preset", name), like)
    assert preset["promise"] == promise and sentence in presets.presetNote(preset)


@mark.parametrize("name", presets.RANGE)
@mark.parametrize("end", [0, 1])
def test_a_preset_names_the_property_that_was_not_measured(name, end):
    ends = presets.RANGE[name]
    beyond = lambda share: {**LIKE, name: ends[end] + share * (2 * end - 1) * ends[1]}
    preset = presets.presetOf(parse("--preset", "fast"), beyond(0.02))
    (sentence,) = preset["outside"]
    assert presets.outsideOf(beyond(0.004)) == []  # rounded
    assert preset["promise"] is None and sentence.startswith(name.partition(" [")[0])
    assert sentence in presets.presetNote(preset)


@settings(max_examples=300)
@given(some.text("0123456789.:,+-_einfax ", max_size=40))
def test_any_text_for_a_table_is_refused_in_words_or_makes_a_joint(text):
    joints = {"bed": materials.MasonryJoint()}
    try:
        applySettings(joints, [("bed", "shearTable", text)])
    except Refused as refused:
        begins = "--set bed.shearTable=", 'joint "bed": shear table, '
        assert str(refused).startswith(begins)
    else:
        ratios = [row[0] for row in joints["bed"].softening()["shear"]]
        assert ratios[0] == 1 and ratios == sorted(set(ratios))


def test_every_option_is_explained_with_its_unit():
    for action in options.parser("a wall", until=12)._actions:
        assert action.help
        assert "[mm" in action.help or action.metavar not in ("MM", "MM_PER_S")


# -- results ---------------------------------------------------------------------------------------


def test_rows_that_a_full_disk_takes_stay_whole(tmp_path):
    folder = str(tmp_path)

    def work():
        r = results.Results(folder, ["a_mm", "b_kN"])
        r.begin()
        limit = os.path.getsize(r.path("curve.csv")) + 102  # bytes: 20 rows and a bit
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        r.append([[1, 2]] * 3)
        with raises(Unwritable, match="File too large$"):
            r.append([[3, 4]] * 50)
        yield len(r.rows)

    assert Task(work).result() == 53
    # As many lines of 5 bytes as fit after the first 3.
    assert files.readCurve(folder)["a_mm"] == [1] * 3 + [3] * 17


def test_dynamic_imbalance_is_the_share_of_the_force_that_does_not_arrive():
    base, found = [min(0.01 * i, 1.0) for i in range(200)], curves.dynamicImbalance
    assert found(base, base) == 0 and found([], []) == 0
    drag = [b + 0.25 for b in base]
    assert found(drag, base) == approx(0.25 / 1.25, rel=1e-9)
    swing = [b + 0.25 * (-1) ** i for i, b in enumerate(base)]
    assert found(swing, base) == approx(0.25 / 1.25, rel=1e-9)
    # A vibration at the start must not count.
    start = [b + 0.25 * (b < 0.4) for b in base]
    assert found(start, base) == 0
    after = base + [0.2] * 100  # behind the peak 100 of 200 rows lack 0.7
    lacking = found(base + [0.9] * 100, after)
    assert lacking == approx(0.7 * math.sqrt(0.5), rel=0.01)
    stuck = [0.1 * b for b in base]
    assert found(base, stuck) == approx(0.9 * math.sqrt(2 / 3), rel=0.01)


def test_initial_stiffness_is_that_between_a_twentieth_and_a_quarter_of_the_peak():
    force = [0.001 * i for i in range(1001)]  # up to a peak of 1
    slopes = [3 if f <= 0.05 else 2 if f <= 0.25 else 1 for f in force]
    moved = [0.0]
    for slope in slopes[1:]:
        moved.append(moved[-1] + 0.001 / slope)
    assert curves.initialStiffness(moved, force) == approx(2, rel=1e-9)
    assert curves.initialStiffness([], []) == 0
    after = [1 - f for f in force]  # what follows on the peak does not count
    assert curves.initialStiffness(moved + moved, force + after) == approx(2, rel=1e-9)


@mark.parametrize("period, slope", [(0.004, 100.0), (0.013, 5.0)])
def test_the_stiffness_of_a_bar_in_shear_is_found_while_its_drive_grows(period, slope):
    """The waves of a bar that is driven at one end, in closed form: their speed crosses it in half
    a period."""
    step, rate = period / 4000, 100.0
    times = [n * step for n in range(4 * 4000)]
    moved = lambda t: rate * (t**2 / 2 / period if t < period else t - period / 2)
    speed = lambda t: rate * min(max(t / period, 0.0), 1.0)
    wave = slope * period / 2  # force of a wave over its velocity
    sum_ = lambda t, first: sum(2 * speed(t - n * period) for n in range(first, 5))
    top = [wave * (speed(t) + sum_(t, 1)) for t in times]
    base = [wave * sum_(t + period / 2, 1) for t in times]
    x = [moved(t) for t in times]
    still = curves.quasiStatic(top, base)
    for peak in (1.0, 1.5, 2.5):  # displacement at the end, over that of the ramp
        end = next(n for n, v in enumerate(x) if v >= peak * moved(period))
        found = curves.stiffness(x[: end + 1], still[: end + 1], 4000)
        assert found == approx(slope, rel=1e-3)
    assert curves.stiffness([], []) == 0
    assert curves.stiffness([1.0], [3.0]) == 0
    assert curves.stiffness([0.0, 1.0, 2.0], [10.0, 13.0, 16.0]) == approx(3)


def test_the_damped_share_is_that_of_damping_in_what_was_taken():
    rows = {
        "damping_J": [5.0, 6.0, 8.0],
        "dissipated_tension_J": [1.0, 1.0, 2.0],
        "dissipated_shear_J": [10.0, 12.0, 13.0],
        "dissipated_compression_J": [0.0, 0.5, 2.0],
    }
    taken = (2 - 1) + (13 - 10) + (2 - 0)
    grown = lambda rows: lambda name: rows[name][-1] - rows[name][0]
    assert curves.dampedShare(grown(rows)) == approx(3 / (3 + taken), rel=1e-12)
    at = lambda row: {name: [values[row]] * 2 for name, values in rows.items()}
    assert curves.dampedShare(grown(at(2))) == 0  # nothing is taken
    bounced = {**rows, "damping_J": [5.0, 4.0]}  # by round-off it may fall
    assert curves.dampedShare(grown(bounced)) == 0


def test_a_column_says_its_unit_in_its_name_and_in_its_meaning():
    low, high = (targets.Target(n, recorded=(0, 0, z)) for n, z in (("a", 0), ("b", 1)))
    recorded = [
        *high.columns(plane=False),
        *targets.Drift("drift", low, high).columns(plane=True),
        *targets.JointRecord("joint0", (0, 1)).columns(plane=True),
    ]
    assert (
        " ".join(columns.heads(recorded))
        == "b_x_mm b_y_mm b_z_mm b_rotation_mrad drift_x_mm drift_x_mrad joint0_opening_mm "
        "joint0_slide_mm joint0_normal_stress_MPa joint0_shear_stress_MPa"
    )
    usual = columns.PUSH + columns.HISTORY + columns.BALANCE
    listed = columns.meanings(usual + recorded)
    assert next(iter(listed)) == "time_s"
    for head, meaning in listed.items():
        unit = meaning[meaning.rindex("[") + 1 : -1]
        assert unit == "-" or head.endswith("_" + unit)


def test_the_energies_are_those_of_the_balance(scene):
    from yade.wrapper import MasonryEnergy

    scene.engines = [MasonryEnergy()]
    assert set(columns.ENERGIES) | {"error"} == set(scene.engines[0].balance())


# -- a push whose force falls at once is doubted; ordinary softening and waves are not -------------


def curve(force, step=0.01, until=5.0):
    """Displacements [mm], and the force at both ends [kN], of a function of the displacement."""
    moved = [n * step for n in range(int(until / step) + 1)]
    return moved, [force(u) for u in moved]


def test_a_fall_is_found_with_its_place_and_share_of_the_peak():
    moved, force = curve(lambda u: 25.0 * min(u, 1.0) - (4.0 if u >= 2.05 else 0.0))
    share, at = curves.suddenLoss(moved, force, force)
    assert share == approx(4 / 25)
    assert 1.94 < at < 2.06


def test_steady_softening_is_no_sudden_loss():
    # a quarter of the peak is lost over each millimetre
    moved, force = curve(lambda u: 40.0 * min(u, 1.0) * math.exp(-0.29 * max(u - 1, 0)))
    assert curves.suddenLoss(moved, force, force)[0] < 0.03


def test_a_wave_that_one_end_feels_before_the_other_counts_by_half():
    moved, base = curve(lambda u: 30.0 if u < 2 else 30.0 + 5 * math.sin(100 * u))
    top = [60.0 - b for b in base]  # against phase
    assert curves.suddenLoss(moved, top, base)[0] < 1e-9


@mark.parametrize("rows", [0, 1])
def test_a_push_without_rows_and_rows_far_apart_show_none(rows):
    assert curves.suddenLoss([0.0] * rows, [1.0] * rows, [1.0] * rows) == (0.0, 0.0)
    moved, force = curve(lambda u: 10.0 if u < 2 else 5.0, step=0.5)
    assert curves.suddenLoss(moved, force, force) == (0.0, 0.0)
