# SPDX-License-Identifier: GPL-2.0-or-later
"""Which values the rows of a study have: points of the unit cube, then values of what varies.

Points are those of OpenTURNS: independent random numbers, a Latin hypercube, or Sobol's sequence,
moved by a random vector. Correlated numbers follow a normal copula with the given rank correlation
(Spearman's). Between such points kriging stands for what the rows give.
"""

import contextlib
import itertools

import numpy as np
from scipy import optimize

from masonry.errors import Refused
from masonry.packages import needed
from .variables import Distribution

EDGE = 1e-12  # probabilities closer to 0 or 1 are moved here, where all quantiles are finite
# share of the variance that is no function of the properties: without it the covariance of long
# lengths is singular, and their likelihood is round-off, another one on every machine [-]
NUGGET = 1e-8
# lengths for each property, of which the likeliest begin as many searches without derivatives:
# those by derivatives end in the round-off of the likelihood
LENGTHS, SEARCHES = 32, 3
DESIGNS = ("random", "latin", "sobol", "grid", "ida")


@contextlib.contextmanager
def seeded(ot, seed):
    """Random numbers of OpenTURNS from a seed; those of the caller go on afterwards unchanged."""
    before = ot.RandomGenerator.GetState()
    ot.RandomGenerator.SetSeed(seed)
    try:
        yield
    finally:
        ot.RandomGenerator.SetState(before)


def points(design, count, dimension, seed):
    """Points of the unit cube: a list of lists, the same for the same seed."""
    if not dimension:
        return [[] for _ in range(count)]
    ot = needed("openturns")
    cube = ot.IndependentCopula(dimension)
    with seeded(ot, seed):
        if design == "random":
            made = ot.MonteCarloExperiment(cube, count)  # more rows begin with the same ones
        elif design == "latin":
            made = ot.LHSExperiment(cube, count, True, True)
        else:
            made = ot.LowDiscrepancyExperiment(ot.SobolSequence(), cube, count, True)
            made.setRandomize(True)
        return np.clip(made.generate(), EDGE, 1 - EDGE).tolist()


def _factorize(names, correlation):
    """The Cholesky factor of the normal copula of numbers with these rank correlations. Raises
    Refused."""
    ot = needed("openturns")
    matrix = ot.CorrelationMatrix(len(names))
    for (one, two), value in correlation.items():
        matrix[names.index(one), names.index(two)] = value
    normal = ot.NormalCopula.GetCorrelationFromSpearmanCorrelation
    try:
        return normal(matrix).computeCholesky()
    except (TypeError, RuntimeError):
        message = "correlation: no numbers have all these correlations at once"
        raise Refused(message) from None


def values(design, count, seed, vary, correlation):
    """What every row has, without fields; ``vary``: dict of name -> Distribution or Choice."""
    if design == "grid":
        rows = itertools.product(*(c.values for c in vary.values()))
        return [dict(zip(vary, row)) for row in rows]
    names = [n for n, v in vary.items() if isinstance(v, Distribution)]
    chosen = [n for n in vary if n not in names]
    cube = points(design, count, len(vary), seed)
    if correlation:
        factor, normal = _factorize(names, correlation), needed("openturns").Normal()
        cube = [_tied(point, factor, normal) for point in cube]
    columns = zip([*names, *chosen], zip(*cube))
    found = {name: vary[name].valuesAt(column) for name, column in columns}
    return [{name: found[name][row] for name in vary} for row in range(count)]


def _tied(point, factor, normal):
    """A point of the unit cube, whose first numbers get the dependence of a normal copula with this
    Cholesky factor."""
    size = range(factor.getNbRows())
    free = [normal.computeQuantile(point[i])[0] for i in size]
    tied = (sum(factor[i, j] * free[j] for j in size) for i in size)
    return [*map(normal.computeCDF, tied), *point[len(size) :]]


def kriging(u, column):
    """Slopes of the trend, lengths of the covariance, factors of the rows, and their leave-one-out
    errors."""
    ot, size = needed("openturns"), u.shape[1]
    if not column.any():  # the same in all rows
        return np.zeros(size + 1), np.ones(size), np.zeros(len(u)), np.zeros(len(u))
    rows, smooth = ot.Sample(u), ot.SquaredExponential([1.0] * size, [1.0])
    smooth.setNuggetFactor(NUGGET)
    trend, flags = ot.LinearBasisFactory(size).build(), ot.Log.Flags()
    ot.Log.Show(flags & ~ot.Log.WARN)  # of the bounds of lengths
    algorithm = ot.KrigingAlgorithm(rows, ot.Sample(column[:, None]), smooth, trend)
    likelihood, box = algorithm.getReducedLogLikelihoodFunction(), algorithm.getOptimizationBounds()
    ot.Log.Show(flags)
    low, high = np.log(box.getLowerBound()), np.log(box.getUpperBound())
    unlikely = lambda logarithms: -np.ravel(likelihood(np.exp(logarithms)))
    grid = low + (high - low) * np.array(points("sobol", LENGTHS * size, size, 1))
    starts = grid[np.argsort(unlikely(grid))[:SEARCHES]]
    search = {"method": "Nelder-Mead", "bounds": [*zip(low, high)]}
    found = [optimize.minimize(lambda one: unlikely([one])[0], x, **search) for x in starts]
    lengths = np.exp(min(found, key=lambda one: one.fun).x)
    smooth.setScale(lengths)
    inverse = np.linalg.inv(np.array(smooth.discretize(rows)))
    shapes = np.column_stack([np.ones(len(u)), u])
    slopes = np.linalg.solve(shapes.T @ inverse @ shapes, shapes.T @ inverse @ column)
    factors = inverse @ (column - shapes @ slopes)
    # O. Dubrule, Cross validation of kriging in a unique neighborhood (1983)
    return slopes, lengths, factors, factors / inverse.diagonal()
