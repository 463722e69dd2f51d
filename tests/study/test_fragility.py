# SPDX-License-Identifier: GPL-2.0-or-later
"""Fragility from the levels between which records reach a limit: drawn data, closed forms, and what
cannot be found."""

from usual import *
from xml.etree import ElementTree
from hypothesis import reject
from scipy import special, stats
from masonry_study.fragility import MAX_DISPERSION, fit, nrml

LEVELS = np.geomspace(0.2, 3, 8)


def between(capacities, levels=LEVELS):
    """The levels between which some intensities lie."""
    place = np.searchsorted(levels, capacities)
    return np.append(0, levels)[place], np.append(levels, math.inf)[place]


def drawn(seed, records, median=0.8, dispersion=0.5):
    random = np.random.default_rng(seed)
    return between(median * np.exp(dispersion * random.standard_normal(records)))


def test_drawn_data_give_their_distribution_back():
    """A thousand records: standard errors are β/√1000 = 0.016 of ln θ and 0.011 of β. Levels that
    are 0.39 apart in the logarithm add a variance of 0.39²/12 to that of 0.25 of an intensity, so
    0.004 and 0.003 to these errors.
    """
    for seed in range(3):
        logs = 0.5 * np.random.default_rng(seed).standard_normal(1000)
        found = fit(*drawn(seed, 1000))
        assert math.log(found.median.value / 0.8) == approx(logs.mean(), abs=0.015)
        assert found.dispersion.value == approx(logs.std(), abs=0.015)
        assert 0.05 < math.log(found.median.high / found.median.low) < 0.08
        assert 0.04 < found.dispersion.high - found.dispersion.low < 0.06


@mark.parametrize("records", [6, 12])
def test_intervals_hold_the_truth_as_often_as_they_say(records):
    """Of 100 samples 95 should; the binomial standard deviation is 2.2, and 88 are three of them
    below."""
    held = np.zeros(3)
    tried = 0
    for seed in range(100):
        try:
            found = fit(*drawn(seed, records, dispersion=0.6))
        except Refused:
            continue  # records that do not tell the dispersion
        tried += 1
        at = special.ndtr(math.log(0.5 / 0.8) / 0.6)
        probability = found.probability(0.5)
        held += [
            found.median.low <= 0.8 <= found.median.high,
            found.dispersion.low <= 0.6 <= found.dispersion.high,
            probability.low <= at <= probability.high,
        ]
    assert tried > 85
    assert (held / tried > 0.88).all(), held / tried


def test_two_levels_have_a_closed_form():
    """Shares p and q at or below two levels: Φ⁻¹ of both is ln(level/θ)/β, which are two equations
    for θ and β."""
    found = fit(*between([0.1] * 2 + [0.7] * 5 + [2] * 3, [0.5, 1.0]))
    p, q = special.ndtri([0.2, 0.7])
    dispersion = math.log(2) / (q - p)
    assert found.dispersion.value == approx(dispersion, rel=1e-4)
    assert found.median.value == approx(math.exp(-dispersion * q), rel=1e-4)
    assert found.probability(0.5).value == approx(0.2, rel=1e-4)
    assert found.probability(1.0).value == approx(0.7, rel=1e-4)
    assert (found.reached, found.records) == (7, 10)


def test_fine_levels_give_the_interval_of_student():
    """With intensities that are known nearly exactly, the interval of ln θ is that of Student's t
    about the mean."""
    values = np.exp(0.4 * np.random.default_rng(3).standard_normal(8))
    found = fit(values * (1 - 1e-4), values * (1 + 1e-4))
    logs = np.log(values)
    half = stats.t.ppf(0.975, 7) * logs.std(ddof=1) / math.sqrt(8)
    assert math.log(found.median.value) == approx(logs.mean(), abs=1e-4)
    assert found.dispersion.value == approx(logs.std(), rel=1e-3)
    assert math.log(found.median.low) == approx(logs.mean() - half, rel=1e-3)
    assert math.log(found.median.high) == approx(logs.mean() + half, rel=1e-3)


