# SPDX-License-Identifier: GPL-2.0-or-later
"""Capacity and demand: spectra of EN 1998-1, the N2 method against numbers by hand, the files of a
run, and N-V domains."""

from usual import *
import masonry_capacity as capacity
from masonry_capacity import bilinear, demand, elastic, equivalent
from masonry_capacity import __main__ as program
from test_bilinear import PUSH, WHOLE, curve, run
from made_runs import writeRun

# -- spectra ---------------------------------------------------------------------------------------


def test_the_spectrum_has_its_values_at_the_corners():
    """Type 1, ground B, agR 0.2 g, importance 1.2: ag S = 0.2 × 9.81 × 1.2 × 1.2 m/s², TB 0.15, TC
    0.5, TD 2 s."""
    found = elastic(0.2, "g", type=1, ground="B", importance=1.2)
    top = 2.5 * 0.2 * 9.81 * 1.2 * 1.2
    assert found.corner == 0.5
    shares = {0: 0.4, 0.075: 0.7, 0.15: 1, 0.5: 1, 1.0: 0.5, 2.0: 0.25, 4.0: 1 / 16}
    for period, share in shares.items():
        assert found.acceleration(period) == approx(share * top)
    assert found.displacement(1.0) == approx(1e3 * top / 2 / (2 * math.pi) ** 2)


@mark.parametrize(
    "type, ground, soil, corners",
    [
        (1, "A", 1.0, (0.15, 0.4, 2.0)),
        (1, "C", 1.15, (0.2, 0.6, 2.0)),
        (1, "D", 1.35, (0.2, 0.8, 2.0)),
        (1, "E", 1.4, (0.15, 0.5, 2.0)),
        (2, "A", 1.0, (0.05, 0.25, 1.2)),
        (2, "B", 1.35, (0.05, 0.25, 1.2)),
        (2, "C", 1.5, (0.1, 0.25, 1.2)),
        (2, "D", 1.8, (0.1, 0.3, 1.2)),
        (2, "E", 1.6, (0.05, 0.25, 1.2)),
    ],
)
def test_grounds_have_the_corners_of_the_tables(type, ground, soil, corners):
    """The corners are where the plateau begins and ends, and where Se T² becomes constant."""
    found = elastic(1.0, "m/s²", type=type, ground=ground)
    tb, tc, td = corners
    at, top, e = found.acceleration, 2.5 * soil, 1e-6
    assert at(0) == approx(soil)
    assert at(tb - e) < top == approx(at(tb))
    assert at(tc) == approx(top) and at(tc + e) < top
    assert at(td) == approx(top * tc / td)
    assert at(3.0) * 9 == approx(at(4.0) * 16)
    assert at(td - 0.1) * (td - 0.1) ** 2 < top * tc * td * (1 - e)


def test_damping_lowers_the_spectrum_as_far_as_055():
    """η = √(10/(5 + ξ)), 0.816 at 10 %, not below 0.55; the acceleration at the period 0 is that of
    the ground."""
    ground = dict(ag=1.0, unit="m/s²", type=1, ground="A")
    usual = elastic(**ground)
    for damping, correction in (
        (5, 1),
        (10, math.sqrt(10 / 15)),
        (2, math.sqrt(10 / 7)),
        (40, 0.55),
    ):
        found = elastic(**ground, damping=damping)
        assert found.acceleration(0.3) == approx(correction * usual.acceleration(0.3))
        assert found.acceleration(0) == approx(1)


def test_units_and_annexes():
    ground = dict(type=1, ground="C")
    one = elastic(0.1, "g", **ground)
    for ag, unit in ((0.981, "m/s²"), (0.981, "m/s2"), (98.1, "cm/s²")):
        other = elastic(ag, unit, **ground)
        assert other.accelerations == approx(one.accelerations)
    own = elastic(0.1, "g", **ground, parameters=(1.15, 0.2, 0.6, 2.0))
    assert own.accelerations == approx(one.accelerations)
    assert "given values" in own.source


