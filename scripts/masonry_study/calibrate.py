# SPDX-License-Identifier: GPL-2.0-or-later
"""From tests of specimens to the properties that they have: values with intervals and correlations.

Rows of a study fill the ranges of what is unknown. A surrogate, kriging by OpenTURNS, stands for
the scene between them, and a Metropolis-Hastings chain of OpenTURNS draws properties with the
probability that the test gives them, where all values within their ranges are equally likely
beforehand. Errors are normal and independent: those of the test, and those of the surrogate, from
leave-one-out prediction. While the surrogate's error is more than half of the test's, another round
of rows fills what the draws keep of the ranges. A run with the means of the draws is compared with
the surrogate, and added to its rows while it differs.

A few accurate runs say how far the scene as it is run is off: their mean difference is added, and
its scatter is another error.
"""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from typing import Annotated, Any, Iterator, Sequence

import numpy as np
from scipy import stats

from masonry.arguments import FilePath, isA, listOf, number, text, validated, whole
from masonry.errors import Refused, refuse
from masonry.terminal import say
from masonry.packages import needed
from masonry_view.comparison import readMeasured
from masonry.numbers.files import readCurve
from . import pictures
from .designs import kriging, points, seeded
from .gathering import Folder, gather, written
from . import local
from .plan import Study
from .records import CURVE, Record
from .start import begin
from .variables import uniform

DRAWS, THINNING = 4000, 5  # of a chain
BEGIN = 0.1  # steps of the first chain over the ranges [-]
# step of a chain over the deviation of a draw and the root of the dimension: Gelman, Roberts and
# Gilks (1996)
STEP = 2.38
STARTS = 2000  # points of which the most likely one begins the first chain
MAX_ERROR_RATIO = 0.5  # of the surrogate to the test, beyond which rounds and checks go on [-]
CHECKS = 4  # runs with the means of the draws that may be added to the rows
MAX_VOLUME_RATIO = 0.5  # of another round to the last one; a larger one does not pay
TAIL, MARGIN = 0.005, 0.25  # what a next round has outside, and its margin over width
ENDS = 0.025, 0.975  # quantiles of an interval and of a band
#: Deviation of the draws over that of the range from which the test does not tell a property [-].
MAX_SPREAD = 0.8
MIN_PROBABILITY = 0.01  # below which the difference of scene and test is no chance [-]
END_DISTANCE = 0.01  # distance of an interval to the end of a range, over the range [-]
MAX_CORRELATION = 0.9  # beyond which two properties are known only together [-]
RESULT, PICTURE = "calibration.json", "calibration.png"  # in the folder


