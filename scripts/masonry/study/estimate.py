# SPDX-License-Identifier: GPL-2.0-or-later
"""Mean, spread and quantiles from few expensive runs and many cheap ones. This module needs no
YADE.

A preset is a fidelity: ``fast`` and ``bound`` miss the peak of ``accurate`` by a little, but they
move with it when a strength moves. So a few rows are run with both, and many more with the cheap
one alone. The shared rows tell how the expensive number follows from the cheap one, and the many
cheap ones tell how that one scatters.

In the formulas y is the expensive and x the cheap number of a row, N rows are shared, and M rows,
these among them, are cheap. The variance of every estimate here has two parts, A/N + B/M: what the
shared rows leave open, and what the cheap ones do.

- **Mean**: ȳ + b (x̄ of M - x̄ of N), the control variate with the slope b of the regression of y
  on x. A is the variance of the residuals, and B is b² times the variance of x. Where y bends over
  x, it has a bias of the order of 1/N, which is small beside the interval.
- **Standard deviation**: the variance of y is b² times that of x over all M rows, plus that of the
  residuals. A is what the slope and r² leave open, and B the variance of b² (x - mean)².
- **Quantile by a bridge**: y = a + b x + r, with a residual r that is independent of x. The
  distribution of y is that of a + b x over all M rows plus r over all N. It uses every row for
  every quantile.
- **Quantile by an indicator**: the control variate for "y is below q", whose mean is the
  probability, with the probability that the bridge gives as the cheap number. It holds whether the
  bridge does or not, but a quantile of 5 % needs a hundred shared rows.

How many runs of each kind reach an interval at the least cost follows from A and B and the prices
of the runs. For the mean this is the rule of B. Peherstorfer, K. Willcox and M. Gunzburger,
"Optimal model management for multifidelity Monte Carlo estimation", SIAM Journal on Scientific
Computing 38 (2016), for two models.

Rows must be drawn independently, and shared ones must not be chosen by their results.
"""

import math
from collections import namedtuple

import numpy as np
from scipy import special, stats

from ..basics import Refused, refuse
from .statistics import CONFIDENCE, notFinite

#: Fewest shared rows. With fewer, the slope, the residuals and their scatter are not known well
#: enough for an interval.
SHARED = 10
# shared rows that must be expected on either side of a quantile that is found by an indicator
SIDE = 5
QUANTILES = (0.05, 0.5, 0.95)  # the quantiles that :func:`estimate` gives [-]
DOUBT = 0.01  # a doubt about the bridge is reported if its p-value is below this
ROUNDING = 1e-9  # a correlation that is as near to 1 leaves nothing to doubt [-]
#: An estimate. ``name`` says of what, ``value``, ``low`` and ``high`` are in the unit of the
#: numbers. ``expensive`` and ``cheap`` are A and B, and ``alone`` is the variance of one expensive
#: row without any cheap ones; the three have one scale, which is that of probability for a
#: quantile. ``shared`` and ``rows`` are N and M.
Estimate = namedtuple("Estimate", "name value low high expensive cheap alone shared rows")

#: How many runs to make: ``shared`` rows with both, ``rows`` with the cheap one in all, and what
#: they cost; ``alone``, how many expensive runs alone reach the same interval, and ``share``, the
#: cost over the cost of those.
Allocation = namedtuple("Allocation", "shared rows cost alone share")


# -- estimates -------------------------------------------------------------------------------------


def mean(expensive, cheap):
    """The mean of the expensive number: an :class:`Estimate`.

    :param expensive: y of the shared rows
    :param cheap: x of all rows, those of the shared rows first, in the same order
    :raises Refused: if there are fewer than SHARED shared rows, or a number is not finite
    """
    found = _controlled(*_rows(expensive, cheap))
    half = _halfWidth(found)
    ends = found.value - half, found.value + half
    return _estimate("mean", found, ends, found.expensive + found.cheap)


def _estimate(name, found, ends, alone):
    sizes = found.expensive, found.cheap, alone, found.shared, found.rows
    return Estimate(name, found.value, *ends, *sizes)


