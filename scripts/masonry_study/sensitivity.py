# SPDX-License-Identifier: GPL-2.0-or-later
"""How much every varied property decides: changes, rank correlations and Sobol indices.

Everything here is found from the rows that a study has, whatever their design, with varied
properties that are drawn independently of each other. OpenTURNS fits the polynomials.
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

#: The variance that :func:`sobol` could explain [-], by leaving out each row in turn, and the
#: indices by name.
Sobol = namedtuple("Sobol", "explained indices")

SPAN = 0.05, 0.95  # quantiles of a property between which its change is given
DEGREE = 9  # highest degree of a polynomial in one property
HYPERBOLIC = 0.6  # norm that keeps products of high powers out
RESAMPLES = 300  # of the rows, for the intervals of Sobol indices
DEPENDENT = (
    1e-4  # probability that independent properties are taken as dependent ones, over all pairs
)


def effects(inputs, output):
    """What every varied property does: a dict of name -> :class:`Effect`, strongest change first.

    :param inputs: dict of name -> values, one a row; a property that has one value is left out
    :param output: of every row
    :raises Refused: if there are fewer than three rows more than properties
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
    """First and total Sobol indices, from a polynomial chaos on the ranks of the varied properties:
    a :class:`Sobol`.

    The rank of a property is uniform whatever its distribution; indices do not change by that.
    OpenTURNS chooses the polynomials by least angle regression, and the indices are sums of squares
    of their coefficients. The intervals are those of RESAMPLES samples of the rows, drawn with
    replacement and ranked again, with the same polynomials; what these leave out, ``explained``
    tells.

    :param inputs: as in :func:`effects`, drawn independently of each other
    :param output: of every row
    :param seed: of the samples
    :raises Refused: if there are fewer than ten rows a property, or properties are dependent
    """
    inputs, x, y = _varying(inputs, output)
    n = len(x)
    refuse([*_unfit(inputs, x, y)])
    ranks = lambda rows: (stats.rankdata(x[rows], axis=0) - 0.5) / n
    u = ranks(np.arange(n))
    y = (y - y.mean()) / y.std()
    powers = _polynomials(u, y)
    terms = _terms(powers, u)
    coefficients = np.linalg.lstsq(terms, y, rcond=None)[0]
    hat = np.einsum("ij,ji->i", terms, np.linalg.pinv(terms))
    errors = (y - terms @ coefficients) / np.maximum(1 - hat, 1e-9)
    shares = _shares(powers, coefficients)
    generator, resampled = np.random.default_rng(seed), []
    for _ in range(RESAMPLES):
        rows = generator.integers(n, size=n)
        again = np.linalg.lstsq(_terms(powers, ranks(rows)), y[rows], rcond=None)[0]
        resampled.append(_shares(powers, again))
    half = stats.norm.ppf((1 + CONFIDENCE) / 2) * np.std(resampled, axis=0)
    low, high = np.clip([shares - half, shares + half], 0, 1)
    ends = np.stack([shares, low, high], axis=-1)  # (first and total, names, 3)
    found = {n: Indices(Interval(*f), Interval(*t)) for n, f, t in zip(inputs, *ends)}
    found = dict(sorted(found.items(), key=lambda item: -item[1].total.value))
    return Sobol(1 - errors @ errors / n, found)


def _unfit(names, x, y):
    """Sentences on why there are no Sobol indices of some rows."""
    n, k = x.shape
    if n < 10 * k:
        yield f"Sobol indices of {k} properties need {10 * k} rows or more, there are {n}"
    for (one, first), (two, second) in itertools.combinations(zip(names, x.T), 2):
        found = stats.spearmanr(first, second)
        if found.pvalue < 2 * DEPENDENT / (k * (k - 1)):
            yield (
                f"Sobol indices need independent properties, {one} and {two} have a rank"
                f" correlation of {found.statistic:.2f}"
            )
    if np.ptp(y) == 0:
        yield "Sobol indices: all results are the same"


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
    """First and total shares of the variance: an array (2, properties)."""
    squares, involved = coefficients[1:] ** 2, powers[1:] > 0
    alone = involved & (involved.sum(axis=1) == 1)[:, None]
    return np.array([squares @ alone, squares @ involved]) / (squares.sum() or 1)


def _varying(inputs, output):
    """The properties that vary, their values (rows, properties) and the output. Refuses if there
    are none."""
    kept = {name: values for name, values in inputs.items() if np.ptp(values) > 0}
    if not kept:
        raise Refused("no property varies")
    return kept, np.column_stack([*kept.values()]).astype(float), np.asarray(output, float)