class Specimen:
    """A specimen that was tested: the scene of its test, and what was measured.

    :param scene: as in :class:`masonry_study.Study`
    :param measured: the curve as ``"FILE:X:Y"``, a table and two of its columns, FILE from the
        calibration's file on; or a dict of columns of ``study.csv`` -> (value, standard deviation)
    :param error: of a curve: standard deviation of Y, of the measurement or of the mean of several
        specimens
    :param columns: of ``curve.csv`` that X and Y are
    :param count: at how many points, evenly spaced along X, the curve is compared, with errors that
        are taken as independent
    :param options: of the scene, as in :class:`masonry_study.Study`
    :raises Refused: with all problems at once
    """

    @validated
    def __init__(
        self,
        scene: FilePath,
        measured: str | dict[str, tuple[float, float]],
        error: Annotated[float, number("", 0, above=True)] | None = None,
        columns: Annotated[tuple[str, str], listOf(text, 2)] = CURVE,
        count: Annotated[int, whole(2, 200)] = 12,
        options: Annotated[dict[str, Any], isA(dict)] | None = None,
    ) -> None:
        self.scene, self.measured, self.options = scene, measured, dict(options or {})
        self.columns, self.count, self.error = columns, count, error
        pairs = measured.items() if isinstance(measured, dict) else ()
        problems = [
            f"measured {name!r}: {pair!r} must be a value and a standard deviation above 0"
            for name, pair in pairs
            if not (isinstance(pair, (tuple, list)) and len(pair) == 2 and pair[1] > 0)
        ]
        if not measured or not isinstance(measured, (str, dict)):
            problems.append("measured must be 'FILE:X:Y' or a dict of columns")
        if isinstance(measured, str) != (error is not None):
            problems.append("error goes with a curve, and a curve needs it")
        refuse(problems, "specimen: ")

    def read(self, near: FilePath) -> None:
        """Read what was measured: ``names``, ``values`` and ``errors``, of a curve at ``grid``.
        Raises Refused."""
        if isinstance(self.measured, dict):
            self.names, self.grid = [*self.measured], None
            self.values, self.errors = np.array([*self.measured.values()], float).T
            return
        x, y, _ = readMeasured(os.path.join(near, self.measured))
        if (np.diff(x) < 0).any():
            raise Refused(f"{self.measured}: the first column must grow; cycles cannot be compared")
        self.curve, self.grid = (x, y), np.linspace(x[0], x[-1], self.count + 1)[1:]
        self.names = [f"{self.columns[1]} at {at:.3g}" for at in self.grid]
        self.values = np.interp(self.grid, *pictures.increasing(x, y))
        self.errors = np.full(self.count, self.error)

    def of(self, record: Record) -> np.ndarray:
        """What the rows of a study say of it: a line a row, NaN where a row says nothing."""
        if self.grid is None:
            return np.column_stack([record.numbers(name) for name in self.names])
        folder = Folder(record.directory)
        return np.array([self._onGrid(folder.row(int(n))) for n in record.cells["run"]])

    def _onGrid(self, path):
        try:
            curve = readCurve(path)
        except Refused:
            return np.full(self.count, np.nan)
        if missing := ", ".join(name for name in self.columns if name not in curve):
            raise Refused(
                f"{path}: curve.csv has no column {missing}; there are {', '.join(curve)}"
            )
        x, y = pictures.increasing(*(curve[name] for name in self.columns))
        reached = self.grid <= x[-1] + 0.01 * (x[-1] - x[0])
        return np.where(reached, np.interp(self.grid, x, y), np.nan)


