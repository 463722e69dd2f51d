# SPDX-License-Identifier: GPL-2.0-or-later
"""Statistics of the rows of a study, each with its confidence interval, which is that of
independent rows. Rows of a Latin hypercube or of a Sobol sequence are more even, so that a mean is
better known than its interval says. Values that are too few are refused.
"""

import math
from collections import Counter, namedtuple

import numpy as np
from scipy import stats

from masonry.errors import Refused

CONFIDENCE = 0.95  # of all intervals

#: A number with its confidence interval. An end that the rows cannot tell is minus or plus
#: infinity.
Interval = namedtuple("Interval", "value low high")

#: ``median`` and ``dispersion`` of a lognormal distribution, the second is the standard deviation
#: of the logarithm [-]; ``fits`` is the p-value of the test of Shapiro and Wilk that the logarithms
#: are normal.
Lognormal = namedtuple("Lognormal", "median dispersion fits")


def mean(values):
    """The mean, with the interval of Student's t, of two numbers or more."""
    values = _numbers(values, 2, "a mean with its interval")
    t = stats.t.ppf((1 + CONFIDENCE) / 2, len(values) - 1)
    middle, half = values.mean(), t * values.std(ddof=1) / math.sqrt(len(values))
    return Interval(middle, middle - half, middle + half)


def deviation(values):
    """The standard deviation, with an interval for distributions that need not be normal: D. G.
    Bonett, "Approximate confidence interval for standard deviation of nonnormal distributions",
    Computational Statistics & Data Analysis 50 (2006). The logarithm of the variance is normal,
    with the variance (kurtosis - (n - 3)/n)/(n - 1), where the kurtosis counts from a trimmed mean.

    :param values: ten numbers or more
    """
    values = _numbers(values, 10, "a standard deviation with its interval")
    n, spread = len(values), values.std(ddof=1)
    if spread == 0:
        return Interval(0.0, 0.0, 0.0)
    middle = stats.trim_mean(values, 1 / (2 * math.sqrt(n - 4)))
    squares = ((values - values.mean()) ** 2).sum()
    kurtosis = n * ((values - middle) ** 4).sum() / squares**2
    z = stats.norm.ppf((1 + CONFIDENCE) / 2)
    c = n / (n - z)
    half = z * c * math.sqrt(max(kurtosis - (n - 3) / n, 0) / (n - 1))
    ends = (math.sqrt(c * spread**2 * math.exp(sign * half)) for sign in (-1, 1))
    return Interval(spread, *ends)


def quantile(values, share):
    """The value below which a share of all lies, with an interval that holds for every
    distribution.

    The ends of the interval are values of the sample, by the binomial distribution of how many lie
    below. With too few of them an end is infinite: the 5 % quantile needs 72 rows for both ends of
    a 95 % interval.
    """
    values = np.sort(_numbers(values, 2, "a quantile"))
    n, tail = len(values), (1 - CONFIDENCE) / 2
    # the k-th smallest lies above the quantile with probability P(fewer than k lie below it)
    below = stats.binom.cdf(np.arange(n), n, share)
    low = values[below <= tail].max(initial=-math.inf)
    high = values[below >= 1 - tail].min(initial=math.inf)
    return Interval(*map(float, (np.quantile(values, share), low, high)))


def share(count, of):
    """A share of a number of rows, with Wilson's interval."""
    found = stats.binomtest(int(count), int(of))
    return Interval(count / of, *found.proportion_ci(CONFIDENCE, method="wilson"))


def shares(labels):
    counts = Counter(sorted(labels, key=str)).most_common()
    return {label: share(count, len(labels)) for label, count in counts}


def isLognormal(values):
    """Whether values, an array, can have a lognormal distribution."""
    return len(values) >= 3 and values.min() > 0 and np.ptp(np.log(values)) > 1e-12


def lognormal(values):
    """The lognormal distribution with the mean and standard deviation of the logarithms, of values
    for which :func:`isLognormal` holds."""
    logs = np.log(values)
    fits = stats.shapiro(logs).pvalue if len(logs) <= 5000 else math.nan
    return Lognormal(math.exp(logs.mean()), logs.std(ddof=1), fits)


def fragility(capacities, demands):
    """Probability that the capacity is not above a demand, with the exact interval of a share
    (Clopper and Pearson): for one demand at a time; a whole curve leaves the band more often.

    :param capacities: one of every row
    :param demands: an increasing sequence in the same unit
    :returns: three arrays: probability, low and high, one of each for every demand
    """
    capacities = np.sort(capacities)
    n = len(capacities)
    below = np.searchsorted(capacities, demands, side="right")
    tail = (1 - CONFIDENCE) / 2
    with np.errstate(invalid="ignore"):
        low = np.where(below == 0, 0.0, stats.beta.ppf(tail, below, n - below + 1))
        high = np.where(below == n, 1.0, stats.beta.ppf(1 - tail, below + 1, n - below))
    return below / n, low, high


def _numbers(values, least, what):
    """Values as an array. Refuses fewer than ``least``."""
    if len(values) < least:
        raise Refused(f"{what} needs {least} rows or more, there are {len(values)}")
    return np.asarray(values, float)
