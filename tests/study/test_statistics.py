# SPDX-License-Identifier: GPL-2.0-or-later
"""Statistics of a study hold what they promise: how often their intervals have the truth, and what
they say of few rows."""

from usual import *
from masonry_study import statistics
from scipy import stats

REPEATS = 1000
#: How far the share of intervals that have the truth may be from 95 % by chance: three standard
#: deviations of a binomial.
CHANCE = 3 * math.sqrt(0.95 * 0.05 / REPEATS)


def covered(find, draw, truth, seed=1):
    """How often the interval of ``find`` has the truth."""
    generator = np.random.default_rng(seed)
    found = [find(draw(generator)) for _ in range(REPEATS)]
    return np.mean([interval.low <= truth <= interval.high for interval in found])


def test_intervals_of_a_mean_have_it_as_often_as_they_say():
    draw = lambda g: 100 + 10 * g.standard_normal(12)
    assert covered(statistics.mean, draw, 100) == approx(0.95, abs=CHANCE)


@mark.parametrize("normal", [True, False])
def test_intervals_of_a_standard_deviation_have_it_as_often_as_they_say(normal):
    """Also of a distribution that is not normal: the lognormal one of a strength that scatters by
    20 %."""
    scale = math.sqrt(math.log(1.04))
    skewed = lambda g: g.lognormal(-(scale**2) / 2, scale, 60)
    draw = (lambda g: g.standard_normal(60)) if normal else skewed
    found = covered(statistics.deviation, draw, 1 if normal else 0.2)
    # Bonett's interval is an approximation: it may have the truth somewhat more often, or 1 % less
    assert 0.94 - CHANCE <= found <= 0.975


@mark.parametrize("share", [0.05, 0.5, 0.95])
def test_intervals_of_a_quantile_have_it_at_least_as_often_as_they_say(share):
    """They are of steps of one row, so they may have it more often; by how much follows from the
    binomial distribution."""
    n = 100
    inside = stats.binom.cdf(np.arange(n), n, share)
    low = np.flatnonzero(inside <= 0.025)[-1] + 1  # of so many rows below
    high = np.flatnonzero(inside >= 0.975)[0]
    exact = stats.binom.cdf(high, n, share) - stats.binom.cdf(low - 1, n, share)
    assert 0.95 <= exact <= 0.985
    find = lambda values: statistics.quantile(values, share)
    found = covered(find, lambda g: g.exponential(size=n), -math.log(1 - share))
    assert found == approx(exact, abs=CHANCE)


@mark.parametrize("n, low, high", [(6, 1, 6), (10, 2, 9), (20, 6, 15), (50, 18, 33), (100, 40, 61)])
def test_the_interval_of_a_median_has_the_ranks_of_the_sign_test(n, low, high):
    """Ranks of the 95 % interval as in tables of the sign test: fewer than 2.5 % lie beyond each,
    and one rank further in it would be more."""
    found = statistics.quantile(np.arange(1.0, n + 1), 0.5)
    assert (found.low, found.high) == (low, high)
    beyond = lambda rank: sum(math.comb(n, k) for k in range(rank)) / 2**n
    assert beyond(low) <= 0.025 < beyond(low + 1) and high == n + 1 - low


def test_few_rows_tell_no_end_of_a_low_quantile():
    # 71 rows: with probability 0.95**71 = 2.6 % none of them is below the quantile
    found = statistics.quantile(np.arange(1.0, 72), 0.05)
    assert found.low == -math.inf and math.isfinite(found.high)
    assert statistics.quantile(np.arange(1.0, 73), 0.05).low == 1


def test_shares_are_counted_with_the_most_frequent_first():
    found = statistics.shares(["slides"] * 2 + ["rocks"] * 8)
    assert list(found) == ["rocks", "slides"]
    assert found["rocks"].value == 0.8
    # Wilson's interval of 8 of 10, by its formula with z = 1.96
    z = stats.norm.ppf(0.975)
    centre = (0.8 + z * z / 20) / (1 + z * z / 10)
    half = z * math.sqrt(0.8 * 0.2 / 10 + z * z / 400) / (1 + z * z / 10)
    assert found["rocks"][1:] == approx((centre - half, centre + half))


def test_a_fragility_is_the_share_of_rows_below_with_its_exact_band():
    capacities = [3, 1, 2, 4]
    probability, low, high = statistics.fragility(capacities, [0.5, 1, 2.5, 4])
    assert probability.tolist() == [0, 0.25, 0.5, 1]
    assert low[0] == 0 and high[-1] == 1
    assert high[0] == approx(1 - 0.025**0.25)  # none of four is below
    assert low[-1] == approx(0.025**0.25)
    assert low[2] == approx(1 - high[2])  # two of four on both sides


def test_bands_of_a_fragility_have_the_truth_at_least_as_often_as_they_say():
    generator, inside = np.random.default_rng(2), 0
    for _ in range(REPEATS):
        _, low, high = statistics.fragility(generator.normal(100, 10, 50), [90])
        inside += low[0] <= stats.norm.cdf(-1) <= high[0]
    assert 0.95 - CHANCE <= inside / REPEATS <= 0.99


def test_a_lognormal_distribution_is_found_and_another_one_is_doubted():
    generator = np.random.default_rng(3)
    found = statistics.lognormal(100 * np.exp(0.2 * generator.standard_normal(2000)))
    assert found.median == approx(100, rel=4 * 0.2 / math.sqrt(2000))
    assert found.dispersion == approx(0.2, rel=4 / math.sqrt(4000))
    assert found.fits > 0.01
    modes = [generator.normal(mean, 2, 100) for mean in (100, 130)]
    assert statistics.lognormal(np.concatenate(modes)).fits < 1e-4


@mark.parametrize(
    "call, message",
    [
        (lambda: statistics.mean([1]), "2 rows or more, there are 1"),
        (lambda: statistics.deviation(range(9)), "10 rows or more, there are 9"),
    ],
)
def test_what_no_statistics_can_be_made_of_is_refused(call, message):
    with raises(Refused, match=message):
        call()
