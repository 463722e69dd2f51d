# SPDX-License-Identifier: GPL-2.0-or-later
"""Properties from tests: closed forms of linear tests, how often intervals have the truth, rounds,
accurate runs, a couplet."""

from commands import *
from masonry_study import Calibration, Specimen, Study, calibrate, normal
from masonry_study.calibrate import ENDS, Surrogate, posterior
from masonry_study.designs import points

ot = pytest.importorskip("openturns", reason="python3-openturns is not installed")

COUPLET = scenePath("couplet")
RANGES = {"bed.cohesion": (0.0, 0.5), "bed.friction": (0.0, 1.5)}


def pressed(x):
    """Peaks of couplets under 0.2 and 0.6 MPa [MPa]."""
    return np.column_stack([x[:, 0] + 0.2 * x[:, 1], x[:, 0] + 0.6 * x[:, 1]])


def bent(x):
    """Something that depends on two numbers from 0 to 1, and not on a third."""
    a, b = x[:, 0], x[:, 1]
    return np.column_stack([a * np.exp(-b), a + 0.3 * np.sin(4 * b), b**2 - a])


def designed(act, ends, rows, seed=1):
    """The surrogate of a function between these ends."""
    low, high = np.array(ends, float).T
    x = low + (high - low) * np.array(points("sobol", rows, len(low), seed))
    return Surrogate(x, act(x), low, high)


class Direct(Calibration):
    """A calibration whose scene is a function; accurate runs are higher by ``off``. ``rounds`` has
    the rows of each study."""

    act, off = staticmethod(pressed), 0.0

    def _rows(self, name, studyOf, least):
        study = studyOf(self.specimens[0])
        x = np.array([[row[n] for n in self.names] for row in study.rows()])
        self.seen = {**getattr(self, "seen", {}), name: x}
        return x, self.act(x) + self.off * ("preset" in study.options)


def direct(measured, error=0.02, names=RANGES, **settings):
    pairs = {f"peak{n}": (value, error) for n, value in enumerate(measured)}
    return Direct(Specimen("any", pairs), names, **{"runs": 24, **settings})


def test_a_linear_test_has_intervals_and_correlation_of_the_closed_form(tmp_path):
    found = direct([0.33, 0.58]).find(tmp_path)
    # friction 0.25/0.4, its deviation 0.02 √2/0.4; cohesion 1.5 · 0.33 - 0.5 · 0.58, 0.02 √(1.5² +
    # 0.5²); -5/√(2.5 · 12.5)
    assert found.sample.mean(axis=0) == approx([0.205, 0.625], abs=0.006)
    assert found.sample.std(axis=0) == approx([0.03162, 0.07071], rel=0.08)
    assert found.correlation[0, 1] == approx(-0.8944, abs=0.02)
    half = np.diff(found.intervals, axis=0)[0] / 2
    assert half == approx(1.96 * np.array([0.03162, 0.07071]), rel=0.1)
    assert not found.doubts()
    written = json.loads((tmp_path / "calibration.json").read_text())
    assert written == found.describe()


def test_the_surrogate_is_openturns_kriging_and_knows_its_error():
    x = np.random.default_rng(2).uniform(size=(200, 2))

    def errors(act):
        """Those that the surrogate tells, and those that it makes."""
        model = designed(act, [(0, 1)] * 2, 30)
        return model.errors, np.sqrt(np.mean((model(x) - act(x)) ** 2, axis=0))

    estimated, actual = errors(bent)
    assert (actual < 3 * estimated + 1e-9).all() and (estimated < 0.02).all()
    estimated, actual = errors(lambda x: np.round(3 * bent(x)))
    assert actual == approx(estimated, rel=0.6) and (0.1 < estimated).all()
    assert (estimated < 0.6).all()


@mark.parametrize("act", [bent, lambda x: np.round(3 * bent(x))])
def test_the_surrogate_does_not_depend_on_round_off(act):
    """As other machines have another one."""
    generator = np.random.default_rng(4)
    x = generator.uniform(size=(50, 2))
    moved = lambda x: act(x) * (1 + 1e-13 * generator.standard_normal((len(x), 3)))
    for seed in range(1, 5):
        one, other = (designed(f, [(0, 1)] * 2, 30, seed) for f in (act, moved))
        assert other(x) == approx(one(x), abs=2e-3)
        assert other.errors == approx(one.errors, rel=0.05)


def test_the_same_number_in_all_rows_tells_nothing():
    act = lambda x: np.column_stack([x[:, 0], 7 + 0 * x[:, 0]])
    model = designed(act, [(0, 1)] * 2, 12)
    assert model(np.full((1, 2), 0.3))[0] == approx([0.3, 7], abs=1e-3)
    assert model.errors[1] == 0


