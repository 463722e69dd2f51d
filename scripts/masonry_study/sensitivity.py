# SPDX-License-Identifier: GPL-2.0-or-later
"""How much every varied property decides: changes, rank correlations, Sobol indices, and Shapley
effects where properties depend on each other.

Everything here is found from the rows that a study has, whatever their design. OpenTURNS fits the
polynomials. All shares are of the whole variance: what random fields make, and what is not
followed, has the rest.
"""

import itertools
import math
from collections import namedtuple

import numpy as np
from scipy import special, stats

from masonry.errors import Refused, refuse
from masonry.packages import needed
from .statistics import CONFIDENCE, Interval

#: What a varied property does. ``change`` of the output, an :class:`Interval`, when the property
#: goes from its 5 % to its 95 % quantile and the others stay, by the regression on all of them;
#: ``rank``, Spearman's correlation of ranks, an interval, too.
Effect = namedtuple("Effect", "change rank")

#: Sobol indices of a varied property, each an :class:`Interval`: the share of the variance that it
#: makes alone, and the share that it makes alone and together with others.
Indices = namedtuple("Indices", "first total")

#: The share of the variance that :func:`sobol` could explain [-], by leaving out each row in turn,
#: and the indices by name.
Sobol = namedtuple("Sobol", "explained indices")

#: The same share of :func:`shapley`, and its :class:`Interval` by name.
Shapley = namedtuple("Shapley", "explained effects")

SPAN = 0.05, 0.95  # quantiles of a property between which its change is given
DEGREE = 9  # highest degree of a polynomial in one property
HYPERBOLIC = 0.6  # norm that keeps products of high powers out
RESAMPLES = 300  # of the rows, for the intervals of Sobol indices and Shapley effects
MAX_PROPERTIES = 12  # of Shapley effects, which need all their subsets
DEPENDENT = (
    1e-4  # probability that independent properties are taken as dependent ones, over all pairs
)


def effects(inputs, output):
    """What every varied property does: a dict of name -> :class:`Effect`, strongest change first.
    Raises Refused if there are fewer than three rows more than properties.

    :param inputs: dict of name -> values, one a row; a property that has one value is left out
    :param output: of every row
    """
    inputs, x, y = _varying(inputs, output)
    n, k = x.shape
    free = n - k - 1
    if free < 2:
        raise Refused(
            f"the sensitivity of {k} properties needs {k + 3} rows or more, there are {n}"
        )
    scale = x.std(axis=0)
    design = np.column_stack([np.ones(n), (x - x.mean(axis=0)) / scale])
    slopes, _, rank, _ = np.linalg.lstsq(design, y, rcond=None)
    if rank < k + 1:
        raise Refused(
            "the sensitivity: varied properties follow from each other, which cannot be told apart"
        )
    residuals = y - design @ slopes
    scatter = residuals @ residuals / free * np.linalg.inv(design.T @ design).diagonal()
    t = stats.t.ppf((1 + CONFIDENCE) / 2, free)
    z = stats.norm.ppf((1 + CONFIDENCE) / 2)
    found = {}
    for i, name in enumerate(inputs):
        span = np.ptp(np.quantile(x[:, i], SPAN)) / scale[i]
        value, half = slopes[i + 1] * span, t * math.sqrt(scatter[i + 1]) * span
        rho = stats.spearmanr(x[:, i], y).statistic if np.ptp(y) else 0.0
        # D. G. Bonett and T. A. Wright, "Sample size requirements for estimating Pearson, Kendall
        # and Spearman correlations", Psychometrika 65 (2000): the variance of Fisher's transform
        wide = z * math.sqrt((1 + rho**2 / 2) / (n - 3))
        inner = np.arctanh(np.clip(rho, -1 + 1e-12, 1 - 1e-12))
        found[name] = Effect(
            Interval(value, value - half, value + half),
            Interval(rho, math.tanh(inner - wide), math.tanh(inner + wide)),
        )
    return dict(sorted(found.items(), key=lambda item: -abs(item[1].change.value)))


