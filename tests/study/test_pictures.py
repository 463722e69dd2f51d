# SPDX-License-Identifier: GPL-2.0-or-later
"""Sensitivities against closed forms, and pictures of what they must show, drawn from numbers and
from a study's folder."""

from commands import *
from masonry_study import pictures, records, report, sensitivity, statistics
from scipy import stats
from scipy.integrate import trapezoid

NAMES = "bed.cohesion", "bed.friction", "head.tensileStrength"


def uniforms(generator, n, low, high):
    return {name: generator.uniform(low, high, n) for name in NAMES}


def ishigami(x):
    """Of T. Ishigami and T. Homma, 1990, with a = 7 and b = 0.1."""
    a, b, c = x.values()
    return np.sin(a) + 7 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a)


#: Shares of its variance in closed form: (first, total).
A, B = 0.5 * (1 + 0.1 * math.pi**4 / 5) ** 2, 49 / 8
C = 0.1**2 * math.pi**8 * (1 / 18 - 1 / 50)
ISHIGAMI = dict(zip(NAMES, ((A, A + C), (B, B), (0, C))))


def test_sobol_indices_of_ishigamis_function_are_its_closed_form():
    """First and total ones in 10 samples of 300 rows, of which intervals of 95 % may miss a few."""
    generator, missed = np.random.default_rng(1), 0
    for _ in range(10):
        x = uniforms(generator, 300, -math.pi, math.pi)
        found = sensitivity.sobol(x, ishigami(x))
        assert 0.93 < found.explained <= 1
        for name, truth in ISHIGAMI.items():
            for index, part in zip(found.indices[name], truth):
                share = part / (A + B + C)
                assert index.value == approx(share, abs=0.12)
                missed += not index.low - 0.002 <= share <= index.high + 0.002
    assert missed <= stats.binom.ppf(0.999, 60, 0.05)


def test_sobol_indices_do_not_depend_on_the_distribution_of_a_property():
    generator = np.random.default_rng(2)
    x = uniforms(generator, 200, -math.pi, math.pi)
    y = ishigami(x)
    bent = {name: np.exp(3 * values) for name, values in x.items()}
    assert sensitivity.sobol(bent, y) == sensitivity.sobol(x, y)


def test_a_product_has_total_indices_above_its_first_ones():
    """y = a b of standard uniform numbers about 0: no first index, and all of the variance in both
    totals."""
    x = uniforms(np.random.default_rng(3), 300, -1, 1)
    found = sensitivity.sobol(x, x[NAMES[0]] * x[NAMES[1]]).indices
    for name in NAMES[:2]:
        assert found[name].first.value < 0.05 and found[name].total.value > 0.9
    assert found[NAMES[2]].total.high < 0.05


def test_indices_are_shares_of_the_whole_variance():
    """Half of the variance is of a random field, of which no property tells anything."""
    generator = np.random.default_rng(8)
    x = uniforms(generator, 400, 0, 1)
    y = math.sqrt(12) * x[NAMES[0]] + generator.standard_normal(400)
    found = sensitivity.sobol(x, y)
    assert found.explained == approx(0.5, abs=0.08)
    assert found.indices[NAMES[0]].first.value == approx(0.5, abs=0.1)


@mark.parametrize("rank", [0.0, 0.5, 0.9])
def test_shapley_effects_of_two_tied_properties_are_the_closed_form(rank):
    """y = 2 a + b, of normal numbers with a correlation: the squares of their own terms, and half
    of what is common to both, 4 rho, plus rho² (1 - 4)/2 which the stronger one has lent (Owen and
    Prieur, 2017, section 4). A third number tells nothing."""
    generator = np.random.default_rng(9)
    a, b, c = generator.standard_normal((3, 4000))
    b = rank * a + math.sqrt(1 - rank**2) * b
    found = sensitivity.shapley(dict(zip(NAMES, (a, b, c))), 2 * a + b)
    variance, lent = 5 + 4 * rank, rank**2 * (4 - 1) / 2
    shares = (4 + 2 * rank - lent) / variance, (1 + 2 * rank + lent) / variance, 0
    assert [found.effects[name].value for name in NAMES] == approx(shares, abs=0.03)
    assert sum(one.value for one in found.effects.values()) == approx(found.explained)