class Calibration:
    """Properties that shall be found from tests.

    :param specimens: a :class:`Specimen`, or a list of them that share the properties
    :param unknown: dict of a name, or a tuple of names with one value, as in ``vary`` of
        :class:`masonry_study.Study`, to the two ends of its range
    :param runs: rows of a round and a specimen
    :param rounds: how many rounds there may be
    :param seed: the same number gives the same rows and draws
    :param accurate: options of accurate runs, such as ``{"preset": "accurate"}``; None: there are
        none
    :param few: how many accurate runs of a specimen
    :raises Refused: with all problems at once
    """

    @validated
    def __init__(
        self,
        specimens: Specimen | Sequence[Specimen],
        unknown: Annotated[dict[Any, tuple[float, float]], isA(dict)],
        runs: Annotated[int, whole(8, 10_000)] = 64,
        rounds: Annotated[int, whole(1, 9)] = 2,
        seed: Annotated[int, whole(0, 2**30)] = 1,
        accurate: Annotated[dict[str, Any], isA(dict)] | None = None,
        few: Annotated[int, whole(3, 100)] = 4,
    ) -> None:
        self.specimens = [specimens] if isinstance(specimens, Specimen) else [*specimens]
        self.runs, self.rounds, self.seed = runs, rounds, seed
        self.accurate, self.few, self.keys = accurate, few, [*unknown]
        if not (self.keys and self.specimens):
            raise Refused("calibration: there must be a specimen and something unknown")
        if runs < 3 * len(self.keys):
            raise Refused(
                f"calibration: {len(self.keys)} unknown properties need {3 * len(self.keys)} runs"
                " or more"
            )
        ranges = [dict(uniform(*ends).parameters) for ends in unknown.values()]
        self.low, self.high = (np.array([r[e] for r in ranges]) for e in ("low", "high"))
        for one in self.specimens:  # a study names all that is wrong
            self.names = [*self._study(one, self.low, self.high, runs, seed).vary]

    def _study(self, specimen, low, high, runs, seed, options=()):
        ends = zip(self.keys, low.tolist(), high.tolist())
        vary = {key: uniform(*both) for key, *both in ends}
        every = {**specimen.options, **dict(options)}
        return Study(specimen.scene, every, runs, seed, vary, "sobol")

    def find(self, place: FilePath, near: FilePath = ".", jobs: int = 1) -> Found:
        """Run what is missing, and find the properties.

        :param place: folder of the results; the same call goes on with them
        :param near: folder from which scenes and files are looked for
        :param jobs: runs at a time
        :raises Refused: if a scene or a measured file is wrong, or too few rows have what is
            compared
        """
        for one in self.specimens:
            one.read(near)
        self.values = np.hstack([one.values for one in self.specimens])
        self.errors = np.hstack([one.errors for one in self.specimens])
        self._place, self._near, self._jobs = place, near, jobs
        model, sample, run = self._checked(*self._fitted())
        if self.accurate is not None:
            low, high = np.quantile(sample, ENDS, axis=0)
            few = lambda s: self._study(s, low, high, self.few, self.seed, self.accurate)
            x, y = self._rows("accurate", few, 3)
            off = y - model(x)
            model.offset = model.offset + off.mean(axis=0)
            model.errors = off.std(axis=0, ddof=1) * math.sqrt(1 + 1 / len(off))
            sample = self._drawn(model)
            _, run = self._best("best", sample, self.accurate)
        found = Found(self, sample, model, run)
        written(os.path.join(place, RESULT), json.dumps(found.describe(), indent=1) + "\n")
        if any(one.grid is not None for one in self.specimens):
            pictures.calibration(os.path.join(place, PICTURE), found)
        return found

    def _drawn(self, model):
        return posterior(model, self.values, self.errors, self.seed)

    def _fitted(self):
        low, high = self.low, self.high
        x, y = np.empty((0, len(low))), np.empty((0, len(self.values)))
        for turn in range(self.rounds):
            study = lambda s: self._study(s, low, high, self.runs, self.seed + turn)
            more = self._rows(f"round{turn + 1}", study, 3 * len(low))
            x, y = map(np.vstack, zip((x, y), more))
            inside = ((x >= low) & (x <= high)).all(axis=1)
            model = Surrogate(x[inside], y[inside], low, high)
            sample = self._drawn(model)
            off = (model.errors / self.errors).max()
            what = f"the error of the surrogate is at most {off:.2g} of that of the test"
            say(f"round {turn + 1}: {what}")
            least, most = np.quantile(sample, (TAIL, 1 - TAIL), axis=0)
            margin = MARGIN * (most - least)
            least, most = np.maximum(least - margin, low), np.minimum(most + margin, high)
            if off <= MAX_ERROR_RATIO or np.prod((most - least) / (high - low)) > MAX_VOLUME_RATIO:
                break
            low, high = least, most
        return model, sample

    def _checked(self, model, sample):
        """Surrogate and draws after runs with the means of the draws, and what the last one of
        these says."""
        for turn in range(1, CHECKS + 2):
            x, run = self._best(f"check{turn}", sample)
            off = np.max(np.abs(run - model(x)) / self.errors, initial=0)
            if off <= MAX_ERROR_RATIO or turn > CHECKS:
                break
            say(
                f"check {turn}: at the means of the draws the surrogate is off by {off:.2g} of the"
                " error of the test"
            )
            rows = np.vstack([model.x, x]), np.vstack([model.y, run])
            model = Surrogate(*rows, model.low, model.high, turn)
            sample = self._drawn(model)
        return model, sample, run

    def _best(self, name, sample, options=()):
        means = dict(zip(self.keys, sample.mean(axis=0).tolist()))
        study = lambda s: Study(s.scene, {**s.options, **dict(options)}, vary=means, design="grid")
        return self._rows(name, study, 0)

    def _rows(self, name, studyOf, least):
        """Run a study of every specimen: the unknown properties of the rows, at least ``least``,
        and what all specimens say of them."""
        found = []
        for number, specimen in enumerate(self.specimens, 1):
            study, place = studyOf(specimen), f"specimen{number}_{name}"
            folder = begin(study, os.path.join(self._place, place), self._near)
            local.run(folder, self._jobs)
            gather(folder)
            record = Record(folder.path)
            found.append(specimen.of(record))
            x = np.column_stack([record.numbers(n) for n in self.names])
        y = np.hstack(found)
        have = np.isfinite(y).all(axis=1)
        if not have.all():
            say(
                f"{name}: {(~have).sum()} of {len(y)} rows failed or ended before the end of the"
                " curve, and are left out"
            )
        if have.sum() < least:
            raise Refused(
                f"{name}: {have.sum()} rows have all that is compared, and {least} are needed"
            )
        return x[have], y[have]