@mark.parametrize(
    "words, message",
    [
        (dict(ag=25, unit="g", type=1, ground="A"), "is ag 25 g in another unit?"),
        (
            dict(ag=0.1, unit="g", type=1, ground="A", parameters=(1, 0.5, 0.2, 2)),
            "0 < TB <= TC <= TD",
        ),
        (dict(ag=0.1, unit="g", ground="A"), "elastic: type must be given"),
    ],
)
def test_odd_spectra_are_refused(words, message):
    with raises(Refused, match=message):
        elastic(**words)


@mark.parametrize("mark", [",", ";", "\t", "  "])
def test_a_spectrum_of_a_file_is_lines_between_its_rows(tmp_path, mark):
    path = tmp_path / "spectrum.csv"
    path.write_text("# a site\n" + "T Sa\n0 0.1\n0.2 0.3\n\n1.0 0.1\n".replace(" ", mark))
    found = capacity.readSpectrum(path, "g", corner=0.5)
    assert found.acceleration(0.1) == approx(0.2 * 9.81)
    assert found.acceleration(0.6) == approx(0.2 * 9.81)
    assert found.corner == 0.5 and found.longest == 1.0


@mark.parametrize(
    "text, words, message",
    [
        ("0,1\n1,2\n", dict(unit="g"), "give TC in s, corner= in Python or --corner"),
        ("0,1\n1,2\n", dict(unit="g", corner=2), "must be within the periods, 0 to 1 s"),
        ("0,1\n1,2,3\n", dict(unit="g", corner=1), "line 2: it must have a period"),
        ("0,1\n0,2\n", dict(unit="g", corner=1), "line 2: periods must grow"),
        ("0,1\n1,-2\n", dict(unit="g", corner=1), "neither below zero"),
        ("0,1\n", dict(unit="g", corner=1), "two rows at least"),
        ("0,981\n1,981\n", dict(unit="g", corner=1), "below 100 g: is the unit 'g'?"),
        (None, dict(unit="g", corner=1), "cannot read"),
    ],
)
def test_odd_files_of_spectra_are_refused(tmp_path, text, words, message):
    path = tmp_path / "spectrum.csv"
    if text is not None:
        path.write_text(text)
    with raises(Refused, match=message):
        capacity.readSpectrum(path, **words)


# -- the equivalent system -------------------------------------------------------------------------


def test_two_storeys_have_their_equivalent_mass_and_factor():
    """Masses of 20 and 10 t with the shape 0.5, 1: m* = 20 t, Γ = 20/(20 × 0.25 + 10) = 4/3."""
    found = capacity.ofMasses([20e3, 10e3], [0.5, 1])
    assert found.mass == approx(20e3) and found.gamma == approx(4 / 3)
    one = capacity.ofMasses([30e3], [1])
    assert (one.mass, one.gamma) == (30e3, 1)
    # a storey above the recorded point: 20 + 2 × 10 = 40 t over 20 + 4 × 10 t
    assert capacity.ofMasses([20e3, 10e3], [1, 2]).gamma == approx(2 / 3)


@mark.parametrize(
    "masses, shape, message",
    [
        ([1e3], [1, 2], "lists of equal length"),
        ([0.0], [1], "0.0 kg must be above 0"),
        ([1e3, 1e3], [1, -1], "is 0 kg, it must be above 0"),
    ],
)
def test_odd_masses_are_refused(masses, shape, message):
    with raises(Refused, match=message):
        capacity.ofMasses(masses, shape)


SYSTEM = [
    {"name": "equivalent_mass", "value": 30e3, "unit": "kg"},
    {"name": "participation_factor", "value": 1.0, "unit": "-"},
]