def deviation(expensive, cheap):
    """The standard deviation of the expensive number: an :class:`Estimate`. Its logarithm is taken
    as normal.

    Parameters and errors are those of :func:`mean`.
    """
    y, x = _rows(expensive, cheap)
    bridge, n, ofX = _Bridge(y, x), len(y), x.var(ddof=1)
    b, residuals = bridge.slope, bridge.residuals
    ofResiduals = residuals @ residuals / n
    squared = max(b**2 - ofResiduals / bridge.squares, 0)  # b² is too large by that
    value = math.sqrt(squared * ofX + ofResiduals)
    shared = 4 * b**2 * ofX**2 * ofResiduals * n / bridge.squares
    shared += (residuals**2).var(ddof=1)
    many = (b**2 * (x - x.mean()) ** 2).var(ddof=1)
    found = _Found(value, shared, many, n, len(x))
    relative = _halfWidth(found) / value**2
    ends = (value * math.exp(sign * relative / 2) for sign in (-1, 1))
    return _estimate("standard deviation", found, ends, shared + many)


def quantile(expensive, cheap, share, method="bridge"):
    """The value below which a share of the expensive numbers lies: an :class:`Estimate`.

    Its interval is that of R. S. Woodruff, "Confidence intervals for medians and other position
    measures", Journal of the American Statistical Association 47 (1952): from the value where the
    estimated probability is the share less its half width to that where it is the share plus its
    half width. An end that the rows cannot tell is infinite.

    :param share: between 0 and 1
    :param method: ``"bridge"`` or ``"indicator"``, as above
    :raises Refused: as :func:`mean`; or if the share is not between 0 and 1, or the method is
        another, or an indicator would have fewer than SIDE shared rows to expect on one side
    """
    problems = []
    if not 0 < share < 1:
        problems.append(f"a quantile of {share:g}: it must be between 0 and 1")
    if method not in ("bridge", "indicator"):
        problems.append(f"method '{method}' must be 'bridge' or 'indicator'")
    refuse(problems)
    return _quantile(_Bridge(*_rows(expensive, cheap)), share, method)


def _quantile(bridge, share, method):
    n, side = len(bridge.y), min(share, 1 - share)
    if method == "indicator" and n * side < SIDE:
        raise Refused(
            f"the {100 * share:g} % quantile by an indicator needs {math.ceil(SIDE / side)} shared"
            f" rows or more, there are {n}: run more of them, or take the bridge"
        )
    value = _quantileAt(bridge, method, share)
    found = (bridge.probability if method == "bridge" else bridge.controlled)(value)
    half = _halfWidth(found)
    ends = (_quantileAt(bridge, method, share + sign * half) for sign in (-1, 1))
    name = f"{100 * share:g} % quantile"
    return _estimate(name, found._replace(value=value), ends, share * (1 - share))


def estimate(expensive, cheap, method="bridge"):
    """Mean, standard deviation and the quantiles QUANTILES: a list of :class:`Estimate`.

    Parameters and errors are those of :func:`mean` and :func:`quantile`.
    """
    bridge = _Bridge(*_rows(expensive, cheap))
    found = [make(expensive, cheap) for make in (mean, deviation)]
    return found + [_quantile(bridge, share, method) for share in QUANTILES]


def doubts(expensive, cheap):
    """What the shared rows say against the bridge: a list of sentences, empty if nothing does.

    One test asks whether y bends over x, by the square of x in the regression. The other asks
    whether the residuals grow along x, by the rank correlation of their size with x. Each tells in
    one of a hundred samples of which the bridge holds that it does not.
    """
    y, x = _rows(expensive, cheap)
    x = x[: len(y)]
    if 1 - abs(np.corrcoef(x, y)[0, 1]) < ROUNDING:
        return []  # what remains is rounding
    moved = (x - x.mean()) / x.std()
    (bend, *_), covariance = np.polyfit(moved, y, 2, cov=True)
    size = np.abs(y - np.polyval(np.polyfit(moved, y, 1), moved))
    bends = 2 * stats.t.sf(abs(bend) / math.sqrt(covariance[0, 0]), len(y) - 3)
    scatters = stats.spearmanr(size, x).pvalue
    found = (
        ("bend over the cheap ones", bends),
        ("scatter about the cheap ones more at one end than at the other", scatters),
    )
    return [
        f"the expensive numbers {what} (p = {p:.2g}): quantiles by the bridge are biased"
        for what, p in found
        if p < DOUBT
    ]


# -- how many runs ---------------------------------------------------------------------------------


