# SPDX-License-Identifier: GPL-2.0-or-later
"""Bilinear curves and drifts of a push: closed forms, what does not depend on units, and curves
that have none."""

from usual import *
from masonry_capacity.bilinear_curve import RULES, bilinear, drifts, ofRun, pushover
from made_runs import writeRun
from scipy.integrate import trapezoid

HEADS = ["time_s", "displacement_mm", "base_shear_kN", "top_shear_kN"]


def curve(*points, rows=401):
    """A curve of straight lines through points, with their corners."""
    corners, values = np.array(points, float).T
    moved = np.unique(np.append(np.linspace(0, corners[-1], rows), corners))
    return moved, np.interp(moved, corners, values)


# -- closed forms ----------------------------------------------------------------------------------

SUDDEN = curve((0, 0), (2, 100), (12, 100), (12.001, 0))


@mark.parametrize("rule", RULES)
def test_a_perfect_bilinear_curve_gives_itself(rule):
    """50 kN/mm up to 100 kN, a plateau to 12 mm and a sudden fall; the mechanism may form anywhere
    on the plateau."""
    for mechanism in (None, 5.0, 12.0):
        found = bilinear(*SUDDEN, rule, mechanism=mechanism)
        assert found.stiffness == approx(50)
        assert found.yieldForce == approx(100, rel=1e-4)
        assert found.yieldDisplacement == approx(2, rel=1e-4)
        assert found.ultimateDisplacement == approx(12.0002)
        assert found.ductility == approx(6, rel=2e-4)
        assert found.reached and found.notes == ()


def test_a_triangle_has_its_closed_form():
    """Up to 1 at 1 and down to 0 at 2: K = 1, du = 1.2, area 1/2 + (1 + 0.8)/2 × 0.2 = 0.68, Vy =
    1.2 - √(1.44 - 1.36)."""
    triangle = curve((0, 0), (1, 1), (2, 0))
    found = bilinear(*triangle)
    assert (found.stiffness, found.ultimateDisplacement, found.area) == approx((1, 1.2, 0.68))
    assert found.yieldForce == approx(1.2 - math.sqrt(0.08))
    found = bilinear(*triangle, "en1998")
    assert (found.yieldForce, found.yieldDisplacement) == approx((1, 1))


def test_a_parabola_has_its_closed_form():
    """V = 1 - (d - 1)²: 0.7 at 1 - √0.3, 0.8 at 1 + √0.2, area d² - d³/3; up to the peak 2/3, so dy
    = 2 (1 - 2/3)."""
    moved = np.linspace(0, 2, 20001)
    force = 1 - (moved - 1) ** 2
    stiffness, end = 0.7 / (1 - math.sqrt(0.3)), 1 + math.sqrt(0.2)
    area = end**2 - end**3 / 3
    found = bilinear(moved, force)
    assert found.stiffness == approx(stiffness, rel=1e-6)
    assert found.ultimateDisplacement == approx(end, rel=1e-6)
    assert found.area == approx(area, rel=1e-6)
    plateau = stiffness * (end - math.sqrt(end**2 - 2 * area / stiffness))
    assert found.yieldForce == approx(plateau, rel=1e-5)
    found = bilinear(moved, force, "en1998")
    assert found.yieldForce == approx(1)
    assert found.yieldDisplacement == approx(2 / 3, rel=1e-6)
    assert found.stiffness == approx(1.5, rel=1e-6)
    half = bilinear(moved, force, "en1998", mechanism=0.5)
    assert half.yieldForce == approx(0.75)
    assert half.yieldDisplacement == approx(2 * (0.5 - (0.25 - 0.125 / 3) / 0.75))


def test_the_secant_and_the_fall_are_those_that_are_given():
    moved, force = curve((0, 0), (1, 50), (3, 100), (5, 100), (9, 0))
    found = bilinear(moved, force, secant=0.5, fall=0.25)
    assert found.stiffness == approx(50)
    assert found.ultimateDisplacement == approx(8)
    assert bilinear(moved, force).stiffness == approx(70 / 1.8)


def test_the_curve_itself_has_the_plateau_and_no_force_beyond_its_end():
    force = bilinear(*SUDDEN).force([0, 1, 2, 12, 13])
    assert force[:4] == approx([0, 50, 100, 100], rel=1e-4)
    assert math.isnan(force[4])