def test_a_run_says_its_system_or_what_is_missing():
    mass, gamma = SYSTEM
    found = capacity.ofRun({"answers": SYSTEM}, "results/wall")
    assert (found.mass, found.gamma) == (30e3, 1.0)
    for answers, message in (
        ([], "no equivalent_mass and no participation_factor, and neither is guessed"),
        ([mass, {**gamma, "value": None}], "results/wall: run.json has no participation_factor,"),
        ([{**mass, "unit": "t"}, gamma], "has the unit 't', it must be in 'kg'"),
    ):
        with raises(Refused, match=message):
            capacity.ofRun({"answers": answers}, "results/wall")


# -- the target displacement -----------------------------------------------------------------------


def bilinearOf(stiffness, force, ultimate):
    """A bilinear curve [kN/mm, kN, mm] that falls at its end."""
    end = ultimate * (1 + 1e-9)
    points = (0, 0), (force / stiffness, force), (ultimate, force), (end, 0)
    return bilinear(*curve(*points), "en1998")


GROUND_A = elastic(0.2, "g", type=1, ground="A")


def test_above_tc_displacements_are_equal():
    """10 kN/mm and 250 t: T* = 2π √(250/10000) = 0.9935 s, above TC = 0.4 s of ground A. Se = 2.5 ×
    1.962 × 0.4/0.9935 m/s², times (T*/2π)² = 0.025 s²."""
    system = equivalent(250e3, 1.0)
    found = demand(bilinearOf(10, 100, 90), system, GROUND_A)
    period = 2 * math.pi * math.sqrt(0.025)
    moved = 1e3 * 2.5 * 1.962 * 0.4 / period * 0.025
    assert found.period == approx(period) and found.branch == "B.12"
    assert found.strength == approx(0.4)
    assert found.targetDisplacement == found.elasticDisplacement == approx(moved)
    assert found.ductility == approx(moved / 10) and found.ductility > 4
    assert found.holds and found.scale == approx(90 / moved)
    more = f"90 mm is {90 / moved:.3g} times {moved:.4g} mm"
    assert found.verdict() == f"the capacity exceeds the demand: {more}"


def test_below_tc_they_are_not():
    """100 kN/mm, 100 kN and 100 t: T* = 0.1987 s on the plateau of ground A, Se 4.905 m/s², Fy*/m*
    1 m/s², qu 4.905; det* = 4.905 mm, dt* = det*/qu (1 + (qu - 1) TC/T*) with TC = 0.4 s."""
    made = bilinearOf(100, 100, 12)
    found = demand(made, equivalent(100e3, 1.0), GROUND_A)
    period = 2 * math.pi * math.sqrt(1e-3)
    assert found.period == approx(period) and found.branch == "B.10"
    assert found.reduction == approx(4.905)
    assert found.elasticDisplacement == approx(4.905)
    moved = 1 + 3.905 * 0.4 / period
    assert found.targetDisplacement == approx(moved)
    assert found.holds and not any("3 det" in note for note in found.notes)
    # with a fifth of the mass qu is below 1, and the structure stays elastic
    light = demand(made, equivalent(20e3, 1.0), GROUND_A)
    assert light.branch == "B.9" and light.ductility == approx(light.reduction)
    assert light.targetDisplacement == light.elasticDisplacement < 1
    assert "the structure stays below its yield force" in light.notes


def test_the_least_of_the_annex_is_taken_only_if_it_is_asked_for():
    """T* = 0.0628 s, TC = 0.8 s: dt* of (B.10) is 12 times as much as TC/T* says, and more than 3
    det*."""
    ground = elastic(0.2, "g", type=1, ground="D")
    words = bilinearOf(100, 10, 12), equivalent(10e3, 1.0), ground
    found, least = demand(*words), demand(*words, limited=True)
    assert found.equivalentDisplacement > 3 * found.elasticDisplacement
    assert (
        "lets the target displacement of the equivalent system be at most 3 det*" in found.notes[0]
    )
    assert least.equivalentDisplacement == approx(3 * found.elasticDisplacement)
    assert least.branch == "B.10, at most 3 det*"