def sobol(inputs, output, seed=1):
    """First and total Sobol indices, from a polynomial chaos on the ranks of the varied properties.

    The rank of a property is uniform whatever its distribution; indices do not change by that.
    OpenTURNS chooses the polynomials by least angle regression, and the indices are sums of squares
    of their coefficients, times the share ``explained``. The intervals are those of RESAMPLES
    samples of the rows, drawn with replacement and ranked again, with the same polynomials.

    :param inputs: as in :func:`effects`, drawn independently of each other
    :param seed: of the samples
    :raises Refused: if there are fewer than ten rows a property, or properties are dependent
    """
    inputs, x, y = _varying(inputs, output)
    n = len(x)
    tied = dependent(inputs).items()
    apart = "Sobol indices need independent properties, {} and {} have a rank correlation of {:.2f}"
    refuse([*_unfit("Sobol indices", x, y), *(apart.format(*pair, rank) for pair, rank in tied)])
    y = (y - y.mean()) / y.std()
    powers = _polynomials(_ranks(x), y)
    fit = lambda terms, y: _shares(powers, np.linalg.lstsq(terms, y, rcond=None)[0])
    sharesOf = lambda rows: fit(_terms(powers, _ranks(x[rows])), y[rows])
    explained = _explained(_terms(powers, _ranks(x)), y)
    ends = explained * _withIntervals(sharesOf, n, seed)
    found = {n: Indices(Interval(*f), Interval(*t)) for n, f, t in zip(inputs, *ends)}
    found = dict(sorted(found.items(), key=lambda item: -item[1].total.value))
    return Sobol(explained, found)


def shapley(inputs, output, seed=1):
    """Shapley effects, the shares of the variance of properties that may depend on each other.

    What two properties explain together is divided evenly among them (A. B. Owen and C. Prieur, "On
    Shapley value for measuring importance of dependent inputs", SIAM/ASA J. Uncertainty
    Quantification 5 (2017)). The model is linear in the normal scores of the ranks, with which
    studies draw correlated properties; the effects are then means over all orders of the properties
    of what each adds to R². Parameters and intervals as in :func:`sobol`.

    :raises Refused: if there are fewer than ten rows a property, or more than MAX_PROPERTIES
    """
    inputs, x, y = _varying(inputs, output)
    n, k = x.shape
    refuse([*_unfit("Shapley effects", x, y)])
    if k > MAX_PROPERTIES:
        raise Refused(f"Shapley effects: {k} properties, there must be at most {MAX_PROPERTIES}")
    scores = lambda rows: stats.norm.ppf(_ranks(x[rows]))
    explained = _explained(np.column_stack([np.ones(n), scores(slice(None))]), y)
    sharesOf = lambda rows: _meanShares(np.corrcoef(scores(rows).T, y[rows]))
    ends = explained * _withIntervals(sharesOf, n, seed)
    found = {name: Interval(*one) for name, one in zip(inputs, ends)}
    return Shapley(explained, dict(sorted(found.items(), key=lambda item: -item[1].value)))


def dependent(inputs):
    """Pairs of properties that are no independent draws, by their rank correlation [-]: a dict."""
    kept = {name: values for name, values in inputs.items() if np.ptp(values) > 0}
    found, pairs = {}, [*itertools.combinations(kept, 2)]
    for one, two in pairs:
        rank = stats.spearmanr(kept[one], kept[two])
        if rank.pvalue < DEPENDENT / len(pairs):
            found[one, two] = float(rank.statistic)
    return found


def _ranks(x):
    return (stats.rankdata(x, axis=0) - 0.5) / len(x)


def _explained(terms, y):
    """The share of the variance that a regression explains, by leaving out each row in turn [-]; 0
    if it is worse than the mean."""
    hat = terms @ np.linalg.pinv(terms)
    errors = (y - hat @ y) / np.maximum(1 - hat.diagonal(), 1e-9)
    return max(0.0, 1 - errors @ errors / (len(y) * y.var()))