@given(seed=some.integers(0, 1000), scale=some.floats(0.01, 100))
@settings(max_examples=10, deadline=None)
def test_the_unit_of_the_intensity_does_not_matter(seed, scale):
    low, high = drawn(seed, 15)
    try:
        one, other = fit(low, high), fit(scale * low, scale * high)
    except Refused:  # as below
        reject()
    assert other.dispersion == approx(one.dispersion, rel=1e-4)
    assert other.median == approx([scale * m for m in one.median], rel=1e-4)
    place = 0.7 * one.median.value
    assert other.probability(scale * place) == approx(one.probability(place), abs=1e-4)


@given(seed=some.integers(0, 1000))
@settings(max_examples=20, deadline=None)
def test_intervals_hold_the_value_and_probabilities_grow(seed):
    try:
        found = fit(*drawn(seed, 12))
    except Refused:  # of some draws all records may reach the limit at one level
        reject()
    for one in (found.median, found.dispersion):
        assert one.low < one.value < one.high
    at = [found.probability(x) for x in np.geomspace(0.05, 10, 30)]
    assert all(0 <= p.low <= p.value <= p.high <= 1 for p in at)
    for one in zip(*at):
        assert all(a <= b + 1e-12 for a, b in zip(one, one[1:]))


@given(
    capacities=some.lists(some.floats(0.05, 10), min_size=3, max_size=12),
    count=some.integers(1, 6),
)
@settings(max_examples=60, deadline=None)
def test_any_records_give_numbers_or_a_sentence(capacities, count):
    try:
        found = fit(*between(capacities, np.geomspace(0.2, 3, count)))
    except Refused as refused:
        assert "add" in str(refused) and "\n" not in str(refused)
    else:
        assert 0 < found.median.value < math.inf
        assert 0 < found.dispersion.value <= MAX_DISPERSION
        assert 0 <= found.median.low <= found.median.value <= found.median.high


@mark.parametrize(
    "capacities, message",
    [
        ([0.5, 1.0], "needs 3 records or more, there are 2"),
        ([9, 9, 9], "at none of the 3 records is the limit reached; add higher levels"),
        (
            [0.1, 0.1, 0.1, 0.1],
            "at all 4 records the limit is reached at the lowest level that was run; add lower",
        ),
        ([0.5, 0.5, 0.5], "all records may reach the limit at one intensity, 0.434 to 0.638, so"),
        ([0.5, 0.8, 9], None),
        ([0.5, 0.7, 0.7], "all records may reach the limit at one intensity, 0.638, so"),
        ([2.5, 9, 9], "all records may reach the limit at one intensity, 3, so"),
        ([0.1, 9, 0.1, 9], "at their lowest level or not at all, so the dispersion has no bound"),
    ],
)
def test_data_that_cannot_give_it_are_refused_with_a_sentence(capacities, message):
    refused = raises(Refused, match=message)
    with refused if message else contextlib.nullcontext():
        assert fit(*between(capacities)).median.value > 0


def test_a_model_for_openquake_has_names_and_measures_that_it_reads():
    found = fit(*drawn(1, 20))
    text = nrml({"house <1>": found}, "Sa_0.5s_g", "limit", "x < 1 & more", 2.0)
    root = ElementTree.fromstring(text.encode())
    space = "{http://openquake.org/xmlns/nrml/0.5}"
    assert root.find(f".//{space}description").text == "x < 1 & more; run up to 2 g"
    function = root.find(f".//{space}fragilityFunction")
    assert function.get("id") == "house_1_" and function[0].get("imt") == "SA(0.5)"
    # OpenQuake puts what is above maxIML down to it
    assert found.probability(float(function[0].get("maxIML"))).value == approx(0.9999, abs=1e-5)
    with raises(Refused, match="OpenQuake has no Sa_0.5s_2%_g"):
        nrml({}, "Sa_0.5s_2%_g", "limit", "", 2.0)