# -- whatever the curve ----------------------------------------------------------------------------

shares = some.floats(0.05, 1.0)


@some.composite
def pushes(draw):
    """A curve that hardens less and less up to its peak, keeps it for a while, and softens."""
    slopes = sorted(draw(some.lists(shares, min_size=2, max_size=6)), reverse=True)
    steps = draw(some.lists(shares, min_size=len(slopes), max_size=len(slopes)))
    corners, values = [0.0], [0.0]
    for step, slope in zip(steps, slopes):
        corners.append(corners[-1] + step)
        values.append(values[-1] + slope * step)
    for length, share in ((draw(shares), 1.0), (draw(shares), draw(some.floats(0.0, 0.95)))):
        corners.append(corners[-1] + length)
        values.append(values[-1] * share)
    return curve(*zip(corners, values), rows=draw(some.integers(20, 200)))


def found(moved, force, *words):
    """The bilinear curve. Pushes that the method refuses with reason are left out of a test."""
    try:
        return bilinear(moved, force, *words)
    except Refused as refused:
        assume(not re.search("far above its secant|the curve has no peak", str(refused)))
        raise


@given(
    pushes(),
    some.floats(1e-3, 1e3),
    some.floats(1e-3, 1e3),
    some.sampled_from(sorted(RULES)),
)
def test_other_units_of_displacement_and_force_scale_the_answer(push, long, strong, rule):
    moved, force = push
    one, two = found(*push, rule), bilinear(long * moved, strong * force, rule)
    assert two.ultimateDisplacement == approx(long * one.ultimateDisplacement)
    assert two.yieldForce == approx(strong * one.yieldForce, rel=1e-6)
    assert two.stiffness == approx(strong / long * one.stiffness, rel=1e-6)
    assert two.ductility == approx(one.ductility, rel=1e-6)
    assert two.reached == one.reached


@given(pushes())
def test_areas_are_equal(push):
    one, code = found(*push), bilinear(*push, "en1998")
    for made, end in ((one, one.ultimateDisplacement), (code, code.mechanism)):
        fine = np.linspace(0, end, 200001)
        area = trapezoid(np.interp(fine, *push), fine)
        assert made.yieldForce * (end - made.yieldDisplacement / 2) == approx(area, rel=1e-4)
    assert 0 < one.yieldDisplacement <= one.ultimateDisplacement * (1 + 1e-9)
    above = any("yield force is above the peak" in note for note in one.notes)
    assert above == (one.yieldForce > one.peakForce * (1 + 1e-9))


@given(pushes(), some.integers(2, 4))
def test_more_rows_of_the_same_curve_change_nothing(push, times):
    moved, _ = push
    fine = np.unique([*moved, *np.linspace(0, moved[-1], times * len(moved))])
    one, two = found(*push), found(fine, np.interp(fine, *push))
    assume(not one.notes and not two.notes)
    assert two.yieldForce == approx(one.yieldForce, rel=1e-6)
    assert two.ductility == approx(one.ductility, rel=1e-6)


# -- curves that end early, and curves that are none -----------------------------------------------


def test_a_curve_that_does_not_fall_so_far_ends_at_its_end_and_says_so():
    found = bilinear(*curve((0, 0), (2, 100), (10, 85)))
    assert found.ultimateDisplacement == 10 and not found.reached
    assert found.notes[0].startswith("not reached: the force never falls to 0.8 of its peak")
    notes = {one.name: one.note for one in found.numbers()}
    assert notes["ultimate_displacement_mm"] == notes["displacement_ductility"] == found.notes[0]
    assert notes["bilinear_stiffness_kN_per_mm"] == ""


def test_a_plateau_up_to_the_end_says_that_the_force_may_grow():
    found = bilinear(*curve((0, 0), (2, 100), (10, 101)))
    assert any("largest at the end of the curve" in note for note in found.notes)


#: A curve with a fall that lasts for 0.04 mm.
WAVE = curve(
    (0, 0), (2, 100), (3, 98), (3.01, 70), (3.04, 70), (3.05, 98), (6, 90), (7, 0), rows=4001
)


def test_a_short_fall_is_a_wave_and_a_long_one_is_the_ultimate_displacement():
    found = bilinear(*WAVE, pulse=0.1)
    assert found.ultimateDisplacement == approx(6 + 1 / 9) and not found.notes
    found = bilinear(*WAVE)
    assert found.ultimateDisplacement == approx(3 + 0.01 * 18 / 28)
    assert "the force came back above that, up to 6.1" in found.notes[0]


