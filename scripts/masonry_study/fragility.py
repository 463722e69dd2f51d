# SPDX-License-Identifier: GPL-2.0-or-later
"""Fragility of an incremental dynamic analysis: a lognormal distribution of the intensity at which
a limit is first reached.

Rows of one record are not independent: a record at which a structure falls makes it fall at higher
levels, too. So each record is one observation, of which the levels tell an interval: the limit is
not reached at ``low``, the highest level below the first that reaches it (0: none), and it is
reached at ``high`` (infinite: at no level). With the median θ and the dispersion β, the standard
deviation of the logarithm, the likelihood is

    L(θ, β) = Π [Φ(ln(high/θ)/β) - Φ(ln(low/θ)/β)].

A row that failed or is missing makes its interval wider. The usual likelihood of counts, a binomial
factor for every level, takes rows of one record for independent ones. Its estimate is nearly the
same, but its intervals are too narrow.

Intervals are those of the profile likelihood: all values of a number that it has anywhere where
2 ln L is at most c below its maximum. For a normal distribution whose n values are known exactly,
c = n ln(1 + t²/(n-1)), with the quantile t of Student's distribution with n-1 degrees of freedom,
gives the exact interval of the median; for many records it is the quantile of χ². This c is used
here. In 1,000 samples of 5, 10 and 20 records each, with dispersions of 0.3 and 0.6 and eight
levels, 94 to 99 % of the 95 % intervals of median, dispersion and probability held the truth; those
of counts did so in 79 to 88 % of 400 samples.

With a = 1/β and b = ln(θ)/β, ln L is concave, so it has one maximum, and the set of likely values
is convex: its edge is found along rays. The probability Φ(a ln x - b) of reaching the limit at x
has its band from the same edge.
"""

import html
import math
import re
from dataclasses import dataclass

import numpy as np
from scipy import optimize, special, stats

from masonry.arguments import Numbers
from masonry.errors import Refused
from .statistics import CONFIDENCE, Interval

MIN_RECORDS = 3  # records
#: Standard deviations above the median where 0.9999 reach the limit.
NEARLY_ALL = 3.72
MAX_DISPERSION = 10.0  # beyond which the data do not bound it [-]
RAYS = 360  # along which the edge of the likely values is found
MIN_SLOPE_RATIO = 1e-6  # of the value of a = 1/β at the maximum: smaller is 0


@dataclass(frozen=True)
class Fit:
    """A fragility.

    :param median: intensity at which half of all records reach the limit, with its interval
    :param dispersion: standard deviation of the logarithm of the intensity [-], with its interval
    :param reached: how many records reach the limit; ``records``: how many there are
    """

    median: Interval
    dispersion: Interval
    reached: int
    records: int
    _edge: tuple

    def probability(self, intensity: float) -> Interval:
        """Probability of reaching the limit at an intensity above 0, with its interval."""
        place, (a, b) = math.log(intensity), self._edge
        ends = a * place - b
        value = (place - math.log(self.median.value)) / self.dispersion.value
        return Interval(*special.ndtr([value, ends.min(), ends.max()]).tolist())


def fit(low: Numbers, high: Numbers) -> Fit:
    """The fragility with the largest likelihood. Raises Refused, with the reason, if the records
    cannot give it.

    :param low: of every record the highest level below the first that reaches the limit; 0: none
    :param high: of every record the first level that reaches it; infinite: none
    """
    low, high = np.asarray(low, float), np.asarray(high, float)
    _check(low, high)
    n = len(low)
    with np.errstate(divide="ignore"):
        ends = np.log(np.column_stack([low, high]))
    ends, counts = np.unique(ends, axis=0, return_counts=True)
    lower, upper = ends.T

    def likelihood(a, b):
        """ln L for arrays of a and b."""
        a, b = np.asarray(a)[..., None], np.asarray(b)[..., None]
        with np.errstate(invalid="ignore"):
            return _logOfDifference(a * lower - b, a * upper - b) @ counts

    known = np.where(np.isfinite(lower), lower, upper)
    known = known[np.isfinite(known)]
    found = optimize.minimize(
        lambda p: -float(likelihood(math.exp(-p[1]), p[0] * math.exp(-p[1]))),
        [known.mean(), math.log(max(known.std(), 0.1))],
        method="Nelder-Mead",
        bounds=[(-50, 50), (math.log(1e-4), math.log(1e3))],
        options=dict(xatol=1e-10, fatol=1e-12, maxiter=5000, maxfev=5000),
    )
    mean, spread = float(found.x[0]), math.exp(found.x[1])
    if spread > MAX_DISPERSION:
        raise Refused(
            "no fragility: the records reach the limit at their lowest level or not at all, so the"
            " dispersion has no bound; add lower and higher levels"
        )
    t = stats.t.ppf((1 + CONFIDENCE) / 2, n - 1)
    drop = n * math.log1p(t * t / (n - 1))  # the module says why
    a, b = edge = _edge(likelihood, 1 / spread, mean / spread, drop)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        open = a <= MIN_SLOPE_RATIO / spread
        medians = np.exp(np.where(open, np.sign(b) * math.inf, b / a))
        spreads = np.where(open, math.inf, 1 / a)
    median = Interval(math.exp(mean), float(medians.min()), float(medians.max()))
    dispersion = Interval(spread, float(spreads.min()), float(spreads.max()))
    return Fit(median, dispersion, int(np.isfinite(high).sum()), n, edge)