class Surrogate:
    """What a scene says as a function of the unknown properties within their ranges: kriging with a
    linear trend.

    :param x: of every row the unknown properties; ``y``: what it says
    :param low: ends of the ranges, and ``high``
    :param checks: how many rows at the end are checks, whose error is the least that is taken
    """

    def __init__(
        self, x: np.ndarray, y: np.ndarray, low: np.ndarray, high: np.ndarray, checks: int = 0
    ) -> None:
        self.x, self.y = x, y
        self.low, self.high, self.offset = low, high, y.mean(axis=0)
        u = (x - low) / (high - low)
        scale = np.where(np.ptp(y, axis=0) > 0, y.std(axis=0), 1.0)
        found = [kriging(u, column) for column in ((y - self.offset) / scale).T]
        slopes, lengths, factors, missed = map(np.array, zip(*found))
        self.weights, self.factors = 0.5 / np.square(lengths), scale[:, None] * factors
        squares = np.square(missed.T)
        near = squares[-checks:]  # none: all
        self.slopes = scale * slopes.T
        self.errors = scale * np.sqrt(np.maximum(squares.mean(axis=0), near.mean(axis=0)))
        self.cross = 2 * np.einsum("jd,nd->djn", self.weights, u).reshape(len(low), -1)
        self.own = np.einsum("jd,nd->jn", self.weights, u**2)

    def unit(self, u: np.ndarray) -> np.ndarray:
        """Its values for properties as shares of their ranges, a line each."""
        cross = (u @ self.cross).reshape(len(u), *self.own.shape)
        near = np.exp(cross - (u**2 @ self.weights.T)[:, :, None] - self.own)
        bent = np.einsum("mjn,jn->mj", near, self.factors)
        return self.offset + self.slopes[0] + u @ self.slopes[1:] + bent

    def __call__(self, x: np.ndarray) -> np.ndarray:
        return self.unit((x - self.low) / (self.high - self.low))


def posterior(model: Surrogate, values: np.ndarray, errors: np.ndarray, seed: int) -> np.ndarray:
    """Draws of the unknown properties, a line each, with the probability that measured values, with
    these standard deviations, give them."""
    ot, size, spread = needed("openturns"), len(model.low), np.hypot(errors, model.errors)
    misfit = lambda u: -0.5 * (((model.unit(u) - values) / spread) ** 2).sum(axis=1)
    density = ot.PythonFunction(size, 1, lambda u: [misfit(np.array([u]))[0]])
    cube = ot.Interval([0.0] * size, [1.0] * size)
    starts = np.array(points("sobol", STARTS, size, seed))
    start, steps = starts[misfit(starts).argmax()].tolist(), BEGIN**2 * np.eye(size)
    with seeded(ot, seed):
        # the first ones find how long the steps must be
        for thinning in (1, 1, THINNING):
            walk = ot.Normal([0.0] * size, ot.CovarianceMatrix(steps.tolist()))
            chain = ot.RandomWalkMetropolisHastings(density, cube, start, walk)
            chain.setBurnIn(DRAWS)
            drawn = np.array(chain.getSample(DRAWS * thinning))[thinning - 1 :: thinning]
            start = drawn[-1].tolist()
            steps = STEP**2 / size * np.atleast_2d(np.cov(drawn.T)) + 1e-10 * np.eye(size)
    return model.low + (model.high - model.low) * drawn


