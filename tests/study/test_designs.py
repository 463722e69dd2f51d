# SPDX-License-Identifier: GPL-2.0-or-later
"""Designs of studies: moments, bounds, dependence, strata, and that the same seed gives the same
rows."""

from usual import *
from masonry_study import Study, choice, field, lognormal, normal, uniform

ot = pytest.importorskip("openturns", reason="python3-openturns is not installed")

DESIGNS = ["random", "latin", "sobol"]
TWO = {"a.b": uniform(0, 1), "a.c": uniform(0, 1)}


def rowsOf(vary, seed=3, **settings):
    return Study("any", seed=seed, vary=vary, **settings).rows()


def columns(*of, **settings):
    """The values in all rows of one or more names that vary."""
    rows = rowsOf(*of, **settings)
    return [np.array([row[name] for row in rows]) for name in of[0]]


@mark.parametrize("design", DESIGNS)
@mark.parametrize(
    "what, mean, deviation",
    [
        (lognormal(0.11e6, 0.2), 0.11e6, 0.022e6),
        (normal(0.43, 0.05), 0.43, 0.0215),
        (uniform(2.0, 5.0), 3.5, 3 / math.sqrt(12)),
    ],
)
def test_values_have_the_moments_of_their_distribution(what, mean, deviation, design):
    [values] = columns({"bed.cohesion": what}, runs=1024, design=design)
    # the mean of 1,024 independent numbers is within four of its standard deviations; of the others
    # it is closer
    wide = 4 * deviation / 32 / (1 if design == "random" else 10)
    assert abs(values.mean() - mean) < wide
    assert values.std() == approx(deviation, rel=0.12)


@given(
    seed=some.integers(0, 2**31 - 1),
    runs=some.integers(1, 40),
    design=some.sampled_from(DESIGNS),
    low=some.floats(-1e3, 1e3),
    width=some.floats(1e-3, 1e3),
)
@settings(max_examples=40)
def test_values_lie_in_bounds_and_are_the_same_again(seed, runs, design, low, width):
    vary = {"a.b": uniform(low, low + width), "d": ["x", "y"]}
    vary["a.c"] = normal(1.0, 0.5, low=0.5, high=2.0)
    made = lambda: Study("any", runs=runs, seed=seed, vary=vary, design=design)
    rows = made().rows()
    assert rows == made().rows() and made().table() == made().table()
    assert len(rows) == runs
    for row in rows:
        assert low <= row["a.b"] <= low + width
        assert 0.5 <= row["a.c"] <= 2.0
        assert row["d"] in ("x", "y")


@given(
    kind=some.sampled_from([lognormal, normal]),
    size=some.integers(-9, 12),
    mean=some.floats(1, 10),
    cov=some.floats(0.01, 1),
    ends=some.tuples(some.floats(0.02, 0.98), some.floats(0.02, 0.98)).map(sorted),
    given=some.sampled_from(["low", "high", "both"]),
    u=some.floats(0.001, 0.999),
)
@settings(max_examples=200)
def test_a_cut_distribution_is_the_rest(kind, size, mean, cov, ends, given, u):
    assume(ends[0] + 0.01 < ends[1])
    mean *= 10.0**size
    whole = kind(mean, cov).law()
    low, high = (whole.computeQuantile(p)[0] for p in ends)
    below, above = ends[0] * (given != "high"), ends[1] if given != "low" else 1.0
    bounds = {"low": low} if given != "high" else {}
    bounds.update({"high": high} if given != "low" else {})
    value = kind(mean, cov, **bounds).law().computeQuantile(u)[0]
    # the part of the whole between its ends, in proportion
    expected = below + u * (above - below)
    assert whole.computeCDF(value) == approx(expected, abs=1e-6)


def test_another_seed_gives_other_rows_and_fields():
    vary = {"bed.cohesion": lognormal(1.0, 0.2), "head.cohesion": field(cov=0.2)}
    rows = [row for seed in (1, 2) for row in rowsOf(vary, seed, runs=50)]
    for name in rows[0].keys() - {"lean"}:
        assert len({row[name] for row in rows}) == 100, name


def test_the_random_numbers_of_the_caller_are_left_alone():
    ot.RandomGenerator.SetSeed(5)
    expected = ot.RandomGenerator.Generate()
    ot.RandomGenerator.SetSeed(5)
    rowsOf(TWO, runs=20)
    assert ot.RandomGenerator.Generate() == expected


def test_every_stratum_of_a_latin_hypercube_has_one_row():
    for values in columns(TWO, runs=64, design="latin"):
        assert sorted(map(int, 64 * values)) == list(range(64))


def test_sobol_fills_the_square_evenly():
    """Moved by a random vector, the points still fill squares far more evenly than random ones
    do."""

    def unevenness(design):
        return np.histogram2d(*columns(TWO, runs=256, design=design), bins=8)[0].std()

    assert unevenness("sobol") < 0.6 * unevenness("random")


@mark.parametrize("design", DESIGNS)
@mark.parametrize("rank", [0.5, -0.8])
def test_correlated_numbers_have_rank_correlation_and_distributions(design, rank):
    vary = {"a.b": lognormal(2.0, 0.5), "t": choice("x", "y"), "a.c": uniform(0, 1)}
    correlation = {("a.b", "a.c"): rank}
    one, _, two = columns(vary, runs=1000, design=design, correlation=correlation)
    ranks = [np.argsort(np.argsort(v)) for v in (one, two)]
    # the standard error of 1,000 rows is 0.03 at most
    assert np.corrcoef(*ranks)[0, 1] == approx(rank, abs=0.1)
    assert one.mean() == approx(2.0, abs=4 / math.sqrt(1000))
    assert two.mean() == approx(0.5, abs=4 * 0.29 / math.sqrt(1000))


def test_correlations_that_no_numbers_have_are_refused():
    vary = {f"a.{n}": uniform(0, 1) for n in "xyz"}
    pairs = {("a.x", "a.y"): 0.95, ("a.y", "a.z"): 0.95, ("a.x", "a.z"): -0.95}
    with raises(Refused, match="no numbers have all these correlations"):
        rowsOf(vary, runs=5, correlation=pairs)


def test_weights_of_a_choice():
    [values] = columns({"joints": choice("softening", "brittle", weights=(3, 1))}, runs=2000)
    # the standard error is 0.01
    assert np.mean(values == "brittle") == approx(0.25, abs=0.04)


def test_a_grid_has_all_combinations():
    vary = {"rate": [20, 40], "joints": ["softening", "brittle", "cyclic"]}
    study = Study("any", vary=vary, design="grid")
    rows = [(row["rate"], row["joints"]) for row in study.rows()]
    assert study.runs == len(set(rows)) == 6