def test_effects_are_the_changes_of_a_linear_model():
    generator = np.random.default_rng(4)
    x = uniforms(generator, 400, 0, 1)
    y = 5 * x[NAMES[0]] - 2 * x[NAMES[1]] + 0.5 * generator.standard_normal(400)
    found = sensitivity.effects(x, y)
    assert list(found) == list(NAMES)
    for name, slope in zip(NAMES, (5, -2, 0)):
        span = np.ptp(np.quantile(x[name], sensitivity.SPAN))
        error = 0.5 / math.sqrt(400 / 12) * span  # standard error of a slope
        change = found[name].change
        assert change.value == approx(slope * span, abs=3.5 * error)
        assert change.high - change.low == approx(2 * 1.966 * error, rel=0.15)
        rank = stats.spearmanr(x[name], y).statistic
        assert found[name].rank.value == approx(rank)
        assert found[name].rank.low < found[name].rank.value < found[name].rank.high


def test_intervals_of_rank_correlations_have_nothing_as_often_as_they_say():
    generator, inside = np.random.default_rng(5), 0
    for _ in range(600):
        x = {"bed.cohesion": generator.standard_normal(40)}
        effects = sensitivity.effects(x, generator.standard_normal(40))
        rank = effects["bed.cohesion"].rank
        inside += rank.low <= 0 <= rank.high
    assert inside / 600 == approx(0.95, abs=3 * math.sqrt(0.95 * 0.05 / 600))


def tied(n=40):
    a = np.random.default_rng(6).standard_normal(n)
    return {"bed.cohesion": a, "head.cohesion": 2 * a}, a


@mark.parametrize(
    "call, message",
    [
        (lambda: sensitivity.sobol(*tied()), "have a rank correlation of 1.00"),
        (lambda: sensitivity.sobol({"a": range(9)}, range(9)), "there are 9"),
        (lambda: sensitivity.sobol({"a": range(20)}, [1] * 20), "results are the same"),
        (lambda: sensitivity.shapley({"a": range(9)}, range(9)), "there are 9"),
        (lambda: sensitivity.effects(*tied()), "cannot be told apart"),
        (lambda: sensitivity.effects({"a": [1, 2, 4]}, [1, 2, 3]), "4 rows or more"),
        (lambda: sensitivity.effects({"a": [1, 1]}, [1, 2]), "no property varies"),
    ],
)
def test_what_no_sensitivity_can_be_made_of_is_refused(call, message):
    with raises(Refused, match=message):
        call()


# -- pictures --------------------------------------------------------------------------------------


PEAKS, PEAK = "peak_base_shear_kN", "peak base shear [kN]"
VALUES = 110 * np.exp(0.05 * np.random.default_rng(7).standard_normal(200))


def byLabel(axis):
    return {thing.get_label(): thing for thing in (*axis.lines, *axis.collections)}


def test_a_histogram_has_an_area_of_one_and_the_quantiles_of_the_rows(drawn):
    pictures.histogram("h.png", VALUES, PEAK)
    (axis,) = drawn["h.png"].axes
    bars = axis.containers[0]
    area = sum(bar.get_width() * bar.get_height() for bar in bars)
    assert area == approx(1)
    for share in (0.05, 0.5, 0.95):
        value = np.quantile(VALUES, share)
        message = byLabel(axis)[f"{100 * share:g} % quantile: {value:.4g}"]
        assert message.get_xdata() == [value, value]
    labels = byLabel(axis)
    (density,) = [labels[label] for label in labels if label.startswith("lognormal")]
    x, y = density.get_data()
    assert trapezoid(y, x) == approx(1, abs=0.02)
    assert axis.get_xlabel() == PEAK