strong = some.floats(1, 1e3)
spectra = some.fixed_dictionaries(
    {"type": some.sampled_from([1, 2]), "ground": some.sampled_from("ABCDE")}
)


@given(strong, strong, some.floats(1.0, 20), strong, spectra, some.booleans())
def test_the_spectrum_times_its_factor_demands_the_ultimate_displacement(
    stiffness, force, ductility, tons, spectrum, limited
):
    made = bilinearOf(stiffness, force, ductility * force / stiffness * 1.001)
    assume(2 * math.pi * math.sqrt(1e-3 * tons / stiffness) < 3.9)

    def needs(ag):
        of = elastic(ag, "m/s²", **spectrum)
        return demand(made, equivalent(1e3 * tons, 1.3), of, limited)

    found = needs(0.01)
    assume(0.01 * found.scale < 25)
    again = needs(0.01 * found.scale)
    assert again.targetDisplacement == approx(made.ultimateDisplacement, rel=1e-6)
    assert again.scale == approx(1, rel=1e-6)


def test_what_does_not_hold_says_so_and_a_short_curve_is_not_known():
    system = equivalent(100e3, 1.0)
    found = demand(bilinearOf(100, 100, 5), system, GROUND_A)
    assert found.holds is False and "does not reach the demand: 5 mm" in found.verdict()
    short = bilinear(*curve((0, 0), (1, 100), (5, 100)), "en1998")
    found = demand(short, system, GROUND_A)
    assert found.holds is None and found.verdict().startswith("not known: the demand is")
    assert "4.3.3.4.2.3(1)" in "".join(found.notes)
    longer = bilinear(*curve((0, 0), (1, 100), (50, 100)), "en1998")
    found = demand(longer, system, GROUND_A)
    assert found.holds is True and "4.3.3.4.2.3" not in "".join(found.notes)


@mark.parametrize("gamma", [2 / 3, 1.0, 1.5])
def test_the_curve_of_the_structure_is_compared_with_its_own_displacement(gamma):
    """dt = Γ dt*, also with Γ below 1: the structure holds where du reaches dt, and 4.3.3.4.2.3(1)
    of EN 1998-1 wants a curve up to 1.5 dt. T* = 2π √(250/10000) s does not depend on Γ, so dt* is
    that of the test above TC.
    """
    system = equivalent(250e3, gamma)
    moved = gamma * 1e3 * 2.5 * 1.962 * 0.4 / (2 * math.pi) * math.sqrt(0.025)
    for share in (0.97, 1.03):
        found = demand(bilinearOf(10, 100, share * moved), system, GROUND_A)
        assert found.targetDisplacement == approx(moved)
        assert found.holds == (share > 1)
    for share in (1.47, 1.53):
        short = bilinear(*curve((0, 0), (10, 100), (share * moved, 100)), "en1998")
        notes = demand(short, system, GROUND_A).notes
        assert any("4.3.3.4.2.3(1)" in note for note in notes) == (share < 1.5)


def test_the_iteration_ends_where_the_mechanism_forms_at_the_target(tmp_path):
    """The curve is 1 - exp(-d/5): with a mechanism at d, Fy is that, and dy = 2 (d - (d - 5
    Fy)/Fy)."""
    moved = np.append(np.linspace(0, 60, 6001), 60.001)
    force = 100 * (1 - np.exp(-moved / 5))
    force[-1] = 0
    push = capacity.pushover(run(tmp_path, moved, force))
    system = equivalent(200e3, 1.0)
    spectrum = elastic(0.05, "g", type=1, ground="C")
    found = capacity.iterated(push, system, spectrum)
    at = found.targetDisplacement
    assert found.curve.mechanism == approx(at, rel=1e-3) and not found.notes
    share = 1 - math.exp(-at / 5)
    yields = 2 * (at - (at - 5 * share) / share)
    period = 2 * math.pi * math.sqrt(200 * 1e-3 * yields / (100 * share))
    assert found.period == approx(period, rel=1e-3) and period > 0.6
    assert at == approx(spectrum.displacement(period), rel=1e-3)
    # with the mechanism at the peak, 60 mm, it is another one
    atPeak = demand(capacity.bilinearOf(push, "en1998"), system, spectrum)
    assert atPeak.targetDisplacement > 1.02 * at