def allocate(pilot, prices, variance=None, budget=None):
    """The runs that reach a variance at the least cost, or the least variance for a budget: an
    :class:`Allocation`.

    N = sqrt(A/c) S/V and M = sqrt(B/d) S/V, with S = sqrt(A c) + sqrt(B d), cost S²/V; c is the
    price of an expensive run and d that of a cheap one. M is never below N: if the rule has it so,
    the expensive runs are better alone, and all M are shared.

    :param pilot: an :class:`Estimate` from a few shared rows
    :param prices: of an expensive and of a cheap run, in any one unit
    :param variance: that is wanted, on the scale of ``pilot.alone``
    :param budget: in the unit of the prices, in place of the variance
    :raises Refused: if a price is not above 0, or neither or both of variance and budget are given,
        or the one is not above 0, or the budget is below that of SHARED shared rows
    """
    problems = []
    for price, of in zip(prices, ("expensive", "cheap")):
        if not (math.isfinite(price) and price > 0):
            problems.append(f"the price of a {of} run is {price:g}: it must be above 0")
    if (variance is None) == (budget is None):
        problems.append("give either the variance that is wanted or the budget")
    for what, value in (("variance", variance), ("budget", budget)):
        if value is not None and not (math.isfinite(value) and value > 0):
            problems.append(f"the {what} is {value:g}: it must be above 0")
    refuse(problems)
    c, d = prices
    least = SHARED * (c + d)
    if budget is not None and budget < least:
        raise Refused(f"a budget of {budget:g} is too small: {SHARED} shared rows cost {least:g}")
    a, b = pilot.expensive, pilot.cheap
    ratio = math.sqrt(b * c / (a * d)) if a > 0 else math.inf
    ratio = max(1.0, min(ratio, 1e6))
    if variance is None:
        shared = max(SHARED, math.floor(budget / (c + d * ratio)))
        rows = math.floor((budget - shared * c) / d)
    else:
        shared = max(SHARED, math.ceil((a + b / ratio) / variance))
        left = variance - a / shared
        rows = math.ceil(b / left) if left > 0 else shared
    return saved(pilot._replace(shared=shared, rows=max(shared, rows)), prices)


def saved(found, prices):
    """What an estimate cost, and what expensive runs alone would have cost for the same variance:
    an :class:`Allocation`.

    :param prices: of an expensive and of a cheap run, in any one unit
    """
    c, d = prices
    cost = c * found.shared + d * found.rows
    alone = found.alone / (found.expensive / found.shared + found.cheap / found.rows)
    return Allocation(found.shared, found.rows, cost, alone, cost / (c * alone))


def sentence(found, prices, unit="", names=("expensive", "cheap")):
    """An estimate and what it saved, in words.

    :param prices: of an expensive and of a cheap run [s]
    :param names: of the expensive and of the cheap fidelity
    """
    paid, unit = saved(found, prices), unit and f" {unit}"
    end = lambda v: f"{v:.4g}{unit}" if math.isfinite(v) else "an unknown end"
    message = (
        f"{found.name} {found.value:.4g}{unit}, with {100 * CONFIDENCE:g} % confidence between"
        f" {end(found.low)} and {end(found.high)}, from {found.shared} runs of {names[0]} and"
        f" {found.rows} of {names[1]} in {_time(paid.cost)}"
    )
    same = (
        f"{names[0]} alone needs {paid.alone:.0f} runs and {_time(paid.cost / paid.share)} for this"
        " interval"
    )
    if paid.share < 1:
        return f"{message}; {same}, so {100 * (1 - paid.share):.0f} % of the time is saved"
    return (
        f"{message}; {same}, so nothing is saved: {names[1]} follows {names[0]} too little for its"
        " price"
    )


def _time(seconds):
    for length, unit in ((3600, "h"), (60, "min")):
        if seconds >= 2 * length:
            return f"{seconds / length:.3g} {unit}"
    return f"{seconds:.3g} s"


# -- mathematics -----------------------------------------------------------------------------------

#: A number, A and B of its variance, and N and M. A has N - 2 degrees of freedom, and B one less
#: than cheap rows.
_Found = namedtuple("_Found", "value expensive cheap shared rows")


def _rows(expensive, cheap):
    """Both as arrays. Refuses what no interval can be made of, with all problems at once."""
    y, x = np.asarray(expensive, float).ravel(), np.asarray(cheap, float).ravel()
    refuse([*_unfit(y, x)])
    return y, x


def _unfit(y, x):
    if len(y) < SHARED:
        yield f"{len(y)} shared rows are too few: run {SHARED} or more with both fidelities"
    if len(x) < len(y):
        yield (
            f"{len(x)} cheap rows for {len(y)} expensive ones: every expensive row needs its"
            " cheap one"
        )
    for what, values in (("expensive", y), ("cheap", x)):
        yield from (f"{what} {why}" for why in notFinite(values))
        shared = values[: len(y)]
        if len(set(shared)) == 1 < len(shared):
            yield (
                f"the {what} numbers of all shared rows are {values[0]:g}: there is nothing to"
                " learn from them"
            )


