# SPDX-License-Identifier: GPL-2.0-or-later
"""Multi-fidelity estimates against models whose truth is known: their bias, their intervals, and
what they save."""

from usual import *
from masonry.study import estimate
from scipy import stats

REPEATS = 600
#: How far the share of intervals that have the truth may be from 95 % by chance: three standard
#: deviations of a binomial.
CHANCE = 3 * math.sqrt(0.95 * 0.05 / REPEATS)


def line(generator, shared, rows, correlation):
    """Normal numbers of mean 7 and standard deviation 5, and cheap ones of another size with this
    correlation."""
    u = generator.standard_normal(rows)
    r = math.sqrt(1 - correlation**2) * generator.standard_normal(shared)
    return 7 + 5 * (correlation * u[:shared] + r), 3 - 2 * u


def bent(generator, shared, rows):
    """Skewed numbers that bend over the cheap ones and scatter more where they are large: the
    bridge does not hold."""
    x = np.exp(0.4 * generator.standard_normal(rows))
    near = x[:shared]
    return near**2 + 0.3 * near * generator.standard_normal(shared), x


TRUTH = {"mean": 7, "standard deviation": 5}
SHARES = estimate.QUANTILES
TRUTH |= {f"{100 * p:g} % quantile": 7 + 5 * stats.norm.ppf(p) for p in SHARES}


def repeated(find, draw, seed=1):
    """Estimates of many samples, a list of lists of the same."""
    generator = np.random.default_rng(seed)
    return list(zip(*(find(*draw(generator)) for _ in range(REPEATS))))


@pytest.fixture(scope="module")
def ofLine():
    draw = lambda g: line(g, 20, 200, 0.97)
    return {found[0].name: found for found in repeated(estimate.estimate, draw)}


@pytest.mark.parametrize("name", TRUTH)
def test_intervals_have_the_truth_as_often_as_they_say(ofLine, name):
    inside = np.mean([e.low <= TRUTH[name] <= e.high for e in ofLine[name]])
    assert inside == pytest.approx(0.95, abs=CHANCE)


@pytest.mark.parametrize("name", TRUTH)
def test_estimates_are_right_in_the_mean(ofLine, name):
    values = np.array([e.value for e in ofLine[name]])
    away = (values.mean() - TRUTH[name]) / values.std()
    # by chance, and a bias that is small beside the scatter: a tenth of it changes the coverage by
    # less than 0.2 %
    assert abs(away) < 3 / math.sqrt(REPEATS) + 0.1


def test_the_predicted_variance_is_that_of_repetitions(ofLine):
    found = ofLine["mean"]
    predicted = np.mean([e.expensive / e.shared + e.cheap / e.rows for e in found])
    truth = 25 * (1 - 0.97**2) / 20 + 25 * 0.97**2 / 200
    scatter = math.sqrt(2 / REPEATS)  # of the variance of normal numbers, relative
    variance = np.var([e.value for e in found])
    assert variance == pytest.approx(truth, rel=3 * scatter + 1 / 17)
    assert predicted == pytest.approx(truth, rel=0.15)  # residuals have leverage


def test_few_shared_rows_make_no_spread_too_small():
    """Residuals of a line that is fitted to 12 rows are smaller than the errors they show: by a
    sixth of their variance."""
    quantile = estimate.quantile
    find = lambda y, x: [
        estimate.deviation(y, x),
        quantile(y, x, 0.1),
        quantile(y, x, 0.9),
    ]
    spread, low, high = repeated(find, lambda g: line(g, 12, 60, 0.5), seed=3)
    squares = np.array([e.value**2 for e in spread])
    error = squares.std() / math.sqrt(REPEATS)
    # a slope that happens to be small is not made smaller than 0, which adds some variance where
    # the correlation is low
    assert 25 - 2 * error < squares.mean() < 1.06 * 25 + 2 * error
    inside = np.mean([e.low <= 5 <= e.high for e in spread])
    assert inside == pytest.approx(0.95, abs=CHANCE)
    between = np.mean([h.value - l.value for h, l in zip(high, low)])
    assert between == pytest.approx(2 * 5 * stats.norm.ppf(0.9), rel=0.08)