def test_an_iteration_that_leads_beyond_the_curve_says_so(tmp_path):
    push = capacity.pushover(run(tmp_path, *WHOLE))
    spectrum = elastic(1.0, "g", type=1, ground="C")
    found = capacity.iterated(push, equivalent(300e3, 1.0), spectrum)
    assert "was ended with a mechanism at 2 mm: the target displacement" in found.notes[0]
    folder = push.directory
    with raises(Refused, match="iterate: it is of the rule en1998 with a spectrum"):
        capacity.assess(folder, iterate=True)
    again = capacity.assess(folder, spectrum, equivalent(300e3, 1.0), iterate=True)
    assert again["holds"] is False and found.notes[0] in again["notes"]


def test_a_period_beyond_the_spectrum_is_refused_with_its_equation():
    with raises(
        Refused,
        match=r"the equivalent period \(B.7\) is 6.283 s: the spectrum .* goes from 0 to 4 s",
    ):
        demand(bilinearOf(1, 10, 90), equivalent(1e6, 1.0), GROUND_A)


# -- files of a run --------------------------------------------------------------------------------


def test_a_folder_gets_its_numbers_and_its_picture(tmp_path):
    folder = run(tmp_path, *WHOLE, recorded_height_m=2.5, answers=SYSTEM)
    spectrum = elastic(0.2, "g", type=1, ground="B")
    found = capacity.assess(folder, spectrum)
    with open(tmp_path / "capacity.json") as file:
        assert json.load(file) == found
    assert (tmp_path / "capacity.png").read_bytes().startswith(b"\x89PNG")
    expected = demand(capacity.bilinearOf(folder, "en1998"), equivalent(30e3, 1.0), spectrum)
    numbers = {one["name"]: one for one in found["numbers"]}
    assert numbers["target_displacement_mm"]["value"] == expected.targetDisplacement
    assert numbers["target_displacement_mm"]["unit"] == "mm"
    assert found["holds"] is True and "one mass on a spring" in found["assumed"]
    assert numbers["drift_at_peak_mrad"]["value"] == approx(0.8)


def test_without_a_spectrum_there_is_the_bilinear_curve_alone(tmp_path):
    folder, other = run(tmp_path / "run", *WHOLE), tmp_path / "other"
    found = capacity.assess(folder, rule="masonry", out=other)
    assert "holds" not in found and found["rule"] == "masonry"
    assert any("drifts need height=" in note for note in found["notes"])
    assert sorted(os.listdir(other)) == ["capacity.json", "capacity.png"]
    assert not (tmp_path / "run" / "capacity.json").exists()


def test_what_is_missing_is_refused_before_anything_is_written(tmp_path):
    folder = run(tmp_path, *WHOLE)
    with raises(Refused, match="neither is guessed"):
        capacity.assess(folder, elastic(0.2, "g", type=1, ground="B"))
    assert sorted(os.listdir(tmp_path)) == ["curve.csv", "run.json"]


CODE = "--type=1 --ground=B --ag=0.2g"
MASS = "--mass=30e3 --gamma=1"