def test_a_fragility_curve_goes_from_0_to_1_within_its_band(drawn):
    pictures.fragility("f.png", VALUES, PEAK)
    (axis,) = drawn["f.png"].axes
    x, y = byLabel(axis)["200 rows"].get_data()
    assert y[0] == 0 and y[-1] == 1 and (np.diff(y) >= 0).all()
    middle = np.searchsorted(x, np.median(VALUES))
    assert y[middle] == approx(0.5, abs=0.02)
    band = byLabel(axis)["95 % confidence"].get_paths()[0].vertices
    assert band[:, 1].min() == 0 and band[:, 1].max() == 1
    low, high = statistics.fragility(VALUES, [x[middle]])[1:]
    here = band[np.isclose(band[:, 0], x[middle])][:, 1]
    assert here.min() <= low[0] <= 0.5 <= high[0] <= here.max()


def test_a_fan_has_all_curves_and_the_median_of_those_that_go_on(drawn):
    """Nine curves k x, of which the last four end halfway; one goes back for some rows."""
    curves = []
    for k in range(1, 10):
        x = np.linspace(0, 10 if k < 6 else 5, 101)
        curves.append((x, k * x))
    x, y = curves[0]
    curves[0] = np.insert(x, 50, [1, 2]), np.insert(y, 50, [99, 99])
    pictures.fan("c.png", curves, "x [mm]", "y [kN]")
    (axis,) = drawn["c.png"].axes
    x, y = byLabel(axis)["median"].get_data()
    assert y[x < 4.9] == approx(5 * x[x < 4.9])
    assert y[x > 5.1] == approx(3 * x[x > 5.1])
    assert x[-1] == 10
    segments = axis.collections[0].get_segments()
    assert len(segments) == 9 and max(one[:, 1].max() for one in segments) < 51
    assert "9 curves" in byLabel(axis)


def test_bars_stand_for_the_numbers_with_the_largest_on_top(drawn):
    x = uniforms(np.random.default_rng(9), 200, 0, 1)
    y = 5 * x[NAMES[0]] - 9 * x[NAMES[1]]
    effects, found = sensitivity.effects(x, y), sensitivity.sobol(x, y)
    pictures.tornado("t.png", effects, PEAK)
    pictures.sobol("i.png", found, PEAK, "the rest")
    shapley = sensitivity.shapley(x, y)
    pictures.shapley("s.png", shapley, PEAK, "the rest")
    left, _ = drawn["t.png"].axes
    widths = [bar.get_width() for bar in left.patches]
    assert widths == [e.change.value for e in effects.values()][::-1]
    assert left.get_yticklabels()[-1].get_text() == "bed: friction"
    (axis,) = drawn["i.png"].axes
    totals = [bar.get_width() for bar in axis.patches][:3]
    names = [t.get_text().replace(": ", ".") for t in axis.get_yticklabels()][1:]
    assert totals == [found.indices[name].total.value for name in names]
    assert totals[-1] == max(totals)
    (axis,) = drawn["s.png"].axes
    assert [bar.get_width() for bar in axis.patches][2] == shapley.effects[NAMES[1]].value
    for name, found in (("i.png", found), ("s.png", shapley)):
        (axis,) = drawn[name].axes
        assert axis.get_yticklabels()[0].get_text() == "the rest"
        assert axis.patches[-1].get_width() == approx(1 - found.explained)


# -- a study's folder ------------------------------------------------------------------------------


def writeStudy(folder, measures, curves=0):
    """A folder as gathering leaves it. Of ``measures`` a cell that is empty has no number."""
    lines = [["run", *NAMES, "status", *measures]]
    generator = np.random.default_rng(10)
    for n, cells in enumerate(zip(*measures.values()), 1):
        status = "ended" if any(cells) else "failed"
        lines.append([f"{n:04d}", *map(str, generator.uniform(size=3)), status, *cells])
        run = folder / "rows" / f"{n:04d}"
        run.mkdir(parents=True)
        if n <= curves:
            (run / "curve.csv").write_text(
                "displacement_mm,base_shear_kN\r\n0,0\r\n1,100\r\n3,80\r\n"
            )
    (folder / "study.csv").write_text("\n".join(map(",".join, lines)) + "\n")
    return str(folder)