def test_a_dear_row_alone_is_reported_with_its_own_variance(ofLine):
    assert np.mean([e.alone for e in ofLine["mean"]]) == pytest.approx(25, rel=0.05)
    squares = np.mean([e.alone for e in ofLine["standard deviation"]])
    assert squares == pytest.approx(2 * 5**4, rel=0.15)  # variance of (y - mean)²
    assert {e.alone for e in ofLine["5 % quantile"]} == {0.05 * 0.95}


def test_the_mean_needs_no_line():
    """The control variate is right whatever the cheap numbers are; only its gain depends on them.

    Where the expensive numbers bend, its slope depends on which rows are shared. That is a bias of
    order 1/N: a tenth of the scatter with 60 shared rows, which takes 1 % from the coverage.
    """
    draw = lambda g: bent(g, 60, 600)
    (found,) = repeated(lambda y, x: [estimate.mean(y, x)], draw)
    truth = math.exp(2 * 0.4**2)
    values = np.array([e.value for e in found])
    inside = np.mean([e.low <= truth <= e.high for e in found])
    assert inside == pytest.approx(0.94, abs=CHANCE)
    assert abs(values.mean() - truth) < (0.1 + 3 / math.sqrt(REPEATS)) * values.std()


def test_indicators_find_a_quantile_where_the_bridge_is_wrong():
    truth = np.quantile(bent(np.random.default_rng(9), 2_000_000, 2_000_000)[0], 0.05)
    draw = lambda g: bent(g, 120, 1000)
    methods = ("indicator", "bridge")
    find = lambda y, x: [estimate.quantile(y, x, 0.05, method) for method in methods]
    generator = np.random.default_rng(4)
    found = list(zip(*(find(*draw(generator)) for _ in range(50))))
    inside = [np.mean([e.low <= truth <= e.high for e in one]) for one in found]
    assert inside[0] >= 0.95 - 3 * math.sqrt(0.95 * 0.05 / 50)
    assert inside[1] < 0.3
    assert "bend over" in estimate.doubts(*draw(generator))[0]


def test_a_scatter_that_grows_along_the_cheap_numbers_is_doubted():
    generator = np.random.default_rng(8)
    x = generator.uniform(1, 3, 60)
    y = 5 * x + 0.2 * x**2 * generator.standard_normal(60)
    (message,) = estimate.doubts(y, x)
    assert "more at one end" in message


def test_what_rounding_leaves_is_not_doubted():
    x = np.random.default_rng(12).uniform(1, 3, 60)
    assert estimate.doubts(5 * x + 1e-13 * x**4, x) == []


def test_doubts_come_as_seldom_as_they_say_where_the_bridge_holds():
    generator = np.random.default_rng(5)
    counts = [len(estimate.doubts(*line(generator, 25, 25, 0.9))) for _ in range(1000)]
    seldom = 2 * estimate.DOUBT
    assert np.mean(counts) < seldom + 3 * math.sqrt(seldom / 1000)


def test_cheap_rows_that_tell_nothing_do_no_harm():
    """Then the mean and its interval are those of the expensive rows alone, but for one degree of
    freedom."""
    generator, ratios = np.random.default_rng(6), []
    for _ in range(200):
        y, x = generator.standard_normal(40), generator.standard_normal(400)
        found = estimate.mean(y, x)
        half = stats.t.ppf(0.975, 39) * y.std(ddof=1) / math.sqrt(40)
        ratios.append((found.high - found.low) / 2 / half)
    assert 0.97 < np.mean(ratios) < 1.06
    assert estimate.saved(found, (60, 4)).share > 1
    assert "nothing is saved" in estimate.sentence(found, (60, 4))