@mark.parametrize(
    "words, message",
    [
        (CODE, "neither is guessed"),
        (f"{CODE} --mass=30e3", "--mass: --gamma is missing, and it is not guessed"),
        (f"{CODE} --masses=1e3,2e3", "--masses: --shape is missing"),
        (
            f"{CODE} {MASS} --masses=1e3 --shape=1",
            "give either --mass and --gamma or --masses and --shape",
        ),
        (
            f"{CODE} --masses=1e3;2e3 --shape=1,1",
            "--masses '1e3;2e3' must be numbers with commas",
        ),
        (f"--type=1 --ground=B {MASS}", "--type, --ground: --ag must be given, too"),
        (f"--type=1 --ground=B --ag=0.2 {MASS}", "--ag '0.2' must be a number with its unit"),
        (f"--type=1 --ground=B --ag=-0.2g {MASS}", "ag -0.2 must be above 0"),
        (f"--spectrum=s.csv {MASS}", "--spectrum: --unit is missing"),
        (
            f"--spectrum=s.csv --unit=g {CODE} {MASS}",
            "--spectrum: leave --type, --ground, --ag away",
        ),
        (f"--unit=g {MASS}", "--unit: it is of --spectrum FILE, which is missing"),
        ("other --out=there", "--out there: it is for one folder, not 2"),
        ("--mechanism=0", "mechanism 0.0 mm must be above 0"),
    ],
)
def test_odd_options_are_refused_in_a_sentence(tmp_path, monkeypatch, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    run("wall", *WHOLE)
    assert program.main(["wall", *words.split()]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "wall" / "capacity.json").exists()


def test_the_program_prints_every_number_with_its_unit(tmp_path, capsys):
    folder = run(tmp_path, *WHOLE)
    assert program.main([folder, *CODE.split(), *MASS.split()]) == 0
    said = capsys.readouterr().out
    for part in (
        "target_displacement_mm",
        "mm ",
        "kN/mm",
        "the capacity exceeds the demand",
        "written: capacity.json, capacity.png",
    ):
        assert part in said
    path = tmp_path / "s.csv"
    path.write_text("0,0.2\n0.1,0.5\n0.5,0.5\n2,0.1\n")
    words = "--unit=g --corner=0.5 --masses=20e3,10e3 --shape=0.5,1 --limited --rule=masonry"
    assert program.main([folder, f"--spectrum={path}", *words.split()]) == 0
    assert program.main([folder]) == 0
    assert "no spectrum, so no demand" in capsys.readouterr().out
    assert program.main([]) == 2


def test_a_folder_that_has_no_curve_does_not_keep_the_others_from_theirs(tmp_path, capsys):
    good = run(tmp_path / "good", *WHOLE)
    bad = run(tmp_path / "bad", *WHOLE, interrupted=True)
    assert program.main([bad, good]) == 2
    assert (tmp_path / "good" / "capacity.json").exists()
    assert f"{bad}: the run was interrupted" in capsys.readouterr().err


@mark.parametrize(
    "entries",
    [
        {"answers": [1]},
        {"recorded_height_m": math.nan, "displacement_at_first_crack_mm": "x"},
        {"first_period_s": math.inf, "collapse_displacement_mm": math.nan},
        {"stages": [{"load": ["push"], "first_row": "a"}]},
        {"wall": 3},
    ],
)
def test_damaged_files_give_a_sentence_or_are_left_alone(tmp_path, entries):
    folder = run(tmp_path, *WHOLE, **entries)
    spectrum = elastic(0.2, "g", type=1, ground="B")
    with raises(Refused, match="not the files of a finished run|neither is guessed"):
        capacity.assess(folder, spectrum)
    with contextlib.suppress(Refused):
        capacity.assess(folder)
        json.loads((tmp_path / "capacity.json").read_text(), parse_constant=pytest.fail)


# -- N-V domains -----------------------------------------------------------------------------------


def bounds(*rows):
    """Entries of run.json: of pressed and normal force and bound."""
    known = {"unit": "kN", "exact": True}
    return [
        {**known, "load": f"top under {p} kN", "pressed_kN": p, "normal_kN": n, "factor": v}
        for p, n, v in rows
    ]


def scene(folder, *entries, **known):
    """A folder of a scene that says domain(...), beside the bound of another load."""
    other = {"load": "top along x", "unit": "kN", "factor": 3.0, "exact": True}
    return writeRun(folder, ["time_s"], [], bounds=[other, *entries], **known)


def test_a_domain_has_its_bounds_in_order_and_runs_as_points(tmp_path):
    folder = scene(tmp_path / "pier", *bounds((100, 105, 22.5), (20, 25, 5.4), (50, 55, 11.8)))
    moved, force = WHOLE
    at = int(force.argmax())
    heads = ["time_s", "displacement_mm", "base_shear_kN", "top_shear_kN", "base_force_z_kN"]
    down = np.where(np.arange(len(moved)) == at, -60.0, -55.0)
    rows = np.column_stack([moved, moved, force, force, down])
    before = [[0, 0, 0, 0, -50.0]] * 3  # under another load, which is none of the push
    other = {"stage": "lean", "first_row": 0, "load": ["lean", "x", "g"]}
    stages = [other, {**PUSH, "first_row": len(before)}]
    point = writeRun(tmp_path / "run", heads, [*before, *rows], stages=stages, held=["base"])
    found = capacity.assessDomain(folder, [point])
    assert [one.normal for one in found.bounds] == [25, 55, 105]
    assert found.shear(40) == approx((5.4 + 11.8) / 2)
    (one,) = found.runs
    assert one.name == "run"
    assert (one.normal, one.shear, one.displacement) == approx((60, 100, 2))
    with open(tmp_path / "pier" / "domain.json") as file:
        assert json.load(file) == found.entries()
    assert (tmp_path / "pier" / "domain.png").read_bytes().startswith(b"\x89PNG")
    with raises(Refused, match="no normal force of 200 kN: it goes from 25 to 105 kN"):
        found.shear(200)


def test_a_wall_without_vertical_forces_has_those_of_its_load_and_weight(tmp_path):
    """4 m × 0.1 m under 0.5 MPa: 200 kN; 2.5 m of 1800 kg/m³ weigh 17.658 kN."""
    wall = dict(length_m=4.0, thickness_m=0.1, height_m=2.5, precompression_Pa=0.5e6)
    wall["measure_height_m"] = 2.5
    material = {"density_kg_per_m3": 1800.0}
    folder = run(tmp_path, *WHOLE, wall=wall, unit_material=material, held=["base"])
    found = capacity.runPoint(folder)
    assert found.normal == approx(217.658)
    assert "precompression and weight" in found.source
    other = run(tmp_path / "other", *WHOLE, held=["base"])
    with raises(
        Refused, match="curve.csv has no column base_force_z_kN; run the scene with all columns"
    ):
        capacity.runPoint(other)


def test_a_scene_without_a_domain_is_refused_and_a_force_without_bound_is_a_note(tmp_path, capsys):
    folder = scene(tmp_path / "none")
    with raises(Refused, match=r"run.json has no domain: say scene.domain\(top"):
        capacity.domain(folder)
    failed = {"load": "top under 9 kN", "pressed_kN": 9, "note": "it was not solved in time"}
    with raises(Refused, match="under 9 kN: it was not solved in time"):
        capacity.domain(scene(tmp_path / "failed", failed))
    folder = scene(tmp_path / "some", failed, *bounds((20, 25, 5.4)))
    assert capacity.domain(folder).notes == ["top under 9 kN: it was not solved in time"]
    assert program.main(["--domain", folder]) == 0
    said = capsys.readouterr().out
    assert "25" in said and "note: top under 9 kN" in said


def test_a_run_of_another_pier_is_a_note(tmp_path):
    wall = dict(length_m=1.0, thickness_m=0.1, height_m=2.5, precompression_Pa=1e5)
    known = dict(wall=wall, unit_material={"density_kg_per_m3": 1800.0}, units=10)
    joints = lambda friction: {"bed": {"friction": friction}}
    folder = scene(tmp_path / "pier", *bounds((20, 25, 5.4)), units=10, joints=joints(0.5))
    other = run(tmp_path / "run", *WHOLE, **known, joints=joints(0.6))
    assert capacity.domain(folder, [other]).notes == [
        "run: its properties of joints are not those of the domain: is it the same pier?"
    ]