def test_intervals_have_the_truth_as_often_as_they_say(monkeypatch):
    monkeypatch.setattr(calibrate, "DRAWS", 1000)
    model, inside = designed(bent, [(0, 1)] * 2, 30), []
    generator = np.random.default_rng(3)
    for case in range(60):
        true = generator.uniform(size=(1, 2))
        values = bent(true)[0] + 0.05 * generator.standard_normal(3)
        sample = posterior(model, values, np.full(3, 0.05), case)
        low, high = np.quantile(sample, ENDS, axis=0)
        inside += [*((low <= true[0]) & (true[0] <= high))]
    # three standard deviations of a binomial, if both properties of a case were one
    assert np.mean(inside) == approx(0.95, abs=3 * math.sqrt(0.95 * 0.05 / 60))
    assert np.mean(inside) < 1


@pytest.fixture
def act(monkeypatch):
    """Lets the scene of calibrations be another function."""
    return lambda f: monkeypatch.setattr(Direct, "act", staticmethod(f))


TWO = {"bed.a": (0, 1), "bed.b": (0, 1)}


def test_what_a_test_does_not_tell_is_said(tmp_path, act):
    act(bent)
    measured = bent(np.array([[0.4, 0.6]]))[0]
    found = direct(measured, names={**TWO, "bed.c": (0, 1)}).find(tmp_path)
    said = [one for one in found.doubts() if "does not tell" in one]
    assert said == ["bed.c: the test does not tell it"]
    assert found.spread[2] == approx(1, abs=0.05)
    assert (found.spread[:2] < 0.5).all()
    act(lambda x: pressed(x)[:, :1])
    together = direct([0.33]).find(tmp_path).doubts()
    assert any("bed.friction: the test does not tell it" in one for one in together)


def test_a_scene_that_cannot_follow_the_test_is_doubted(tmp_path, act):
    act(lambda x: np.column_stack([x[:, 0], x[:, 0]]))
    found = direct([0.2, 0.3], names={"bed.cohesion": (0.0, 0.5)}).find(tmp_path)
    assert "does not follow the test" in found.doubts()[0]


def test_a_second_round_fills_what_the_first_keeps_of_the_ranges(tmp_path, act):
    def steep(x):
        a, b = x.T
        return np.column_stack([np.tanh(12 * (a - 0.31)), b + 0.2 * np.sin(20 * a)])

    act(steep)
    one = direct(steep(np.array([[0.33, 0.5]]))[0], 0.01, TWO, runs=16)
    found = one.find(tmp_path)
    first, second = one.seen["round1"], one.seen["round2"]
    assert np.ptp(second, axis=0).prod() < 0.5 * np.ptp(first, axis=0).prod()
    assert found.sample.mean(axis=0) == approx([0.33, 0.5], abs=0.02)
    assert (found.model.errors < 0.05).all()


def test_a_run_is_added_where_the_surrogate_is_off(tmp_path, act):
    """A step between the rows: the first surrogate is smooth there, and its interval has not the
    truth."""
    act(lambda x: np.column_stack([x[:, 0] + 0.4 * (x[:, 0] > 0.93), x[:, 1]]))
    one = direct([1.36, 0.5], names=TWO, runs=12)
    found = one.find(tmp_path)
    assert "check2" in one.seen and "check6" not in one.seen
    low, high = found.intervals
    assert low[0] < 0.96 < high[0]


def test_few_accurate_runs_move_the_answer(tmp_path, monkeypatch):
    monkeypatch.setattr(Direct, "off", 0.05)
    found = direct([0.38, 0.63], accurate={"preset": "accurate"}).find(tmp_path)
    assert found.sample.mean(axis=0) == approx([0.205, 0.625], abs=0.01)
    assert found.run[0] == approx([0.38, 0.63], abs=0.01)


def test_the_error_of_accurate_runs_is_that_of_another_one(tmp_path, monkeypatch):
    """Three differences -0.03, 0 and 0.03: the next one scatters about their mean by 0.03, and the
    mean by 0.03/√3."""
    rows = Direct._rows

    def scattered(self, name, *others):
        x, y = rows(self, name, *others)
        return x, y + (np.array([[-0.03], [0], [0.03]]) if name == "accurate" else 0)

    monkeypatch.setattr(Direct, "_rows", scattered)
    found = direct([0.33, 0.58], accurate={"preset": "accurate"}, few=3).find(tmp_path)
    assert found.model.errors == approx(0.03 * math.sqrt(1 + 1 / 3), rel=1e-3)