def test_what_is_saved_is_the_rule_of_two_models():
    """Of Peherstorfer, Willcox and Gunzburger: cost over cost alone is (sqrt(1 - ρ²) + sqrt(d/c
    ρ²))², at the best ratio."""
    rho, prices = 0.98, (60.0, 3.0)
    parts = 25 * (1 - rho**2), 25 * rho**2
    pilot = estimate.Estimate("mean", 0, -1, 1, *parts, 25, 20, 200)
    best = estimate.allocate(pilot, prices, variance=0.02)
    rule = (math.sqrt(1 - rho**2) + math.sqrt(rho**2 * 3 / 60)) ** 2
    assert best.share == pytest.approx(rule, rel=0.02)  # whole runs
    ratio = math.sqrt(rho**2 * 60 / (1 - rho**2) / 3)
    assert best.rows / best.shared == pytest.approx(ratio, rel=0.03)
    assert pilot.expensive / best.shared + pilot.cheap / best.rows <= 0.02
    assert best.alone == pytest.approx(25 / 0.02, rel=0.01)
    assert best.cost == 60 * best.shared + 3 * best.rows
    again = estimate.allocate(pilot, prices, budget=best.cost)
    assert again.cost <= best.cost
    assert again.shared == pytest.approx(best.shared, rel=0.03)


def test_a_budget_is_never_exceeded_and_all_of_it_is_used():
    pilot = estimate.Estimate("mean", 0, -1, 1, 1.0, 24.0, 25, 20, 200)
    for budget in (700, 1234, 5000, 1e5):
        best = estimate.allocate(pilot, (60, 3), budget=budget)
        assert budget - 60 - 3 < best.cost <= budget
        assert best.shared >= estimate.SHARED


def test_words_say_what_was_saved():
    found = estimate.Estimate("mean", 115.2, 114.8, 115.6, 1.0, 24.0, 25, 20, 600)
    message = estimate.sentence(found, (60, 3), "kN", ("accurate", "fast"))
    # variance 1/20 + 24/600 = 0.09, for which 25/0.09 = 278 runs are needed alone
    assert "20 runs of accurate and 600 of fast in 50 min" in message
    assert "accurate alone needs 278 runs and 4.63 h" in message
    assert "82 % of the time is saved" in message


def test_an_end_that_few_rows_do_not_tell_is_said_to_be_unknown():
    y, x = line(np.random.default_rng(11), 10, 12, 0.5)
    found = estimate.quantile(y, x, 0.05)
    assert found.low == -math.inf and math.isfinite(found.high)
    assert "between an unknown end and" in estimate.sentence(found, (60, 3))


y30, x30 = line(np.random.default_rng(1), 30, 100, 0.9)
mean30 = estimate.mean(y30, x30)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: estimate.mean(y30[:9], x30), "9 shared rows are too few"),
        (lambda: estimate.mean(y30, x30[:29]), "29 cheap rows for 30 expensive ones"),
        (lambda: estimate.mean([*y30[:-1], math.nan], x30), "expensive rows 30 have"),
        (lambda: estimate.mean(y30, np.ones(100)), "cheap numbers of all shared rows"),
        (lambda: estimate.quantile(y30, x30, 1), "quantile of 1"),
        (lambda: estimate.quantile(y30, x30, 0.5, "magic"), "'magic' must be"),
        (lambda: estimate.quantile(y30, x30, 0.05, "indicator"), "there are 30"),
        (lambda: estimate.allocate(mean30, (0, 1)), "expensive run is 0"),
        (lambda: estimate.allocate(mean30, (9, 1)), "either"),
        (lambda: estimate.allocate(mean30, (9, 1), budget=99), "rows cost 100"),
    ],
)
def test_what_no_estimate_can_be_made_of_is_refused(call, message):
    with pytest.raises(Refused, match=message):
        call()