def _controlled(g, z):
    """The mean of g with the control variate z: a :class:`_Found`.

    :param g: of the N shared rows
    :param z: of all M rows
    """
    n, m = len(g), len(z)
    near, away = z[:n] - z[:n].mean(), z.mean() - z[:n].mean()
    squares = near @ near or math.inf  # what is the same in all rows has no slope
    slope = near @ (g - g.mean()) / squares
    # each residual is smaller than the error that it shows, by its leverage
    leverage = 1 / n + near**2 / squares
    errors = (g - g.mean() - slope * near) / np.maximum(1 - leverage, 1 / n)
    weights = 1 / n + near * away / squares
    expensive, cheap = weights**2 @ errors**2 * n, (slope * z).var(ddof=1)
    return _Found(float(g.mean() + away * slope), float(expensive), float(cheap), n, m)


def _halfWidth(found):
    """Half of an interval: Student's t, with the degrees of freedom of Welch and Satterthwaite,
    times the deviation."""
    a, b = found.expensive / found.shared, found.cheap / found.rows
    if a + b <= 0:
        return 0.0
    freedom = (a + b) ** 2 / (a**2 / (found.shared - 2) + b**2 / (found.rows - 1))
    return special.stdtrit(freedom, (1 + CONFIDENCE) / 2) * math.sqrt(a + b)


class _Bridge:
    """y = a + b x + r of the shared rows, and the distribution of y that follows over all rows."""

    def __init__(self, y, x):
        self.y, self.x, n = y, x, len(y)
        away = x - x[:n].mean()
        self.near = near = away[:n]
        self.squares = near @ near
        self.slope = near @ y / self.squares
        self.line = y.mean() + self.slope * away
        # each residual is smaller than the error that it shows, by its leverage
        grown = 1 / np.sqrt(np.maximum(1 - 1 / n - near**2 / self.squares, 1 / n))
        self.residuals = self._residuals(self.line, grown)
        error = math.sqrt(self.residuals @ self.residuals / (n - 2) / self.squares)
        self.sortedLine = np.sort(self.line)
        self.sortedResiduals = np.sort(self.residuals)
        #: with the slope as it is, one standard error less and one more, and the difference of the
        #: last two
        self.sums, *self.turned = (
            np.sort(np.add.outer(self._residuals(line, grown), line), axis=None)
            for line in (self.line + sign * error * away for sign in (0, -1, 1))
        )
        self.turn = 2 * error

    def _residuals(self, line, grown):
        residuals = (self.y - line[: len(self.y)]) * grown
        return residuals - residuals.mean()

    @staticmethod
    def _below(values, q):
        """Share of sorted values that are not above q, which may be an array."""
        return np.searchsorted(values, q, side="right") / len(values)

    def probability(self, q):
        """The probability that y is not above q, by the bridge: a :class:`_Found`."""
        n, m = len(self.y), len(self.x)
        value = self._below(self.sums, q)
        ofResidual = self._below(self.sortedLine, q - self.residuals)
        if self.turn > 0:
            low, high = (self._below(sums, q) for sums in self.turned)
            bySlope = (high - low) / self.turn
            ofResidual += bySlope * n * self.near * self.residuals / self.squares
        ofLine = self._below(self.sortedResiduals, q - self.line)
        expensive, cheap = ofResidual.var() * n / (n - 2), ofLine.var(ddof=1)
        return _Found(value, expensive, cheap, n, m)

    def controlled(self, q):
        """The probability that y is not above q, by the indicator: a :class:`_Found`."""
        ofLine = self._below(self.sortedResiduals, q - self.line)
        return _controlled((self.y <= q).astype(float), ofLine)


def _quantileAt(bridge, method, share):
    """The value at which the probability of ``method`` reaches a share; infinite for a share of 0
    or less, or 1 or more."""
    if not 0 < share < 1:
        return math.copysign(math.inf, share - 0.5)
    if method == "bridge":
        return float(bridge.sums[math.ceil(share * len(bridge.sums)) - 1])
    low, high = bridge.sums[0], bridge.sums[-1]
    while high - low > 1e-7 * (bridge.sums[-1] - bridge.sums[0]):
        middle = (low + high) / 2
        below = bridge.controlled(middle).value < share
        low, high = (middle, high) if below else (low, middle)
    return (low + high) / 2