def test_a_curve_that_ends_early_says_nothing_beyond(tmp_path):
    (tmp_path / "t.csv").write_text("d,F\n0,0\n4,2\n")
    (tmp_path / "curve.csv").write_text("displacement_mm,base_shear_kN\n0,0\n1,3\n2.6,5\n")
    specimen = Specimen("any", "t.csv:d:F", 1.0, count=4)
    specimen.read(tmp_path)
    values = specimen._onGrid(str(tmp_path))
    assert specimen.grid.tolist() == [1, 2, 3, 4]
    assert values[:2] == approx([3, 4.25]) and np.isnan(values[2:]).all()


def test_what_is_printed_for_studies_is_a_study(tmp_path):
    found = direct([0.33, 0.58]).find(tmp_path)
    of = {"normal": normal}
    exec("\n".join([*found.forStudies()]), of)
    settings = {name: of[name] for name in ("vary", "correlation")}
    drawn = Study("any", runs=400, **settings).rows()
    x = np.array([[row[n] for n in RANGES] for row in drawn])
    assert x.mean(axis=0) == approx(found.sample.mean(axis=0), rel=0.03)
    assert np.corrcoef(x.T)[0, 1] == approx(found.correlation[0, 1], abs=0.05)


@mark.parametrize(
    "make, message",
    [
        (lambda: Specimen("any", "t.csv:d:F"), "a curve needs it"),
        (
            lambda: Specimen("any", {"peak": 80}),
            "'peak': 80 must be a value and a standard deviation",
        ),
        (lambda: Specimen("any", {"peak": (80, 0)}), "standard deviation above 0"),
        (lambda: Specimen("any", {}), "measured must be 'FILE:X:Y'"),
        (lambda: direct([0.3], names={}), "something unknown"),
        (lambda: direct([0.3], names={"bed.cohesion": (2, 1)}), "low 2 must be below high 1"),
        (
            lambda: direct([0.3], runs=8, names={f"bed.a{n}": (0, 1) for n in range(3)}),
            "need 9 runs",
        ),
        (lambda: direct([0.3], names={"bed cohesion": (0, 1)}), "'bed cohesion' must be an option"),
    ],
)
def test_wrong_descriptions_are_refused(make, message):
    with raises(Refused, match=re.escape(message)):
        make()


def test_a_curve_that_goes_back_is_refused(tmp_path):
    (tmp_path / "t.csv").write_text("d,F\n0,0\n1,2\n0.5,1\n")
    with raises(Refused, match="cycles cannot be compared"):
        Specimen("any", "t.csv:d:F", 1.0).read(tmp_path)


FILE = f"""
from masonry_study import Calibration, Specimen
curve = Specimen({COUPLET!r}, "test.csv:slide:stress", 0.01, ("slide_mm", "shear_stress_MPa"), 6,
    options={{"normal_stress": -0.5, "until": 0.4, "rate": 30}})
peak = Specimen({COUPLET!r}, {{"peak_shear_stress_MPa": (0.52, 0.01)}},
    options={{"normal_stress": -1, "until": 0.1, "rate": 30}})
calibration = Calibration([curve, peak], {{"bed.cohesion": (0.05e6, 0.2e6),
    ("bed.friction", "bed.residualFriction"): (0.3, 0.6)}}, 8)
"""


def test_couplets_give_their_cohesion_and_friction_back(tmp_path):
    """Those of calcium silicate, 0.11 MPa and 0.43, by a command that goes on where it was
    stopped."""
    slide = np.linspace(0, 0.28, 15)
    stress = np.where(slide > 0, 0.215 + 0.11 * np.exp(-0.11 * slide / 0.07), 0)
    lines = [f"{x},{y}" for x, y in zip(slide, stress)]
    (tmp_path / "test.csv").write_text("\n".join(["slide,stress", *lines]))
    (tmp_path / "file.py").write_text(FILE)
    out = tmp_path / "out"
    words = tmp_path / "file.py", "--out", out, "--jobs", 2
    done(*words)
    kept = read(out, "calibration.json")
    cohesion, friction = json.loads(kept)["properties"]
    assert cohesion["low"] < 0.11e6 < cohesion["high"]
    assert friction["low"] < 0.43 < friction["high"]
    assert (out / "calibration.png").stat().st_size > 10000
    shutil.rmtree(out / "specimen1_check1")
    assert "shear_stress_MPa at" in done(*words)
    assert read(out, "calibration.json") == kept