@dataclass
class Found:
    """What the tests say of the unknown properties.

    :param calibration: has what was measured as ``values``, with its standard deviations ``errors``
    :param sample: draws of the properties, a line each
    :param run: what a run with the means of the draws says, one line; none if it failed
    """

    calibration: Calibration
    sample: np.ndarray
    model: Surrogate
    run: np.ndarray

    @property
    def intervals(self) -> np.ndarray:
        """Low and high ends of 95 % intervals, a line each."""
        return np.quantile(self.sample, ENDS, axis=0)

    @property
    def spread(self) -> np.ndarray:
        """Standard deviations of the draws over those of the ranges [-]: 1 tells nothing."""
        ranges = self.calibration.high - self.calibration.low
        return math.sqrt(12) * self.sample.std(axis=0) / ranges

    @property
    def correlation(self) -> np.ndarray:
        return np.atleast_2d(np.corrcoef(self.sample.T))

    def bands(self) -> np.ndarray:
        """What the draws say of the test, the ends of 95 % bands: a line each."""
        return np.quantile(self.model(self.sample), ENDS, axis=0)

    def doubts(self) -> list[str]:
        """Sentences on what speaks against the intervals."""
        of, found, matrix = self.calibration, [], self.correlation
        off = (self.run - of.values) / np.hypot(of.errors, self.model.errors)
        if not len(off) or stats.chi2.sf((off**2).sum(), off.size) < MIN_PROBABILITY:
            found.append(
                "a run with these values does not follow the test within its errors: do not use"
                " them"
            )
        missed = np.abs(self.run - self.model(self.sample.mean(axis=0)[None]))
        if (missed > MAX_ERROR_RATIO * of.errors).any():
            found.append("the surrogate differs from a run with these values: give more runs")
        for n, (name, low, high) in enumerate(zip(of.names, *self.intervals)):
            near = END_DISTANCE * (of.high[n] - of.low[n])
            if self.spread[n] >= MAX_SPREAD:
                found.append(f"{name}: the test does not tell it")
            elif low < of.low[n] + near or high > of.high[n] - near:
                found.append(
                    f"{name}: its interval reaches an end of its range, which may be too narrow"
                )
            found += [
                f"{of.names[m]} and {name}: the test tells them only together, with a correlation"
                f" of {matrix[n, m]:.2f}"
                for m in range(n)
                if abs(matrix[n, m]) > MAX_CORRELATION
            ]
        return found

    @property
    def properties(self) -> list[dict[str, Any]]:
        columns = self.sample.mean(axis=0), *self.intervals, self.spread
        rows = zip(self.calibration.names, *(c.tolist() for c in columns))
        return [dict(zip("name value low high spread".split(), row)) for row in rows]

    def describe(self) -> dict[str, Any]:
        return {
            "properties": self.properties,
            "correlation": self.correlation.tolist(),
            "doubts": self.doubts(),
        }

    def lines(self) -> Iterator[str]:
        of = self.calibration
        wide = max(map(len, of.names))
        heads = f"{'property':{wide}}  {'value':>10}  {'95 % interval':^23}"
        yield f"{heads}  deviation over that of the range"
        line = "{name:{wide}}  {value:10.4g}  {low:10.4g} … {high:10.4g}  {spread:.2f}"
        for one in self.properties:
            yield line.format(wide=wide, **one)
        yield "correlation, in this order"
        for line in self.correlation:
            yield "  " + " ".join(f"{v:5.2f}" for v in line)
        names = [name for one in of.specimens for name in one.names]
        run = self.run[0] if len(self.run) else np.full(len(names), np.nan)
        for name, value, low, high, one in zip(names, of.values, *self.bands(), run):
            band = f"draws {low:.4g} … {high:.4g}"
            yield f"  {name}: measured {value:.4g}, {band}, run with their means {one:.4g}"
        yield from self.doubts()
        yield "for a study with these properties, whose report draws the band of all curves:"
        yield from self.forStudies()

    def forStudies(self) -> Iterator[str]:
        """Lines of Python: ``vary`` and ``correlation`` of :class:`masonry_study.Study`."""
        of, draws = self.calibration, self.sample
        yield "vary = {"
        for key, one, low, high in zip(of.keys, draws.T, of.low, of.high):
            cov = one.std() / abs(one.mean())
            yield (
                f"    {key!r}: normal(mean={one.mean():.4g}, cov={cov:.3g}, low={low:.4g},"
                f" high={high:.4g}),"
            )
        rank = lambda m, n: round(float(stats.spearmanr(draws[:, m], draws[:, n]).statistic), 2)
        ranks = {
            (of.keys[m], of.keys[n]): rank(m, n) for n in range(len(of.keys)) for m in range(n)
        }
        yield f"}}\ncorrelation = {ranks}"