def test_a_fall_just_before_the_end_may_be_a_wave():
    moved, force = curve((0, 0), (2, 100), (6, 90), (6.01, 70), (6.05, 70), rows=4001)
    assert bilinear(moved, force).reached
    found = bilinear(moved, force, pulse=0.1)
    assert not found.reached and found.ultimateDisplacement == 6.05
    assert "for longer than a wave of 0.1 mm" in found.notes[0]
    assert bilinear(moved, force, pulse=0.03).reached
    drop = np.append(moved[moved <= 6], 6.0), np.append(force[moved <= 6], 0.0)
    assert bilinear(*drop).ultimateDisplacement == 6  # an upright line


def test_a_peak_anywhere_on_a_plateau_says_what_the_stiffness_depends_on():
    moved, force = curve((0, 0), (1, 50), (2, 96), (20, 100), (22, 0), rows=4001)
    found = bilinear(moved, force, "en1998")
    early = bilinear(moved, force, "en1998", mechanism=2 - 1 / 46)
    for part in (
        "the force is above 0.95 of its peak from 1.978 mm on, and the peak is at 20 mm",
        f"{early.stiffness:.4g} kN/mm with the first and {found.stiffness:.4g} kN/mm with the",
    ):
        assert part in found.notes[0]
    assert early.notes == () and bilinear(moved, force).notes == ()


@mark.parametrize(
    "moved, force, message",
    [
        ([], [], "the curve is empty"),
        ([0, 1], [0, 1, 2], "as many displacements as forces, not 2 and 3"),
        ([0, 1, math.nan], [0, 1, 2], "a number that is not finite"),
        ([0, 1], [0, 1], "is no push: it has 2 rows"),
        ([0, 1, 2], [0, -1, -2], "its largest force is 0 kN"),
        (
            [0, 1, 2, 3],
            [0, 1, 2, 3],
            "has no peak: its force still grows at its end, 3 mm, with 1 kN/mm",
        ),
        (
            [0, 1, 2, 1, 0],
            [0, 5, 6, 2, 0],
            "the displacement goes back by 2 mm: the curve is of cycles or of several pushes",
        ),
        ([0, 1, 2, 3], [3, 5, 6, 2], "the curve begins with 3 kN at 0 mm"),
        ([1, 2, 3, 4], [0, 5, 6, 2], "the curve begins with 0 kN at 1 mm"),
    ],
)
def test_a_curve_that_has_none_is_refused_in_a_sentence(moved, force, message):
    for rule in RULES:
        with raises(Refused, match=message):
            bilinear(moved, force, rule)


def test_a_curve_with_more_area_than_any_bilinear_one_is_refused():
    # the triangle of 1 kN/mm has 8 J up to 4 mm, the curve has 0.5 + 2.5 + 8 J
    moved, force = curve((0, 0), (1, 1), (2, 4), (4, 4.0), (4.001, 0))
    for how, message in (
        (dict(secant=0.25), "triangle has 8.*J, because the curve lies far above its secant"),
        (dict(rule="en1998", mechanism=2.0), "no yield displacement between 0 and 2 mm"),
        (dict(rule="en1998", mechanism=9.0), "beyond the ultimate displacement"),
    ):
        with raises(Refused, match=message):
            bilinear(moved, force, **how)


# -- of a run --------------------------------------------------------------------------------------


PUSH = {"stage": "push", "first_row": 0, "load": ["push", "top along x", ""]}


def run(folder, moved, base, top=None, **entries):
    """A folder of results with a push that takes a second."""
    time, top = np.linspace(0, 1, len(moved)), base if top is None else top
    rows = np.column_stack([time, moved, base, top])
    return writeRun(folder, HEADS, rows, **{"stages": [PUSH], "interrupted": False, **entries})


def alike(one, two):
    numbers = lambda found: [number.value for number in found.numbers()]
    return numbers(one) == approx(numbers(two), rel=1e-8) and one.notes == two.notes


WHOLE = curve((0, 0), (2, 100), (10, 95), (12, 60))


def test_the_force_of_a_run_is_what_both_ends_carry_at_once(tmp_path):
    moved, base = WHOLE
    top = base.copy()
    top[150], base = 140, np.where(np.arange(len(base)) == 160, 150, base)
    folder = run(tmp_path, moved, base, top)
    assert alike(ofRun(folder), bilinear(*WHOLE))