PEAKS15 = 100 + np.random.default_rng(10).uniform(-15, 25, 15)


@pytest.fixture
def study(tmp_path):
    """A study of 15 rows."""
    modes = ["slides"] * 5 + ["rocks"] * 10
    measures = {"failure_mode": modes, PEAKS: [*map(str, PEAKS15)]}
    return writeStudy(tmp_path / "accurate", measures, curves=15)


def test_the_seed_of_a_random_field_is_no_input(study):
    record = records.Record(study)
    record.varied.append("field:bed.cohesion")
    record.cells["field:bed.cohesion"] = list(map(str, range(15)))
    assert list(record.complete(PEAKS)[1]) == list(NAMES)


def test_the_report_tells_and_draws_all(study, capsys):
    assert report.main([study, "--demand", "100,120"]) == 0
    said = capsys.readouterr().out
    low, high = statistics.mean(PEAKS15)[1:]
    assert f"{low:.5g} … {high:.5g}" in said
    assert "peak base shear [kN]: 15 of 15 rows" in said
    assert "rocks                    0.667" in said
    assert "unknown" in said  # 15 rows do not tell the ends of the 5 % quantile
    for name in ("scatter", "tornado", "histogram", "fragility", "curves"):
        path = os.path.join(study, name + ".png")
        assert path in said and 5e3 < os.path.getsize(path) < 3e5
    assert "no sobol.png: Sobol indices of 3 properties need 30 rows" in said


def test_rows_that_failed_are_reported_and_left_out(tmp_path, capsys):
    peaks = [str(n) if n % 4 else "" for n in range(40)]
    folder = writeStudy(tmp_path / "study", {PEAKS: peaks})
    assert report.main([folder, "--no-pictures"]) == 0
    said = capsys.readouterr().out
    assert "30 of 40 rows" in said and "rows that have not ended: 10 failed" in said


def test_rows_that_were_too_fast_are_counted(tmp_path, capsys):
    fast = ["True"] * 4 + ["False"] * 20
    measures = {PEAKS: [*map(str, range(100, 124))], "too_fast": fast}
    folder = writeStudy(tmp_path / "study", measures)
    assert report.main([folder, "--no-pictures"]) == 0
    assert "4 of 24 rows, all in the numbers above, were pushed too fast" in " ".join(
        capsys.readouterr().out.split()
    )


def test_properties_that_were_drawn_with_a_correlation_have_shapley_effects(tmp_path, capsys):
    """Also where the rows are so few that the correlation could be chance."""
    folder = writeStudy(tmp_path / "study", {PEAKS: [*map(str, range(100, 140))]})
    drawn = {"runs": 40, "vary": {}, "correlation": [["bed.cohesion", "bed.friction", 0.5]]}
    for name, has, hasNot in (("shapley", "shapley", "sobol"), ("sobol", "sobol", "shapley")):
        (tmp_path / "study" / "study.json").write_text(json.dumps({"script": "", "study": drawn}))
        assert report.main([folder]) == 0
        said = " ".join(capsys.readouterr().out.split())
        assert f"{has}.png" in said and f"{hasNot}.png" not in said
        assert ("bed.cohesion and bed.friction by 0.50" in said) == (has == "shapley")
        drawn["correlation"] = []


def test_what_is_no_study_is_refused_with_its_name(tmp_path, study, capsys):
    other = tmp_path / "other"
    other.mkdir()
    (other / "study.csv").write_text("a,b\n1,2\n")
    for words, message in (
        ([str(tmp_path / "nowhere")], "nowhere"),
        ([str(other)], "no table of a study"),
        ([study, "--measure", "peak"], "no column peak; there are run, bed.coh"),
        ([study, "--demand", "a"], "--demand a must be numbers"),
    ):
        assert report.main([*words, "--no-pictures"]) == 2
        assert message in capsys.readouterr().err