def _withIntervals(sharesOf, n, seed):
    """Shares, an array whose last axis has value, low and high.

    :param sharesOf: function of the numbers of some of the n rows
    """
    generator, shares = np.random.default_rng(seed), sharesOf(np.arange(n))
    resampled = [sharesOf(generator.integers(n, size=n)) for _ in range(RESAMPLES)]
    half = stats.norm.ppf((1 + CONFIDENCE) / 2) * np.std(resampled, axis=0)
    return np.stack([shares, *np.clip([shares - half, shares + half], 0, 1)], axis=-1)


def _meanShares(matrix):
    """Of every input its share in R², the mean over all orders of the inputs of what it adds.

    :param matrix: correlations of the inputs and, at the end, the output
    """
    k = len(matrix) - 1
    found, explained = np.zeros(k), {}
    for one in (s for size in range(k + 1) for s in itertools.combinations(range(k), size)):
        own = matrix[list(one), -1]
        explained[one] = own @ np.linalg.pinv(matrix[np.ix_(one, one)]) @ own if one else 0.0
        for i in one:
            before = tuple(n for n in one if n != i)
            added = explained[one] - explained[before]
            found[i] += added / (k * math.comb(k - 1, len(before)))
    return found / (found.sum() or 1)


def _unfit(what, x, y):
    n, k = x.shape
    if n < 10 * k:
        yield f"{what} of {k} properties need {10 * k} rows or more, there are {n}"
    if np.ptp(y) == 0:
        yield f"{what}: all results are the same"


def _polynomials(u, y):
    """The Legendre polynomials that OpenTURNS chooses: their degrees, a line each, the first of
    which is the constant."""
    ot, k = needed("openturns"), u.shape[1]
    count = ot.HyperbolicAnisotropicEnumerateFunction(k, HYPERBOLIC)
    basis = ot.OrthogonalProductPolynomialFactory([ot.LegendreFactory()] * k, count)
    # no more candidates than half of the rows, else chance chooses
    size = k + 1
    while 2 * (size + 1) <= len(u) and max(count(size)) <= DEGREE:
        size += 1
    chosen = ot.LeastSquaresMetaModelSelectionFactory(ot.LARS(), ot.CorrectedLeaveOneOut())
    how = ot.FixedStrategy(basis, size), ot.LeastSquaresStrategy(chosen)
    rows = ot.Sample(u), ot.Sample(y[:, None])
    algorithm = ot.FunctionalChaosAlgorithm(*rows, ot.IndependentCopula(k), *how)
    algorithm.run()
    # what every property does on its own stays in, so that an index of nothing has an interval, too
    chosen = {*range(k + 1), *map(int, algorithm.getResult().getIndices())}
    return np.array([list(count(i)) for i in sorted(chosen)])


def _terms(powers, u):
    """Values of Legendre polynomials, of variance 1 over uniform properties: a line a row, a column
    a polynomial."""
    values = special.eval_legendre(powers[None], 2 * u[:, None, :] - 1)
    return (values * np.sqrt(2 * powers + 1)).prod(axis=2)


def _shares(powers, coefficients):
    """First and total shares of the variance (2, properties)."""
    squares, involved = coefficients[1:] ** 2, powers[1:] > 0
    alone = involved & (involved.sum(axis=1) == 1)[:, None]
    return np.array([squares @ alone, squares @ involved]) / (squares.sum() or 1)


def _varying(inputs, output):
    """The properties that vary, their values (rows, properties) and the output. Raises Refused."""
    kept = {name: values for name, values in inputs.items() if np.ptp(values) > 0}
    if not kept:
        raise Refused("no property varies")
    return kept, np.column_stack([*kept.values()]).astype(float), np.asarray(output, float)