def test_a_wave_of_a_run_lasts_no_longer_than_its_first_period(tmp_path):
    slow = run(tmp_path / "slow", *WAVE, first_period_s=1e-3)
    fast = run(tmp_path / "fast", *WAVE, first_period_s=2e-2)
    assert pushover(fast).data.pulse == approx(0.14)
    assert ofRun(slow).ultimateDisplacement < 3.01
    assert ofRun(fast).ultimateDisplacement == approx(6 + 1 / 9)


def test_only_the_rows_of_the_last_push_count(tmp_path):
    moved, force = WHOLE
    both = np.append([3.0, 1.0, 0.0], moved), np.append([9.0, 9.0, 9.0], force)
    other = {**PUSH, "load": ["push", "top along y", ""]}
    folder = run(tmp_path, *both, stages=[other, {**PUSH, "first_row": 3}])
    assert alike(ofRun(folder), bilinear(moved, force))


@mark.parametrize(
    "entries, message",
    [
        ({"interrupted": True}, "the run was interrupted, so its curve is not whole"),
        ({"error": "the disk is full"}, "ended by an error: the disk is full"),
        ({"history": {"text": "1,2"}}, "goes along a history of loading"),
        ({"stages": []}, "the run has no push"),
        ({"stages": [None]}, "not the files of a finished run"),
    ],
)
def test_a_run_without_a_whole_push_is_refused_with_its_folder(tmp_path, entries, message):
    folder = run(tmp_path, *WHOLE, **entries)
    with raises(Refused, match=message) as refused:
        ofRun(folder)
    assert str(refused.value).startswith(folder)


def test_a_run_that_is_no_push_is_refused(tmp_path):
    folder = writeRun(tmp_path, ["time_s", "load_factor"], [[0, 0], [1, 1]], figure={})
    heads = "displacement_mm, base_shear_kN, top_shear_kN"
    with raises(Refused, match=f"the run has no push: curve.csv has no column {heads}"):
        ofRun(folder)
    with raises(Refused, match="cannot read"):
        ofRun(tmp_path / "nowhere")


def test_a_push_to_its_collapse_and_the_warnings_of_a_run_are_said(tmp_path):
    moved, force = curve((0, 0), (2, 100), (10, 90))
    warnings = ["the push is too fast: 12 %", "the force fell by 30 % of its peak within 0.1 mm"]
    folder = run(tmp_path, moved, force, collapsed=True, warnings=warnings)
    notes = ofRun(folder).notes
    assert notes[0].startswith("not reached: the structure collapsed at 10 mm")
    assert notes[1:] == tuple(f"the run warns: {text}" for text in warnings)


def test_drifts_are_displacements_over_the_height(tmp_path):
    folder = run(tmp_path / "wall", *WHOLE, recorded_height_m=2.5)
    _, peak, fall, collapse = drifts(folder)
    assert (peak.name, peak.value) == ("drift_at_peak_mrad", approx(0.8))
    assert fall.value == approx(bilinear(*WHOLE).ultimateDisplacement / 2.5)
    assert collapse.value is None and collapse.note == "the push did not end in a collapse"
    assert drifts(folder, height=5.0)[1].value == approx(0.4)
    other = run(tmp_path / "other", *WHOLE)
    with raises(Refused, match="drifts need height=, in m"):
        drifts(other)
    assert drifts(other, 2.0)[1].value == approx(1)


def test_numbers_have_unit_meaning_and_source():
    found = bilinear(*WHOLE)
    for one in found.numbers():
        assert one.name.endswith(one.unit.replace("/", "_per_")) or one.unit == "-"
        assert one.meaning.endswith(".") and one.source
    code = bilinear(*WHOLE, "en1998").numbers()
    assert code[0].source == "EN 1998-1:2004, annex B.3, equation (B.6)"


def test_the_program_prints_both_rules_and_the_drifts(tmp_path):
    folder = run(tmp_path, *WHOLE)
    program = [sys.executable, "-m", "masonry_capacity.bilinear_curve"]
    done = ran([*program, folder])
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("yield_force_kN") == 2
    assert "drifts need height=" in done.stdout
    done = ran([*program, "nowhere"])
    assert done.returncode == 2 and "cannot read" in done.stderr