def nrml(fits: dict[str, Fit], measure: str, state: str, what: str, highest: float) -> str:
    """Fragilities as a model that OpenQuake reads, of NRML 0.5: GEM Foundation, OpenQuake engine
    manual, "Fragility Models". Its mean and standard deviation are those of the intensity, not of
    its logarithm. OpenQuake takes intensities above maxIML down to it, so maxIML is where nearly
    all reach the limit, and the description says which levels were run. Raises Refused if OpenQuake
    does not know the measure.

    :param fits: by the taxonomy of the assets
    :param measure: of intensity, as a column of study.csv
    :param state: name of the limit state; ``what``: it in words
    :param highest: level that was run [g]
    """
    period = re.fullmatch(r"Sa_([\d.]+)s_g", measure)
    if not (period or measure == "PGA_g"):
        raise Refused(f"OpenQuake has no {measure}")
    imt = f"SA({period[1]})" if period else "PGA"
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<nrml xmlns="http://openquake.org/xmlns/nrml/0.5">',
        '<fragilityModel id="fragility" assetCategory="buildings" lossCategory="structural">',
        f"<description>{html.escape(what)}; run up to {highest:g} g</description>",
        f"<limitStates>{state}</limitStates>",
    ]
    ids = [re.sub(r"[^A-Za-z0-9_-]+", "_", name)[:100] for name in fits]
    if len({*ids}) < len(ids):
        raise Refused(f"OpenQuake cannot tell names apart: {', '.join(fits)} are {', '.join(ids)}")
    for name, fit in zip(ids, fits.values()):
        spread = fit.dispersion.value
        mean = fit.median.value * math.exp(spread**2 / 2)
        deviation = mean * math.sqrt(math.expm1(spread**2))
        most = max(highest, fit.median.value * math.exp(NEARLY_ALL * spread))
        lines += [
            f'<fragilityFunction id="{name}" format="continuous" shape="logncdf">',
            f'<imls imt="{imt}" minIML="0" maxIML="{most:.6g}"/>',
            f'<params ls="{state}" mean="{mean:.6g}" stddev="{deviation:.6g}"/>',
            "</fragilityFunction>",
        ]
    return "\n".join([*lines, "</fragilityModel>", "</nrml>", ""])


def _check(low, high):
    n = len(low)
    if n < MIN_RECORDS:
        raise Refused(f"a fragility needs {MIN_RECORDS} records or more, there are {n}")
    if not np.isfinite(high).any():
        raise Refused(
            f"no fragility: at none of the {n} records is the limit reached; add higher levels"
        )
    if not low.any():
        raise Refused(
            f"no fragility: at all {n} records the limit is reached at the lowest level that was"
            " run; add lower levels"
        )
    if low.max() <= high.min():
        places = dict.fromkeys(f"{end:.3g}" for end in (low.max(), high.min()))
        raise Refused(
            "no fragility: all records may reach the limit at one intensity,"
            f" {' to '.join(places)}, so the dispersion cannot be found; add levels about it, or"
            " records"
        )


def _logOfDifference(low, high):
    flip = low > 0
    low, high = np.where(flip, -high, low), np.where(flip, -low, high)
    top = special.log_ndtr(high)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.exp(special.log_ndtr(low) - top)
        return top + np.log1p(-np.minimum(share, 1))


def _edge(likelihood, a, b, drop):
    """Points (a, b) of the edge of the set where 2 ln L is at most ``drop`` below its maximum, on
    rays from the maximum."""
    best = float(likelihood(a, b))
    shape = _shape(likelihood, a, b)
    angles = np.linspace(0, 2 * math.pi, RAYS, endpoint=False)
    rays = shape @ np.array([np.cos(angles), np.sin(angles)])
    least = MIN_SLOPE_RATIO * a

    def outside(radius):
        at = a + radius * rays[0]
        beyond = 2 * (best - likelihood(np.maximum(at, least), b + radius * rays[1]))
        return (at <= least) | ~(beyond < drop)

    inner, outer = np.zeros(RAYS), np.ones(RAYS)
    for _ in range(60):
        found = outside(outer)
        if found.all():
            break
        inner = np.where(found, inner, outer)
        outer = np.where(found, outer, 2 * outer)
    for _ in range(40):
        middle = 0.5 * (inner + outer)
        found = outside(middle)
        outer, inner = np.where(found, middle, outer), np.where(found, inner, middle)
    return np.maximum(a + outer * rays[0], 0), b + outer * rays[1]


def _shape(likelihood, a, b):
    """A matrix that makes the likely values of a and b about as wide to all sides: from the second
    derivatives of ln L."""
    sizes = np.array([a, max(abs(b), a)])
    step = 1e-4 * sizes
    value = lambda i, j: float(likelihood(a + i * step[0], b + j * step[1]))
    bend = lambda i, j: value(i, j) - 2 * value(0, 0) + value(-i, -j)
    cross = (value(1, 1) - value(1, -1) - value(-1, 1) + value(-1, -1)) / 4
    second = np.array([[bend(1, 0), cross], [cross, bend(0, 1)]])
    second /= np.outer(step, step)
    try:
        return np.linalg.inv(np.linalg.cholesky(-second)).T
    except np.linalg.LinAlgError:
        return np.diag(sizes)
